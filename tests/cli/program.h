// Runs the program as a script does and checks its status, output and files.
#pragma once

#include "framework/test.h"

#include <jansson.h>

struct run {
    int status;       // of the exit; -1: ended by a signal
    char out[262144]; // what it wrote, cut where it is longer
    char err[16384];
};

// Fails the test unless the program exits with that status. The first text is split at blanks,
// the others are single arguments: run_expect(0, "render @cornell -o", path, NULL). The result is
// valid until the next call.
const struct run *run_expect(int status, const char *words, ...) __attribute__((sentinel));
// Likewise, with any status.
const struct run *run_program(const char *words, ...) __attribute__((sentinel));
// The output is a single line, "afterglow: …", on standard error.
void check_one_error_line(const struct run *result);
// The standard output as JSON; the caller releases it.
json_t *run_json(const struct run *result);
// Skips the test, visibly, without a usable device.
void require_device(void);

// A path in the test's folder, valid until some calls later.
const char *path_of(const char *name);
bool file_exists(const char *path);
bool files_are_equal(const char *a, const char *b);
void write_file(const char *path, const char *bytes, size_t size);
// Number of entries of a folder, without . and ..
int count_files(const char *folder);
// Creates an empty folder for this test run.
const char *make_folder(const char *name);
