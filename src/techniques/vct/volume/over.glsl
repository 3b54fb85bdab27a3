// How much is seen of what lies behind something else. By chance, a part that is left free shows
// the same part of what comes behind: (1 − α) α₂. Samples of one sheet lie next to each other
// instead: they add up, to all that is left.
#ifndef AG_VCT_OVER_GLSL
#define AG_VCT_OVER_GLSL

// What shows of an opacity where `left` of 1 is still free. sheet: how much of a sheet both are
// parts of, 0…1. The fourth power tells a wall, of which there is all, from two things that fill a
// half each.
float vct_visible_alpha(float left, float alpha, float sheet)
{
    float power = sheet * sheet * sheet * sheet;
    return mix(left * min(alpha, 1.0), min(alpha, left), power);
}

// `front` before `back`, both premultiplied, in neighbouring voxels or texels.
vec4 vct_over(vec4 front, vec4 back)
{
    float shown = vct_visible_alpha(1.0 - min(front.a, 1.0), back.a, min(front.a + back.a, 1.0));
    return front + back * (back.a > 0.0 ? shown / back.a : 0.0);
}

#endif
