// Completion for zsh: a function of its completion system, with the first line of each help text.
#include "texts.h"

#include "completion.h"

#include <string.h>

// Help text within single quotes and the brackets of _arguments.
static void print_help(const char *text)
{
    for (; *text && *text != '\n'; text++) {
        if (*text == '\'')
            printf("'\\''");
        else if (strchr("[]:\\", *text))
            printf("\\%c", *text);
        else
            putchar(*text);
    }
}

static void print_words(const char *words)
{
    for (; *words; words++) {
        if (*words == ':') putchar('\\');
        putchar(*words);
    }
}

static void print_option(const struct command_option *option)
{
    static char words[65536];
    printf("            '*%s[", option->name);
    print_help(option->help);
    printf("]");
    if (option->value) {
        completion_words(option, words, sizeof words);
        printf(":");
        print_help(option->value);
        printf(":");
        if (words[0]) {
            printf("(");
            print_words(words);
            printf(")");
        } else if (completion_is_path(option)) {
            printf("_files");
        }
    }
    printf("' \\\n");
}

static void print_command(const struct command *command, const char *scenes)
{
    struct command_option option;
    printf("    %s)\n        _arguments \\\n", command->name);
    for (int i = 0; arguments_option(command, i, &option); i++) print_option(&option);
    if (command->positional_count == 1)
        printf("            '1:scene:{ [[ $PREFIX == @* ]] && compadd -- %s || _files }' ;;\n",
               scenes);
    else
        printf("            '*:file:%s' ;;\n", command->positional_count ? "_files" : "");
}

void print_zsh_completion(void)
{
    static char scenes[4096];
    const struct command *command;
    completion_scenes(scenes, sizeof scenes);
    printf("#compdef afterglow\n# Completion of afterglow for zsh; made from the program's "
           "tables.\nlocal -a commands=(\n");
    for (int i = 0; (command = command_get(i)); i++) {
        printf("    '%s:", command->name);
        print_help(command->summary);
        printf("'\n");
    }
    printf(")\nif (( CURRENT == 2 )); then\n    _describe command commands\n    return\nfi\n"
           "local command=$words[2]\nshift words\n(( CURRENT-- ))\ncase $command in\n");
    for (int i = 0; (command = command_get(i)); i++) print_command(command, scenes);
    printf("esac\n");
}
