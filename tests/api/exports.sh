#!/bin/sh
# exports.sh LIBRARY INCLUDE: the library exports exactly the functions that the headers declare with AG_API. The one with the
# version in its name is declared without.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
nm -D --defined-only "$1" | awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' |
    sed 's/^ag_context_create_[0-9]*_[0-9]*$/ag_context_create/' | sort -u >"$work/exported"
# A declaration's name is the first ag_…( after AG_API, maybe on the next line.
cat "$2"/afterglow/*.h | tr '\n' ' ' | sed 's/AG_API/\nAG_API/g' | sed 's/;.*//' | grep '^AG_API ' | grep -v '__attribute__' |
    grep -o '^[^(;]*(' | grep -o 'ag_[a-z_]*($' | tr -d '(' | sort -u >"$work/declared"
[ -s "$work/declared" ] || { echo "no declarations found"; exit 1; }
diff "$work/declared" "$work/exported" || { echo "< declared, > exported"; exit 1; }
echo "$(wc -l <"$work/exported") functions"
