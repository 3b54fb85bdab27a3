#!/bin/sh
# subproject.sh SOURCE CC CXX LAUNCHER: add_subdirectory offers the targets of an installed copy, adds no program, test or
# install rule of the library's own, and builds a module and a shader.
set -eu
export CMAKE_GENERATOR=Ninja
source=$1 cc=$2 cxx=$3 launcher=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.25)
project(consumer C CXX)
include(CTest)
add_subdirectory($source afterglow)
add_executable(program $source/examples/minimal.c)
target_link_libraries(program PRIVATE afterglow::afterglow)
add_executable(program_static $source/examples/minimal.c)
target_link_libraries(program_static PRIVATE afterglow::afterglow_static)
foreach(name afterglow afterglow_manual minimal bench_frame)
  if(TARGET \${name})
    message(FATAL_ERROR "\${name} is a target")
  endif()
endforeach()
get_property(tests DIRECTORY $source PROPERTY TESTS)
if(tests)
  message(FATAL_ERROR "tests of the library: \${tests}")
endif()
END
cmake -S "$work" -B "$work/build" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER_LAUNCHER="$launcher" \
    -DCMAKE_BUILD_TYPE=Debug >"$work/log"
cmake --build "$work/build" --target ag_core afterglow/src/frame/generated/composite.comp.inc --parallel 2 >"$work/log" || { cat "$work/log"; exit 1; }
[ -s "$work/build/afterglow/shaders/composite.comp.spv" ]
cmake --install "$work/build" --prefix "$work/none" --component Unspecified >/dev/null 2>&1 || true
[ -z "$(find "$work/none" -type f 2>/dev/null)" ]
