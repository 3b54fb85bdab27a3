// The pass that fills the estimate. A shader includes this file and says in screen_ao_visibility
// how it looks round a pixel's point; bindings from 4 on are its own.
//
// One invocation does SCREEN_AO_ROWS pixels below each other and goes over those without a surface,
// which were cleared before, in a loop of its own: software drivers run through what is not wanted
// of a body, but not through a loop that is done.
#extension GL_EXT_control_flow_attributes : require

#include "frame/octahedral.glsl"
#include "techniques/common/screen_ao.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3, rg32f) uniform writeonly image2D estimate;

struct screen_place {
    ivec2 pixel;  // of the frame
    uint pattern; // which of the turned sets is its own
    float depth;
    vec3 n; // towards the eye; x right, y down, z away
};

float screen_ao_visibility(screen_place place);

screen_place place_at(ivec2 work, float depth)
{
    ivec2 pixel = work * SCREEN_AO_STEP;
    vec3 n = screen_normal(octahedral_decode(texelFetch(normal, pixel, 0).rg));
    return screen_place(pixel, screen_pattern(uvec2(work)), depth, n);
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
        float visibility = screen_ao_visibility(place_at(work, here));
        imageStore(estimate, work, vec4(clamp(visibility, 0.0, 1.0), here, 0.0, 0.0));
    }
}
