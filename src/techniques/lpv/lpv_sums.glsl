// Adds virtual lights to the grid. Include after core/sh.glsl, lpv_grid.glsl, lpv_light.glsl and
// lpv_lookup.glsl;
// define LPV_SUMS_BINDING.
//
// Sums are integers, so that the order of invocations does not change a bit: 64 bits in two words
// per coefficient. The carry of the low word is added to the high one; modulo 2^64 the total is
// exact in any order.
#ifndef AG_LPV_SUMS_GLSL
#define AG_LPV_SUMS_GLSL

// [cell][coefficient][colour][low, high], LPV_VALUES to a cell
layout(set = 0, binding = LPV_SUMS_BINDING, scalar) buffer lpv_sums
{
    uint words[];
};

const int LPV_NO_CELL = -1;
const float LPV_LARGEST = 1073741824.0; // 2^30: bound of one addition, see lpv_scale_of

void lpv_add_value(int at, float value)
{
    int fixed_value = int(roundEven(clamp(value * lpv.fixed_from_flux, -LPV_LARGEST, LPV_LARGEST)));
    if (fixed_value == 0) return;
    uint low = uint(fixed_value);
    uint before = atomicAdd(words[at], low);
    uint carry;
    uaddCarry(before, low, carry);
    uint high = (fixed_value < 0 ? 0xffffffffu : 0u) + carry;
    if (high != 0u) atomicAdd(words[at + 1], high);
}

// Adds coefficients × flux to a cell; nothing for LPV_NO_CELL.
void lpv_add(int cell, vec3 lobe[9])
{
    if (cell == LPV_NO_CELL) return;
    int at = 2 * LPV_VALUES * cell;
    for (int i = 0; i < LPV_BANDS * LPV_BANDS; i++)
        for (int colour = 0; colour < 3; colour++)
            lpv_add_value(at + 2 * (3 * i + colour), lobe[i][colour]);
}

// Half a cell in front of the surface, so that a virtual light is on its lit side; beside a wall,
// too.
int lpv_injection_cell(vec3 position, vec3 normal)
{
    vec3 surface = lpv_cells_from_world(position), at = surface + 0.5 * normal;
    if (!lpv_inside(ivec3(floor(at)))) return LPV_NO_CELL;
    if (LPV_GEOMETRY != LPV_GEOMETRY_SCENE) return lpv_index(ivec3(floor(at)));
    return lpv_index(
        lpv_cell_on_side(lpv_lookup_at(at, surface, normal, at, lpv_cells()), lpv_cells()));
}

// Coefficients of 1/π (n·ω)₊, a flux of 1. Those of unused bands are never read.
void lpv_unit_lobe(vec3 normal, out float lobe[9])
{
    sh9_eval(normal, lobe);
    for (int i = 1; i < 9; i++) lobe[i] *= i < 4 ? lpv.injected_1 : 0.25;
}

#endif
