// Sums along an axis of linked texels, see levels.h.
#ifndef AG_ORT_STEPS_GLSL
#define AG_ORT_STEPS_GLSL

// Linked texels to one side (x: to the left or above) and to the other, of ort_steps.
uvec2 ort_steps_along(uint steps, uint axis)
{
    return uvec2(steps >> 16u * axis, steps >> (16u * axis + 8u)) & 0xffu;
}

// Weights of the taps at −2, −1, 0, 1 and 2 strides. That of a tap which is not linked goes to the
// middle: weights are symmetric, and the sum of all light stays.
void ort_tap_weights(uvec2 linked, uint stride, out float weight[5])
{
    weight = float[](linked.x >= 2u * stride ? 0.0625 : 0.0, linked.x >= stride ? 0.25 : 0.0, 0.0,
                     linked.y >= stride ? 0.25 : 0.0, linked.y >= 2u * stride ? 0.0625 : 0.0);
    weight[2] = 1.0 - weight[0] - weight[1] - weight[3] - weight[4];
}

#endif
