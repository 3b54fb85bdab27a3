# ag_shaders(module header)
#
# Compiles every *.comp, *.vert and *.frag below the current folder to SPIR-V and embeds it in ag_<module>:
# `#include "<header>"` declares `extern const struct gpu_shader shader_<name>_<stage>` for each.
# The .spv files also land in <build>/shaders, the folder to give as AFTERGLOW_SHADER_DIR for reloading.
function(ag_shaders module header)
  ag_shaders_for(ag_${module} ${header} ${CMAKE_CURRENT_SOURCE_DIR})
endfunction()

# ag_shaders_for(target header folder): the same for any target and folder. The target's property AFTERGLOW_SPIRV lists the
# .spv files.
function(ag_shaders_for target header folder)
  file(GLOB_RECURSE shaders CONFIGURE_DEPENDS ${folder}/*.comp ${folder}/*.vert ${folder}/*.frag)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(declarations "#pragma once\n#include \"gpu/gpu.h\"\n")
  set(definitions "#include \"${header}\"\n")
  set(words "")
  set(spirv "")
  foreach(shader ${shaders})
    get_filename_component(name ${shader} NAME)
    string(REPLACE "." "_" symbol ${name})
    set(inc ${generated}/${name}.inc)
    set(spv ${CMAKE_BINARY_DIR}/shaders/${name}.spv)
    add_custom_command(OUTPUT ${inc} ${spv}
      COMMAND ${GLSLC} --target-env=vulkan1.3 -Werror -DAG_GLSL=1 -I${CMAKE_SOURCE_DIR}/src -MD -MF ${inc}.d -MT ${inc}
              -mfmt=c -o ${inc} ${shader}
      COMMAND ${GLSLC} --target-env=vulkan1.3 -DAG_GLSL=1 -I${CMAKE_SOURCE_DIR}/src -o ${spv} ${shader}
      DEPENDS ${shader} DEPFILE ${inc}.d COMMENT "GLSL ${name}" VERBATIM)
    list(APPEND words ${inc})
    list(APPEND spirv ${spv})
    string(APPEND declarations "extern const struct gpu_shader shader_${symbol};\n")
    string(APPEND definitions
      "static const uint32_t ${symbol}_words[] =\n#include \"${name}.inc\"\n;\n"
      "const struct gpu_shader shader_${symbol} = { \"${name}\", ${symbol}_words, sizeof ${symbol}_words / 4 };\n")
  endforeach()
  file(MAKE_DIRECTORY ${generated} ${CMAKE_BINARY_DIR}/shaders)
  file(CONFIGURE OUTPUT ${generated}/${header} CONTENT "${declarations}" @ONLY)
  file(CONFIGURE OUTPUT ${generated}/${target}_shaders.c CONTENT "${definitions}" @ONLY)
  set_property(TARGET ${target} PROPERTY AFTERGLOW_SPIRV ${spirv})
  set_source_files_properties(${generated}/${target}_shaders.c PROPERTIES OBJECT_DEPENDS "${words}")
  target_sources(${target} PRIVATE ${generated}/${target}_shaders.c)
  target_include_directories(${target} PUBLIC ${generated})
endfunction()
