// afterglow-manual KIND: prints the manual page or a completion of the program; run by the build.
#include "texts.h"

#include <stdio.h>
#include <string.h>

int main(int argc, char **argv)
{
    static const struct {
        const char *kind;
        void (*print)(void);
    } texts[] = { { "man", print_manual_page },
                  { "bash", print_bash_completion },
                  { "zsh", print_zsh_completion } };
    for (int i = 0; i < (int)(sizeof texts / sizeof texts[0]); i++) {
        if (argc != 2 || strcmp(argv[1], texts[i].kind) != 0) continue;
        texts[i].print();
        return fflush(stdout) != 0;
    }
    fprintf(stderr, "usage: afterglow-manual man|bash|zsh\n");
    return 2;
}
