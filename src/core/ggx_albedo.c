// Table of the directional albedo of the GGX lobe.
#include "core/ggx_albedo.h"

const uint32_t ggx_albedo_table[GGX_ALBEDO_SIZE * GGX_ALBEDO_SIZE] = {
#include "core/ggx_albedo.inc"
};

struct ggx_albedo_texel ggx_albedo_texel(int i, int j)
{
    const int right = i + 1 < GGX_ALBEDO_SIZE ? i + 1 : i;
    const uint32_t *row = ggx_albedo_table + GGX_ALBEDO_SIZE * j;
    const uint32_t *next = j + 1 < GGX_ALBEDO_SIZE ? row + GGX_ALBEDO_SIZE : row;
    return (struct ggx_albedo_texel){ { row[i], row[right], next[i], next[right] } };
}
