#!/bin/sh
# light_build.sh SOURCE LIBRARY SHADERS CC CXX LAUNCHER: a library without the reference, bakes, files and OpenMP needs the Vulkan
# loader alone beside the C library. It renders the images of the full LIBRARY, refuses in words what it is without, and exports
# the same functions. Installed, its static library needs no more. It takes over the SPIR-V in the folder SHADERS.
set -eu
export CMAKE_GENERATOR=Ninja
source=$1 library=$2 shaders=$3 cc=$4 cxx=$5 launcher=$6
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake -S "$source" -B "$work/build" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER_LAUNCHER="$launcher" \
    -DCMAKE_BUILD_TYPE=None -DAFTERGLOW_TESTS=OFF -DAFTERGLOW_PROGRAMS=OFF -DAFTERGLOW_REFERENCE=OFF -DAFTERGLOW_FILES=OFF \
    -DAFTERGLOW_OPENMP=OFF -DAFTERGLOW_SPIRV_FROM="$shaders" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work/build" --parallel 2 >"$work/log" 2>&1 || { tail -40 "$work/log"; exit 1; }
light=$work/build/libafterglow.so
! grep -q 'warning:' "$work/log" || { grep -A4 'warning:' "$work/log"; exit 1; }

needed=$(readelf -d "$light" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | sort | paste -s -d ' ')
echo "needed: $needed"
for name in $needed; do
    case $name in
    libc.so.* | libm.so.* | ld-linux* | libvulkan.so.*) ;;
    *) echo "$name is needed"; exit 1 ;;
    esac
done
[ -z "$(ldd -r "$light" | grep 'undefined symbol')" ] || { ldd -r "$light"; exit 1; }
for file in "$light" "$library"; do nm -D --defined-only "$file" | awk '$2 == "T" { print $3 }' | sort >"$work/$(basename "$(dirname "$file")").names"; done
diff "$work/$(basename "$(dirname "$library")").names" "$work/build.names" || { echo "< full, > light: exported functions"; exit 1; }

for kind in light full; do
    file=$light
    [ $kind = light ] || file=$library
    "$cc" -Wall -I "$source/include" "$source/tests/api/light_host.c" "$file" "-Wl,-rpath,$(dirname "$file")" -o "$work/$kind"
    status=0
    "$work/$kind" $kind >"$work/$kind.out" || status=$?
    [ $status -eq 0 ] || { cat "$work/$kind.out"; exit $status; }
done

cmake --install "$work/build" --prefix "$work/installed" >/dev/null
PKG_CONFIG_PATH=$(dirname "$(find "$work/installed" -name afterglow-static.pc)")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046 # a list of words
"$cc" "$source/tests/api/light_host.c" $(pkg-config --cflags --libs afterglow-static) -o "$work/static"
"$work/static" >"$work/static.out"
diff "$work/light.out" "$work/static.out"
cat "$work/light.out"
diff "$work/full.out" "$work/light.out"
