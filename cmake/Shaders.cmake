# AFTERGLOW_SPIRV_FROM: folder of the .spv files that another build of the same sources compiled, which are taken over. Builds for sanitizers
# need not compile them again.
set(AFTERGLOW_SPIRV_FROM "" CACHE PATH "Folder with the SPIR-V of another build of these sources; empty: compile")
add_custom_target(shaders)

# ag_shaders(module header [folder…])
#
# Compiles every *.comp, *.vert and *.frag below the current folder, but for some of its folders, to SPIR-V and embeds it in ag_<module>:
# `#include "<header>"` declares `extern const struct gpu_shader shader_<name>_<stage>` for each.
# The .spv files also land in <build>/shaders, the folder to give as AFTERGLOW_SHADER_DIR for reloading.
#
# The name is the path below the current folder with '_' for '/'. A folder that the next part of the path repeats is
# left out: lpv/apply/apply.comp is lpv_apply, vct/cones/edges.comp is vct_cones_edges.
#
# Permutations: a file shader_variants.txt beside the shaders has one line for each, "FILE SUFFIX [DEFINITION...]".
# "trace.comp svo VCT_SVO=1" compiles trace.comp with -DVCT_SVO=1 as <name of trace>_svo. A suffix may name the stage,
# so that stages share a .glsl file: "add.glsl raster.frag VCT_RASTER=1". A shader that is listed is compiled only as
# its lines say.
function(ag_shaders module header)
  ag_shaders_for(ag_${module} ${header} ${CMAKE_CURRENT_SOURCE_DIR} ${ARGN})
endfunction()

# ag_shader_name(result path): the name of the shader at a relative path, without its extension.
function(ag_shader_name result path)
  string(REGEX REPLACE "\\.[a-z]+$" "" path ${path})
  string(REPLACE "/" ";" parts ${path})
  set(name "")
  set(previous "")
  foreach(part ${parts})
    if(previous AND NOT "${part}_" MATCHES "^${previous}_")
      string(APPEND name ${previous}_)
    endif()
    set(previous ${part})
  endforeach()
  set(${result} ${name}${previous} PARENT_SCOPE)
endfunction()

# ag_shader_units(result folder [folder in it to leave out…]): all compilations, as "path|name.stage|definitions", definitions separated by commas.
function(ag_shader_units result folder)
  file(GLOB_RECURSE shaders CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*.comp ${folder}/*.vert ${folder}/*.frag)
  file(GLOB_RECURSE lists CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/shader_variants.txt)
  foreach(left_out ${ARGN})
    list(FILTER shaders EXCLUDE REGEX "^${left_out}/")
    list(FILTER lists EXCLUDE REGEX "^${left_out}/")
  endforeach()
  set(units "")
  foreach(list ${lists})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder}/${list})
    get_filename_component(subfolder ${list} DIRECTORY)
    file(STRINGS ${folder}/${list} lines REGEX "^[^#]")
    foreach(line ${lines})
      separate_arguments(words UNIX_COMMAND "${line}")
      list(POP_FRONT words file suffix)
      set(path ${subfolder}/${file})
      if(NOT EXISTS ${folder}/${path})
        message(FATAL_ERROR "${folder}/${list}: there is no ${file}")
      endif()
      ag_shader_name(name ${path})
      if(NOT suffix MATCHES "[.]")
        string(REGEX MATCH "[.][a-z]+$" stage ${file})
        string(APPEND suffix ${stage})
      endif()
      list(JOIN words "," definitions)
      list(APPEND units "${path}|${name}_${suffix}|${definitions}")
      list(REMOVE_ITEM shaders ${path})
    endforeach()
  endforeach()
  foreach(path ${shaders})
    ag_shader_name(name ${path})
    string(REGEX MATCH "[.][a-z]+$" stage ${path})
    list(APPEND units "${path}|${name}${stage}|")
  endforeach()
  set(${result} ${units} PARENT_SCOPE)
endfunction()

# ag_shaders_for(target header folder [folder in it to leave out…]): the same for any target and folder. The target's property AFTERGLOW_SPIRV lists the
# .spv files.
function(ag_shaders_for target header folder)
  ag_shader_units(units ${folder} ${ARGN})
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(declarations "#pragma once\n#include \"gpu/gpu.h\"\n")
  set(definitions "#include \"${header}\"\n")
  set(words "")
  set(spirv "")
  foreach(unit ${units})
    string(REGEX MATCH "^([^|]*)[|](([^|]*)[.]([a-z]+))[|](.*)$" unit ${unit})
    set(shader ${folder}/${CMAKE_MATCH_1})
    set(name ${CMAKE_MATCH_2})
    set(stage ${CMAKE_MATCH_4})
    set(symbol ${CMAKE_MATCH_3}_${CMAKE_MATCH_4})
    string(REPLACE "," ";" defines "${CMAKE_MATCH_5}")
    list(TRANSFORM defines PREPEND -D)
    set(inc ${generated}/${name}.inc)
    set(spv ${PROJECT_BINARY_DIR}/shaders/${name}.spv)
    # The words of the .spv file, as text for the C compiler.
    set(write_words od -An -v -tx4 -w64 ${spv} | sed "s/ \\([0-9a-f]*\\)/0x\\1,/g" > ${inc})
    if(AFTERGLOW_SPIRV_FROM)
      add_custom_command(OUTPUT ${inc} ${spv}
        COMMAND cp ${AFTERGLOW_SPIRV_FROM}/${name}.spv ${spv}
        COMMAND ${write_words} DEPENDS ${AFTERGLOW_SPIRV_FROM}/${name}.spv COMMENT "SPIR-V ${name}" VERBATIM)
    else()
      add_custom_command(OUTPUT ${inc} ${spv}
        COMMAND ${GLSLC} -fshader-stage=${stage} --target-env=vulkan1.3 -Werror -DAG_GLSL=1 ${defines}
                -I${PROJECT_SOURCE_DIR}/src -MD -MF ${inc}.d -MT ${inc} -o ${spv} ${shader}
        COMMAND ${write_words} DEPENDS ${shader} DEPFILE ${inc}.d COMMENT "GLSL ${name}" VERBATIM)
    endif()
    list(APPEND words ${inc})
    list(APPEND spirv ${spv})
    string(APPEND declarations "extern const struct gpu_shader shader_${symbol};\n")
    string(APPEND definitions
      "static const uint32_t ${symbol}_words[] = {\n#include \"${name}.inc\"\n};\n"
      "const struct gpu_shader shader_${symbol} = { \"${name}\", ${symbol}_words, sizeof ${symbol}_words / 4 };\n")
  endforeach()
  file(MAKE_DIRECTORY ${generated} ${PROJECT_BINARY_DIR}/shaders)
  file(CONFIGURE OUTPUT ${generated}/${header} CONTENT "${declarations}" @ONLY)
  file(CONFIGURE OUTPUT ${generated}/${target}_shaders.c CONTENT "${definitions}" @ONLY)
  set_property(TARGET ${target} PROPERTY AFTERGLOW_SPIRV ${spirv})
  add_custom_target(${target}_spirv DEPENDS ${spirv})
  add_dependencies(${target} ${target}_spirv)
  add_dependencies(shaders ${target}_spirv)
  set_source_files_properties(${generated}/${target}_shaders.c PROPERTIES OBJECT_DEPENDS "${words}")
  target_sources(${target} PRIVATE ${generated}/${target}_shaders.c)
  target_include_directories(${target} PUBLIC ${generated})
endfunction()
