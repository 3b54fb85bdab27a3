// c, the radiosity of the faces of clutter: of direct light, and of the irradiance E of the bounce
// before. Reads E of this bounce by walls from r, where couple.comp wrote it, adds that by other
// faces, and replaces r by c. One workgroup per opening that is clutter, one invocation per face.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/mrt/runtime/level.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(constant_id = MRT_CONSTANT_QUADS_R) const uint QUADS_R = 8;

layout(set = 0, binding = 2, scalar) readonly buffer mrt_clutter_openings
{
    uint opening_of[];
};
layout(set = 0, binding = 3, scalar) readonly buffer mrt_clutter_direct
{
    float c_direct[]; // [clutter][colour][slot]
};
layout(set = 0, binding = 4, scalar) readonly buffer mrt_clutter_albedo
{
    float albedo[]; // [clutter][colour][slot]
};
layout(set = 0, binding = 5, scalar) readonly buffer mrt_clutter_coupling
{
    float coupling[]; // [clutter][slot][slot]
};
// A group reads and writes the coefficients of its own opening only.
layout(set = 0, binding = 6, scalar) buffer mrt_clutter_incident
{
    float incident[]; // [clutter][colour][slot], of the bounce before
};
layout(set = 0, binding = 7, scalar) buffer mrt_r
{
    float r_table[]; // [opening][colour][slot]
};

shared float radiosity[3][4 * MRT_MAX_QUADS];

void main()
{
    uint clutter = gl_WorkGroupID.x, slot = gl_LocalInvocationIndex, slots = 4u * QUADS_R;
    uint first = 3u * clutter * slots, first_r = 3u * opening_of[clutter] * slots;
    bool used = slot < slots;
    for (uint c = 0u; c < 3u && used; c++) {
        uint at = first + c * slots + slot;
        float sum = c_direct[at];
        // Without feedback the last bounce, which may be of no frame, does not count.
        if (level.feedback > 0.0) sum += level.feedback * albedo[at] * incident[at];
        radiosity[c][slot] = sum;
    }
    barrier();
    for (uint c = 0u; c < 3u && used; c++) {
        float sum = r_table[first_r + c * slots + slot];
        for (uint k = 0u; k < slots; k++)
            sum += coupling[(clutter * slots + slot) * slots + k] * radiosity[c][k];
        incident[first + c * slots + slot] = sum;
        r_table[first_r + c * slots + slot] = radiosity[c][slot];
    }
}
