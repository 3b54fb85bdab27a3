// The offset form of the rendering equation (equation 9): for a run of eight texels the sum over
// all offsets of the transfer map times the light that is an offset away. A workgroup has a column
// of runs, whose pieces follow each other in memory, bin after bin.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/light_map/table.glsl"
#include "techniques/ort/ort_shared.h"

layout(local_size_x_id = ORT_GATHER_ROWS) in;
const bool BYTES = ORT_BYTES != 0; // maps have 8 bits
// A piece may end within the rows of a workgroup, where another one begins; beyond tiles are zeros.
layout(constant_id = ORT_GATHER_SLICES) const bool SLICES = false;

layout(push_constant, scalar) uniform push_block
{
    ort_gather_push push_of_all;
};
// Images, not textures, which software drivers look up by a call.
layout(set = 0, binding = 0, rg32ui) uniform readonly uimage2D ort_lists; // first entry, entries
// struct entry of ort_lists.c.
layout(set = 0, binding = 1, rgba32ui) uniform readonly uimage2D ort_entries;
#if ORT_BYTES
layout(set = 0, binding = 2, rg32ui) uniform readonly uimage2DArray ort_bins;
#else
layout(set = 0, binding = 2, rgba32ui) uniform readonly uimage2DArray ort_bins;
#endif
layout(set = 0, binding = 3, rgba32ui) uniform readonly uimage2DArray ort_light;
layout(set = 0, binding = 4, rgba32f) uniform image2D ort_sums;

vec4 low[3] = { vec4(0.0), vec4(0.0), vec4(0.0) }, high[3] = { vec4(0.0), vec4(0.0), vec4(0.0) };

struct run {
    vec4 low, high;
};

run unpack_halves(uvec4 words)
{
    return run(vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y)),
               vec4(unpackHalf2x16(words.z), unpackHalf2x16(words.w)));
}

run unpack_bytes(uvec2 words)
{
    const uvec4 shifts = uvec4(0, 8, 16, 24);
    return run(vec4(words.xxxx >> shifts & 0xffu), vec4(words.yyyy >> shifts & 0xffu));
}

// Values of an invocation for all pieces: the copy saves loads in the loop.
struct receiver {
    uint y;
    int x, from_x_end, from_y_end;
};

void add_piece(uvec4 entry, receiver to)
{
    bool inside = !SLICES || to.y - (entry.z & 0xffffu) < entry.z >> 16;
    int map = inside ? 3 * (int(entry.x << 16) >> 16) + 3 * int(to.y) : 0;
    int column = int(entry.y & 0xfffu), level = int(entry.y >> 12 & 0xfu), bin = int(entry.y >> 16);
    ivec2 offset = ivec2(entry.w << 16, entry.w) >> 16;
    int from_x = clamp(to.x + offset.x, 0, to.from_x_end);
    int from_y = clamp(int(to.y) + offset.y, 0, to.from_y_end);
    uvec4 light[ORT_RUN / 2];
    for (int k = 0; k < ORT_RUN / 2; k++)
        light[k] = imageLoad(ort_light, ivec3(from_y, from_x + 2 * k, level));
    float factor = BYTES ? unpackHalf2x16(entry.x).y : 1.0;
    if (SLICES && !inside) factor = 0.0;
    for (int c = 0; c < 3; c++) {
        uvec4 words = imageLoad(ort_bins, ivec3(map + c, column, bin));
        run weight = BYTES ? unpack_bytes(words.xy) : unpack_halves(words);
        run sent = unpack_halves(uvec4(light[0][c], light[1][c], light[2][c], light[3][c]));
        if (BYTES || SLICES) {
            weight.low *= factor;
            weight.high *= factor;
        }
        low[c] = fma(weight.low, sent.low, low[c]);
        high[c] = fma(weight.high, sent.high, high[c]);
    }
}

void main()
{
    ort_gather_push push = push_of_all;
    uint y = gl_GlobalInvocationID.x, column = gl_WorkGroupID.y;
    receiver to = receiver(y, int(ORT_RUN * column) + ORT_MARGIN, int(push.width) + ORT_MARGIN - 1,
                           int(push.height) - 1);
    uint group = column * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uvec2 list = imageLoad(ort_lists, light_map_at(push.lists + group)).xy;
    for (uint k = list.x; k < list.x + list.y; k++)
        add_piece(imageLoad(ort_entries, light_map_at(k)), to);
    if (y >= push.height) return;
    uint at = (column * push.height + y) * 6u;
    for (int c = 0; c < 3; c++) {
        ivec2 first = light_map_at(at + 2 * c), second = light_map_at(at + 2 * c + 1);
        if (push.more != 0u) {
            low[c] += imageLoad(ort_sums, first);
            high[c] += imageLoad(ort_sums, second);
        }
        imageStore(ort_sums, first, low[c]);
        imageStore(ort_sums, second, high[c]);
    }
}
