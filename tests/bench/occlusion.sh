#!/bin/sh
# occlusion.sh OCCLUSION AFTERGLOW: a small run on one scene: a row for each technique, cones closer to rays with the same decay than
# vo with its radius of half a metre, maps, and refused command lines.
set -eu
"$2" list --json | grep -q '"index": 0' || { echo "skipped: no Vulkan device"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$1"; exit 1; }

"$1" --gi vctao:resolution=32 --gi vo --decay 0 --decay 1 --frames 1 --size 48x27 --spp 16 --maps "$folder" @cornell:light=point > "$folder/output"
[ "$(grep -c '^@cornell:light=point, 48x27, decay [01] 1/m, 16 rays a pixel$' "$folder/output")" = 2 ] || fail "no header for each decay"
# Columns: technique, ms, mean error.
awk '$1 == "vo" { other = $3 } $1 == "vctao:resolution=32" { cones = $3; ms = $2 }
     $1 == "vo" { rows += ms > 0 && cones > 0 && 3 * cones < other } END { exit rows != 2 }' "$folder/output" || fail "the error of cones is too large"
[ -s "$folder/@cornell:light=point-1-traced.png" ] || fail "no map"

for options in "--decay" "--decay 1x" "--frames 0" "--size 48" "--nonesuch 1"; do
    status=0
    "$1" $options > /dev/null 2>&1 || status=$?
    [ "$status" = 2 ] || fail "$options: exit status $status instead of 2"
done
