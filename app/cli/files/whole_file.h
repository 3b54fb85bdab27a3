// Atomic writes: a temporary file beside the target, then renamed.
#pragma once

#include "cli/terminal/messages.h"

#include <stdio.h>

enum { PATH_SIZE = 4096 };

// Checks that a file can be written; reports the reason if not.
enum status whole_file_check(const char *path);

// `write` fills the file and reports its own failures; errors of the disk are reported here. An
// existing file keeps its content until the new one is complete.
enum status whole_file_write(const char *path, enum status (*write)(FILE *file, const void *what),
                             const void *what);
// For temporary_remove_stale: a warning. user: the path as the user gave it.
void whole_file_removed(void *user, const char *path);
