// JSON on standard output and in files.
#pragma once

#include "cli/terminal/messages.h"
#include "shell/json_values.h"

// Prints an indented document to standard output. Takes ownership; NULL: out of memory.
enum status json_print(json_t *document);
// Writes a file, complete or not at all. Keeps the document.
enum status json_write(const json_t *document, const char *path);
// Without line breaks, and with numbers that parse to the same 32-bit floats: for long arrays.
enum status json_write_compact(const json_t *document, const char *path);
