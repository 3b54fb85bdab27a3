#!/bin/sh
# install.sh BUILD SOURCE CC: what is installed is enough to build the first example and to run it, with pkg-config and
# either library, and the tree can be moved: the importer program is found beside either, and refused in words where it is
# missing.
set -eu
build=$1 source=$2 cc=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/moved"
PKG_CONFIG_PATH=$(dirname "$(find "$work/moved" -name afterglow.pc)")
export PKG_CONFIG_PATH
lib=$(dirname "$PKG_CONFIG_PATH")
example=$source/examples/minimal.c
# shellcheck disable=SC2046 # lists of words
"$cc" "$example" $(pkg-config --cflags --libs afterglow) -o "$work/shared"
# shellcheck disable=SC2046
"$cc" "$example" $(pkg-config --cflags afterglow) "$lib/libafterglow.a" \
    $(pkg-config --static --libs afterglow | sed 's/-lafterglow//') -o "$work/static"
LD_LIBRARY_PATH=$lib "$work/shared" "$work/shared.png"
"$work/static" "$work/static.png"
cmp "$work/shared.png" "$work/static.png"
"$work/moved/bin/afterglow" --version

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
unset AFTERGLOW_IMPORTER
# shellcheck disable=SC2046
"$cc" "$work/load.c" $(pkg-config --cflags --libs afterglow) -o "$work/load"
LD_LIBRARY_PATH=$lib "$work/load" "$work/triangle.obj"
"$work/moved/bin/afterglow" info "$work/triangle.obj" | grep -q 'triangles *1'
rm -r "$work/moved/libexec"
! "$work/moved/bin/afterglow" info "$work/triangle.obj" 2>"$work/refused"
grep -q afterglow-import "$work/refused"
