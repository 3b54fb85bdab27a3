# The public functions, through the public headers alone.
foreach(name arguments context scene catalogue)
  ag_test(api/${name} USES api)
endforeach()
