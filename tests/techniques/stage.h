// A stage for techniques without a frame: a wall that the camera sees, and reflective shadow maps
// set texel by texel.
#pragma once

#include "frame/frame.h"
#include "framework/gpu_test.h"

enum { STAGE_MAX_FACES = 4 };

// One texel of a reflective shadow map before it is encoded. Normals are rounded as the GPU will
// see them.
struct stage_texel {
    float depth;  // in the face's clip space; 0: nothing
    vec3s normal; // unit
    uint8_t reflectance[3];
};

struct stage {
    struct gpu *gpu;
    gpu_image depth, normal, irradiance;
    gpu_image rsm_depth, rsm_normal, rsm_flux;
    gpu_buffer faces_buffer, constants_buffer, emitters_buffer;
    struct rsm_face faces[STAGE_MAX_FACES];
    struct stage_texel *texels; // [face][y][x]
    struct frame_constants constants;
    struct frame_view view; // fill in bounds; the rest is kept by the functions below
};

void stage_init(struct stage *stage, struct gpu *gpu, uint32_t width, uint32_t height,
                uint32_t rsm_size, int face_count);
void stage_finish(struct stage *stage);
// The camera sees the parallelogram corner + [0,1] across + [0,1] down, of this normal.
void stage_show_wall(struct stage *stage, vec3s corner, vec3s across, vec3s down, vec3s normal);
// Face `face` is a sun's: its texels lie on corner + [0,1] across + [0,1] down + depth · away,
// `lumen` through each.
void stage_set_face(struct stage *stage, int face, vec3s corner, vec3s across, vec3s down,
                    vec3s away, vec3s lumen);
struct stage_texel *stage_texel(struct stage *stage, int face, uint32_t x, uint32_t y);
void stage_fill_face(struct stage *stage, int face, struct stage_texel texel);
vec3s stage_texel_position(const struct stage *stage, int face, uint32_t x, uint32_t y);
vec3s stage_texel_flux(const struct stage *stage, int face, uint32_t x, uint32_t y); // scaled lumen
vec3s stage_rounded_normal(vec3s normal); // as the 16-bit image holds it
// Points of emissive surfaces, until set again; they must live as long.
void stage_set_emitters(struct stage *stage, const struct frame_emitter *emitters, int count);
// Sends texels and faces to the GPU; to be called after changes.
void stage_upload(struct stage *stage);
// Irradiance, 3 floats a pixel.
void stage_read_irradiance(struct stage *stage, float *rgb);
