// A command line, word by word, for a shell.
#pragma once

#include <stddef.h>

struct words {
    char *out;
    size_t size, used; // used ≥ size: it does not fit
};

void words_add(struct words *w, const char *format, ...) __attribute__((format(printf, 2, 3)));
// A blank and the word, in single quotes where a shell would change it.
void words_add_word(struct words *w, const char *word);
// X,Y,Z with all digits.
void words_add_triple(struct words *w, const float v[3]);
