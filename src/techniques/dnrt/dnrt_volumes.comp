// The volume of each object whose light has changed: π Σ c_j m_j, the change of irradiance of a
// receiver that faces the object's centre (Giuffrida 2016, equation 16). Light d_j of punctual
// lights is reflected, but not occluded: π Σ d_j t_j, with t = m + k. One lookup per pixel is then
// enough, whatever the number of coefficients. An invocation has four neighbouring samples.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame_shared.h"
// A struct and a block cannot share a name.
#define dnrt_changed dnrt_changed_data
#include "techniques/dnrt/dnrt_shared.h"
#undef dnrt_changed
#include "techniques/dnrt/dnrt_object.glsl"

layout(local_size_x = DNRT_LOCAL) in;
layout(constant_id = 1) const uint NORMALS = 1; // of receivers: volumes of an object

layout(push_constant, scalar) uniform push_block
{
    dnrt_volumes_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer dnrt_objects
{
    dnrt_gpu_object object_table[];
};
layout(set = 0, binding = 1, scalar) readonly buffer dnrt_light
{
    vec3 light_table[];
};
layout(set = 0, binding = 2, scalar) readonly buffer dnrt_shapes
{
    dnrt_gpu_shape shape_table[];
};
layout(set = 0, binding = 3, scalar) readonly buffer dnrt_samples
{
    uint word_table[];
};
layout(set = 0, binding = 4, rgba16f) uniform writeonly image3D volumes;
layout(set = 0, binding = 5, scalar) readonly buffer dnrt_changed
{
    dnrt_changed_data changed;
};

#include "techniques/dnrt/dnrt_samples.glsl"

// Σ π (c_j m_j + d_j t_j) of four samples in each colour.
mat3x4 product(uint shape_index, uint light_index, uint punctual_index, uint first, uint count)
{
    dnrt_gpu_shape shape = shape_table[shape_index];
    uint words = samples_words(count);
    mat3x4 sum = mat3x4(0.0);
    for (uint j = 0; j < COEFFICIENTS; j++) {
        vec3 light = light_table[light_index + j], punctual = vec3(0.0);
        vec4 hidden = vec4(0.0);
        if (PLANES == 4u) {
            uint plane = PLANES * j + 3u;
            punctual = light_table[punctual_index + j];
            hidden = shape.scale[plane] * samples_of(shape.first_word + plane * words, first);
        }
        for (uint c = 0; c < 3; c++) {
            uint plane = PLANES * j + c;
            sum[c] += ((light[c] + punctual[c]) * shape.scale[plane]) *
                          samples_of(shape.first_word + plane * words, first) +
                      punctual[c] * hidden;
        }
    }
    return sum;
}

void main()
{
    uint first = 4u * gl_GlobalInvocationID.x, n = push.size, count = n * n * n;
    uint row = gl_GlobalInvocationID.y, normal = row % NORMALS;
    uint index = changed.list[row / NORMALS];
    dnrt_gpu_object object = object_table[index];
    if (first >= count || object.shape < 0) return;
    uint light = push.first + index * DNRT_COEFFICIENTS;
    uint punctual = push.punctual + index * DNRT_COEFFICIENTS;
    mat3x4 sum = product(NORMALS * uint(object.shape) + normal, light, punctual, first, count);
    if (object.part > 0.0) {
        mat3x4 next = product(NORMALS * uint(object.next) + normal, light, punctual, first, count);
        sum = (1.0 - object.part) * sum + object.part * next;
    }
    ivec3 to =
        ivec3(dnrt_slot(object)) + ivec3(normal * n + first % n, first / n % n, first / (n * n));
    for (int i = 0; i < 4; i++) {
        vec3 change = vec3(sum[0][i], sum[1][i], sum[2][i]);
        imageStore(volumes, to + ivec3(i, 0, 0),
                   vec4(clamp(change, vec3(-HALF_MAX), vec3(HALF_MAX)), 0.0));
    }
}
