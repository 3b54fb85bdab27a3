// Data of a frame that passes and techniques share, C and GLSL. Scalar layout.
//
// Radiometric unit of all GPU images: physical value × radiance_scale, a power of two derived from
// the lights, so that half floats neither overflow nor underflow and twice the light changes only
// the scale. Readbacks divide by it.
#ifndef AG_FRAME_SHARED_H
#define AG_FRAME_SHARED_H

#include "core/shared.h"

#define FRAME_LIGHT_SUN   0
#define FRAME_LIGHT_POINT 1
#define FRAME_LIGHT_SPOT  2

#define FRAME_MAX_LIGHTS          64
#define FRAME_MAX_CASCADES        4
#define FRAME_MAX_VIEWS           8
#define FRAME_ENVIRONMENT_PATCHES 64 // ENVIRONMENT_PATCHES of scene/environment.h

// Uniform block "frame_constants".
struct frame_constants {
    mat4s clip_from_world; // reversed Z: depth 1 at the near plane, see frame_camera.h
    mat4s world_from_clip;
    mat4s previous_clip_from_world; // of the previous frame, with the jitter of this one
    mat4s view_from_world;
    vec4s viewer;            // homogeneous: the position, or minus the axis of an orthographic view
    vec4s distance_of_depth; // distance = (x + y · depth) / (z + w · depth)
    // x and y (right and down) of the sight line through the centre of the first pixel, and their
    // steps per pixel: at 1 m along the axis, or orthographic in m at any distance.
    vec4s image_plane;
    // Distance along the view axis, and that of the previous frame: xyz · position + w.
    vec4s axis, previous_axis;
    vec3s camera_position; // world, m
    float near_m;
    // The sight line through a point (x, y) of clip space: origin + distance · ray, each with its
    // parts by x and y. World space, m; rays have the length 1 along the view axis.
    vec3s origin, origin_x, origin_y, ray, ray_x, ray_y;
    vec3s sky;                  // scaled radiance, mean of the environment: environment.glsl
    float radiance_scale;       // scaled = physical × radiance_scale
    float previous_scale_ratio; // radiance_scale / previous radiance_scale: a factor for history
    uint32_t width, height;
    uint32_t light_count;
    uint32_t frame_index;
    float unlit_white;       // scaled radiance of a white unlit material (scene/unlit.h)
    float emissive_scale;    // of the emissive layer to scaled radiance; 1 unless it is a caller's
    vec3s uniform_sky;       // scaled radiance that the environment has besides its map
    float environment_scale; // of texels of the map to scaled radiance; 0: there is no map
    float environment_cos, environment_sin; // of the map's rotation about +y
    float environment_side;                 // texels of the map's finest level
    vec3s environment_sh[9]; // coefficients of the environment's scaled radiance (core/sh.h)
    // Jitter of this frame minus that of the previous one, in pixels; 0 after a cut.
    float jitter_step_x, jitter_step_y;
    uint32_t padding[3]; // mat4s is aligned to 16 bytes in C
};

// Storage block "frame_lights".
struct frame_light {
    vec3s position;
    uint32_t type;   // FRAME_LIGHT_…
    vec3s direction; // unit, away from the light
    float range_m;   // 0: unlimited
    vec3s intensity; // scaled lux or candela
    float cos_inner;
    float cos_outer;
    int32_t shadow_first; // first face in shadow_faces, -1: no shadow
    int32_t shadow_count; // suns: cascades; spots: 1; points: 6 (+x −x +y −y +z −z)
    uint32_t padding;
};

// Storage block "rsm_faces": one per layer of the reflective shadow map arrays.
struct rsm_face {
    mat4s world_from_clip;
    mat4s clip_from_world;
    // Suns: scaled lux × texel area in m², the flux through a texel; other lights: scaled candela.
    vec3s intensity;
    uint32_t type;  // FRAME_LIGHT_…
    vec3s position; // of the light; suns: 0
    // Points and spots: tangent of the face's half-angle; suns: half-width in metres.
    float tan_half;
    vec3s direction; // of suns and spots, away from the light
    uint32_t light;  // index in frame_lights
};

// Storage block "frame_emitters": a virtual point light on an emissive surface, of intensity
// flux/π · (normal·ω)₊.
struct frame_emitter {
    vec3s position; // world, m
    vec3s normal;   // unit, of the emitting side
    vec3s flux;     // scaled lumen
};

// Grid and image layout of a probe volume: frame/probes.glsl.
#define FRAME_PROBE_SLABS 7
struct frame_probes {
    vec3s first_m;   // of probe (0, 0, 0), world
    float spacing_m; // between neighbouring probes, along each axis of the world
    int32_t count_x, count_y, count_z;
    int32_t slab; // texels along z between slabs of the image
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct frame_constants) == 4 * 64 + 92 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct frame_light) == 64, "layout is shared with GLSL");
_Static_assert(sizeof(struct frame_emitter) == 9 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct frame_probes) == 8 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct rsm_face) == 2 * 64 + 12 * 4, "layout is shared with GLSL");
#endif

#endif
