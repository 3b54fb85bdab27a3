// The discontinuity buffer (Hong 2015, sec. 4.2): 1 marks a discontinuity to the pixel on the
// right, 2 to the one below. Also writes the cone normal, the axis of the pixel's cone set.
//
// The cone normal is a mean over nearby pixels within a texel of the light volume, since the volume
// does not resolve smaller folds and bumps. With the pixel's own normal the cones of neighbours
// would start up to a texel apart and hit the next fold.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#define FRAME_CONSTANTS_COPIED
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/vct/clipmap/clipmap.glsl"
#include "techniques/vct/cones/cones_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set_block;
};
vct_cone_params set; // a copy that main begins with, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5, r8) uniform writeonly image2D edges;
layout(set = 0, binding = 6, rg16f) uniform writeonly image2D cone_normal;

const float LEAST_COSINE = 0.4; // of adjacent normals on one surface: 66 degrees

struct point {
    bool valid;
    vec3 position; // view space, m
    vec3 normal;   // world space
};

point point_at(ivec2 pixel)
{
    pixel = int(set.step) * clamp(pixel, ivec2(0), ivec2(set.width, set.height) - 1);
    float z = texelFetch(depth, pixel, 0).r;
    point p;
    p.valid = z > 0.0;
    p.position = frame_view_position(pixel, frame_view_distance(max(z, 1e-12)));
    p.normal = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    return p;
}

// Texel size of the light volume at the pixel's surface point, m.
float texel_at(ivec2 pixel)
{
    pixel *= int(set.step);
    vec3 position =
        frame_world_position(frame_uv(uvec2(pixel)), max(texelFetch(depth, pixel, 0).r, 1e-12));
    return set.texel_m * vct_texel_at((position - clips.origin_m) / set.texel_m);
}

vec3 to_view_space(vec3 world)
{
    return mat3(frame.view_from_world) * world * vec3(1.0, -1.0, -1.0);
}

// A point more than half a texel of the light volume off the plane is on another surface: closer
// ones have the same light.
bool discontinuous(point here, vec3 view_normal, point there, float texel_m)
{
    return !here.valid || !there.valid || dot(here.normal, there.normal) < LEAST_COSINE ||
           abs(dot(view_normal, there.position - here.position)) > 0.5 * texel_m;
}

// Weight of a neighbour's normal in the mean. 0 from about 96 degrees on, where the surfaces face
// each other.
float normal_weight(point there, point here, float texel_m)
{
    vec3 offset = there.position - here.position;
    float near = clamp(1.0 - dot(offset, offset) / (texel_m * texel_m), 0.0, 1.0);
    return there.valid ? near * clamp(0.2 + 2.0 * dot(here.normal, there.normal), 0.0, 1.0) : 0.0;
}

// Mean over eight neighbours: 2 pixels away along the axes, 3 along the diagonals.
vec3 cone_normal_at(ivec2 pixel, point here, float texel_m)
{
    vec3 sum = here.normal;
    for (int i = 0; i < 4; i++) {
        ivec2 side = (i & 1) == 0 ? ivec2((i & 2) - 1, 0) : ivec2(0, (i & 2) - 1);
        ivec2 corner = ivec2((i & 1) * 2 - 1, (i & 2) - 1);
        point beside = point_at(pixel + 2 * side), across = point_at(pixel + 3 * corner);
        sum += normal_weight(beside, here, texel_m) * beside.normal +
               normal_weight(across, here, texel_m) * across.normal;
    }
    return normalize(sum);
}

void main()
{
    frame = frame_block;
    set = set_block;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(set.width, set.height)))) return;
    point here = point_at(pixel);
    float texel_m = texel_at(pixel);
    vec3 view_normal = to_view_space(here.normal);
    float bits =
        discontinuous(here, view_normal, point_at(pixel + ivec2(1, 0)), texel_m) ? 1.0 : 0.0;
    bits += discontinuous(here, view_normal, point_at(pixel + ivec2(0, 1)), texel_m) ? 2.0 : 0.0;
    imageStore(edges, pixel, vec4(bits / 255.0));
    vec2 up = here.valid ? octahedral_encode(cone_normal_at(pixel, here, texel_m)) : vec2(0.0);
    imageStore(cone_normal, pixel, vec4(up, 0.0, 0.0));
}
