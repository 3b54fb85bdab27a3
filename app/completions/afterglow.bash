# Completion of afterglow for bash. The program itself offers the words ("afterglow __complete"). Readline replaces what
# follows the last ':' or '=' alone, so that the words before it are cut off.
_afterglow()
{
    local words word line broken files=
    read -ra words <<<"${COMP_LINE:0:COMP_POINT}"
    [[ ${COMP_LINE:0:COMP_POINT} == *[[:space:]] ]] && words+=('')
    word=${words[-1]} broken=${words[-1]%"${words[-1]##*[:=]}"}
    COMPREPLY=()
    while IFS= read -r line; do
        if [[ $line == :files ]]; then
            files=1
        else
            line=${line%%$'\t'*}
            COMPREPLY+=("${line#"$broken"}")
        fi
    done < <("${words[0]/#\~/$HOME}" __complete "${words[@]:1}" 2>/dev/null)
    [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *[:=] ]] && compopt -o nospace
    [[ $files ]] || return 0
    [[ $word == -*=* ]] && word=${word#*=}
    [[ ${#COMPREPLY[@]} == 0 ]] && compopt -o filenames # it quotes ':' and '=' of words
    while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen -f -- "$word")
    return 0
}
complete -F _afterglow afterglow
