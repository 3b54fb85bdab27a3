#!/bin/sh
# install.sh BUILD SOURCE CC CXX GLSLC: an installed copy, which can be moved, is enough to build the examples outside of the
# tree and to run them: as C and C++, with either library, by pkg-config and by find_package. It has the texts that belong to
# it, and shader functions that compile. The importer program is found beside either library, and refused in words where it
# is missing.
set -eu
export CMAKE_GENERATOR=Ninja
build=$1 source=$2 cc=$3 cxx=$4 glslc=$5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/moved"
prefix=$work/moved
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name afterglow.pc)")
export PKG_CONFIG_PATH
lib=$(pkg-config --variable=libdir afterglow)
flags=$(pkg-config --cflags --libs afterglow)
static_flags=$(pkg-config --cflags --libs afterglow-static)
rpath=-Wl,-rpath,$lib
doc=$prefix/share/doc/afterglow
unset LD_LIBRARY_PATH AFTERGLOW_IMPORTER

# ---- pkg-config: C and C++, shared and static, the same picture
# shellcheck disable=SC2086 # lists of words
{
    for name in minimal embed_1 textured balls measure side_by_side views; do
        "$cc" -Wall -Werror "$doc/examples/$name.c" $flags "$rpath" -o "$work/$name"
    done
    "$cc" -Wall -Werror "$doc"/examples/host*.c $flags -lvulkan -lm "$rpath" -o "$work/host"
    "$cc" -Wall -Werror "$doc"/examples/engine*.c "$doc"/examples/host_*.c $flags -lvulkan -lm -pthread "$rpath" -o "$work/engine"
    for name in embed_2 embed_3; do
        "$cc" -Wall -Werror "$doc/examples/$name.c" "$doc"/examples/host_*.c $flags -lvulkan -lm "$rpath" -o "$work/$name"
    done
    for name in minimal host; do
        "$cxx" -x c++ -std=c++20 -Wall -Werror "$doc/examples/$name"*.c -x none $flags -lvulkan "$rpath" -o "$work/$name-cxx"
    done
    "$cc" "$doc/examples/minimal.c" $static_flags -o "$work/minimal-static"
    "$cxx" -x c++ -std=c++20 "$doc/examples/minimal.c" -x none $static_flags -o "$work/minimal-static-cxx"
}
for name in minimal minimal-cxx minimal-static minimal-static-cxx; do
    "$work/$name" "$work/$name.png"
    cmp "$work/minimal.png" "$work/$name.png"
done
for name in host host-cxx; do "$work/$name" "$work/$name.png"; done
cmp "$work/host.png" "$work/host-cxx.png"
for name in minimal minimal-cxx; do readelf -d "$work/$name" | grep -q 'NEEDED.*libafterglow\.so'; done
for name in minimal-static minimal-static-cxx; do ! readelf -d "$work/$name" | grep -q 'NEEDED.*libafterglow'; done

# ---- find_package: both targets; a project of C++ alone needs no third-party library
mkdir "$work/c" "$work/cxx"
cat >"$work/c/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(consumer C)
find_package(afterglow 0.1 REQUIRED COMPONENTS static)
foreach(kind afterglow afterglow_static)
  add_executable(minimal-${kind} ${EXAMPLES}/minimal.c)
  target_link_libraries(minimal-${kind} PRIVATE afterglow::${kind})
endforeach()
END
cat >"$work/cxx/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(consumer CXX)
set(CMAKE_CXX_STANDARD 20)
find_package(afterglow 0.1 REQUIRED)
configure_file(${EXAMPLES}/minimal.c minimal.cpp COPYONLY)
add_executable(minimal-afterglow ${CMAKE_CURRENT_BINARY_DIR}/minimal.cpp)
target_link_libraries(minimal-afterglow PRIVATE afterglow::afterglow)
END
for language in c cxx; do
    cmake --no-warn-unused-cli -S "$work/$language" -B "$work/$language/build" -DCMAKE_PREFIX_PATH="$prefix" -DEXAMPLES="$doc/examples" \
        -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" >/dev/null
    cmake --build "$work/$language/build" >/dev/null
    for program in "$work/$language"/build/minimal-afterglow*; do
        [ -x "$program" ] || continue
        "$program" "$work/found.png"
        cmp "$work/minimal.png" "$work/found.png"
        rm "$work/found.png"
    done
done
[ -x "$work/c/build/minimal-afterglow_static" ]

# ---- the texts, and shader functions for a host's own shaders
grep -q . "$doc/LICENSE"
grep -q . "$doc/docs/library.md"
cat >"$work/host.comp" <<'END'
#version 460
#extension GL_EXT_scalar_block_layout : require
#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "frame/octahedral.glsl"
#include "frame/probes.glsl"
#include "techniques/common/probes/lookup.glsl"
layout(local_size_x = 1) in;
layout(binding = 0) uniform sampler3D volume;
layout(binding = 1) uniform sampler2D depths;
layout(binding = 2, scalar) buffer Data { frame_probes grid; int visibility; vec3 position, normal, irradiance; } data;
void main()
{
    vec3 normal = octahedral_decode(octahedral_encode(data.normal));
    data.irradiance = probes_published_irradiance(volume, depths, data.grid, data.visibility, data.position, normal);
}
END
"$glslc" --target-env=vulkan1.3 -DAG_GLSL=1 -I "$(pkg-config --variable=glsldir afterglow)" "$work/host.comp" -o "$work/host.spv"

# ---- programs
"$prefix/bin/afterglow" --version
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$work/triangle.obj"
cat >"$work/load.c" <<'END'
#include <afterglow/afterglow.h>
#include <stdio.h>
int main(int argc, char **argv)
{
    struct ag_context *context;
    struct ag_scene *scene;
    if (argc < 2 || ag_context_create(NULL, &context) != AG_OK) return 2;
    enum ag_result result = ag_scene_load(context, argv[1], &scene);
    if (result != AG_OK) fprintf(stderr, "%s\n", ag_context_last_error(context));
    ag_scene_destroy(scene);
    ag_context_destroy(context);
    return result != AG_OK;
}
END
# shellcheck disable=SC2086
"$cc" "$work/load.c" $flags "$rpath" -o "$work/load"
"$work/load" "$work/triangle.obj"
"$prefix/bin/afterglow" info "$work/triangle.obj" | grep -q 'triangles *1'
rm -r "$prefix/libexec"
! "$prefix/bin/afterglow" info "$work/triangle.obj" 2>"$work/refused"
grep -q afterglow-import "$work/refused"
