// 16-bit floats.
#ifndef CORE_HALF_GLSL
#define CORE_HALF_GLSL

// The largest one: more becomes infinite in RGBA16F images and packed halves.
const float HALF_MAX = 65504.0;

// The nearest 16-bit float, ties to even, of |x| ≤ HALF_MAX: images and packed halves store it
// unchanged. By integers, as Vulkan lets a driver round packHalf2x16 and stores to images either
// way, and take unpackHalf2x16(packHalf2x16(x)) for x.
float half_rounded(float x)
{
    const float LEAST_NORMAL = 6.103515625e-5, STEPS = 16777216.0; // 2^-14; 2^24
    uint bits = floatBitsToUint(x);
    bits += 0x0fffu + (bits >> 13 & 1u); // half of the 13 bits that go
    return abs(x) < LEAST_NORMAL ? roundEven(x * STEPS) / STEPS : uintBitsToFloat(bits & ~0x1fffu);
}

#endif
