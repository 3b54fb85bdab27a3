// Completion for bash. Words of COMP_WORDS end at ':' and '='; the script therefore looks at the
// whole word before the cursor and replies with what follows the last break.
#include "texts.h"

#include "completion.h"

static const char start[] =
    "# Completion of afterglow for bash; made from the program's tables.\n"
    "_afterglow_reply()\n"
    "{\n"
    "    local word=$1 broken\n"
    "    shift\n"
    "    COMPREPLY=($(compgen \"$@\" -- \"$word\"))\n"
    "    [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *= ]] && compopt -o nospace\n"
    "    broken=${word%\"${word##*[:=]}\"}\n"
    "    COMPREPLY=(\"${COMPREPLY[@]#\"$broken\"}\")\n"
    "}\n"
    "_afterglow()\n"
    "{\n"
    "    local words word before command\n"
    "    read -ra words <<<\"${COMP_LINE:0:COMP_POINT}\"\n"
    "    [[ ${COMP_LINE:0:COMP_POINT} == *[[:space:]] ]] && words+=('')\n"
    "    word=${words[-1]} before=${words[-2]} command=${words[1]}\n"
    "    if [[ ${#words[@]} == 2 ]]; then\n";

static void print_values(const struct command *command, const struct command_option *option)
{
    static char words[65536];
    completion_words(option, words, sizeof words);
    printf("    %s\\ %s) ", command->name, option->name);
    if (words[0])
        printf("_afterglow_reply \"$word\" -W '%s'; return ;;\n", words);
    else if (completion_is_path(option))
        printf("compopt -o filenames; COMPREPLY=($(compgen -f -- \"$word\")); return ;;\n");
    else
        printf("return ;;\n");
}

static void print_options(const struct command *command, const char *scenes)
{
    struct command_option option;
    printf("    %s)\n        if [[ $word == -* ]]; then\n            COMPREPLY=($(compgen -W '",
           command->name);
    for (int i = 0; arguments_option(command, i, &option); i++)
        printf("%s%s", i ? " " : "", option.name);
    printf("' -- \"$word\"))\n");
    if (command->positional_count == 1)
        printf("        elif [[ $word == @* ]]; then\n"
               "            COMPREPLY=($(compgen -W '%s' -- \"$word\"))\n",
               scenes);
    if (command->positional_count > 0)
        printf("        else\n            compopt -o filenames\n"
               "            COMPREPLY=($(compgen -f -- \"$word\"))\n");
    printf("        fi ;;\n");
}

void print_bash_completion(void)
{
    static char scenes[4096];
    const struct command *command;
    struct command_option option;
    completion_scenes(scenes, sizeof scenes);
    printf("%s        COMPREPLY=($(compgen -W '", start);
    for (int i = 0; (command = command_get(i)); i++) printf("%s ", command->name);
    printf("--help --version' -- \"$word\"))\n        return\n    fi\n");
    printf("    case \"$command $before\" in\n");
    for (int i = 0; (command = command_get(i)); i++)
        for (int k = 0; arguments_option(command, k, &option); k++)
            if (option.value) print_values(command, &option);
    printf("    esac\n    case $command in\n");
    for (int i = 0; (command = command_get(i)); i++) print_options(command, scenes);
    printf("    esac\n}\ncomplete -F _afterglow afterglow\n");
}
