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

struct mat3 {
    vec3 columns[3];
    mat3(float a, float b, float c, float d, float e, float f, float g, float h, float i)
        : columns{ { a, b, c }, { d, e, f }, { g, h, i } }
    {
    }
};

using std::exp2;
using std::max;
using std::min;

// A function of each component.
template <typename F> vec3 each(vec3 a, F f)
{
    return vec3(f(a.r), f(a.g), f(a.b));
}

template <typename F> vec3 each(vec3 a, vec3 b, F f)
{
    return vec3(f(a.r, b.r), f(a.g, b.g), f(a.b, b.b));
}

vec3 operator+(vec3 a, vec3 b)
{
    return vec3(a.r + b.r, a.g + b.g, a.b + b.b);
}

vec3 operator*(vec3 a, vec3 b)
{
    return vec3(a.r * b.r, a.g * b.g, a.b * b.b);
}

vec3 operator/(vec3 a, vec3 b)
{
    return vec3(a.r / b.r, a.g / b.g, a.b / b.b);
}

vec3 operator+(vec3 a, float b)
{
    return a + vec3(b);
}

vec3 operator+(float a, vec3 b)
{
    return vec3(a) + b;
}

vec3 operator-(vec3 a, float b)
{
    return a + vec3(-b);
}

vec3 operator*(float a, vec3 b)
{
    return vec3(a) * b;
}

vec3 operator/(vec3 a, float b)
{
    return a / vec3(b);
}

vec3 operator*(const mat3 &m, vec3 v)
{
    return v.r * m.columns[0] + v.g * m.columns[1] + v.b * m.columns[2];
}

vec3 abs(vec3 a)
{
    return each(a, [](float v) { return std::fabs(v); });
}

vec3 log2(vec3 a)
{
    return each(a, [](float v) { return std::log2(v); });
}

vec3 pow(vec3 a, vec3 b)
{
    return each(a, b, [](float v, float power) { return std::pow(v, power); });
}

vec3 clamp(vec3 a, float least, float most)
{
    return each(a, [=](float v) { return min(max(v, least), most); });
}

vec3 max(vec3 a, vec3 b)
{
    return each(a, b, [](float v, float w) { return max(v, w); });
}

vec3 min(vec3 a, vec3 b)
{
    return each(a, b, [](float v, float w) { return min(v, w); });
}

bvec3 lessThan(vec3 a, vec3 b)
{
    return { a.r < b.r, a.g < b.g, a.b < b.b };
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

// Curves in the order of enum tonemap_curve.
extern "C" void glsl_tonemap(int curve, const float exposed[3], float out[3])
{
    const vec3 e(exposed[0], exposed[1], exposed[2]);
    const vec3 display = curve == 0   ? tonemap_pbr_neutral(e)
                         : curve == 1 ? tonemap_agx(e)
                                      : tonemap_linear(e);
    out[0] = display.r, out[1] = display.g, out[2] = display.b;
}
