// Atomic writes: a temporary file beside the target, then renamed.
#pragma once

#include "messages.h"

#include <stdio.h>

// `write` fills the file and reports its own failures; errors of the disk are reported here. An
// existing file keeps its content until the new one is complete.
enum status whole_file_write(const char *path, enum status (*write)(FILE *file, const void *what),
                             const void *what);
// Name of the temporary file for `path`; the caller frees it. NULL: out of memory.
char *whole_file_beside(const char *path);
