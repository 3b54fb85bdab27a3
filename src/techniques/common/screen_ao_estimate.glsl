// Main function of the estimate. A shader includes this file and defines screen_ao_visibility; its
// own bindings start at 4.
//
// One invocation processes SCREEN_AO_ROWS pixels of a column. An inner loop skips pixels without a
// surface, which are already cleared: software drivers execute masked branches but leave finished
// loops.
#extension GL_EXT_control_flow_attributes : require

#include "frame/octahedral.glsl"
#include "techniques/common/pattern.glsl"
#include "techniques/common/screen_ao.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3, rg32f) uniform writeonly image2D estimate;

struct screen_point {
    ivec2 pixel;  // of the frame
    uint pattern; // of the blur's footprint: index of its rotated sample set
    float depth;
    vec3 n; // faces the camera; x right, y down, z forward
};

float screen_ao_visibility(screen_point point);

screen_point point_at(ivec2 work, float depth)
{
    ivec2 pixel = work * SCREEN_AO_STEP;
    vec3 n = screen_normal(octahedral_decode(texelFetch(normal, pixel, 0).rg));
    return screen_point(pixel, pattern_4x4(uvec2(work)), depth, n);
}

void main()
{
    ivec2 work = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, SCREEN_AO_ROWS);
    int end =
        work.x < int(view.work_width) ? min(work.y + SCREEN_AO_ROWS, int(view.work_height)) : 0;
    [[dont_unroll]] for (;; work.y++)
    {
        float here = 0.0;
        [[dont_unroll]] for (; work.y < end; work.y++)
        {
            here = texelFetch(depth, work * SCREEN_AO_STEP, 0).r;
            if (here > 0.0) break;
        }
        if (work.y >= end) break;
        float visibility = screen_ao_visibility(point_at(work, here));
        imageStore(estimate, work, vec4(clamp(visibility, 0.0, 1.0), here, 0.0, 0.0));
    }
}
