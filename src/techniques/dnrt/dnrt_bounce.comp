// The light at each object with its changes by the others: the function q of equation 18 (Giuffrida
// 2016, section 9.1) for light between objects. Object A changes the irradiance of a receiver at
// the centre of B by V if the receiver faces it, else by V (n·n_o)₊. The coefficients of this are
// V Y_j(n_o) times the bands' factors of the clamped cosine. A workgroup has an object B, its
// invocations the others.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "techniques/dnrt/dnrt_shared.h"

#include "techniques/dnrt/dnrt_object.glsl"
#include "techniques/dnrt/dnrt_receiver.glsl"

layout(local_size_x = DNRT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    dnrt_bounce_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer dnrt_objects
{
    dnrt_gpu_object object_table[];
};
layout(set = 0, binding = 1, scalar) buffer dnrt_light
{
    vec3 light_table[]; // [part][object][coefficient]; part 0: of the probes
};
layout(set = 0, binding = 2, scalar) readonly buffer dnrt_shapes
{
    dnrt_gpu_shape shape_table[];
};
layout(set = 0, binding = 3, scalar) readonly buffer dnrt_samples
{
    uint word_table[];
};

#include "techniques/dnrt/dnrt_samples.glsl"

shared vec3 change[DNRT_COEFFICIENTS][DNRT_LOCAL]; // by the objects of each invocation

// m_j of a volume between its samples, by colour; w: k_j, or 0.
vec4 transfer_at(uint shape_index, uint j, vec3 at)
{
    dnrt_gpu_shape shape = shape_table[shape_index];
    uint n = push.size, words = samples_words(n * n * n);
    uvec3 low = min(uvec3(at), uvec3(n - 2u));
    vec3 part = at - vec3(low);
    vec4 sum = vec4(0.0);
    for (uint k = 0; k < 8; k++) {
        uvec3 corner = uvec3(k, k >> 1, k >> 2) & 1u, p = low + corner;
        vec3 weight = mix(1.0 - part, part, vec3(corner));
        uint index = (p.z * n + p.y) * n + p.x;
        for (uint c = 0; c < PLANES; c++)
            sum[c] += shape.scale[PLANES * j + c] * weight.x * weight.y * weight.z *
                      sample_of(shape.first_word + (PLANES * j + c) * words, index);
    }
    return sum;
}

// The change of irradiance of a receiver, times π: Σ π c_j m_j is one, and dnrt_light has π c_j.
vec3 change_at(uint index, dnrt_gpu_object object, vec3 position, vec3 n)
{
    dnrt_receiver at = dnrt_receiver_of(object, position, n);
    dnrt_place place = dnrt_place_of(object, at, push.size, push.fade);
    vec3 above = dnrt_above_horizon(object, at, object.half_m / push.reach);
    float cosine = max(-dot(at.position, at.normal) / max(length(at.position), 1e-12), 0.0);
    vec3 sum = vec3(0.0);
    if (place.reach == 0.0) return sum;
    for (uint i = 0; i < NORMALS; i++) {
        float weight = place.reach * (NORMALS == 1u ? cosine : dnrt_weight(at, above, i));
        if (weight == 0.0) continue;
        for (uint j = 0; j < COEFFICIENTS; j++) {
            vec4 m = transfer_at(NORMALS * uint(object.shape) + i, j, place.at);
            if (object.part > 0.0)
                m = mix(m, transfer_at(NORMALS * uint(object.next) + i, j, place.at), object.part);
            uint entry = index * DNRT_COEFFICIENTS + j;
            vec3 punctual = PLANES == 4u ? light_table[push.punctual + entry] : vec3(0.0);
            sum += weight * ((light_table[push.from + entry] + punctual) * m.rgb + punctual * m.w);
        }
    }
    return SH_COSINE_0 * sum;
}

void add_change(uint index, dnrt_gpu_object to, inout vec3 sum[9])
{
    dnrt_gpu_object object = object_table[index];
    float basis[9];
    vec3 n_o = object.centre - to.centre;
    if (dot(n_o, n_o) == 0.0) return;
    n_o = normalize(n_o);
    vec3 facing = change_at(index, object, to.centre, n_o);
    if (facing == vec3(0.0)) return;
    sh9_eval(dnrt_object_from_world(to, n_o), basis);
    for (int j = 0; j < 9; j++)
        sum[j] += (j == 0 ? SH_COSINE_0 : j < 4 ? SH_COSINE_1 : SH_COSINE_2) * basis[j] * facing;
}

void main()
{
    uint index = gl_WorkGroupID.x, local = gl_LocalInvocationIndex;
    dnrt_gpu_object object = object_table[index];
    vec3 sum[9];
    for (int j = 0; j < 9; j++) sum[j] = vec3(0.0);
    for (uint other = local; other < push.objects; other += DNRT_LOCAL)
        if (other != index) add_change(other, object, sum);
    for (int j = 0; j < 9; j++) change[j][local] = sum[j];
    barrier();
    if (local >= DNRT_COEFFICIENTS) return;
    uint coefficient = index * DNRT_COEFFICIENTS + local;
    vec3 light = light_table[coefficient];
    for (uint i = 0; i < min(push.objects, DNRT_LOCAL); i++) light += change[local][i];
    light_table[push.to + coefficient] = light;
}
