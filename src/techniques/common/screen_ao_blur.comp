// Edge-aware mean of an estimate over five pixels of a row, the outer two with half the weight,
// which removes a pattern of period four. A pixel's weight falls with its distance, in sphere
// radii, from the line through its neighbours' depths. Rows, then columns, give the mean over 4 × 4
// pixels.
//
// One invocation filters four pixels of a row, which share their fetches.
//
// Permutations: ALONG_Y, columns instead of rows; TO_VISIBILITY, the output is the frame's
// visibility instead of visibility and depth.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/screen_ao.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D source; // visibility, depth
#if TO_VISIBILITY
layout(set = 0, binding = 2, r8) uniform writeonly image2D visibility;
void store(ivec2 at, vec2 value)
{
    imageStore(visibility, at, vec4(value.x));
}
#else
layout(set = 0, binding = 2, rg32f) uniform writeonly image2D target;
void store(ivec2 at, vec2 value)
{
    imageStore(target, at, vec4(value, 0.0, 0.0));
}
#endif

const ivec2 DOWN = ALONG_Y ? ivec2(0, 1) : ivec2(1, 0);

const int ROW = 4, REACH = 2;
const float EDGE = 4.0; // weight 0 at a quarter of a radius

// Weight of a pixel `offset` steps from one of depth `here`; slope: of the depth, per step.
float weight_of(float depth, float here, float slope, float offset, float per_depth)
{
    return clamp(1.0 - abs(depth - here - slope * offset) * per_depth, 0.0, 1.0);
}

// The smaller of the two one-sided slopes; the larger may cross an edge.
float flatter(float a, float b)
{
    return abs(a) < abs(b) ? a : b;
}

vec2 mean_around(vec2 row[ROW + 2 * REACH], int i)
{
    float here = row[i].y;
    if (here <= 0.0) return row[i];
    float radius_px = screen_radius_px(view.radius_m, here);
    float per_depth = EDGE * screen_radii_per_depth(view.scale, radius_px, here);
    float slope = flatter(row[i + 1].y - here, here - row[i - 1].y);
    float weights = 1.0, sum = row[i].x;
    for (int k = 1; k <= REACH; k++) {
        float share = k == REACH ? 0.5 : 1.0;
        float left = share * weight_of(row[i - k].y, here, slope, -float(k), per_depth);
        float right = share * weight_of(row[i + k].y, here, slope, float(k), per_depth);
        sum += left * row[i - k].x + right * row[i + k].x;
        weights += left + right;
    }
    return vec2(sum / weights, here);
}

void main()
{
    ivec2 size = ivec2(view.work_width, view.work_height);
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * (ivec2(1) + DOWN * (ROW - 1));
    if (any(greaterThanEqual(first, size))) return;
    vec2 row[ROW + 2 * REACH];
    for (int i = 0; i < ROW + 2 * REACH; i++)
        row[i] = texelFetch(source, clamp(first + DOWN * (i - REACH), ivec2(0), size - 1), 0).rg;
    for (int i = 0; i < ROW; i++) {
        ivec2 at = first + DOWN * i;
        if (all(lessThan(at, size))) store(at, mean_around(row, i + REACH));
    }
}
