// Runs every function of sh.glsl, one invocation per direction; test_twins.c compares them with C.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "core/sh.glsl"

layout(local_size_x = 64) in;

struct twin {
    float basis[9], lobe[9];
    float value, irradiance;
    vec3 value_rgb, irradiance_rgb;
    vec4 basis4, lobe4;
    float value4, irradiance4;
};

layout(scalar, binding = 0) readonly buffer Directions
{
    vec3 directions[];
};
layout(scalar, binding = 1) readonly buffer Coefficients
{
    float coefficients[9];
};
layout(scalar, binding = 2) writeonly buffer Twins
{
    twin twins[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= directions.length()) return;
    vec3 d = directions[i];
    float c[9], e[9];
    vec3 c_rgb[9], e_rgb[9];
    for (int k = 0; k < 9; k++) {
        c[k] = coefficients[k];
        c_rgb[k] = coefficients[k] * vec3(1.0, 2.0, -3.0);
    }
    sh9_irradiance(c, e);
    sh9_irradiance(c_rgb, e_rgb);
    vec4 c4 = vec4(c[0], c[1], c[2], c[3]);

    twin t;
    sh9_eval(d, t.basis);
    sh9_clamped_cosine(d, t.lobe);
    t.value = sh9_dot(c, d);
    t.irradiance = sh9_dot(e, d);
    t.value_rgb = sh9_dot(c_rgb, d);
    t.irradiance_rgb = sh9_dot(e_rgb, d);
    t.basis4 = sh4_eval(d);
    t.lobe4 = sh4_clamped_cosine(d);
    t.value4 = sh4_dot(c4, d);
    t.irradiance4 = sh4_dot(sh4_irradiance(c4), d);
    twins[i] = t;
}
