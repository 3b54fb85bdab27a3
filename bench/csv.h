// The table that a bench writes beside what it prints.
#ifndef AG_BENCH_CSV_H
#define AG_BENCH_CSV_H

#include <stdbool.h>
#include <stdio.h>

// Opens the table at `path`; none where it is NULL. False, and said, where that fails.
bool csv_open(const char *path, FILE **out);
// A text in quotes and a comma, whatever is in it.
void csv_text(FILE *file, const char *text);
// Ends a table, or none. False, and said, where something of it could not be written.
bool csv_close(FILE *file, const char *path);

#endif
