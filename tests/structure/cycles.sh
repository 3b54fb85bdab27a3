#!/bin/sh
# cycles.sh [BUILD [ROOT]]: no header or shader of ROOT includes itself, directly or through others, and no object file of
# the library or the program in BUILD needs, through others, a symbol of a file that needs one of its own. Prints each cycle.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "${1:-build/debug}" && pwd)
cd "${2:-$here/../..}"
folders=
for folder in include src app bench; do
    [ -d "$folder" ] && folders="$folders $folder"
done

# "from to line": the includes of files that lie here. Paths are written from src/ or include/, or without a folder.
includes() {
    # shellcheck disable=SC2086 # a list of words; no file of ours has blanks in its name
    find $folders -type f \( -name '*.[ch]' -o -name '*.glsl' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag' \) | sort |
        awk '
            { file[$0]; name[NR] = $0 }
            END {
                for (i = 1; i <= NR; i++) {
                    folder = name[i]
                    sub(/[^\/]*$/, "", folder)
                    while ((getline line < name[i]) > 0) {
                        if (line !~ /^[ \t]*#[ \t]*include[ \t]*["<]/) continue
                        sub(/^[^"<]*["<]/, "", line)
                        sub(/[">].*$/, "", line)
                        if (("src/" line) in file) print name[i], "src/" line, "include"
                        else if (("include/" line) in file) print name[i], "include/" line, "include"
                        else if ((folder line) in file) print name[i], folder line, "include"
                    }
                    close(name[i])
                }
            }'
}

# "from to symbol": what object files need of each other. Objects of sources that are gone are left out.
symbols() {
    (cd "$build" && find src app -name '*.c.o' | sort | xargs -r nm -A -P -g) | awk '
        {
            sub(/CMakeFiles\/[^\/]*\//, "", $1)
            sub(/\.o:$/, "", $1)
            if (!($1 in exists)) {
                exists[$1] = (getline line < $1) > 0
                close($1)
            }
            if (!exists[$1]) next
        }
        $3 ~ /^[Uwv]$/ { from[++needs] = $1; needed[needs] = $2; next }
        $3 ~ /^[A-Z]$/ { owner[$2] = $1 }
        END { for (i = 1; i <= needs; i++) if (needed[i] in owner) print from[i], owner[needed[i]], needed[i] }'
}

bad=0
includes | awk -f "$here/cycles.awk" || { echo "headers or shaders include each other, above"; bad=1; }
symbols | awk -f "$here/cycles.awk" || { echo "files need symbols of each other, above"; bad=1; }
exit $bad
