# Completion of afterglow for fish. The program itself offers the words ("afterglow __complete").
function __afterglow_complete
    set -l words (commandline -opc)
    set -l typed (commandline -ct)
    for line in (command $words[1] __complete $words[2..-1] $typed 2>/dev/null)
        if test $line = :files
            set -l option (string match -r -- '^-[^=]*=' $typed)
            __fish_complete_path (string replace -r -- '^-[^=]*=' '' $typed) | string replace -r -- '^' "$option"
        else
            echo $line
        end
    end
end
complete -c afterglow -f -a '(__afterglow_complete)'
