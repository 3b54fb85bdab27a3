#include "techniques/ort/bake_fixture.h"

#include "core/half.h"
#include "core/rng.h"
#include "techniques/bake_bytes.h"
#include "techniques/kept_bake.h"
#include "techniques/ort/levels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- scenes

void ort_fixture_facing(struct ort_fixture *f)
{
    *f = (struct ort_fixture){ 0 };
    fixture_init(&f->s, NULL);
    fixture_floor(&f->s, 1, fixture_matte(&f->s, vec3_of(0.8f, 0.5f, 0.2f)));
    fixture_quad(&f->s, vec3_of(-1, 1, -1), vec3_of(1, 1, -1), vec3_of(1, 1, 1), vec3_of(-1, 1, 1),
                 fixture_matte(&f->s, vec3_of(0.3f, 0.5f, 0.9f)));
}

void ort_fixture_boxes(struct ort_fixture *f)
{
    *f = (struct ort_fixture){ 0 };
    fixture_init(&f->s, NULL);
    const int white = fixture_matte(&f->s, vec3_of(0.7f, 0.7f, 0.7f));
    const int orange = fixture_matte(&f->s, vec3_of(0.8f, 0.5f, 0.2f));
    fixture_box(&f->s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, white);
    fixture_box(&f->s, vec3_of(-0.6f, 0.5f, -0.8f), vec3_of(0.7f, 1.6f, 0.4f), false, orange);
}

void ort_fixture_open(struct ort_fixture *f, const char *options)
{
    struct gi_spec spec;
    char text[256];
    f->options = options;
    snprintf(text, sizeof text, "ort:%s", options);
    CHECK(gi_spec_parse(&spec, test_host(), text));
    CHECK(pose_init(&f->s.pose, f->s.scene, -1, 0.0f));
    CHECK(scene_statics_init(&f->statics, test_host(), &f->s.pose));
    CHECK(ort_map_init(&f->map, test_host(), &f->statics.pose, spec.options[0]));
    f->trace = trace_scene_create(test_host(), &f->statics.pose);
    assert_non_null(f->trace);
    gi_spec_finish(&spec);
}

void ort_fixture_close(struct ort_fixture *f)
{
    trace_scene_destroy(f->trace);
    ort_map_finish(&f->map);
    scene_statics_finish(&f->statics);
    fixture_finish(&f->s);
}

// ---- bakes

struct bake *ort_fixture_plan(const struct ort_fixture *f, const char *more, uint64_t seed)
{
    char text[256];
    snprintf(text, sizeof text, "ort:%s%s%s", f->options, more[0] ? "," : "", more);
    struct bake *bake = bake_of_gi(text, &f->s.pose, seed);
    assert_non_null(bake);
    return bake;
}

struct ort_baked ort_fixture_bake(const struct ort_fixture *f, const char *more, uint64_t seed)
{
    struct ort_baked baked = { .bake = ort_fixture_plan(f, more, seed) };
    CHECK(kept_bake_run(baked.bake));
    baked.tensors = bake_tensors(baked.bake);
    return baked;
}

void ort_baked_finish(struct ort_baked *baked)
{
    bake_destroy(baked->bake);
}

// ---- light

float *ort_texel_floats(const struct ort_fixture *f)
{
    float *out = calloc(3 * (size_t)f->map.texel_count, sizeof *out);
    assert_non_null(out);
    return out;
}

// level: of the offsets of all groups; NULL: 0. light: [level][texels][3].
static void gather_texel(const struct ort_fixture *f, const struct ort_baked *baked, uint32_t texel,
                         const uint8_t *level, const float *const *light, float *out)
{
    const struct tensor *offsets = tensors_find(baked->tensors, ORT_OFFSETS);
    const size_t count = offsets->shape[1];
    const size_t first = f->map.group_of[texel] * count;
    const int32_t *offset = (const int32_t *)offsets->data + 2 * first;
    const uint16_t *weight = tensors_find(baked->tensors, ORT_MAPS)->data;
    const struct ort_place place = ort_place_of(&f->map, texel);
    double sum[3] = { 0 };
    for (size_t k = 0; k < count; k++) {
        const uint32_t from = ort_texel_at(&f->map, place, offset[2 * k], offset[2 * k + 1]);
        const uint16_t *w = weight + 3 * (texel * count + k);
        if (from == CHART_NONE) continue;
        const float *sent = light[level ? level[first + k] : 0] + 3 * (size_t)from;
        for (size_t c = 0; c < 3; c++) sum[c] += (double)float_from_half(w[c]) * (double)sent[c];
    }
    for (int c = 0; c < 3; c++) out[c] = (float)(sum[c] / (double)ORT_MAP_SCALE);
}

void ort_indirect(const struct ort_fixture *f, const struct ort_baked *baked, const float *light,
                  float *out)
{
    for (uint32_t i = 0; i < f->map.texel_count; i++)
        gather_texel(f, baked, i, NULL, &light, out + 3 * (size_t)i);
}

// Whether all links from a texel to the place `count` away along an axis are there.
static bool is_reached(const struct ort_map *map, const uint8_t *links, size_t place, int axis,
                       int count)
{
    const size_t step = axis ? map->width : 1, first = count < 0 ? (size_t)-count * step : 0;
    const size_t from = axis ? place / map->width : place % map->width;
    if (count < 0 && from < (size_t)-count) return false;
    for (size_t k = 0, at = place - first; k < (size_t)abs(count); k++, at += step) {
        const uint32_t texel =
            at < (size_t)map->width * map->height ? map->texel_at[at] : CHART_NONE;
        if (texel == CHART_NONE || !(links[texel] & (axis ? ORT_LINK_Y : ORT_LINK_X))) return false;
    }
    return true;
}

void ort_filter_light(const struct ort_map *map, const uint8_t *links, int axis, int stride,
                      const float *from, float *to)
{
    static const float TAP[5] = { 1.0f / 16, 4.0f / 16, 6.0f / 16, 4.0f / 16, 1.0f / 16 };
    const ptrdiff_t step = stride * (axis ? (ptrdiff_t)map->width : 1);
    for (size_t i = 0; i < (size_t)map->width * map->height; i++) {
        float sum[3] = { 0 };
        for (int k = -2; k <= 2; k++) {
            const bool reached = is_reached(map, links, i, axis, k * stride);
            const float *at = from + 3 * ((ptrdiff_t)i + (reached ? k * step : 0));
            for (int c = 0; c < 3; c++) sum[c] += TAP[k + 2] * at[c];
        }
        for (int c = 0; c < 3; c++)
            to[3 * i + (size_t)c] = float_from_half(half_from_float(sum[c]));
    }
}

// Between light of texels and that of places.
static void to_plane(const struct ort_map *map, const float *texels, float *plane)
{
    for (size_t i = 0; i < (size_t)map->width * map->height; i++)
        for (size_t c = 0; map->texel_at[i] != CHART_NONE && c < 3; c++)
            plane[3 * i + c] = texels[3 * (size_t)map->texel_at[i] + c];
}
static void from_plane(const struct ort_map *map, const float *plane, float *texels)
{
    for (size_t i = 0; i < (size_t)map->width * map->height; i++)
        for (size_t c = 0; map->texel_at[i] != CHART_NONE && c < 3; c++)
            texels[3 * (size_t)map->texel_at[i] + c] = plane[3 * i + c];
}

static void make_levels(const struct ort_map *map, const uint8_t *links, float *light[ORT_LEVELS])
{
    const size_t floats = 3 * (size_t)map->width * map->height;
    float *plane = calloc(floats, sizeof *plane), *rows = calloc(floats, sizeof *rows);
    assert_true(plane && rows);
    to_plane(map, light[0], plane);
    for (int level = 1, stride = 1; level < ORT_LEVELS; level++) {
        ort_filter_light(map, links, 0, stride, plane, rows);
        ort_filter_light(map, links, 1, stride, rows, plane);
        from_plane(map, plane, light[level]);
        stride *= 3;
    }
    free(plane);
    free(rows);
}

void ort_indirect_prefiltered(const struct ort_fixture *f, const struct ort_baked *baked,
                              const float *light, float *out)
{
    const struct tensor *offsets = tensors_find(baked->tensors, ORT_OFFSETS);
    const uint32_t count = (uint32_t)offsets->shape[1], maps = f->map.group_count * count;
    float *levels[ORT_LEVELS];
    uint8_t *level = calloc(maps, 1);
    assert_non_null(level);
    for (int l = 0; l < ORT_LEVELS; l++) levels[l] = ort_texel_floats(f);
    memcpy(levels[0], light, 3 * (size_t)f->map.texel_count * sizeof *light);
    make_levels(&f->map, tensors_find(baked->tensors, ORT_LINKS)->data, levels);
    CHECK(ort_find_levels(
        &(struct ort_maps){ &f->map, .offset = offsets->data, .offsets = count, .count = maps },
        level));
    for (uint32_t i = 0; i < f->map.texel_count; i++)
        gather_texel(f, baked, i, level, (const float *const *)levels, out + 3 * (size_t)i);
    for (int l = 0; l < ORT_LEVELS; l++) free(levels[l]);
    free(level);
}

// 1 plus a wave of about the scene's size: positive.
static float smooth_light(struct rng rng, vec3s at)
{
    const float phase = 2.0f * GLM_PIf * rng_float(&rng);
    vec3s wave;
    for (int a = 0; a < 3; a++) wave.raw[a] = 2.0f * rng_float(&rng) - 1.0f;
    return 1.0f + 0.9f * cosf(2.0f * glms_vec3_dot(wave, at) + phase);
}

static float spotty_light(const struct ort_fixture *f, struct rng rng, vec3s at)
{
    enum { SPOTS = 4 };
    static const float RADIUS = 0.25f;
    float sum = 0.0f;
    for (int i = 0; i < SPOTS; i++) {
        const uint32_t center = rng_u32(&rng) % f->map.texel_count;
        const vec3s to = glms_vec3_sub(at, chart_texel_of(&f->map.charts, center)->position);
        sum += expf(-glms_vec3_norm2(to) / (2.0f * RADIUS * RADIUS));
    }
    return sum;
}

void ort_random_light(const struct ort_fixture *f, enum ort_light kind, uint32_t seed, float *light)
{
    for (uint32_t i = 0; i < f->map.texel_count; i++)
        for (uint32_t c = 0; c < 3; c++) {
            const struct rng rng = rng_for(seed, c, 0);
            const vec3s at = chart_texel_of(&f->map.charts, i)->position;
            light[3 * i + c] =
                kind == ORT_SMOOTH ? smooth_light(rng, at) : spotty_light(f, rng, at);
        }
}
