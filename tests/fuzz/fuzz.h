// Shared by the fuzz harnesses. A harness defines LLVMFuzzerTestOneInput; libFuzzer calls it with
// inputs that it makes (tools/fuzz), replay.c with those of the corpus (CTest).
#pragma once

#include <afterglow/context.h>

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

// A property that holds for every input; without NDEBUG and with it.
#define FUZZ_CHECK(condition)                                                                      \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "%s:%d: not true: %s\n", __FILE__, __LINE__, #condition);              \
            abort();                                                                               \
        }                                                                                          \
    } while (0)

// A context whose log is checked: each message is one line without control characters. It reads no
// environment.
struct ag_context *fuzz_context(void);
struct host;
// The same for modules below the public API. The pointer stays valid.
struct host *fuzz_host(void);

// The input as a string, up to its first zero byte. The caller frees it.
char *fuzz_text(const uint8_t *data, size_t size);
// A temporary folder of this process, which exit removes with all files in it.
const char *fuzz_folder(void);
// Writes the input to a file in that folder. The next call replaces the file.
const char *fuzz_file(const uint8_t *data, size_t size, const char *extension);
