#!/bin/sh
# completions.sh SHELL SCRIPTS PROGRAM: a tab in bash, zsh or fish offers what the program knows, inside a GI spec, a list
# and the options of a scene too. 77: the shell is not there.
set -eu
shell=$1 scripts=$2 program=$3
command -v "$shell" >/dev/null || { echo "skipped: no $shell"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
: >scene.glb
: >'my image.exr'
PATH=$(dirname "$program"):$PATH
export PATH

# Each prints the words that the shell offers at the end of a line, one a line. bash inserts them, and quotes special
# characters of names of files.
offer_bash() {
    bash -c '
        . "$1/afterglow.bash"
        COMP_LINE=$2 COMP_POINT=${#2} quoted=
        compopt() { [[ "$*" != "-o filenames" ]] || quoted=1; }
        _afterglow
        printf "%s\n" "${COMPREPLY[@]}" | if [[ $quoted ]]; then sed "s/[ @:=]/\\\\&/g"; else cat; fi' bash "$scripts" "$1"
}
# A zsh in a terminal of its own, whose completion system reports the words instead of listing them.
offer_zsh() {
    zsh -f -c '
        zmodload zsh/zpty
        zpty shell zsh -f -i
        zpty -w shell "PS1= ; fpath=($1 \$fpath); autoload -U compinit; compinit -u -D"
        zpty -w shell "compadd() { [[ \${@[1,-2]} == *(-O|-A|-D)* ]] || { builtin compadd -O hits \"\$@\"; print -rl -- \$hits >>offered }; builtin compadd \"\$@\" }"
        zpty -w shell "bindkey \"^I\" complete-word; print ready"
        while zpty -r shell line; do [[ $line == ready* ]] && break; done
        : >offered
        zpty -n -w shell "$2"$'"'\t'"'
        for i in {1..50}; do sleep 0.1; [[ -s offered ]] && break; done
        sleep 0.2
        zpty -d shell
        cat offered' zsh "$scripts" "$1"
}
offer_fish() {
    fish --no-config -c 'source $argv[1]/afterglow.fish; complete -C $argv[2]' "$scripts" "$1" | cut -f1
}

failed=0
# expect LINE WORD: the word is offered, in bash without what is before its last ':' or '='.
expect() {
    word=$2
    [ "$shell" != bash ] || word=${word##*[:=]}
    case $2 in *[:=]) [ "$shell" != bash ] || word=$(printf %s "$2" | sed 's/.*[:=]\(.*[:=]\)$/\1/') ;; esac
    offer_$shell "$1" >"$work/.offered"
    grep -qxF -e "$word" "$work/.offered" || { echo "'$1' offers no '$word' but:"; cat "$work/.offered"; failed=1; }
}
# The name of a file, which fish quotes later.
expect_file() {
    [ "$shell" = fish ] || set -- "$1" "$(printf %s "$2" | sed 's/ /\\&/g')"
    expect "$@"
}
refuse() {
    offer_$shell "$1" >"$work/.offered"
    ! grep -qxF -e "$2" "$work/.offered" || { echo "'$1' offers '$2'"; failed=1; }
}
expect 'afterglow ref' reference
expect 'afterglow render --no-s' --no-scene-lights
refuse 'afterglow render --spp' --spp
expect 'afterglow render @cornell --gi lp' lpv
expect 'afterglow render @cornell --gi lpv:st' lpv:steps=
expect 'afterglow render --gi lpv:steps=4,precis' lpv:steps=4,precision=
expect 'afterglow render --gi vct:quality=hi' vct:quality=high
expect 'afterglow render --gi lpv+v' lpv+vo
expect 'afterglow render --gi lpv:steps=4+vo:rea' lpv:steps=4+vo:reach=
expect 'afterglow render --gi=vct+hb' --gi=vct+hbao
expect 'afterglow render --aov color,dep' color,depth
expect 'afterglow reference --aov color,err' color,error
expect 'afterglow compare @corn' @cornell
expect 'afterglow render @maze:bl' @maze:blocks=
expect 'afterglow render @maze:blocks=3,se' @maze:blocks=3,seed=
expect 'afterglow list dnr' dnrt
expect 'afterglow list @maz' @maze
expect 'afterglow help cac' cache
expect 'afterglow diff --metric flip_' flip_hdr
expect 'afterglow render --environment sun-sky:el' sun-sky:elevation=
expect 'afterglow render --environment=sun-sky:el' --environment=sun-sky:elevation=
expect_file 'afterglow info sce' scene.glb
expect_file 'afterglow info my' 'my image.exr'
exit $failed
