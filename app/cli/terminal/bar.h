// The progress bar of a terminal.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// Whether standard error is a terminal that can erase a line: TERM is neither "dumb" nor empty.
bool bar_is_possible(void);
// Columns of that terminal: $COLUMNS, or as the terminal states it, or 80.
int bar_columns(void);
// "what [####....] count, 12 s left" in fewer columns than `columns`, so that no line wraps. A
// narrow terminal has a shorter bar, then none, then no time, then the beginning of `what` before
// the count. All texts are ASCII.
void bar_print(int columns, const char *what, double share, const char *count, double left_s,
               char *out, size_t size);
