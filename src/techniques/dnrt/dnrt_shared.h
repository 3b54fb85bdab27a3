// Data of dynamic objects that the host uploads for the shaders of dnrt. Scalar layout.
#ifndef AG_DNRT_SHARED_H
#define AG_DNRT_SHARED_H

#include "core/shared.h"

#ifndef AG_GLSL
#include "frame/frame_shared.h"
#endif

#define DNRT_LOCAL        64  // workgroup size over samples of a volume
#define DNRT_TILE         16  // pixels along an edge of a tile, a workgroup
#define DNRT_TILE_BITS    2   // words of a tile before its bits
#define DNRT_MAX_OBJECTS  192 // a tile has a bit for each
#define DNRT_COEFFICIENTS 9   // of irradiance at an object
#define DNRT_PLANES       4   // of a coefficient, at most
#define DNRT_NO_SHAPE     -2  // of no object
#define DNRT_LOCAL_ROWS   4   // workgroup size of a tile along y in the pass `self`
// Bits of a patch's grid; the others: steps along an edge.
#define DNRT_PATCH_STEPS     0xffffu
#define DNRT_PATCH_TWO_SIDES 0x10000u
#define DNRT_PATCH_MIRRORED  0x20000u // corners are clockwise from the front
// Near plane of depth maps, over the radius of the bounding sphere.
#define DNRT_NEAR (1.0 / 64.0)

// Few words: a loop over objects in a shader loads them for each invocation.
struct dnrt_gpu_object {
    vec3s centre;      // of its volume, world, m
    float half_m;      // of an edge of the inner volume
    float rotation[4]; // world from object: a unit quaternion, w last
    int32_t shape;     // its volume; −1: none
    int32_t next;      // that of the next key frame
    float part;        // of the way there
    uint32_t slot;     // of its volume among all, in texels: x, y, z of 10 bits
    uint32_t first_instance, instance_count; // its own pixels
    vec3s box_centre, box_half;              // of its bounds, from the centre, along the axes, m
};

// The baked volume of a shape and a normal of receivers: planes of samples, coefficient after
// coefficient, m of red, green and blue, with the option `direct` k.
struct dnrt_gpu_shape {
    uint32_t first_word;                          // in dnrt_samples
    float scale[DNRT_PLANES * DNRT_COEFFICIENTS]; // of a plane
};

// Objects whose light, shape or moment between key frames differs from that of their volume, a row
// of workgroups for each; shapes and moments of all.
struct dnrt_changed {
    uint32_t groups_x, groups_y, groups_z; // of the pass `volumes`
    uint32_t list[DNRT_MAX_OBJECTS];
    int32_t shape[DNRT_MAX_OBJECTS];
    float part[DNRT_MAX_OBJECTS];
};

// A triangle of a volume's shape, and points on it (bake/patches.h).
struct dnrt_gpu_patch {
    vec3s corner[3]; // from the volume's centre, along the object's axes
    uint32_t first;  // point
    uint32_t grid;   // DNRT_PATCH_… bits
};

// An instance of the scene, for pixels of objects.
struct dnrt_own_instance {
    int32_t object;       // −1: none with patches
    uint32_t first, next; // patch, of the object's volume and of the next key frame's
    uint32_t triangles;
    float scale; // m, of the patches' unit
};

struct dnrt_self_push {
    uint32_t words;     // of a tile's bits
    uint32_t tiles_x;   // across the image
    uint32_t instances; // of the scene
    uint32_t light;     // first entry of dnrt_light
    uint32_t punctual;  // the same for punctual lights
};

struct dnrt_punctual_push {
    uint32_t objects;
    uint32_t to;           // first entry of dnrt_light
    float reach;           // of the inner volume, radii of the bounding sphere
    int32_t shadow_radius; // texels of the shadow map
};

struct dnrt_light_push {
    AG_STRUCT(frame_probes) grid;
    uint32_t objects;
    uint32_t normals; // volumes of an object
    uint32_t all;     // each is computed again
};

struct dnrt_bounce_push {
    uint32_t objects;
    uint32_t from, to; // entries of dnrt_light before those of the objects, read and written
    uint32_t punctual; // the same for punctual lights, read
    uint32_t size;
    float fade;
    float reach; // of the inner volume, radii of the bounding sphere
};

struct dnrt_volumes_push {
    uint32_t size;     // samples along an edge
    uint32_t first;    // entry of dnrt_light
    uint32_t punctual; // entry for punctual lights
};

struct dnrt_apply_push {
    uint32_t first_tile; // of the list
    uint32_t words;      // of a tile's bits
    uint32_t tiles_x;    // across the image
    uint32_t size;
    float fade;         // where the outer volume ends, in halves of the inner one's edge
    uint32_t map_size;  // texels along an edge of a depth map
    uint32_t map_count; // of the first objects
    float reach;        // of the inner volume, radii of the bounding sphere
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct dnrt_gpu_object) == 20 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct dnrt_gpu_object) * DNRT_MAX_OBJECTS <= 16384,
               "each device has uniform blocks of this size");
_Static_assert(sizeof(struct dnrt_gpu_shape) == 37 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct dnrt_changed) == (3 + 3 * DNRT_MAX_OBJECTS) * 4,
               "layout is shared with GLSL");
_Static_assert(sizeof(struct dnrt_gpu_patch) == 11 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct dnrt_own_instance) == 5 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct dnrt_apply_push) == 8 * 4, "layout is shared with GLSL");
#endif

#endif
