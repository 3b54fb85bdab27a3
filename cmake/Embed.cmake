# ag_embed(target header name=file…)
#
# Embeds files in a program. The header declares `extern const struct embedded_file embedded_files[]`: name, bytes and size of
# each, ended by a NULL name. Run as a script, this file converts one file to a C array.
if(CMAKE_SCRIPT_MODE_FILE)
  file(READ "${INPUT}" bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  file(WRITE "${OUTPUT}" "${bytes}")
  return()
endif()
set(AG_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(ag_embed target header)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(arrays "")
  set(table "")
  set(bytes "")
  foreach(pair ${ARGN})
    string(REGEX MATCH "^([^=]+)=(.+)$" matched ${pair})
    set(name ${CMAKE_MATCH_1})
    set(file ${CMAKE_MATCH_2})
    string(MAKE_C_IDENTIFIER ${name} symbol)
    set(inc ${generated}/${name}.inc)
    add_custom_command(OUTPUT ${inc}
      COMMAND ${CMAKE_COMMAND} -DINPUT=${file} -DOUTPUT=${inc} -P ${AG_EMBED_SCRIPT}
      DEPENDS ${file} ${AG_EMBED_SCRIPT} COMMENT "Embedding ${name}" VERBATIM)
    list(APPEND bytes ${inc})
    string(APPEND arrays "static const unsigned char ${symbol}[] = {\n#include \"${name}.inc\"\n};\n")
    string(APPEND table "    { \"${name}\", ${symbol}, sizeof ${symbol} },\n")
  endforeach()
  file(MAKE_DIRECTORY ${generated})
  file(CONFIGURE OUTPUT ${generated}/${header} @ONLY CONTENT
    "#pragma once\n#include <stddef.h>\nstruct embedded_file {\n    const char *name;\n    const unsigned char *bytes;\n    size_t size;\n};\nextern const struct embedded_file embedded_files[];\n")
  file(CONFIGURE OUTPUT ${generated}/${target}_embedded.c @ONLY CONTENT
    "#include \"${header}\"\n${arrays}const struct embedded_file embedded_files[] = {\n${table}    { NULL, NULL, 0 },\n};\n")
  set_source_files_properties(${generated}/${target}_embedded.c PROPERTIES OBJECT_DEPENDS "${bytes}")
  target_sources(${target} PRIVATE ${generated}/${target}_embedded.c)
  target_include_directories(${target} PRIVATE ${generated})
endfunction()
