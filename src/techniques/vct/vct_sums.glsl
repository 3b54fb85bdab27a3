// What the sums of a voxel say about the sheet in it. Include after vct_grid.glsl; declare vct_list and vct_sums with
// `list` and `sums` before.
#ifndef AG_VCT_SUMS_GLSL
#define AG_VCT_SUMS_GLSL

vec3 vct_sum(uint at)
{
    return vec3(sums[at], sums[at + 1u], sums[at + 2u]);
}

vec3 vct_signed_sum(uint at)
{
    return vec3(int(sums[at]), int(sums[at + 1u]), int(sums[at + 2u]));
}

struct vct_sheet
{
    vec3 position; // world space
    vec3 normal;   // unit, of the front; 0 where the sides cannot be told apart
    vec2 opacity;  // to ways that meet the front, the back
};

vct_sheet vct_sheet_of(uint slot)
{
    uint at = slot * VCT_SUM_WORDS;
    float weight = max(float(sums[at + VCT_SUM_WEIGHT]), 1.0);
    vec2 sides = vec2(sums[at + VCT_SUM_FRONTS], sums[at + VCT_SUM_BACKS]);
    vec3 normal = vct_signed_sum(at + VCT_SUM_NORMAL);
    float length2 = dot(normal, normal);
    vec3 offset = vct_signed_sum(at + VCT_SUM_POSITION) / (weight * VCT_POSITION_ONE);
    vct_sheet sheet;
    sheet.position = vct_world_from_voxels(vec3(vct_voxel(list[slot])) + 0.5 + offset);
    sheet.normal = length2 > 0.0 ? normal * inversesqrt(length2) : vec3(0.0);
    sheet.opacity = min(sides / VCT_WEIGHT_ONE, vec2(1.0));
    return sheet;
}

#endif
