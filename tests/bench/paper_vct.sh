#!/bin/sh
# paper_vct.sh PAPER_VCT AFTERGLOW: one scene, in small: every figure has its rows, octrees have nodes and mips have none, and wrong
# words are refused.
set -eu
"$2" list --json | grep -q '"index": 0' || exit 77 # no device
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
wrong() { echo "$1"; exit 1; }

"$1" --resolution 16 --frames 1 --size 32x18 --csv "$folder/out.csv" @cornell:light=point > "$folder/said"
head -n 1 "$folder/out.csv" | grep -q '^figures,scene,resolution,method,stage,' || wrong "out.csv has no head"
# Columns from the right, as the figures' numbers and the stages have commas: ms is the last but one.
row() { grep "^\"$1\",.*,16,$2,\"$3" "$folder/out.csv"; }
row 53-55 octree nodes | awk -F, '{ exit !($(NF - 1) > 0 && $NF > 100000) }' || wrong "the octree has no nodes"
row 53-55 mips nodes | awk -F, '{ exit !($(NF - 1) == 0) }' || wrong "mips have nodes"
for method in mips octree; do
    row 53-55 "$method" together | awk -F, '{ exit !($(NF - 1) > 0) }' || wrong "$method takes no time"
done
row 70,74 raw cones | awk -F, '{ exit !($(NF - 1) > 0) }' || wrong "no cones are traced"
row 73,75 interleaved voxelisation | awk -F, '{ exit !($(NF - 1) > 0) }' || wrong "voxels are not made anew"
grep -q 'averaging of borders' "$folder/said" || wrong "nothing was said"

"$1" --resolution 16 --frames 1 --size 32x18 --only 70,74 @cornell:light=point > "$folder/said"
! grep -q "octree" "$folder/said" || wrong "more than one figure was made"

for words in "--only 54" "--frames 0" "--frames" "--resolution 1x" "--nonesuch 1"; do
    status=0
    "$1" $words > /dev/null 2>&1 || status=$?
    [ "$status" = 2 ] || wrong "$words: exit status $status instead of 2"
done
