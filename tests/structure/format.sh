#!/bin/sh
# format.sh ROOT: every C file, header, shader and option table below ROOT is as clang-format 14 writes it. Other versions
# write some lines in another way, so without this one the test is skipped (77).
set -eu
format=
for program in clang-format-14 clang-format; do
    if command -v "$program" >/dev/null && "$program" --version | grep -q 'version 14\.'; then
        format=$program
        break
    fi
done
[ -n "$format" ] || { echo "skipped: no clang-format 14"; exit 77; }
cd "$1"
list() {
    if [ -e .git ] && command -v git >/dev/null; then
        git ls-files -- "$@"
    else
        for pattern; do find . -path ./build -prune -o -name "$pattern" -print; done | sed 's|^\./||'
    fi
}
bad=0
[ -n "$(list '*.c')" ] || { echo "no file to check in $1"; exit 1; }
list '*.c' '*.h' '*.cpp' | tr '\n' '\0' | xargs -0 "$format" --style=file --dry-run -Werror || bad=1
# Languages that it does not know, under names that it does: tables as C, shaders as C++.
copies=$(mktemp -d)
trap 'rm -rf "$copies"' EXIT
[ ! -e .clang-format ] || cp .clang-format "$copies"
copy() { # ENDING PATTERN…
    ending=$1
    shift
    list "$@" | tar -cf - -T - | tar -xf - -C "$copies" --transform "s|\$|$ending|"
}
copy .h '*.def'
copy .cpp '*.glsl' '*.comp' '*.vert' '*.frag'
(cd "$copies" && find . -type f ! -name .clang-format -print0 | sed -z 's|^\./||' |
    xargs -0 -r "$format" --style=file --dry-run -Werror 2>"$copies.errors") || bad=1
sed -E 's/\.(h|cpp):([0-9]+:)/:\2/' "$copies.errors" >&2
rm -f "$copies.errors"
exit $bad
