// The directional light of a cell, and its storage. Include after core/sh.glsl and lpv_grid.glsl.
//
// A volume is one image: slabs of dim³ texels, one behind the other along z. Values 3 i + colour,
// four to a texel, are the coefficients i of red, green and blue: 3 slabs hold two bands; 7 slabs
// hold three bands and one unused value.
//
// Three bands of an intensity are a polynomial of the direction ω,
//     I(ω) = Y0 mean + Y1 Σ along_a ω_a + Σ square_a ω_a² + Yxy Σ product_a ω_b ω_c, Σ square_a =
//     0,
// which treats all axes alike: `square` combines the coefficients of 3z² − 1 and x² − y².
#ifndef AG_LPV_LIGHT_GLSL
#define AG_LPV_LIGHT_GLSL

layout(constant_id = LPV_CONSTANT_BANDS) const int LPV_BANDS = 2;
layout(constant_id = LPV_CONSTANT_HALF) const bool LPV_HALF = true; // volumes are half floats

const int LPV_SLABS = LPV_BANDS == 3 ? 7 : 3;
const int LPV_VALUES = 4 * LPV_SLABS; // of a cell

struct lpv_light { // red, green, blue; by axis x, y, z
    vec3 mean;
    vec3 along[3];
    vec3 square[3];
    vec3 product[3]; // of the other two axes
};

// From the coefficients 6 and 8 of three bands.
void lpv_set_squares(inout lpv_light light, vec3 zz, vec3 xx_yy)
{
    light.square[0] = SH_Y2_XX_YY * xx_yy - SH_Y2_ZZ * zz;
    light.square[1] = -SH_Y2_XX_YY * xx_yy - SH_Y2_ZZ * zz;
    light.square[2] = 2.0 * SH_Y2_ZZ * zz;
}

lpv_light lpv_unpack(vec4 slabs[7])
{
    lpv_light light;
    light.mean = slabs[0].xyz;
    light.along[1] = vec3(slabs[0].w, slabs[1].xy);
    light.along[2] = vec3(slabs[1].zw, slabs[2].x);
    light.along[0] = slabs[2].yzw;
    light.product[2] = slabs[3].xyz;
    light.product[0] = vec3(slabs[3].w, slabs[4].xy);
    light.product[1] = slabs[5].yzw;
    lpv_set_squares(light, vec3(slabs[4].zw, slabs[5].x), slabs[6].xyz);
    return light;
}

void lpv_fetch_slabs(sampler3D volume, ivec3 cell, out vec4 slabs[7])
{
    for (int i = 0; i < 3; i++) slabs[i] = texelFetch(volume, cell + ivec3(0, 0, i * lpv.dim), 0);
    for (int i = 3; i < 7; i++)
        slabs[i] =
            LPV_BANDS == 3 ? texelFetch(volume, cell + ivec3(0, 0, i * lpv.dim), 0) : vec4(0.0);
}

// Rounds to the nearest half float. Drivers may truncate, which loses light in every step. Below
// 2^-14 half floats are multiples of 2^-24, like floats around 3/4.
vec4 lpv_rounded(vec4 value)
{
    uvec4 bits = floatBitsToUint(value);
    precise vec4 small = (value + 0.75) - 0.75;
    vec4 nearest = uintBitsToFloat((bits + 0xfffu + ((bits >> 13) & 1u)) & ~0x1fffu);
    return mix(nearest, small, lessThan(abs(value), vec4(1.0 / 16384.0)));
}

// Macros, because not every driver accepts write-only images as function parameters.
#define lpv_store_slab(volume, cell, slab, value)                                                  \
    imageStore(volume, (cell) + ivec3(0, 0, (slab)*lpv.dim),                                       \
               LPV_HALF ? lpv_rounded(value) : (value))
#define lpv_store_slabs(volume, cell, slabs)                                                       \
    for (int slab_ = 0; slab_ < (LPV_BANDS == 3 ? 7 : 3); slab_++)                                 \
    lpv_store_slab(volume, cell, slab_, slabs[slab_])

lpv_light lpv_fetch(sampler3D volume, ivec3 cell)
{
    vec4 slabs[7];
    lpv_fetch_slabs(volume, cell, slabs);
    return lpv_unpack(slabs);
}

// Filtered lookup at `at`, in cells from the corner of a grid of `cells`. Clamped to half a cell
// inside of it, so that slabs do not mix.
void lpv_sample_slabs(sampler3D volume, vec3 at, ivec3 cells, out vec4 slabs[7])
{
    vec3 texel = clamp(at, vec3(0.5), vec3(cells) - 0.5), size = vec3(textureSize(volume, 0));
    for (int i = 0; i < 3; i++)
        slabs[i] = textureLod(volume, (texel + vec3(0, 0, i * lpv.dim)) / size, 0.0);
    for (int i = 3; i < 7; i++)
        slabs[i] = LPV_BANDS == 3
                       ? textureLod(volume, (texel + vec3(0, 0, i * lpv.dim)) / size, 0.0)
                       : vec4(0.0);
}

lpv_light lpv_sample(sampler3D volume, vec3 at)
{
    vec4 slabs[7];
    lpv_sample_slabs(volume, at, lpv_cells(), slabs);
    return lpv_unpack(slabs);
}

#endif
