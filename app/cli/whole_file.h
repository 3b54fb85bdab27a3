// A file that appears whole or not at all: written beside its place, then renamed.
#pragma once

#include "messages.h"

#include <stdio.h>

// `write` fills the file; whether that reached the disk is found out here. It may fail for a reason
// of its own, which it has then said. An existing file keeps its content until the new one is
// whole.
enum status whole_file_write(const char *path, enum status (*write)(FILE *file, const void *what),
                             const void *what);
// The name beside `path` under which it is written before it is renamed; the caller frees it. NULL:
// out of memory.
char *whole_file_beside(const char *path);
