// A shape of the dictionary: its surface as a set of texels, and rays inside it. The surface is
// where light is known: direct light at texel centres in, indirect light at texel centres out.
// Openings (missing faces, ends of a tube) let light through.
#pragma once

#include "techniques/mrt/dictionary/cube.h"

#include <stddef.h>

enum mrt_shape_kind { MRT_CUBE };

enum { MRT_MAX_OPENINGS = CUBE_FACES };

struct mrt_shape {
    enum mrt_shape_kind kind;
    int resolution;   // texels along an edge of a face
    unsigned missing; // bit f: face f is an opening
};

// A point of the surface. The columns of `frame` are tangent, bitangent and the normal into the
// shape: those of the face's frame, turned by half a turn around v.
struct mrt_point {
    vec3s position;
    mat3s frame;
};

// Bilinear lookup among the texels of one face, clamped to it (weights sum to 1), or the opening
// through which the ray left the shape (`texels` is 0) at coordinates (s, t) of that face.
struct mrt_hit {
    int texels;
    int opening; // face; −1: a surface was hit
    float s, t;
    int texel[4];
    float weight[4];
};

struct mrt_shape mrt_cube(int resolution, unsigned missing);
int mrt_shape_texels(const struct mrt_shape *shape);
int mrt_shape_openings(const struct mrt_shape *shape);
struct mrt_point mrt_shape_texel(const struct mrt_shape *shape, int texel);
// The texel that contains coordinates (s, t) of a face, −1 on an opening.
int mrt_shape_texel_at(const struct mrt_shape *shape, int face, float s, float t);
void mrt_shape_trace(const struct mrt_shape *shape, vec3s from, vec3s direction,
                     struct mrt_hit *hit);
