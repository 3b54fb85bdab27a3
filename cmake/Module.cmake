# ag_module(name [USES module…] [THIRD_PARTY target…])
#
# One static library per module, target ag_<name>, from all .c files of the folder. It may include the modules of USES and, in its
# own .c files, the libraries of THIRD_PARTY.
function(ag_module name)
  cmake_parse_arguments(arg "" "" "USES;THIRD_PARTY" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.c)
  if(NOT sources)
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/empty.c CONTENT "typedef int ag_empty_${name};\n")
    set(sources ${CMAKE_CURRENT_BINARY_DIR}/empty.c)
  endif()
  add_library(ag_${name} STATIC ${sources})
  target_include_directories(ag_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
  target_compile_definitions(ag_${name} PRIVATE AG_BUILD)
  list(TRANSFORM arg_USES PREPEND ag_)
  target_link_libraries(ag_${name} PUBLIC ${arg_USES} PRIVATE afterglow_flags ${arg_THIRD_PARTY})
  set_property(GLOBAL APPEND PROPERTY AFTERGLOW_MODULES ag_${name})
endfunction()
