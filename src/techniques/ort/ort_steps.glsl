// Sums along an axis of linked texels, see levels.h.
#ifndef AG_ORT_STEPS_GLSL
#define AG_ORT_STEPS_GLSL

// Linked texels to one side (x: to the left or above) and to the other, of ort_steps.
uvec2 ort_steps_along(uint steps, uint axis)
{
    return uvec2(steps >> 16u * axis, steps >> (16u * axis + 8u)) & 0xffu;
}

// Weights of the taps at −2, −1, 0, 1 and 2 strides. Taps that are not linked have none.
void ort_tap_weights(uvec2 linked, uint stride, out float weight[5])
{
    weight = float[](linked.x >= 2u * stride ? 1.0 : 0.0, linked.x >= stride ? 4.0 : 0.0, 6.0,
                     linked.y >= stride ? 4.0 : 0.0, linked.y >= 2u * stride ? 1.0 : 0.0);
    float sum = weight[0] + weight[1] + weight[2] + weight[3] + weight[4];
    for (int k = 0; k < 5; k++) weight[k] /= sum;
}

#endif
