#!/bin/sh
# occlusion.sh OCCLUSION AFTERGLOW: one scene, in small: a row for each term, in which cones are nearer to rays that fade with the
# distance than what looks half a metre far; pictures; wrong words are refused.
set -eu
"$2" list --json | grep -q '"index": 0' || exit 77 # no device
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
wrong() { echo "$1"; exit 1; }

"$1" --gi vctao:resolution=32 --gi vo --decay 0 --decay 1 --frames 1 --size 48x27 --spp 16 --maps "$folder" @cornell:light=point > "$folder/said"
[ "$(grep -c '^@cornell:light=point, 48x27, decay [01] 1/m, 16 rays a pixel$' "$folder/said")" = 2 ] || wrong "there is no head for each decay"
# Term, ms, mean error.
awk '$1 == "vo" { other = $3 } $1 == "vctao:resolution=32" { cones = $3; ms = $2 }
     $1 == "vo" { rows += ms > 0 && cones > 0 && 3 * cones < other } END { exit rows != 2 }' "$folder/said" || wrong "cones are far from rays"
[ -s "$folder/@cornell:light=point-1-traced.png" ] || wrong "there is no picture"

for words in "--decay" "--decay 1x" "--frames 0" "--size 48" "--nonesuch 1"; do
    status=0
    "$1" $words > /dev/null 2>&1 || status=$?
    [ "$status" = 2 ] || wrong "$words: exit status $status instead of 2"
done
