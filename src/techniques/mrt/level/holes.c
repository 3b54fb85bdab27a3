// Rays across the face of a block.
#include "techniques/mrt/level/holes.h"

#include "techniques/mrt/level/wall.h"

enum { ALONG = 16 }; // rays along each edge of a part

// Edges to either side of a face where a wall of it may be, as in clutter_find.c.
static const float REACH = 0.15f;

static bool is_open(const struct mrt_block *block, int face, float s, float t,
                    mrt_is_blocked is_blocked, const void *scene)
{
    vec3s inner = mrt_wall_place(block, face, s, t).position, outer = inner;
    inner.raw[face / 2] *= 1.0f - 2.0f * REACH;
    outer.raw[face / 2] *= 1.0f + 2.0f * REACH;
    const vec3s from = mrt_warp_point(block->corner, inner);
    return !is_blocked(scene, from, glms_vec3_sub(mrt_warp_point(block->corner, outer), from));
}

static float open_share(const struct mrt_block *block, int face, int part,
                        mrt_is_blocked is_blocked, const void *scene)
{
    int open = 0;
    for (int i = 0; i < ALONG * ALONG; i++) {
        const float s = (float)(part % MRT_HOLES) + ((float)(i % ALONG) + 0.5f) / ALONG;
        const float t = (float)(part / MRT_HOLES) + ((float)(i / ALONG) + 0.5f) / ALONG;
        open += is_open(block, face, s / MRT_HOLES, t / MRT_HOLES, is_blocked, scene);
    }
    return (float)open / (ALONG * ALONG);
}

float mrt_find_holes(const struct mrt_block *block, int face, mrt_is_blocked is_blocked,
                     const void *scene, struct mrt_holes *out)
{
    float sum = 0.0f;
    for (int p = 0; p < MRT_HOLE_PARTS; p++) {
        out->share[p] = open_share(block, face, p, is_blocked, scene);
        sum += out->share[p];
    }
    return sum / MRT_HOLE_PARTS;
}
