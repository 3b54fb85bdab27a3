#!/bin/sh
# manual.sh MANUAL PROGRAM: the manual page formats without a warning and has every command, option and technique.
set -eu
texts=$1 program=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
page=$texts/afterglow.1
for command in render reference compare bake info list diff cache; do
    grep -q "^\.SS afterglow $command$" "$page"
    "$program" "$command" --help | sed -n 's/^  \(--*[a-z-]*\).*/\1/p' | sort -u >"$work/options"
    [ -s "$work/options" ]
    # The section of the command alone.
    sed -n "/^\.SS afterglow $command$/,/^\.S[SH] /p" "$page" | sed '1!{/^\.SH/q}' | sed -n 's/^\\fB\(\\-.*\)\\fR.*\\fI.*/\1/p' |
        sed 's/\\-/-/g' | sort -u >"$work/described"
    diff "$work/options" "$work/described"
done
"$program" list --json | awk -F'"' '/"name":/ { name = $4 } /"paper":/ { print name }' >"$work/techniques"
grep -q . "$work/techniques"
while read -r technique; do grep -q "^\.SS $technique$" "$page"; done <"$work/techniques"
if command -v groff >/dev/null; then
    groff -Kutf8 -Tutf8 -man -ww -z "$page" 2>"$work/warnings"
    [ ! -s "$work/warnings" ] || { cat "$work/warnings"; exit 1; }
fi
