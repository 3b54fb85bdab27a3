#include "words.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void words_add(struct words *w, const char *format, ...)
{
    va_list arguments;
    if (w->used >= w->size) return;
    va_start(arguments, format);
    const int wrote = vsnprintf(w->out + w->used, w->size - w->used, format, arguments);
    va_end(arguments);
    w->used += wrote > 0 ? (size_t)wrote : 0;
}

void words_add_word(struct words *w, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "@%+=:,./-_";
    if (word[0] && strspn(word, plain) == strlen(word)) {
        words_add(w, " %s", word);
        return;
    }
    words_add(w, " '");
    for (const char *c = word; *c; c++) {
        if (*c == '\'')
            words_add(w, "'\\''");
        else
            words_add(w, "%c", *c);
    }
    words_add(w, "'");
}

void words_add_triple(struct words *w, const float v[3])
{
    words_add(w, "%.9g,%.9g,%.9g", (double)v[0], (double)v[1], (double)v[2]);
}
