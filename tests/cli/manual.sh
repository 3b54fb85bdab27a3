#!/bin/sh
# manual.sh MANUAL PROGRAM: the manual page formats without a warning and has every command, option and technique; bash
# completes commands, options, techniques with their options, and scenes; zsh accepts its script, where it is there.
set -eu
texts=$1 program=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
page=$texts/afterglow.1
for command in render reference compare bake info list diff cache; do
    grep -q "^\.SS afterglow $command$" "$page"
    "$program" "$command" --help | sed -n 's/^  \(--*[a-z-]*\).*/\1/p' | sort -u >"$work/options"
    [ -s "$work/options" ]
    # Of the page: the section of the command alone.
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

# complete LINE: the replies of bash to a tab at the end of LINE, one a line.
complete_bash() {
    bash -c '
        . "$1"
        COMP_LINE=$2 COMP_POINT=${#2}
        compopt() { :; }
        _afterglow
        printf "%s\n" "${COMPREPLY[@]}"' bash "$texts/afterglow" "$1"
}
if command -v bash >/dev/null; then
    complete_bash 'afterglow re' | tr '\n' ' ' | grep -qx 'render reference '
    complete_bash 'afterglow render --no-s' | grep -qx -e --no-scene-lights
    ! complete_bash 'afterglow render --spp' | grep -q -e --spp
    complete_bash 'afterglow render @cornell --gi lp' | grep -qx lpv
    complete_bash 'afterglow render @cornell --gi lpv:st' | grep -qx steps=
    complete_bash 'afterglow render --gi lpv:quality=hi' | grep -qx high
    complete_bash 'afterglow compare @corn' | grep -qx @cornell
    complete_bash 'afterglow diff --metric flip_' | grep -qx flip_hdr
    cd "$work"
    : >'scene.glb'
    complete_bash 'afterglow info sce' | grep -qx scene.glb
fi
if command -v zsh >/dev/null; then zsh -n "$texts/_afterglow"; fi
