// tonemap.glsl compiled as C++, with the GLSL types and functions that it uses, so that a test can
// compare the twins without a GPU.
#include <algorithm>
#include <cmath>

namespace {

struct vec3 {
    float r, g, b;
    explicit vec3(float v) : r(v), g(v), b(v)
    {
    }
    vec3(float r_, float g_, float b_) : r(r_), g(g_), b(b_)
    {
    }
    void operator-=(float v)
    {
        r -= v, g -= v, b -= v;
    }
    void operator*=(float v)
    {
        r *= v, g *= v, b *= v;
    }
};

struct bvec3 {
    bool r, g, b;
};

using std::exp2;
using std::max;
using std::min;

vec3 min(vec3 a, vec3 b)
{
    return vec3(min(a.r, b.r), min(a.g, b.g), min(a.b, b.b));
}

bvec3 greaterThan(vec3 a, vec3 b)
{
    return { a.r > b.r, a.g > b.g, a.b > b.b };
}

vec3 mix(vec3 a, vec3 b, bvec3 take_b)
{
    return vec3(take_b.r ? b.r : a.r, take_b.g ? b.g : a.g, take_b.b ? b.b : a.b);
}

vec3 mix(vec3 a, vec3 b, float t)
{
    return vec3(a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b));
}

#include "image/tonemap.glsl"

} // namespace

extern "C" float glsl_exposure_scale(float ev)
{
    return exposure_scale(ev);
}

extern "C" void glsl_tonemap_pbr_neutral(const float exposed[3], float out[3])
{
    vec3 display = tonemap_pbr_neutral(vec3(exposed[0], exposed[1], exposed[2]));
    out[0] = display.r, out[1] = display.g, out[2] = display.b;
}
