// The light at each object: irradiance of the source's probes at its centre, as coefficients over
// normals in the object's frame, times π. It is the factor of the object's volumes. Lists the
// objects whose volumes have another light.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/math.glsl"
#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "frame/probes.glsl"
#ifdef DNRT_DEPTHS
#include "frame/octahedral.glsl"
#include "techniques/common/probes/lookup.glsl"
#endif
// A struct and a block cannot share a name.
#define dnrt_changed dnrt_changed_data
#include "techniques/dnrt/dnrt_shared.h"
#undef dnrt_changed
#include "techniques/dnrt/dnrt_object.glsl"

layout(local_size_x = DNRT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    dnrt_light_push push;
};
layout(set = 0, binding = 0) uniform sampler3D probes;
layout(set = 0, binding = 1, scalar) readonly buffer dnrt_objects
{
    dnrt_gpu_object object_table[];
};
layout(set = 0, binding = 2, scalar) buffer dnrt_light
{
    vec3 light_table[]; // [object][coefficient]
};
layout(set = 0, binding = 3, scalar) buffer dnrt_changed
{
    dnrt_changed_data changed;
};
#ifdef DNRT_DEPTHS
layout(set = 0, binding = 4) uniform sampler2D probe_depths; // no light passes through walls
#endif

// A quadratic form n·Q n without trace has the five coefficients of band 2.
mat3 form_of(float xy, float yz, float zz, float xz, float xx_yy)
{
    mat3 q;
    q[0] = vec3(SH_Y2_XX_YY * xx_yy - SH_Y2_ZZ * zz, 0.5 * SH_Y2_XY * xy, 0.5 * SH_Y2_XY * xz);
    q[1] = vec3(q[0][1], -SH_Y2_XX_YY * xx_yy - SH_Y2_ZZ * zz, 0.5 * SH_Y2_XY * yz);
    q[2] = vec3(q[0][2], q[1][2], 2.0 * SH_Y2_ZZ * zz);
    return q;
}

// Coefficients of the function in a frame whose axes are the columns of `axes`.
void rotate(mat3 axes, inout vec3 c[9])
{
    for (int colour = 0; colour < 3; colour++) {
        vec3 along = transpose(axes) * vec3(c[3][colour], c[1][colour], c[2][colour]);
        mat3 q = form_of(c[4][colour], c[5][colour], c[6][colour], c[7][colour], c[8][colour]);
        q = transpose(axes) * q * axes;
        c[1][colour] = along.y;
        c[2][colour] = along.z;
        c[3][colour] = along.x;
        c[4][colour] = 2.0 * q[0][1] / SH_Y2_XY;
        c[5][colour] = 2.0 * q[1][2] / SH_Y2_XY;
        c[6][colour] = 0.5 * q[2][2] / SH_Y2_ZZ;
        c[7][colour] = 2.0 * q[0][2] / SH_Y2_XY;
        c[8][colour] = 0.5 * (q[0][0] - q[1][1]) / SH_Y2_XX_YY;
    }
}

#ifdef DNRT_DEPTHS
void light_at(vec3 position, out vec3 c[9])
{
    probes_visible_coefficients(probes, probe_depths, push.grid, position, c);
}
#else
void light_at(vec3 position, out vec3 c[9])
{
    vec3 last = vec3(push.grid.count_x, push.grid.count_y, push.grid.count_z) - 1.0;
    vec3 at = clamp((position - push.grid.first_m) / push.grid.spacing_m, vec3(0.0), last);
    for (int s = 0; s < FRAME_PROBE_SLABS; s++) {
        vec3 texel = at + vec3(0.5, 0.5, 0.5 + float(s * push.grid.slab));
        vec4 values = textureLod(probes, texel / vec3(textureSize(probes, 0)), 0.0);
        for (int k = 0; k < 4; k++)
            if (4 * s + k < 27) c[(4 * s + k) / 3][(4 * s + k) % 3] = values[k];
    }
}
#endif

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.objects) return;
    dnrt_gpu_object object = object_table[index];
    vec3 c[9];
    light_at(object.centre, c);
    for (int j = 0; j < 9; j++) c[j] *= PI;
    rotate(mat3(dnrt_world_from_object(object, vec3(1.0, 0.0, 0.0)),
                dnrt_world_from_object(object, vec3(0.0, 1.0, 0.0)),
                dnrt_world_from_object(object, vec3(0.0, 0.0, 1.0))),
           c);
    bool differs = push.all != 0u || changed.shape[index] != object.shape ||
                   changed.part[index] != object.part;
    for (int j = 0; j < DNRT_COEFFICIENTS; j++) {
        uint to = index * DNRT_COEFFICIENTS + j;
        differs = differs || light_table[to] != c[j];
        light_table[to] = c[j];
    }
    changed.shape[index] = object.shape;
    changed.part[index] = object.part;
    if (differs) changed.list[atomicAdd(changed.groups_y, push.normals) / push.normals] = index;
}
