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
for file in $(list '*.def' '*.glsl' '*.comp' '*.vert' '*.frag'); do
    case $file in *.def) as=x.h ;; *) as=x.cpp ;; esac # languages that it knows
    "$format" --style=file --assume-filename=$as <"$file" | cmp -s - "$file" || { echo "$file: not formatted"; bad=1; }
done
exit $bad
