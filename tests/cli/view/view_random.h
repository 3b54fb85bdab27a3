// Random scripts of view: the same for the same seed.
#pragma once

#include <stdint.h>
#include <stdio.h>

struct view_random {
    uint64_t seed;
    int lines;         // of random commands; some take a few lines of the script
    const char *scene; // to which the script returns, and the method there
    const char *gi;
    const char *other_scene; // opened now and then
};

// Commands of all kinds, some of them wrong, after which the first scene and the first method are
// shown as at the start. Files are those of the current folder.
void view_random_write(const struct view_random *desc, FILE *out);
