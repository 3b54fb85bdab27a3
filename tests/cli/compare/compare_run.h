// Reports, files and caches of compare.
#pragma once

#include "cli/program.h"

#include "image/image.h"

#define SCENE "compare @cornell --size 24x18 --quiet"
#define SMALL SCENE " --frames 2 --spp 2 --gi none"

// A path in a folder, valid until some calls later.
const char *path_in(const char *folder, const char *name);
// Creates a cache for the test and returns its folder of references.
const char *own_cache(const char *name);

// Owned by the caller.
json_t *report_of(const char *folder);
// A part of the report; a number, which there must be.
json_t *method_of(const json_t *report, size_t index);
double number_of(const json_t *object, const char *key);
double of_reference(const json_t *report, const char *key);

// A layer of an EXR file; NULL: its color. Ends with image_finish().
struct image read_layer(const char *path, const char *layer);
// But for times, two methods of reports have the same numbers.
void check_equal_numbers(const json_t *a, const json_t *b);
