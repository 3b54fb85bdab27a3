#!/bin/sh
# wording.sh ROOT: no source, script or document below ROOT has a phrase of wording.txt. Old names of options and file names
# are no words: a letter, digit or underscore beside a phrase excludes it. The change log may quote old names.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$1"
list() {
    if [ -e .git ] && command -v git >/dev/null; then
        git ls-files
    else
        find . -path ./build -prune -o -type f -print | sed 's|^\./||'
    fi | grep -E '(^|/)(check|demo|CMakeLists\.txt)$|\.(c|h|cpp|def|glsl|comp|vert|frag|md|sh|awk|cmake)$' |
        grep -vE '^(CHANGELOG|THIRD_PARTY)\.md$|^tests/structure/(wording|self_test)\.'
}
[ -n "$(list)" ] || { echo "no file to check in $1"; exit 1; }
tab=$(printf '\t')
grep -v '^#' "$here/wording.txt" | {
    bad=0
    while IFS=$tab read -r phrase term; do
        if list | tr '\n' '\0' | xargs -0 grep -IHniwE "$phrase"; then
            echo "write instead: $term"
            bad=1
        fi
    done
    exit $bad
}
