// Samples of the baked volumes. Include after the buffer dnrt_samples, `uint word_table[]`.
#ifndef DNRT_SAMPLES_GLSL
#define DNRT_SAMPLES_GLSL

#include "core/half.glsl"

layout(constant_id = 2) const uint COEFFICIENTS = 4;
layout(constant_id = 3) const bool BYTES = false; // of a sample, else half floats
layout(constant_id = 4) const uint PLANES = 3;    // of a coefficient; 4: the last one is k

uint samples_words(uint count)
{
    return count / (BYTES ? 4u : 2u);
}

// Four samples of a plane from `first` on, a multiple of 4, over the plane's scale.
vec4 samples_of(uint plane_word, uint first)
{
    if (BYTES) {
        uvec4 bytes = (uvec4(word_table[plane_word + first / 4u]) >> uvec4(0, 8, 16, 24)) & 255u;
        return (vec4(bytes) - 128.0) / 127.0;
    }
    uint word = plane_word + first / 2u;
    return vec4(unpackHalf2x16(word_table[word]), unpackHalf2x16(word_table[word + 1u]));
}

float sample_of(uint plane_word, uint index)
{
    return samples_of(plane_word, index & ~3u)[index & 3u];
}

#endif
