// The discontinuity buffer (Hong 2015, sec. 4.2): where a surface ends between a pixel and the next one to the right
// (1) or below (2).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/vct/vct_clipmap.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5, r8) uniform writeonly image2D edges;

const float LEAST_COSINE = 0.7; // of normals next to each other on one surface: 45 degrees

struct point
{
    bool valid;
    vec3 position, normal;
};

point point_at(ivec2 pixel)
{
    pixel = min(pixel, ivec2(set.width, set.height) - 1);
    float z = texelFetch(depth, pixel, 0).r;
    point p;
    p.valid = z > 0.0;
    p.position = frame_world_position(frame_uv(uvec2(pixel)), max(z, 1e-12));
    p.normal = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    return p;
}

// Half a texel of the light volume off the plane is another surface, as far as light can tell.
bool apart(point a, point b)
{
    return !a.valid || !b.valid || dot(a.normal, b.normal) < LEAST_COSINE ||
           abs(dot(a.normal, b.position - a.position)) >
               0.5 * set.texel_m * vct_texel_at((a.position - clips.origin_m) / set.texel_m);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(set.width, set.height)))) return;
    point here = point_at(pixel);
    float bits = apart(here, point_at(pixel + ivec2(1, 0))) ? 1.0 : 0.0;
    bits += apart(here, point_at(pixel + ivec2(0, 1))) ? 2.0 : 0.0;
    imageStore(edges, pixel, vec4(bits / 255.0));
}
