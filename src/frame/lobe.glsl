// The specular lobe of GGX: its mean direction and its width, for light that is averaged over it.
//
// At normal incidence half of the half-vectors have tan θ < α, as the distribution D cos θ dω has
// the CDF t²/(t² + α²) in t = tan θ. Reflection doubles the angle, so half of the reflected light
// comes from within
//     2 atan α (1)
// of the mirror direction. A uniform cone of this half-angle, 1/(π (2α)²) per sr, also has the peak
// of the lobe, D(0)/4 = 1/(4πα²) per sr, for small α. Its standard deviation is half of that.
//
// From a roughness of 0.8 on, the lobe has the width of a cosine-weighted hemisphere, by the length
// of its mean direction, and is centred near the normal: its radiance is E/π. Between
// LOBE_ROUGH_FROM and there lookups blend both.
#ifndef AG_FRAME_LOBE_GLSL
#define AG_FRAME_LOBE_GLSL

const float LOBE_ROUGH_FROM = 0.6, LOBE_ROUGH = 0.8; // roughness

// Share of E/π in the radiance of a lobe.
float lobe_roughness(float roughness)
{
    return smoothstep(LOBE_ROUGH_FROM, LOBE_ROUGH, roughness);
}

// Share of E/π beside a uniform cone of (1) along the mirror direction. The cone has half of the
// lobe's light; the rest reaches far beyond it and leans to the normal. With this share the length
// of the mean direction is that of the lobe: 0.11, 0.23, 0.37, 0.52, 0.74, 0.97 at a roughness of
// 0.3 … 0.8, at normal incidence up to 0.05 more, for angles of view up to 75°.
float lobe_tail(float alpha)
{
    return min(1.5 * alpha, 1.0);
}

// Tangent of the half-angle of the cone, at most `widest`.
float lobe_tan_half_angle(float alpha, float widest)
{
    return alpha < 1.0 ? min(2.0 * alpha / (1.0 - alpha * alpha), widest) : widest; // (1)
}

// Standard deviation of the cone, for each of two axes, rad.
float lobe_deviation(float alpha)
{
    return atan(alpha);
}

// How far the mean direction of the lobe leans, over the mirror direction's. A fit within 0.04 from
// n·v = 0.25 on.
float lobe_lean(float alpha)
{
    return (1.0 - alpha) / (1.0 + 1.2 * alpha * alpha);
}

// Mean direction of the lobe, of any length but 0.
vec3 lobe_mean(vec3 n, vec3 to_viewer, float alpha)
{
    vec3 upwards = dot(to_viewer, n) * n;
    return upwards + (upwards - to_viewer) * lobe_lean(alpha) + 1e-4 * n;
}

#endif
