#!/bin/sh
# wording.sh ROOT: no source, script or document below ROOT has a phrase of wording.txt, but for the lines of
# wording_allowed.txt. Old names of options and file names are no words: a letter, digit or underscore beside a phrase
# excludes it. The change log may quote old names.
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
allowed=$(grep -v '^#' "$here/wording_allowed.txt")
# Lines "file:line:text" of the input that no line of wording_allowed.txt stands for.
without_allowed() {
    while IFS= read -r hit; do
        text=${hit#*:}
        printf '%s\n' "$allowed" | grep -qxF "${hit%%:*}$tab$(printf '%s' "${text#*:}" | sed 's/^[ \t]*//')" || printf '%s\n' "$hit"
    done
}
grep -v '^#' "$here/wording.txt" | {
    bad=0
    while IFS=$tab read -r phrase term files; do
        case $phrase in *[[:upper:]]*) case_option= ;; *) case_option=-i ;; esac
        hits=$(list | grep -E "${files:-.}" | tr '\n' '\0' | xargs -0 grep -IHnwE $case_option "$phrase" /dev/null | without_allowed)
        [ -n "$hits" ] || continue
        printf '%s\nwrite instead: %s\n' "$hits" "$term"
        bad=1
    done
    exit $bad
}
