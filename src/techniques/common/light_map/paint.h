// Painted light: first-order irradiance that a program sets for texels of a light map. Nothing is
// created before the first call. Passes read it by light_map_painted_light (texels.glsl).
#pragma once

#include "frame/frame.h"
#include "techniques/common/light_map/map_shared.h"

struct charts;

// A rectangle of the light map on one side, and its irradiance.
struct light_map_area {
    uint32_t x, y, width, height;
    bool back;
    const float *lux; // [height][width][3]; NULL: 0
};

struct light_map_paint {
    struct host *host;
    struct gpu *gpu;
    const struct charts *charts;      // stay where they are
    struct light_map_painted *texels; // [texels of both sides] the pending ones first
    uint32_t *at;                     // [texels of both sides] of a texel, in `texels`
    uint32_t pending;                 // texels that `table` does not have yet
    float most;                       // largest irradiance
    gpu_image table;                  // [texels of both sides] lux
    gpu_pipeline write;
};

// charts: may be empty yet. light_map_paint_finish accepts zero.
void light_map_paint_init(struct light_map_paint *out, struct host *host, struct gpu *gpu,
                          const struct charts *charts);
void light_map_paint_finish(struct light_map_paint *paint);
// Replaces the irradiance of the texels in an area, of which gutters have none. false, and nothing
// changed: the area is not in the light map, a value is negative or not finite, or no memory.
bool light_map_paint_set(struct light_map_paint *paint, const struct light_map_area *area);
// Before the passes of a frame that read it. Whether paint has changed since the last frame.
bool light_map_paint_record(struct light_map_paint *paint, struct gpu_cmd *cmd);

// Bindings, in GPU_BIND, and push constants of shaders that include texels.glsl. Without paint the
// table of texels is bound for its table and not read.
#define LIGHT_MAP_TEXEL_BINDINGS(view, paint, texels, sky)                                         \
    (view)->environment_patches_binding, { .name = "light_map_texels", .image = (texels) },        \
        { .name = "light_map_sky", .image = (sky) },                                               \
    {                                                                                              \
        .name = "light_map_paint", .image = (paint)->table.id ? (paint)->table : (texels)          \
    }
static inline struct light_map_sources
light_map_sources(const struct light_map_paint *paint, const struct frame_view *view, bool emitters)
{
    return (struct light_map_sources){ emitters ? 1.0f : 0.0f, paint->table.id != 0,
                                       view->constants->environment_scale > 0.0f ? TEXEL_SKY_WORDS
                                                                                 : 0 };
}
