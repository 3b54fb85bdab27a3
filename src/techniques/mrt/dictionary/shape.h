// A shape of the dictionary: its surface as a set of texels, and rays inside it. The surface is
// where light is known: direct light at texel centres in, indirect light at texel centres out.
// Openings (missing faces, ends of a tube) let light through.
#pragma once

#include "techniques/mrt/dictionary/cube.h"
#include "techniques/mrt/dictionary/tube.h"

#include <stddef.h>

enum mrt_shape_kind { MRT_CUBE, MRT_TUBE, MRT_TUBE_LEFT, MRT_TUBE_RIGHT };

enum { MRT_MAX_OPENINGS = CUBE_FACES };

struct mrt_shape {
    enum mrt_shape_kind kind;
    int resolution;   // texels along an edge of a face; around and along a tube
    unsigned missing; // bit f: face f of the cell is an opening
};

// A point of the surface. The columns of `frame` are tangent, bitangent and the normal into the
// shape: on a cube those of the face's frame, rotated by 180° around v, in a tube forward,
// around and inward.
struct mrt_point {
    vec3s position;
    mat3s frame;
};

// Bilinear lookup among the texels of one face, clamped to it (weights sum to 1), or the opening
// through which the ray left the shape (`texels` is 0) at coordinates (s, t) of that face. A tube
// is one face, closed around.
struct mrt_hit {
    int texels;
    int face;    // of a cube
    int opening; // face; −1: a surface was hit
    float s, t;
    float distance; // in lengths of the direction
    int texel[4];
    float weight[4];
};

struct mrt_shape mrt_cube(int resolution, unsigned missing);
struct mrt_shape mrt_tube(int resolution, enum tube_bend bend);
static inline bool mrt_shape_is_open(const struct mrt_shape *shape, int face)
{
    return shape->missing >> face & 1u;
}
int mrt_shape_texels(const struct mrt_shape *shape);
int mrt_shape_openings(const struct mrt_shape *shape);
struct mrt_point mrt_shape_texel(const struct mrt_shape *shape, int texel);
// The texel nearest to a point of the surface, −1 on an opening.
int mrt_shape_texel_near(const struct mrt_shape *shape, vec3s point);
// Parts of the surface on which the enrichment of the prior is constant: faces of a cube, a left,
// upper, right and lower quarter of a tube.
int mrt_shape_patches(const struct mrt_shape *shape);
int mrt_shape_patch(const struct mrt_shape *shape, int texel);
// Whether a ray can leave by an opening: false where its straight line misses that.
bool mrt_shape_points_at(const struct mrt_shape *shape, int face, vec3s from, vec3s direction);
// `direction` is a unit vector.
void mrt_shape_trace(const struct mrt_shape *shape, vec3s from, vec3s direction,
                     struct mrt_hit *hit);
