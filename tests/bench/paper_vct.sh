#!/bin/sh
# paper_vct.sh PAPER_VCT AFTERGLOW: a small run on one scene: rows for every figure, octrees with nodes and mips without, and refused
# command lines.
set -eu
"$2" list --json | grep -q '"index": 0' || { echo "skipped: no Vulkan device"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$1"; exit 1; }

"$1" --resolution 16 --frames 1 --size 32x18 --csv "$folder/out.csv" @cornell:light=point > "$folder/output"
head -n 1 "$folder/out.csv" | grep -q '^figures,scene,resolution,method,stage,' || fail "out.csv has no header"
# Columns are counted from the right, since figure numbers and stages contain commas: ms is the last but one.
row() { grep "^\"$1\",.*,16,$2,\"$3" "$folder/out.csv"; }
row 53-55 octree nodes | awk -F, '{ exit !($(NF - 1) > 0 && $NF > 50000) }' || fail "the octree has no nodes"
row 53-55 mips nodes | awk -F, '{ exit !($(NF - 1) == 0) }' || fail "mips have nodes"
for method in mips octree; do
    row 53-55 "$method" together | awk -F, '{ exit !($(NF - 1) > 0) }' || fail "$method takes no time"
done
row 70,74 raw cones | awk -F, '{ exit !($(NF - 1) > 0) }' || fail "no cones are traced"
row 73,75 interleaved voxelization | awk -F, '{ exit !($(NF - 1) > 0) }' || fail "no voxelization in the frame"
grep -q 'averaging of borders' "$folder/output" || fail "no output"

"$1" --resolution 16 --frames 1 --size 32x18 --only 70,74 @cornell:light=point > "$folder/output"
! grep -q "octree" "$folder/output" || fail "more than one figure was measured"

for options in "--only 54" "--frames 0" "--frames" "--resolution 1x" "--nonesuch 1"; do
    status=0
    "$1" $options > /dev/null 2>&1 || status=$?
    [ "$status" = 2 ] || fail "$options: exit status $status instead of 2"
done
