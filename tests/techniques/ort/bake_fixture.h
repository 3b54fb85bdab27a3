// Bakes of ort without a GPU: a scene by code, its light map and the transfer of its bake.
//
//     struct ort_fixture f;
//     ort_fixture_facing(&f);
//     ort_fixture_open(&f, "texels=512,offsets=100");
//     struct ort_baked baked = ort_fixture_bake(&f, "rows=paper", 0);
//     ort_indirect(&f, &baked, light, out);
//     ort_baked_finish(&baked);
//     ort_fixture_close(&f);
#pragma once

#include "frame/frame_fixture.h"
#include "scene/statics.h"
#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"
#include "techniques/ort/ort_map.h"
#include "trace/trace.h"

struct ort_fixture {
    struct frame_fixture s; // its scene and pose alone
    const char *options;
    struct scene_statics statics;
    struct ort_map map;
    struct trace_scene *trace;
};

// Two facing squares of 2, 1 apart: orange and blue.
void ort_fixture_facing(struct ort_fixture *f);
// A closed box of 4 × 3 × 4 whose walls have several colours, and a smaller box inside.
void ort_fixture_boxes(struct ort_fixture *f);
// A scene made in f->s. options: without spaces; outlive the fixture.
void ort_fixture_open(struct ort_fixture *f, const char *options);
void ort_fixture_close(struct ort_fixture *f);

struct ort_baked {
    struct bake *bake;
    const struct tensors *tensors; // of a bake that has run
};
// Plans a bake with more options. It runs, or is run later.
struct bake *ort_fixture_plan(const struct ort_fixture *f, const char *more, uint64_t seed);
struct ort_baked ort_fixture_bake(const struct ort_fixture *f, const char *more, uint64_t seed);
void ort_baked_finish(struct ort_baked *baked);

// Irradiance of texels, [texels][3]; `light` is first-order, `out` indirect: equation 9.
void ort_indirect(const struct ort_fixture *f, const struct ort_baked *baked, const float *light,
                  float *out);
// The same with `prefilter`: offsets read levels of the light.
void ort_indirect_prefiltered(const struct ort_fixture *f, const struct ort_baked *baked,
                              const float *light, float *out);
// The next level of light along an axis, 0: x, from and to [height][width][3], by links of texels
// one after another; rounded to halves.
void ort_filter_light(const struct ort_map *map, const uint8_t *links, int axis, int stride,
                      const float *from, float *to);
// First-order light of a random kind: smooth over the scene, or of spots.
enum ort_light { ORT_SMOOTH, ORT_SPOTS };
void ort_random_light(const struct ort_fixture *f, enum ort_light kind, uint32_t seed,
                      float *light);
// Zeroed; the caller frees it (free).
float *ort_texel_floats(const struct ort_fixture *f);
