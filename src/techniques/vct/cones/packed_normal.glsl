// Normals of a history's surfaces: in one float, and how alike two are. Include
// frame/octahedral.glsl first.
#ifndef AG_VCT_PACKED_NORMAL_GLSL
#define AG_VCT_PACKED_NORMAL_GLSL

const float NORMAL_STEPS = 4096.0;
const float HISTORY_LEAST_COSINE = 0.9; // of two normals of one surface: 26 degrees

// Octahedral, two times 12 bits as an integer that a float represents exactly.
float packed_normal(vec3 n)
{
    vec2 whole = round(clamp(octahedral_encode(n) * 0.5 + 0.5, 0.0, 1.0) * (NORMAL_STEPS - 1.0));
    return whole.x + NORMAL_STEPS * whole.y;
}

vec3 unpacked_normal(float bits)
{
    float y = floor(bits / NORMAL_STEPS);
    return octahedral_decode(vec2(bits - NORMAL_STEPS * y, y) / (NORMAL_STEPS - 1.0) * 2.0 - 1.0);
}

float normal_similarity(vec3 a, vec3 b)
{
    return clamp((dot(a, b) - HISTORY_LEAST_COSINE) / (1.0 - HISTORY_LEAST_COSINE), 0.0, 1.0);
}

#endif
