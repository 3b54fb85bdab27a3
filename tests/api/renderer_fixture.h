// A renderer of the Cornell box with a point light, through the public API, with validation on.
#pragma once

#include "framework/gpu_test.h"
#include "framework/own_device.h"

#include <afterglow/afterglow.h>

#include <stdlib.h>

enum { FIXTURE_WIDTH = 48, FIXTURE_HEIGHT = 32, FIXTURE_SPEC = 512 };

// Options of mrt and drt for a bake of a second, with delta operators of few rays.
#define FIXTURE_SMALL_DICTIONARY                                                                   \
    "maze=plane,texels=6,rays=256,modes=12,lightfield_positions=4,lightfield_directions=6,"        \
    "lightfield_supersampling=1,lightfield_modes=16,lightfield_rounds=0,response_modes=8,"         \
    "block_probes=2,delta_rays=64"

struct renderer_fixture {
    struct ag_context *context;
    struct ag_device *device;
    struct ag_scene *scene;
    struct ag_renderer *renderer;
    struct ag_frame_desc frame; // of the camera main
};

// The last warning of all contexts from fixture_context; "" at first.
extern char fixture_last_warning[512];

struct ag_device_adopt fixture_lend(struct own_device *own);
struct ag_context *fixture_context(void);
struct ag_renderer_desc fixture_renderer_desc(const char *gi);
// Before the first frame. Uses the device in `adopt` (validated if the struct own_device of
// fixture_lend is); if NULL, one that later tests of the program use, too.
struct renderer_fixture fixture_open(const char *gi, const struct ag_device_adopt *adopt);
// With a device and a context of its own, which the test may destroy.
struct renderer_fixture fixture_open_alone(const char *gi);
// Fails the test if validation logged a message.
void fixture_close(struct renderer_fixture *fixture);
// The caller destroys it.
struct ag_image *fixture_read(struct renderer_fixture *fixture, const char *layer);
struct ag_layer_handle fixture_layer(struct renderer_fixture *s, struct ag_renderer *renderer,
                                     const char *name);
struct ag_image *fixture_read_from(struct renderer_fixture *fixture, struct ag_renderer *renderer,
                                   const char *layer);
// The Cornell box, whose ceiling emits, with a sky. gi NULL: without a renderer.
struct renderer_fixture fixture_open_lit(const char *gi);
// Mean difference of two images over the mean of b.
double fixture_difference(const struct ag_image *a, const struct ag_image *b);
// "name", or a small bake's "name:option=least,…"; visibility needs light to show. `out` has
// FIXTURE_SPEC bytes.
void fixture_print_base(int technique, const struct ag_technique_info *info, char *out);
// The base for index 0; with temporal=true for 1, if it has that option. false: no more.
bool fixture_print_variant(int technique, const struct ag_technique_info *info, int index,
                           char *out);
// Whether the fixture's device runs on the CPU.
bool fixture_is_software(const struct renderer_fixture *s);
// A complete bake of such a spec for the fixture's scene; NULL if the technique needs none.
struct ag_bake *fixture_bake(struct renderer_fixture *s, const char *gi,
                             const struct ag_technique_info *info);
