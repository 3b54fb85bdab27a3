// Front-to-back compositing of neighbouring samples. Statistically independent occluders composite
// with the over operator, (1 − α) α₂. Samples of one opaque sheet cover disjoint parts instead:
// their opacities add up, to 1 at most.
#ifndef AG_VCT_OVER_GLSL
#define AG_VCT_OVER_GLSL

// Visible part of `alpha` behind the transmittance `left`. sheet: combined opacity of both samples,
// 0…1. The fourth power separates a wall, 1, from two independent halves.
float vct_visible_alpha(float left, float alpha, float sheet)
{
    float power = sheet * sheet * sheet * sheet;
    return mix(left * min(alpha, 1.0), min(alpha, left), power);
}

// `front` over `back`, both premultiplied, of neighbouring voxels or texels.
vec4 vct_over(vec4 front, vec4 back)
{
    float visible = vct_visible_alpha(1.0 - min(front.a, 1.0), back.a, min(front.a + back.a, 1.0));
    return front + back * (back.a > 0.0 ? visible / back.a : 0.0);
}

#endif
