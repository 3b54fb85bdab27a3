#!/bin/sh
# paper_lpv.sh PAPER_LPV AFTERGLOW: a small run on one scene: a row for each technique, a scanline of irradiance, a plot and an
# image; scenes with a missing file are skipped with a message; refused command lines.
set -eu
"$2" list --json | grep -q '"index": 0' || { echo "skipped: no Vulkan device"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$1"; exit 1; }

"$1" --out "$folder/out" --only diagonal --frames 1 --spp 4 --image-spp 1 --picture-width 32 > "$folder/output" 2> "$folder/errors"
grep -q -- '--picture-width is now --image-width' "$folder/errors" || fail "no note on the renamed option"
head -n 1 "$folder/out/table.csv" | grep -q '^scene,section,technique,' || fail "table.csv has no header"
columns=$(awk -F, 'NR == 1 { print NF }' "$folder/out/table.csv")
# The options are quoted and have three commas.
grep '^diagonal,5.2,lpv,"lpv:cascades=1,bounces=0,dim=16,steps=20",900,900,1,' "$folder/out/table.csv" |
    awk -F, -v n="$columns" '{ exit !(NF == n + 3 && $11 > 0 && $15 > $11 && $17 > 1000) }' || fail "the row of lpv is wrong"
grep -q '^diagonal  *lpv ' "$folder/output" || fail "no output"
awk -F, 'NR == 1 && $1 != "metres" { wrong++ } NR > 1 { lit += $2 > 0 && $3 > 0; wrong += $1 > 6.3 } END { exit !(NR == 481 && lit > 300 && !wrong) }' \
    "$folder/out/diagonal.csv" || fail "diagonal.csv has no light"
grep -q '</svg>' "$folder/out/diagonal.svg" || fail "diagonal.svg is incomplete"
[ -s "$folder/out/diagonal.png" ] || fail "no image"

"$1" --out "$folder/out" --only bunny --scenes "$folder" > /dev/null 2> "$folder/errors"
grep -q 'bunny skipped' "$folder/errors" || fail "no message for a missing file"

for options in "--only dragon" "--frames 0" "--frames" "--settings best" "--spp 1x" "--size 8x8" "@cornell"; do
    status=0
    "$1" --out "$folder/out" $options > /dev/null 2>&1 || status=$?
    [ "$status" = 2 ] || fail "$options: exit status $status instead of 2"
done
