// Line breaks between words.
#include "wrapped.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// Columns of UTF-8 text: bytes that do not continue a character.
static int columns_of(const char *text, int length)
{
    int columns = 0;
    for (int i = 0; i < length; i++) columns += ((unsigned char)text[i] & 0xc0) != 0x80;
    return columns;
}

void print_wrapped(int column, const char *text)
{
    int at = column, words = 0;
    while (*text) {
        int length = (int)strcspn(text, " \n"), width = columns_of(text, length);
        bool full = words == HELP_WORDS || at + 1 + width > HELP_WIDTH;
        if (words > 0 && full) {
            printf("\n%*s", column, "");
            at = column;
            words = 0;
        } else if (words > 0) {
            at += printf(" ");
        }
        for (int i = 0; i < length; i++) putchar(text[i] == HELP_NO_BREAK ? ' ' : text[i]);
        at += width;
        words++;
        text += length;
        if (*text == '\n') {
            printf("\n%*s", column, "");
            at = column;
            words = 0;
        }
        text += *text != 0;
    }
    printf("\n");
}
