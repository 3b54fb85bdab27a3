// Input of a technique without a frame: a wall in view of the camera, and reflective shadow maps
// set texel by texel.
#pragma once

#include "frame/frame.h"
#include "framework/gpu_test.h"

enum { RSM_FIXTURE_MAX_FACES = 4 };

// One texel of a reflective shadow map before it is encoded. Normals are quantized as on the
// GPU.
struct rsm_fixture_texel {
    float depth;  // in the face's clip space; 0: nothing
    vec3s normal; // unit
    uint8_t reflectance[3];
};

struct rsm_fixture {
    struct gpu *gpu;
    gpu_image depth, normal, irradiance;
    gpu_image rsm_depth, rsm_normal, rsm_flux;
    gpu_buffer faces_buffer, constants_buffer, emitters_buffer;
    struct rsm_face faces[RSM_FIXTURE_MAX_FACES];
    struct rsm_fixture_texel *texels; // [face][y][x]
    struct frame_constants constants;
    struct frame_view view; // fill in bounds; the rest is kept by the functions below
};

void rsm_fixture_init(struct rsm_fixture *rsm, struct gpu *gpu, uint32_t width, uint32_t height,
                      uint32_t rsm_size, int face_count);
void rsm_fixture_finish(struct rsm_fixture *rsm);
// The visible surface is the parallelogram corner + [0,1] across + [0,1] down, of this normal.
void rsm_fixture_show_wall(struct rsm_fixture *rsm, vec3s corner, vec3s across, vec3s down,
                           vec3s normal);
// Face `face` is a sun's: its texels lie on corner + [0,1] across + [0,1] down + depth · away,
// `lumen` through each.
void rsm_fixture_set_face(struct rsm_fixture *rsm, int face, vec3s corner, vec3s across, vec3s down,
                          vec3s away, vec3s lumen);
struct rsm_fixture_texel *rsm_fixture_texel(struct rsm_fixture *rsm, int face, uint32_t x,
                                            uint32_t y);
void rsm_fixture_fill_face(struct rsm_fixture *rsm, int face, struct rsm_fixture_texel texel);
vec3s rsm_fixture_texel_position(const struct rsm_fixture *rsm, int face, uint32_t x, uint32_t y);
vec3s rsm_fixture_texel_flux(const struct rsm_fixture *rsm, int face, uint32_t x,
                             uint32_t y);       // scaled lumen
vec3s rsm_fixture_rounded_normal(vec3s normal); // as the 16-bit image holds it
// Points on emissive surfaces; the caller keeps the array.
void rsm_fixture_set_emitters(struct rsm_fixture *rsm, const struct frame_emitter *emitters,
                              int count);
// Uploads texels and faces; call it after changes.
void rsm_fixture_upload(struct rsm_fixture *rsm);
// Irradiance, 3 floats a pixel.
void rsm_fixture_read_irradiance(struct rsm_fixture *rsm, float *rgb);
