// Symbolic links that lead out of a folder. The importer program uses it, too: libc alone.
#pragma once

#include <stdbool.h>

// Whether `path`, with all symbolic links resolved, is neither in the folder of the file `main` nor
// below it. False for a file that does not exist.
bool link_leads_out(const char *path, const char *main);
