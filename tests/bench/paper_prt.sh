#!/bin/sh
# paper_prt.sh PAPER_PRT AFTERGLOW: an open @cornell with two sizes: rows of each method for vectors and matrices, times of each variant,
# plots; --help; refused command lines.
set -eu
"$2" list --json | grep -q '"index": 0' || { echo "skipped: no Vulkan device"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$1"; exit 1; }
export AFTERGLOW_CACHE="$folder/new/cache"

"$1" --texels 512 --vectors 4 --vectors 8 --clusters 4 --points 256 --points 512 --options rays=16 --size 64x36 --frames 3 --threads 2 \
    --out "$folder/out" @cornell:ceiling=false > "$folder/output" 2> "$folder/errors" || fail "$(cat "$folder/errors")"
[ "$(wc -l < "$folder/out/error.csv")" = 13 ] || fail "error.csv has not twelve rows"
# Vectors have the smallest error by cpca at equal bytes.
sed 's/"[^"]*",//g' "$folder/out/error.csv" | awk -F, '
    NR == 1 { next }
    { if (NF != 12) exit 1 }
    { if (!($2 > 256 && $7 > 0 && $7 < $8 && $8 == 2 * $2 * $3)) exit 2 }
    { for (i = 9; i <= 11; i++) if (!($i > 0 && $i < 1)) exit 3 }
    { if (!($12 >= 0 && $12 != "")) exit 3 }
    { if (!($10 <= $11)) exit 4 }
    $4 == "vq" { vq = $9 }
    $4 == "pca" { pca = $9 }
    $1 == "vectors" && $4 == "cpca" && !($9 < vq && $9 < pca) { exit 5 }' || fail "errors are wrong ($?): $(cat "$folder/out/error.csv")"
[ "$(wc -l < "$folder/out/passes.csv")" = 9 ] || fail "passes.csv has not eight rows"
sed 's/"[^"]*",//g' "$folder/out/passes.csv" | awk -F, '
    NR == 1 { next }
    { if (NF != 10 || !($2 > 0 && $6 > 0 && $7 > 0 && $9 > 0 && $10 > 0)) exit 1 }
    { if (($5 > 0) != ($4 == "cpca") || ($8 > 0) != ($3 == "true")) exit 2 }' || fail "times are wrong ($?): $(cat "$folder/out/passes.csv")"
for plot in error-vectors error-matrices passes; do
    grep -q '</svg>' "$folder/out/$plot.svg" || fail "$plot.svg is incomplete"
done

"$1" --help | grep -q -e '--vectors N  *of cpca' || fail "--help does not explain the options"
for options in "--only error" "--frames 0" "--vectors 33" "--threads" "--points 8" "@cornell @atrium"; do
    status=0
    "$1" --out "$folder/out" $options > /dev/null 2>&1 || status=$?
    [ "$status" = 2 ] || fail "$options: exit status $status instead of 2"
done
