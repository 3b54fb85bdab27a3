// Data of the cone tracing shaders that the host writes. Scalar layout.
#ifndef AG_VCT_CONES_SHARED_H
#define AG_VCT_CONES_SHARED_H

#include "techniques/vct/vct_shared.h"

#define VCT_MAX_CONES      25
#define VCT_MAX_INTERLEAVE 5
#define VCT_GATHER_ROW     4 // pixels per invocation of cones/gather.comp
#define VCT_BLUR_TILE      4 // pixels per invocation of cones/blur.comp, in x and y
#define VCT_REFLECT_SIDE   4 // of the pixels that share the directions of a specular lobe

// Uniform block "vct_cones".
struct vct_cone_params {
    // Direction, weight. Voxels: around +z, weights in sr, Σ = π. Pixels: world space, Σ = 1.
    vec4s cones[VCT_MAX_CONES];
    uint32_t cone_count;
    uint32_t interleave;
    uint32_t step;          // frame pixels per traced pixel, in x and y
    uint32_t width, height; // in traced pixels
    float width_per_m;      // texel width over distance: cone width times step size
    float offset;           // of the apex along the normal, texels of the light volume
    float gain;
    float texel_m; // of the finest level
    uint32_t last_mip;
    float environment_sigma; // of the lobes of the environment, rad (frame/environment_map.glsl)
    uint32_t columns;        // of the grid of strata, for rays
    // Sets whose records are not of this frame's voxels: 1 static, 2 dynamic, of each level from
    // the finest on.
    uint32_t new_sets;
    uint32_t in_turns;   // bool, bounces: only parts whose turn it is gather
    uint32_t frame;      // number of the frame
    vec3s set_axes[3];   // axes of the strata of pixels, world space
    float level_chance;  // of rays between two levels of the clip map: differs by frame
    uint32_t padding[3]; // vec4s is aligned to 16 bytes in C
};

// Storage block "vct_small_emitters".
#define VCT_MAX_SMALL_EMITTERS 16
#define VCT_EMITTER_POINTS     12
struct vct_small_emitter {
    float area_m2;                         // per sample point
    uint32_t both_sides;                   // bit i: point i emits to both sides
    vec3s positions[VCT_EMITTER_POINTS];   // world space
    vec3s normals[VCT_EMITTER_POINTS];     // unit, front side
    vec3s intensities[VCT_EMITTER_POINTS]; // along the normal, scaled candela
};

// Uniform block "vct_specular".
struct vct_specular_params {
    float tan_half; // tangent of all cones' half-angle; 0: from the roughness
    float step_size;
    float offset; // texels of the light volume
    float gain;
    float texel_m; // of the finest level
    uint32_t last_mip;
    uint32_t traced;         // bool: not metals alone, by E/π
    uint32_t has_dielectric; // bool: FRAME_DIELECTRIC is bound
    uint32_t turn;           // number of the directions, which differ from frame to frame
    uint32_t stride; // one in stride × stride pixels of rough surfaces has a ray in a frame
};

// Push constants of cones/denoise.comp.
struct vct_denoise_push {
    int32_t stride;   // of the taps, px
    float step_per_m; // width of that many pixels at a distance of 1 m
    float radius_m;   // beyond which light is another
    float deviations; // of the mean, in which two pixels differ by noise alone
};

// How the history follows a change of light: see cones/temporal.c.
#define VCT_KEEP            0 // no light has changed
#define VCT_FOLLOW_KNOWN    1 // by the difference of two frames of one rotation
#define VCT_FOLLOW_EXPECTED 2 // by the last known difference
#define VCT_SETTLE          3 // the last bounces follow: with less weight

// Uniform block "vct_history": the view of the previous frame. The surface in pixel (x, y) at the
// distance d is, relative to the camera, at d · forward + s · (corner + x · right + y · down), with
// s = d, or 1 in orthographic views; world space, m.
struct vct_history_params {
    vec3s right, down, corner, forward;
    float pixel;           // width of a pixel: times s
    float perspective;     // 1; 0: orthographic
    float most;            // maximum weight of the history, frames
    float clamp;           // standard deviations; 0: off
    float scale;           // radiance scale of this frame over that of the previous one
    uint32_t known;        // bool: the history is valid
    uint32_t follow;       // VCT_KEEP, …
    uint32_t change_known; // bool: the previous frame has stored its change
    int32_t block;         // px along a side that share one set of cones or rays
    float added;           // weight of this frame where pixels do not move, frames
    // Maximum weight of the history of reflections, frames: of mirrors, and of rough surfaces.
    float most_of_mirror, most_of_lobe;
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct vct_cone_params) == VCT_MAX_CONES * 16 + 28 * 4,
               "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_small_emitter) == (2 + 9 * VCT_EMITTER_POINTS) * 4,
               "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_specular_params) == 10 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_history_params) == 24 * 4, "layout is shared with GLSL");
#endif

#endif
