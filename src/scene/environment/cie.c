#include "scene/environment/cie.h"

#include <math.h>

// A Gaussian with different widths below and above its centre.
static float lobe(float wavelength_nm, float centre_nm, float below_nm, float above_nm)
{
    const float distance = wavelength_nm - centre_nm;
    const float t = distance / (distance < 0.0f ? below_nm : above_nm);
    return expf(-0.5f * t * t);
}

vec3s cie_match(float nm)
{
    return vec3_of(
        1.056f * lobe(nm, 599.8f, 37.9f, 31.0f) + 0.362f * lobe(nm, 442.0f, 16.0f, 26.7f) -
            0.065f * lobe(nm, 501.1f, 20.4f, 26.2f),
        0.821f * lobe(nm, 568.8f, 46.9f, 40.5f) + 0.286f * lobe(nm, 530.9f, 16.3f, 31.1f),
        1.217f * lobe(nm, 437.0f, 11.8f, 36.0f) + 0.681f * lobe(nm, 459.0f, 26.0f, 13.8f));
}

vec3s cie_rec709_from_xyz(vec3s xyz)
{
    // Rows of the inverse of Rec. 709's primaries with D65 (ITU-R BT.709-6, item 1.3); green closes
    // the sum of luminance().
    const float y = fmaxf(xyz.y, 0.0f);
    const float r = 3.2404542f * xyz.x - 1.5371385f * y - 0.4985314f * xyz.z;
    const float b = 0.0556434f * xyz.x - 0.2040259f * y + 1.0572252f * xyz.z;
    const vec3s rgb = vec3_of(r, (y - 0.2126f * r - 0.0722f * b) / 0.7152f, b);
    const float least = glms_vec3_min(rgb);
    if (least >= 0.0f) return rgb;
    const vec3s white = vec3_of(y, y, y);
    return glms_vec3_maxv(glms_vec3_lerp(white, rgb, y / (y - least)), glms_vec3_zero());
}
