#!/bin/sh
# paper_lpv.sh PAPER_LPV AFTERGLOW: one scene, in small: a row for each technique, a line of irradiance, a plot, a picture; scenes
# whose file is missing are left out with a word; wrong words are refused.
set -eu
"$2" list --json | grep -q '"index": 0' || exit 77 # no device
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
wrong() { echo "$1"; exit 1; }

"$1" --out "$folder/out" --only diagonal --frames 1 --spp 4 --picture-spp 1 --picture-width 32 > "$folder/said" 2> "$folder/notes"
head -n 1 "$folder/out/table.csv" | grep -q '^scene,section,technique,' || wrong "table.csv has no head"
columns=$(awk -F, 'NR == 1 { print NF }' "$folder/out/table.csv")
# The options stand in quotes and have three commas.
grep '^diagonal,5.2,lpv,"lpv:cascades=1,bounces=0,dim=16,steps=20",900,900,1,' "$folder/out/table.csv" |
    awk -F, -v n="$columns" '{ exit !(NF == n + 3 && $11 > 0 && $15 > $11 && $17 > 1000) }' || wrong "the row of lpv is wrong"
grep -q '^diagonal  *lpv ' "$folder/said" || wrong "nothing was said"
awk -F, 'NR == 1 && $1 != "metres" { wrong++ } NR > 1 { lit += $2 > 0 && $3 > 0; wrong += $1 > 6.3 } END { exit !(NR == 481 && lit > 300 && !wrong) }' \
    "$folder/out/diagonal.csv" || wrong "diagonal.csv has no light"
grep -q '</svg>' "$folder/out/diagonal.svg" || wrong "diagonal.svg is not whole"
[ -s "$folder/out/diagonal.png" ] || wrong "there is no picture"

"$1" --out "$folder/out" --only bunny --scenes "$folder" > /dev/null 2> "$folder/notes"
grep -q 'left out' "$folder/notes" || wrong "a missing file was not said"

for words in "--only dragon" "--frames 0" "--frames" "--settings best" "--spp 1x"; do
    status=0
    "$1" --out "$folder/out" $words > /dev/null 2>&1 || status=$?
    [ "$status" = 2 ] || wrong "$words: exit status $status instead of 2"
done
