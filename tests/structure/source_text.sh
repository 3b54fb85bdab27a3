#!/bin/sh
# source_text.sh ROOT: no tracked file below ROOT leaves work for later, and no source has blanks at the end of a line or
# more than 100 characters on it. Without git (a source archive) all files outside build/ are checked.
set -eu
cd "$1"
list() {
    if [ -e .git ] && command -v git >/dev/null; then
        git ls-files -- "$@"
    else
        find . -path ./build -prune -o -type f -print | sed 's|^\./||' | { [ $# -eq 0 ] && cat || grep -E '\.(c|h|cpp|def|glsl|comp|vert|frag)$'; }
    fi
}
marks='TO''DO|FIX''ME' # in two pieces, so that this file does not find itself
blank=$(printf '[ \t]')
bad=0
[ -n "$(list)" ] || { echo "no file to check in $1"; exit 1; }
if list | tr '\n' '\0' | xargs -0 grep -IHnwE "$marks"; then
    echo "work left for later, above"
    bad=1
fi
if list '*.c' '*.h' '*.cpp' '*.def' '*.glsl' '*.comp' '*.vert' '*.frag' | tr '\n' '\0' |
    xargs -0 grep -IHnE "$blank+\$" /dev/null; then
    echo "blanks at the end of a line, above"
    bad=1
fi
# Bytes 128 to 191 continue a UTF-8 character.
list '*.c' '*.h' '*.cpp' '*.def' '*.glsl' '*.comp' '*.vert' '*.frag' | tr '\n' '\0' | LC_ALL=C xargs -0 awk '
    { characters = $0; gsub(/[\200-\277]/, "", characters) }
    length(characters) > 100 { print FILENAME ":" FNR ": " length(characters) " characters"; bad = 1 }
    END { exit bad }' /dev/null || { echo "lines of more than 100 characters, above"; bad=1; }
exit $bad
