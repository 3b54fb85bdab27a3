// Free space of the file system that a file is written to.
#pragma once

#include <stdbool.h>
#include <stdint.h>

// Bytes that this user may still write beside `path`. False: the system does not say.
bool disk_free(const char *path, uint64_t *bytes);
