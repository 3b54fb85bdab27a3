#!/bin/sh
# headers_alone.sh INCLUDE CC CXX: every header of INCLUDE/afterglow compiles alone, and twice, as C17 and as C++17.
set -u
include=$1 cc=$2 cxx=$3
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
count=0 bad=0
for header in "$include"/afterglow/*.h; do
    [ -f "$header" ] || continue
    count=$((count + 1))
    name=$(basename "$header")
    printf '#include <afterglow/%s>\n#include <afterglow/%s>\nint main(void) { return 0; }\n' "$name" "$name" >"$work/alone.c"
    cp "$work/alone.c" "$work/alone.cpp"
    "$cc" -std=c17 -Wall -Wextra -Wpedantic -Werror -I"$include" -fsyntax-only "$work/alone.c" || { echo "$name: not C17 alone"; bad=1; }
    "$cxx" -std=c++17 -Wall -Wextra -Wpedantic -Werror -I"$include" -fsyntax-only "$work/alone.cpp" || { echo "$name: not C++17 alone"; bad=1; }
done
[ $count -gt 0 ] || { echo "no header in $include/afterglow"; exit 1; }
echo "$count headers"
exit $bad
