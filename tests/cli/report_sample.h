// A report as compare writes it, with small images, for the tests of its page.
#pragma once

#include "framework/test.h"

#include <jansson.h>

enum {
    SAMPLE_WIDTH = 64,
    SAMPLE_HEIGHT = 48,
    SAMPLE_METHODS = 4,
    SAMPLE_IMAGES = 2 + 4 * SAMPLE_METHODS
};

// A report with this scene and GI spec of the first method; its images are written to `folder`.
// The caller releases it.
json_t *sample_report(const char *folder, const char *scene, const char *gi);
