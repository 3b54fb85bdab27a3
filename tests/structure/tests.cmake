# Checks of the sources. POSIX shell and awk, so that they run wherever the project builds.
set(structure ${CMAKE_CURRENT_SOURCE_DIR}/structure)
add_test(NAME structure.include_table COMMAND sh ${structure}/include_table.sh ${CMAKE_SOURCE_DIR})
add_test(NAME structure.source_text COMMAND sh ${structure}/source_text.sh ${CMAKE_SOURCE_DIR})
add_test(NAME structure.headers_alone
  COMMAND sh ${structure}/headers_alone.sh ${CMAKE_SOURCE_DIR}/include ${CMAKE_C_COMPILER} ${CMAKE_CXX_COMPILER})
add_test(NAME structure.self_test COMMAND sh ${structure}/self_test.sh ${CMAKE_C_COMPILER} ${CMAKE_CXX_COMPILER})
add_test(NAME structure.format COMMAND sh ${structure}/format.sh ${CMAKE_SOURCE_DIR})
add_test(NAME structure.wording COMMAND sh ${structure}/wording.sh ${CMAKE_SOURCE_DIR})
add_test(NAME structure.cycles COMMAND sh ${structure}/cycles.sh ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR})
add_executable(test_sample_cases framework/sample_cases.c)
target_link_libraries(test_sample_cases PRIVATE ag_test_framework afterglow_flags)
set_target_properties(test_sample_cases PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
add_test(NAME structure.check COMMAND sh ${structure}/check.sh ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR} $<TARGET_FILE:test_sample_cases>)
set_tests_properties(structure.include_table structure.source_text structure.headers_alone structure.self_test
  structure.format structure.wording structure.cycles structure.check PROPERTIES TIMEOUT 300 LABELS structure)
set_tests_properties(structure.format PROPERTIES SKIP_RETURN_CODE 77)

# The public headers are part of the build, so that errors in them appear early.
file(GLOB public_headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/include/afterglow/*.h)
foreach(header ${public_headers})
  get_filename_component(name ${header} NAME_WE)
  set(sources "")
  foreach(extension c cpp)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.${extension})
    file(CONFIGURE OUTPUT ${source} CONTENT "#include <${header}>\n" @ONLY)
    list(APPEND sources ${source})
  endforeach()
  add_library(header_${name} OBJECT ${sources})
  target_include_directories(header_${name} PRIVATE ${CMAKE_SOURCE_DIR}/include)
  target_compile_options(header_${name} PRIVATE -Wall -Wextra -Wpedantic -Werror)
  set_target_properties(header_${name} PROPERTIES C_EXTENSIONS OFF CXX_EXTENSIONS OFF)
endforeach()

# C and GLSL agree about the structs that they share, in the shaders as they were built.
file(GLOB_RECURSE shared_headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/*_shared.h)
set(shared_structs ${CMAKE_CURRENT_BINARY_DIR}/structure/shared_structs)
add_custom_command(OUTPUT ${shared_structs}.inc ${shared_structs}.spv
  COMMAND awk -f ${structure}/shared_structs.awk ${shared_headers} > ${shared_structs}.inc
  COMMAND awk -v glsl=1 -f ${structure}/shared_structs.awk ${shared_headers} > ${shared_structs}.comp
  COMMAND ${GLSLC} --target-env=vulkan1.3 -Werror -DAG_GLSL=1 -I${CMAKE_SOURCE_DIR}/src
          -o ${shared_structs}.spv ${shared_structs}.comp
  DEPENDS ${structure}/shared_structs.awk ${shared_headers} ${CMAKE_SOURCE_DIR}/src/core/shared.h VERBATIM)
set(shared_spirv ${shared_structs}.spv)
foreach(module frame techniques)
  get_target_property(spirv ag_${module} AFTERGLOW_SPIRV)
  list(APPEND shared_spirv ${spirv})
endforeach()
list(JOIN shared_spirv "\",\n\"" paths)
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/structure/shared_shaders.inc CONTENT "\"${paths}\"\n" @ONLY)
ag_test(structure/shared_layout USES frame techniques LIBRARIES PkgConfig::SPIRV_CROSS)
target_sources(test_structure PRIVATE ${shared_structs}.inc)
target_include_directories(test_structure PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/structure)
