// The discontinuity buffer (Hong 2015, sec. 4.2): where a surface ends between a pixel and the next
// one to the right (1) or below (2). And the way in which the pixel's cones start.
//
// Cones leave their surface as the light volume has it, with what is smaller than its texels evened
// out: folds and bumps would else send cones of neighbours off from places that lie a texel apart,
// and into the next fold. So they start along the mean of the normals of what lies about the pixel,
// within a texel and within the reach of what neighbours share.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/vct/clipmap/clipmap.glsl"
#include "techniques/vct/cones/cones_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5, r8) uniform writeonly image2D edges;
layout(set = 0, binding = 6, rg16f) uniform writeonly image2D cone_normal;

const float LEAST_COSINE = 0.4; // of normals next to each other on one surface: 66 degrees

// In the eye's space: x right, y down, z away.
struct point {
    bool valid;
    vec3 position; // m
    vec3 normal;   // world
};

point point_at(ivec2 pixel)
{
    pixel = int(set.step) * clamp(pixel, ivec2(0), ivec2(set.width, set.height) - 1);
    float z = texelFetch(depth, pixel, 0).r;
    vec2 from_middle = vec2(pixel) + 0.5 - 0.5 * vec2(frame.width, frame.height);
    point p;
    p.valid = z > 0.0;
    p.position = frame_view_distance(max(z, 1e-12)) * vec3(set.pixel * from_middle, 1.0);
    p.normal = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    return p;
}

// Of the light volume where the pixel's point is, m.
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

// Half a texel of the light volume off the plane is another surface, as far as light can tell.
bool apart(point here, vec3 normal_seen, point there, float texel_m)
{
    return !here.valid || !there.valid || dot(here.normal, there.normal) < LEAST_COSINE ||
           abs(dot(normal_seen, there.position - here.position)) > 0.5 * texel_m;
}

// Of a pixel's normal in the mean about another: what faces it by more than a few degrees is
// another side.
float share_of(point there, point here, float texel_m)
{
    vec3 off = there.position - here.position;
    float near = clamp(1.0 - dot(off, off) / (texel_m * texel_m), 0.0, 1.0);
    return there.valid ? near * clamp(0.2 + 2.0 * dot(here.normal, there.normal), 0.0, 1.0) : 0.0;
}

// Eight of the pixels about it: beside it at 2, at their corners at 3.
vec3 start_of(ivec2 pixel, point here, float texel_m)
{
    vec3 sum = here.normal;
    for (int i = 0; i < 4; i++) {
        ivec2 side = (i & 1) == 0 ? ivec2((i & 2) - 1, 0) : ivec2(0, (i & 2) - 1);
        ivec2 corner = ivec2((i & 1) * 2 - 1, (i & 2) - 1);
        point beside = point_at(pixel + 2 * side), across = point_at(pixel + 3 * corner);
        sum += share_of(beside, here, texel_m) * beside.normal +
               share_of(across, here, texel_m) * across.normal;
    }
    return normalize(sum);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(set.width, set.height)))) return;
    point here = point_at(pixel);
    vec3 normal_seen = to_view_space(here.normal);
    float texel_m = texel_at(pixel);
    float bits = apart(here, normal_seen, point_at(pixel + ivec2(1, 0)), texel_m) ? 1.0 : 0.0;
    bits += apart(here, normal_seen, point_at(pixel + ivec2(0, 1)), texel_m) ? 2.0 : 0.0;
    imageStore(edges, pixel, vec4(bits / 255.0));
    vec2 up = here.valid ? octahedral_encode(start_of(pixel, here, texel_m)) : vec2(0.0);
    imageStore(cone_normal, pixel, vec4(up, 0.0, 0.0));
}
