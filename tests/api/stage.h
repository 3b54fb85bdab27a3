// A point light in the Cornell box, seen by a renderer of the public functions, with validation on.
#pragma once

#include "framework/gpu_test.h"

#include <afterglow/afterglow.h>

#include <stdlib.h>

enum { STAGE_WIDTH = 48, STAGE_HEIGHT = 32 };

struct stage {
    struct ag_context *context;
    struct ag_device *device;
    struct ag_scene *scene;
    struct ag_renderer *renderer;
    struct ag_frame_desc frame; // of the camera main
};

// The last warning of any context that stage_context made; "" before.
extern char stage_last_warning[512];

struct ag_context *stage_context(void);
struct ag_renderer_desc stage_renderer_desc(const char *gi);
// Not rendered yet. On a device of the library's own, or where `adopt` is given on that one, which
// its owner validates.
struct stage stage_open(const char *gi, const struct ag_device_adopt *adopt);
// Fails where validation has said something.
void stage_close(struct stage *stage);
// The caller destroys it.
struct ag_image *stage_read(struct stage *stage, const char *layer);
