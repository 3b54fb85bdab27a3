// The light that a texel receives. Include frame/frame.glsl first.
#ifndef AG_RADIOSITY_RECEIVE_GLSL
#define AG_RADIOSITY_RECEIVE_GLSL

#include "techniques/radiosity/radiosity_texels.glsl"

layout(set = 0, binding = RADIOSITY_LIGHT_BINDING,
       rg32ui) uniform writeonly uimage2D radiosity_light; // [colour][texel]

// Of clusters: irradiance, and the vector irradiance along the tangents.
struct radiosity_received {
    vec3 irradiance, by_u, by_v;
};

// And the sky, and emissive surfaces.
void radiosity_store_light(uint texel, uint texels, radiosity_received sum, float emitters)
{
    // The tangents of basis_of (core/vec.h).
    vec3 n = radiosity_texel_part(texel, texels, RADIOSITY_NORMAL).xyz;
    float side = n.z < 0.0 || (n.z == 0.0 && floatBitsToUint(n.z) != 0u) ? -1.0 : 1.0;
    float a = -1.0 / (side + n.z), b = n.x * n.y * a;
    vec3 u = vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x);
    vec3 v = vec3(b, side + n.y * n.y * a, -n.y);
    for (int c = 0; c < 3; c++) {
        vec4 light =
            vec4(sum.irradiance[c], sum.irradiance[c] * n + sum.by_u[c] * u + sum.by_v[c] * v) +
            radiosity_unbounced(texel, texels, c, frame.sky, emitters);
        imageStore(radiosity_light, radiosity_at(c * texels + texel),
                   uvec4(radiosity_pack_light(light), 0u, 0u));
    }
}

#endif
