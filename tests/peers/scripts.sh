#!/bin/sh
# scripts.sh ROOT PROGRAM: what the scripts of examples/blender and bench/peers do without Blender: syntax, files, statistics. 77: no
# Python 3.
set -eu
here=$(dirname "$0") root=$1 program=$2
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export AFTERGLOW_CACHE="$work/cache" PYTHONDONTWRITEBYTECODE=1
"$program" bake @cornell --gi radiosity:texels=4096 --spp 2 --quiet --lightmap-format exr --lightmap "$work/maps"
"$program" diff --json "$work/maps/irradiance.exr" "$work/maps/irradiance.exr" >"$work/means.json"
"$program" bake @cornell --gi radiosity:texels=8192 --spp 2 --page 64 --quiet --lightmap-format exr --lightmap "$work/pages"
python3 "$here/scripts.py" "$root" "$work"
# The diffuse copy is a scene, with the light of the first.
"$program" info --json "$work/diffuse.glb" >"$work/info.json"
grep -q '"emissive": true' "$work/info.json"
status=0
python3 "$root/bench/peers/measure" --blender "$work/none" --out "$work/out" >"$work/skipped" || status=$?
[ $status -eq 77 ] && grep -q '^skipped: no Blender' "$work/skipped"
