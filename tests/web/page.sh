#!/bin/sh
# page.sh FOLDER PROGRAM EXAMPLES: examples/web in headless Chromium shows a light map as `afterglow render` does: mean FLIP at most
# .05, at the same camera, exposure and tone curve, in diffuse light, which is what a light map has. 77: Chromium, node, its
# packages or a device are not there.
set -eu
here=$(dirname "$0") folder=$1 program=$2 examples=$3 chromium=${AFTERGLOW_CHROMIUM-}
for name in chromium chromium-browser google-chrome; do
    [ -n "${AFTERGLOW_CHROMIUM+given}$chromium" ] || chromium=$(command -v $name) || :
done
[ -n "$chromium" ] || { echo "skipped: no Chromium"; exit 77; }
sh "$here/run.sh" "$folder" gltf.mjs || exit $?
"$program" list --json | grep -q '"devices": \[\]' && { echo "skipped: no Vulkan device"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export AFTERGLOW_CACHE="$work/cache"
gi=radiosity:texels=65536,rays=128,specular=false size=640x360
set --
# bake_and_render NAME [OPTION]
bake_and_render() {
    name=$1
    shift
    "$program" bake @$name --gi $gi "$@" --quiet --lightmap-format ktx2,png --lightmap "$work/$name"
    "$program" bake @$name --gi $gi,probes=true --quiet --probes "$work/$name-probes"
    "$program" render @$name --gi $gi --size $size --quiet --json -o "$work/$name.png" >"$work/$name.json"
}
bake_and_render cornell                # light of an emissive surface, all in the map
bake_and_render atrium --indirect-only # the page computes the sun, with a shadow map
"$program" bake @cornell --gi $gi --page 160 --quiet --lightmap-format ktx2,png --lightmap "$work/pages"
[ -f "$work/pages/irradiance.1.ktx2" ]
for name in cornell atrium; do
    query="antialias=none&maps=$name&ev=$(sed -n 's/.*"exposure_ev": \([-0-9.]*\).*/\1/p' "$work/$name.json")"
    set -- "$@" "$query" $size "$work/$name-page.png" "$query&format=png" $size "$work/$name-png.png" \
        "$query&probes=$name-probes&time=1" $size "$work/$name-ball.png"
done
ev=$(sed -n 's/.*"exposure_ev": \([-0-9.]*\).*/\1/p' "$work/cornell.json")
set -- "$@" "antialias=none&maps=pages&ev=$ev" $size "$work/pages.png"
sh "$here/run.sh" "$folder" page.mjs "$chromium" "$examples" "$work" "$@"
flip_of() { "$program" diff --json "$1" "$2" | sed -n 's/.*"flip": \([0-9.e-]*\).*/\1/p'; }
for name in cornell atrium; do
    flip=$(flip_of "$work/$name-page.png" "$work/$name.png")
    echo "@$name: FLIP $flip with KTX2, $(flip_of "$work/$name-png.png" "$work/$name.png") with PNG," \
        "$(flip_of "$work/$name-ball.png" "$work/$name-page.png") by the ball"
    awk -v flip="$flip" 'BEGIN { exit !(flip > 0 && flip <= 0.05) }'
    ball=$(flip_of "$work/$name-ball.png" "$work/$name-page.png")
    awk -v flip="$ball" 'BEGIN { exit !(flip > 0.0005 && flip < 0.2) }' # it is drawn, and hides little
done
# A map of several pages is the same.
flip=$(flip_of "$work/pages.png" "$work/cornell-page.png")
echo "@cornell: FLIP $flip by pages"
awk -v flip="$flip" 'BEGIN { exit !(flip < 0.002) }'
