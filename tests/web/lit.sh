#!/bin/sh
# lit.sh FOLDER PROGRAM: light maps of four built-in scenes, and one of several pages, read by programs of others. 77: they are not
# there.
set -eu
here=$(dirname "$0") folder=$1 program=$2
sh "$here/run.sh" "$folder" gltf.mjs || exit $?
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export AFTERGLOW_CACHE="$work/cache"
for scene in @cornell @atrium @spheres @maze; do
    "$program" bake $scene --gi radiosity:texels=4096 --spp 2 --quiet --lightmap "$work/${scene#@}"
done
"$program" bake @atrium --gi radiosity:texels=8192 --spp 2 --quiet --page 128 --lightmap "$work/pages"
sh "$here/run.sh" "$folder" gltf.mjs "$work"/*/scene.glb
sh "$here/run.sh" "$folder" maps.mjs "$work/cornell" "$work/atrium" "$work/spheres" "$work/maze" "$work/pages"
