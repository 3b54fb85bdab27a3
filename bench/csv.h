// CSV files of the benchmarks.
#ifndef AG_BENCH_CSV_H
#define AG_BENCH_CSV_H

#include <stdbool.h>
#include <stdio.h>

// Creates the file and writes its header line. A NULL path gives no file. False on an error, which
// is printed.
bool csv_open(const char *path, const char *header, FILE **out);
// Writes a quoted text and a comma.
void csv_text(FILE *file, const char *text);
// Closes the file; NULL is accepted. False on a write error, which is printed.
bool csv_close(FILE *file, const char *path);

#endif
