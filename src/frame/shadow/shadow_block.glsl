// Results of the test of shadow_resolved.glsl that the blocks of a sun's shadow map prove, with the
// conditions of its code for all receivers in a block. Include after it.
#ifndef AG_FRAME_SHADOW_BLOCK_GLSL
#define AG_FRAME_SHADOW_BLOCK_GLSL

#include "frame/shadow/shadow_plane.glsl"
#include "frame/shadow/shadow_sun_shared.h"

#define SHADOW_KNOWN_LIT    0
#define SHADOW_KNOWN_SHADOW 1
#define SHADOW_UNKNOWN      2

// Surely above SHADOW_PARALLEL for each stencil of a block, whose slopes deviate from the plane's.
const float SHADOW_BLOCK_PARALLEL = 0.8;

// Whether the receiver's surface is surely parallel to the block's.
bool shadow_is_parallel(shadow_plane plane, vec3 normal)
{
    vec3 n = vec3(-plane.slope, 1.0);
    float along = dot(n, normal);
    return along > 0.0 && along * along > SHADOW_BLOCK_PARALLEL * SHADOW_BLOCK_PARALLEL *
                                              dot(n, n) * dot(normal, normal);
}

int shadow_known(sampler2DArray blocks, shadow_receiver r)
{
    vec2 at = clamp(r.position.xy, 1.0, r.size - 3.0) / float(SHADOW_BLOCK), block = floor(at);
    shadow_plane plane = shadow_plane_of(texelFetch(blocks, ivec3(ivec2(block), r.layer), 0));
    float above =
        plane.height + dot(plane.slope, (at - block) * float(SHADOW_BLOCK)) - r.position.z;
    float steepness = shadow_steepness(plane), deviation = shadow_deviation(plane);
    // All texels are occluders. The test extrapolates upward slopes to the receiver, not others.
    float deepest = SHADOW_TOLERANCE + (1.0 + SHADOW_SLOPE_TOLERANCE) * (steepness + deviation);
    if (above > (plane.is_exact ? deepest : 0.0)) return SHADOW_KNOWN_SHADOW;
    // All texels are the receiver's own surface, and the viewer is on its side.
    float loose = shadow_is_parallel(plane, r.normal) ? SHADOW_SLOPE_TOLERANCE : 0.0;
    float tolerance = SHADOW_TOLERANCE + loose * (steepness - 2.0 * deviation) - deviation;
    float side = r.to_viewer.z - dot(plane.slope, r.to_viewer.xy);
    bool seen = side > deviation * (abs(r.to_viewer.x) + abs(r.to_viewer.y));
    return plane.is_exact && abs(above) <= tolerance && seen ? SHADOW_KNOWN_LIT : SHADOW_UNKNOWN;
}

#endif
