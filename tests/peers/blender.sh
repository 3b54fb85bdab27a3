#!/bin/sh
# blender.sh ROOT PROGRAM: examples/blender shows a light map as `afterglow render` does, and bench/peers compares equal light. 77:
# Blender, Python 3 or a device are not there.
set -eu
root=$1 program=$2
for name in blender python3; do
    command -v $name >/dev/null || { echo "skipped: no $name"; exit 77; }
done
"$program" list --json | grep -q '"devices": \[\]' && { echo "skipped: no Vulkan device"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export AFTERGLOW_CACHE="$work/cache" PYTHONDONTWRITEBYTECODE=1
unset AFTERGLOW_SCENES
gi=radiosity:texels=32768,rays=128,specular=false
# shows NAME SCENE [OPTION]: materials without a specular lobe, which a light map does not have.
shows() {
    name=$1 scene=$2
    shift 2
    "$program" bake "$scene" --gi $gi --quiet --lightmap-format exr --lightmap "$work/given"
    python3 -c 'import sys; sys.path.insert(0, sys.argv[1]); import glb; glb.make_diffuse(*sys.argv[2:])' \
        "$root/examples/blender" "$work/given/scene.glb" "$work/$name.glb"
    "$program" bake "$work/$name.glb" --gi $gi --quiet --lightmap-format exr --lightmap "$work/$name" "$@"
    "$program" render "$work/$name.glb" --gi $gi --size 320x180 --antialias 16 --tonemap linear --exposure 8.2 --quiet -o "$work/$name.png"
    blender --background --factory-startup --python-exit-code 1 --python "$root/examples/blender/open_lightmap.py" -- \
        "$work/$name/scene.glb" "$work/$name-blender.png" --exposure 8.2 --size 320x180 >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
    flip=$("$program" diff --json "$work/$name-blender.png" "$work/$name.png" | sed -n 's/.*"flip": \([0-9.e-]*\).*/\1/p')
    echo "$scene $*: FLIP $flip"
    awk -v flip="$flip" 'BEGIN { exit !(flip > 0 && flip <= 0.02) }'
}
shows cornell @cornell                              # light of an emissive surface, all in the map
shows point @cornell:light=point --indirect-only    # Blender computes the point light, with its shadows
shows pages @cornell --page 160                     # several images
[ -f "$work/pages/irradiance.1.exr" ]
python3 "$root/bench/peers/measure" --program "$program" --out "$work/peers" --scenes cornell --texels 4096 --paths 16
# Ratios of means and of texels: one quantity, but for the noise of this few paths.
awk -F'|' '/^\| cornell/ { ok = $5 > 0.97 && $5 < 1.03 && $6 > 0.97 && $6 < 1.03 } END { exit !ok }' "$work/peers/table.md"
