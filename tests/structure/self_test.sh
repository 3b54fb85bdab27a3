#!/bin/sh
# self_test.sh CC CXX: the structure tests find violations. Each case is a small tree with a single violation, which the test
# must report.
set -u
here=$(cd "$(dirname "$0")" && pwd)
cc=$1 cxx=$2
tree=$(mktemp -d) || exit 1
trap 'rm -rf "$tree"' EXIT
bad=0

# A tree without violations.
fresh() {
    rm -rf "$tree/src" "$tree/include" "$tree/app" "$tree/examples"
    mkdir -p "$tree/src/core" "$tree/src/scene" "$tree/src/gpu" "$tree/src/trace" "$tree/src/frame/gbuffer" "$tree/src/frame/rsm" \
        "$tree/src/techniques/lpv" "$tree/src/techniques/vct" "$tree/src/new" "$tree/include/afterglow" "$tree/app" "$tree/examples"
    printf '#include "core/host.h"\n#include <stdio.h>\n' >"$tree/src/scene/scene.c"
    printf '#include "gpu/gpu.h"\n#include <vulkan/vulkan.h>\nvoid f(void) { vkCmdDraw(); }\n' >"$tree/src/gpu/gpu.c"
    printf 'OPTION(x)\n' >"$tree/src/techniques/lpv/lpv_options.def"
    printf '#include "frame/frame.h"\n#include "lpv_options.def"\n// as vkCmdDraw does\n/* and\n   rtcIntersect1 */\nconst char *s = "vkCmdDraw \\" //";\n' \
        >"$tree/src/techniques/lpv/lpv.c"
    printf '#include <afterglow/afterglow.h>\n' >"$tree/examples/first.c"
    printf '#ifndef X_H\n#define X_H\n#include <stdint.h>\nstruct ag_x { uint32_t v; };\n#endif\n' >"$tree/include/afterglow/x.h"
}

# fails NAME PATTERN COMMAND…: the command must fail and print the pattern.
fails() {
    name=$1 pattern=$2
    shift 2
    if output=$("$@" 2>&1); then
        echo "$name: not reported"
        bad=1
    elif ! printf '%s\n' "$output" | grep -q "$pattern"; then
        echo "$name: failed for another reason: $output"
        bad=1
    fi
}

passes() {
    name=$1
    shift
    if ! output=$("$@" 2>&1); then
        echo "$name: refused: $output"
        bad=1
    fi
}

# include_case FILE PATTERN TEXT: a file with this text in the good tree.
include_case() {
    fresh
    printf "$3\n" >"$tree/$1"
    fails "$1 with $3" "$2" "$here/include_table.sh" "$tree"
}

fresh
passes "a tree without violations" "$here/include_table.sh" "$tree"
include_case src/core/bad.c 'may not include scene/scene.h' '#include "scene/scene.h"'
include_case src/core/bad.c 'may not include jansson.h' '#include <jansson.h>'
include_case src/scene/bad.h 'may not include vulkan/vulkan.h' '#  include  <vulkan/vulkan.h>'
include_case src/scene/bad.c 'not written from src' '#include "../core/host.h"'
include_case src/scene/bad.c 'does not lie in src/scene' '#include "host.h"'
include_case src/gpu/bad.c 'may not include frame/frame.h' '#include "frame/frame.h"'
include_case src/frame/rsm/bad.c 'may not include frame/gbuffer' '#include "frame/gbuffer/gbuffer.h"'
include_case src/frame/rsm/bad.comp 'may not include frame/gbuffer' '#include "frame/gbuffer/gbuffer.glsl"'
include_case src/trace/bad.c 'may not include scene/import/gltf/gltf.h' '#include "scene/import/gltf/gltf.h"'
include_case src/frame/bad.c 'may not include techniques' '#include "techniques/technique.h"'
include_case src/techniques/lpv/bad.c 'may not include techniques/vct' '#include "techniques/vct/vct.h"'
include_case src/techniques/lpv/bad.comp 'may not include techniques/vct' '#include "techniques/vct/vct.glsl"'
include_case src/techniques/lpv/bad.c 'may not include image/image.h' '#include "image/image.h"'
include_case src/techniques/lpv/bad.c 'may not include frame/rsm' '#include "frame/rsm/rsm.h"'
include_case src/frame/bad.c 'Vulkan function outside' 'void f(void) { int a; /* x */ vkCmdDraw(a); }'
include_case examples/bad.c 'Vulkan function outside' 'void f(void) { vkCmdDraw(a); }'
include_case src/trace/bad.c 'Vulkan function outside' 'void f(void) { g("\\"", vkCmdDraw); }'
include_case src/gpu/bad.c 'Embree function outside' 'void f(void) { rtcNewDevice(0); }'
include_case src/new/bad.c 'no row' 'int x;'
include_case examples/bad.c 'may not include core/host.h' '#include "core/host.h"'
include_case app/bad.c 'may not include scene/scene.h' '#include "scene/scene.h"'
include_case include/afterglow/bad.h 'may not include vulkan' '#include <vulkan/vulkan.h>'

fresh
passes "clean text" "$here/source_text.sh" "$tree"
printf 'int x; \n' >"$tree/src/core/bad.c"
fails "a blank at the end of a line" 'src/core/bad.c:1' "$here/source_text.sh" "$tree"
printf 'int x;\t\n' >"$tree/src/core/bad.c"
fails "a tabulator at the end of a line" 'src/core/bad.c:1' "$here/source_text.sh" "$tree"
long=$(printf 'x%.0s' 1 2 3 4 5 6 7 8 9 10)
long=$long$long$long$long$long$long$long$long$long
printf '// %s…ü…ü…ü\n' "$long" >"$tree/src/core/bad.c"
passes "a line of 99 characters" "$here/source_text.sh" "$tree"
printf '// %s…ü…ü…ü…ü\n' "$long" >"$tree/src/core/bad.c"
fails "a line of 101 characters" 'src/core/bad.c:1: 101' "$here/source_text.sh" "$tree"
fresh
printf 'later: TO''DO\n' >"$tree/notes.md"
fails "work left for later" 'notes.md:1' "$here/source_text.sh" "$tree"
rm "$tree/notes.md"

fresh
cp "$here/../../.clang-format" "$tree"
printf 'int x;\n' | tee "$tree/src/gpu/gpu.c" >"$tree/src/techniques/lpv/lpv.c"
rm "$tree/include/afterglow/x.h"
"$here/format.sh" "$tree" >/dev/null 2>&1
if [ $? -ne 77 ]; then
    passes "formatted sources" "$here/format.sh" "$tree"
    printf 'int  x;\n' >"$tree/src/core/bad.c"
    fails "a C file that is not formatted" 'src/core/bad.c:1' "$here/format.sh" "$tree"
    rm "$tree/src/core/bad.c"
    printf 'float  x;\n' >"$tree/src/core/bad.comp"
    fails "a shader that is not formatted" 'src/core/bad.comp:1' "$here/format.sh" "$tree"
fi
rm "$tree/.clang-format"

fresh
passes "plain terms" "$here/wording.sh" "$tree"
printf 'Surfaces that glow.\n' >"$tree/notes.md"
fails "a phrase that has a term" 'notes.md:1:Surfaces that glow' "$here/wording.sh" "$tree"
rm "$tree/notes.md"
printf 'int x; // a picture of it\n' >"$tree/src/core/bad.c"
fails "a phrase in a comment" 'write instead: image' "$here/wording.sh" "$tree"
printf 'int x; // of it, what it is, where it is\nint lampshade; // so it is\n' >"$tree/src/core/bad.c"
passes "a comment of a member" "$here/wording.sh" "$tree"
for word in Of What Where So; do
    printf '// %s it is.\nint x;\n' "$word" >"$tree/src/core/bad.c"
    fails "a comment without a subject, $word" "bad.c:1:// $word it is" "$here/wording.sh" "$tree"
done
printf 'int x; // light of two lamps\n' >"$tree/src/core/bad.c"
fails "a lamp" 'write instead: punctual light' "$here/wording.sh" "$tree"
printf 'The point is inside of something.\n' >"$tree/src/core/bad.c"
fails "an inside without geometry" 'write instead: inside geometry' "$here/wording.sh" "$tree"
mkdir -p "$tree/src/techniques/vct"
printf '    { "lamps", "small_emitters" },\n' >"$tree/src/core/bad.c"
mv "$tree/src/core/bad.c" "$tree/src/techniques/vct/vct.c"
passes "a line that is allowed" "$here/wording.sh" "$tree"
cp "$tree/src/techniques/vct/vct.c" "$tree/src/core/bad.c"
fails "the same line in another file" 'core/bad.c:1:' "$here/wording.sh" "$tree"

fresh
passes "a header that stands alone" "$here/headers_alone.sh" "$tree/include" "$cc" "$cxx"
printf 'uint32_t ag_missing;\n' >"$tree/include/afterglow/bad.h"
fails "a header that needs another" 'bad.h: not C17 alone' "$here/headers_alone.sh" "$tree/include" "$cc" "$cxx"
printf '#ifndef B\n#define B\nstatic inline int ag_new(int class) { return class; }\n#endif\n' >"$tree/include/afterglow/bad.h"
fails "a header that is no C++" 'bad.h: not C++17 alone' "$here/headers_alone.sh" "$tree/include" "$cc" "$cxx"
printf 'struct ag_twice { int x; };\n' >"$tree/include/afterglow/bad.h"
fails "a header without a guard" 'bad.h: not C17 alone' "$here/headers_alone.sh" "$tree/include" "$cc" "$cxx"

# cycle_case A B C: three files whose functions call the named ones, and headers that include the same.
cycle_case() {
    rm -rf "$tree/include" "$tree/src" "$tree/build"
    mkdir -p "$tree/src/m" "$tree/build/src/m/CMakeFiles/ag_m.dir" "$tree/build/app"
    for file in a b c; do
        for other in $(eval "echo \$$file"); do
            printf '#include "m/%s.h"\n' "$other"
        done >"$tree/src/m/$file.h"
        {
            printf 'void %s(void);\n' a b c
            printf 'void %s(void) {' "$file"
            for other in $(eval "echo \$$file"); do printf ' %s();' "$other"; done
            printf ' }\n'
        } >"$tree/src/m/$file.c"
        "$cc" -c "$tree/src/m/$file.c" -o "$tree/build/src/m/CMakeFiles/ag_m.dir/$file.c.o" || bad=1
    done
}

a='b c' b=c c='' cycle_case
passes "files without a cycle" "$here/cycles.sh" "$tree/build" "$tree"
a=b b=c c=a cycle_case
fails "headers in a cycle" 'cycle of 3 files: src/m/a.h src/m/b.h src/m/c.h' "$here/cycles.sh" "$tree/build" "$tree"
fails "symbols in a cycle" 'src/m/c.c -> src/m/a.c: a$' "$here/cycles.sh" "$tree/build" "$tree"
a=b b='a c' c='' cycle_case
fails "a cycle of two" 'cycle of 2 files: src/m/a.c src/m/b.c$' "$here/cycles.sh" "$tree/build" "$tree"
exit $bad
