#!/bin/sh
# include_table.sh ROOT: every source file below ROOT follows include_table.txt.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$1"
folders=
for folder in include src app bench examples; do
    [ -d "$folder" ] && folders="$folders $folder"
done
# shellcheck disable=SC2086 # a list of words; no file of ours has blanks in its name
find $folders -type f \( -name '*.c' -o -name '*.h' -o -name '*.cpp' -o -name '*.glsl' -o -name '*.comp' -o -name '*.vert' \
    -o -name '*.frag' \) | sort | xargs awk -f "$here/include_table.awk" "$here/include_table.txt"
