foreach(name arena file hash host option parallel rng sampling sh vec)
  ag_test(core/${name} USES core)
endforeach()
