// Adding virtual lights to the grid. Include after core/sh.glsl and lpv_grid.glsl; define LPV_SUMS_BINDING.
//
// Sums are whole numbers, so that no order of the invocations changes a bit: each coefficient has 64 bits in two words.
// The carry out of the low word is added to the high one; modulo 2^64 the total is exact whatever the order.
#ifndef AG_LPV_SUMS_GLSL
#define AG_LPV_SUMS_GLSL

// [cell][colour][coefficient][low, high]
layout(set = 0, binding = LPV_SUMS_BINDING, scalar) buffer lpv_sums
{
    uint words[];
};

const int LPV_NO_CELL = -1;
const float LPV_LARGEST = 1073741824.0; // 2^30, what lpv_scale_of promises not to exceed

void lpv_add_number(int at, float value)
{
    int whole = int(roundEven(clamp(value * lpv.fixed_from_flux, -LPV_LARGEST, LPV_LARGEST)));
    if (whole == 0) return;
    uint low = uint(whole);
    uint before = atomicAdd(words[at], low);
    uint carry;
    uaddCarry(before, low, carry);
    uint high = (whole < 0 ? 0xffffffffu : 0u) + carry;
    if (high != 0u) atomicAdd(words[at + 1], high);
}

void lpv_add_lobe(int at, vec4 lobe)
{
    for (int i = 0; i < 4; i++) lpv_add_number(at + 2 * i, lobe[i]);
}

// Coefficients × flux of what arrives in a cell; nothing for LPV_NO_CELL.
void lpv_add(int cell, vec4 red, vec4 green, vec4 blue)
{
    if (cell == LPV_NO_CELL) return;
    lpv_add_lobe(24 * cell, red);
    lpv_add_lobe(24 * cell + 8, green);
    lpv_add_lobe(24 * cell + 16, blue);
}

// Half a cell in front of its surface, so that a virtual light is on the side that it shines to.
int lpv_injection_cell(vec3 position, vec3 normal)
{
    ivec3 at = ivec3(floor(lpv_cells_from_world(position) + 0.5 * normal));
    return lpv_inside(at) ? lpv_index(at) : LPV_NO_CELL;
}

// Coefficients of 1/π (n·ω)₊: a flux of 1.
vec4 lpv_unit_lobe(vec3 normal)
{
    return sh4_clamped_cosine(normal) / SH_COSINE_0;
}

#endif
