#!/bin/sh
# paper_drt.sh PAPER_DRT AFTERGLOW: @cornell with a small dictionary, which is baked once: a row for each variant, whose
# stages are those of its operators; refused command lines.
set -eu
"$2" list --json | grep -q '"index": 0' || { echo "skipped: no Vulkan device"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$1"; exit 1; }
export AFTERGLOW_CACHE="$folder/new/cache"
small=texels=8,rays=512,prior_modes=16,modes=16,block_probes=2,response_modes=8,lightfield_positions=4,lightfield_directions=6
small=$small,lightfield_supersampling=1,lightfield_modes=16,lightfield_rounds=0

"$1" --options "$small" --size 32x18 --spp 16 --bounces 1 --frames 1 --csv "$folder/drt.csv" @cornell:light=point \
    > "$folder/output" 2> "$folder/errors" || fail "$(cat "$folder/errors")"
[ "$(grep -c '^baking' "$folder/errors")" = 1 ] || fail "baked more than once"
[ "$(wc -l < "$folder/drt.csv")" = 6 ] || fail "drt.csv has not five rows"
sed 's/"[^"]*",//g' "$folder/drt.csv" | awk -F, '
    NR == 1 { next }
    { clutter[NR - 1] = $2 > 0; map[NR - 1] = $7 > 0; bytes[NR - 1] = $12; energy[NR - 1] = $15 }
    { if (!($1 > 0 && $3 > 0 && $4 > 0 && $10 > 0 && $11 > 0 && $13 > 0)) exit 1 }
    END {
        if (clutter[1] + clutter[2] + clutter[3] > 0 || clutter[4] + clutter[5] != 2) exit 2
        if (map[1] + map[2] + map[3] + map[4] > 0 || !map[5]) exit 3
        if (!(bytes[5] > bytes[4] && bytes[4] > bytes[3] && bytes[3] > bytes[2])) exit 4
        if (!(energy[3] < energy[2] && energy[4] > energy[3])) exit 5
    }' || fail "the table is wrong: $(cat "$folder/drt.csv")"

for options in "--bounces 0" "--frames 0" "--spp" "--only x"; do
    status=0
    "$1" $options > /dev/null 2>&1 || status=$?
    [ "$status" = 2 ] || fail "$options: exit status $status instead of 2"
done
