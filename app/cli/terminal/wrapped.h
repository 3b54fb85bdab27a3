// Help texts in lines of limited width.
#pragma once

enum { HELP_WIDTH = 100, HELP_WORDS = 15 }; // of a line: columns, words

#define HELP_NO_BREAK '\x01' // printed as a space, never a line break

// Prints `text` and a line break. The cursor is at `column`, where further lines begin too. A '\n'
// in the text ends a line.
void print_wrapped(int column, const char *text);
