#!/bin/sh
# paper_mrt.sh PAPER_MRT AFTERGLOW: two mazes with a small dictionary, which is baked once: rows and curves of both figures; a small
# table 3.3; refused command lines.
set -eu
"$2" list --json | grep -q '"index": 0' || { echo "skipped: no Vulkan device"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$1"; exit 1; }
export AFTERGLOW_CACHE="$folder/new/cache"
small=texels=4,rays=256,prior_modes=8,modes=4,block_probes=1,response_modes=4,lightfield_positions=4,lightfield_directions=6
small=$small,lightfield_supersampling=1,lightfield_modes=16

"$1" --only mazes --options "$small" --most 10 --seeds 1 --runs 1 --frames 1 --out "$folder/out" > "$folder/output" 2> "$folder/errors"
grep -q 'R² of a line: cpu 1.0000, gpu 1.0000' "$folder/output" || fail "no line through two points"
[ "$(grep -c '^baking' "$folder/errors")" = 1 ] || fail "baked more than once"
for figure in 3.13 4.13; do
    [ "$(wc -l < "$folder/out/figure-$figure.csv")" = 3 ] || fail "figure-$figure.csv has not two rows"
    awk -F, 'NR > 1 { for (i = 4; i <= NF; i++) if (!($i > 0)) exit 1 }' "$folder/out/figure-$figure.csv" || fail "figure-$figure.csv lacks a time"
    grep -q '</svg>' "$folder/out/figure-$figure.svg" || fail "figure-$figure.svg is incomplete"
done
"$1" --only 3.3 --options "$small" --runs 1 --frames 1 --out "$folder/out" > "$folder/output" 2> "$folder/errors"
grep -q '^full,4,4,41,.*,6.2,1.0$' "$folder/out/table-3.3.csv" || fail "the row of 41 blocks is wrong"
[ "$(wc -l < "$folder/out/table-3.3.csv")" = 5 ] || fail "table-3.3.csv has not four rows"

for options in "--only 3.4" "--frames 0" "--most 5" "--runs" "--size 8x8" "@maze"; do
    status=0
    "$1" --out "$folder/out" $options > /dev/null 2>&1 || status=$?
    [ "$status" = 2 ] || fail "$options: exit status $status instead of 2"
done
