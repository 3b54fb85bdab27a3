#!/bin/sh
# install.sh BUILD SOURCE CC: what is installed is enough to build the first example and to run it, with pkg-config and
# either library, and the tree can be moved.
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
