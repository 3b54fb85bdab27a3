#!/bin/sh
# paper_ort.sh PAPER_ORT AFTERGLOW: @cornell with two numbers of offsets, each baked once: a row for each order and precision, with
# bins, times and errors; plots; lights; --help; refused command lines.
set -eu
"$2" list --json | grep -q '"index": 0' || { echo "skipped: no Vulkan device"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$1"; exit 1; }
export AFTERGLOW_CACHE="$folder/new/cache"

"$1" --only table --side 48 --offsets 50 --offsets 100 --options rays=16 --beside ambient --spp 8 --image-width 64 --frames 1 \
    --threads 2 --out "$folder/out" @cornell:light=point > "$folder/output" 2> "$folder/errors" || fail "$(cat "$folder/errors")"
[ "$(grep -c '^baking' "$folder/errors")" = 2 ] || fail "not one bake for each number of offsets"
grep -q '^ambient: l2, ' "$folder/output" || fail "no error of another technique"
[ "$(wc -l < "$folder/out/table-1.csv")" = 9 ] || fail "table-1.csv has not eight rows"
sed 's/"[^"]*",//g' "$folder/out/table-1.csv" | awk -F, '
    NR == 1 { next }
    { if (NF != 29) exit 1 }
    { if (!($3 * $4 > 0.9 * 48 * 48 && $3 * $4 < 1.1 * 48 * 48 && $5 > 0 && $5 <= $3 * $4)) exit 2 }
    { if (!($9 > 0 && $10 == $9 * 1024 * 1024 * 3 * ($8 == "half" ? 2 : 1) && $11 > $10)) exit 3 }
    { for (i = 12; i <= 26; i++) if (i != 21 && i != 22 && !($i > 0)) exit 4 } # those are of software drivers
    { if (!($26 > 0.8 && $26 < 1.25)) exit 5 }
    $7 == "tiles" && $8 == "half" { l2[$6] = $23 }
    $7 == "slices" && $8 == "half" && !($23 > 0.999 * l2[$6] && $23 < 1.001 * l2[$6]) { exit 6 }
    END { if (!(l2[100] < l2[50])) exit 7 }' || fail "the table is wrong ($?): $(cat "$folder/out/table-1.csv")"
for plot in error gathers; do
    grep -q '</svg>' "$folder/out/$plot.svg" || fail "$plot.svg is incomplete"
done

"$1" --only lights --side 48 --options rays=16 --frames 8 --image-width 64 --out "$folder/out" @cornell > "$folder/output" 2> "$folder/errors" ||
    fail "$(cat "$folder/errors")"
[ "$(wc -l < "$folder/out/lights.csv")" = 4 ] || fail "lights.csv has not three rows"
# The least of eight frames: the first ones compile.
sed 's/"[^"]*",//g' "$folder/out/lights.csv" | awk -F, '
    NR > 1 { direct[$3] = $4; for (i = 4; i <= 9; i++) if (!($i > 0)) exit 1 }
    END { if (!(direct[64] > direct[1])) exit 2 }' || fail "the times of lights are wrong: $(cat "$folder/out/lights.csv")"

"$1" --help | grep -q -e '--side N  *light map' || fail "--help does not explain the options"
for options in "--only bins" "--frames 0" "--offsets 10" "--spp" "--size 8x8" "@cornell @atrium"; do
    status=0
    "$1" --out "$folder/out" $options > /dev/null 2>&1 || status=$?
    [ "$status" = 2 ] || fail "$options: exit status $status instead of 2"
done
