// afterglow: exit status: 0 success, 1 failure, 2 wrong usage.
#include "program.h"

int main(int count, char **words)
{
    program_begin(false);
    return program_run(count, words, NULL);
}
