// The sheet of the surface that a cone starts on. Filtered to the texels of a level it reaches up
// to a texel and a half off the surface, where grazing cones would see it: a double-sided floor
// would hide the sky from itself, and a slanted one meets its own front along two of three axes.
// The plane of the surface predicts this opacity, and samples are taken without it.
//
// Along the axis nearest to the normal, a plane has an opacity of 1 in each column of texels, split
// between layers by the heights at which it crosses the column. Along the other axes its opacity
// is less by the ratio of the components of its normal: see volume/prefilter.glsl.
#ifndef AG_VCT_RECEIVER_GLSL
#define AG_VCT_RECEIVER_GLSL

struct vct_receiver {
    vec3 axis;    // nearest to the normal, a component of 1
    vec3 slope;   // normal over its component along `axis`
    float height; // of the plane along `axis` at the origin: dot(slope, any of its points)
    float spread; // range of heights that contribute to a filtered sample, texels
};

// A plane on the border of two layers of voxels may be in either, by rounding.
const float VCT_LAYER_TOLERANCE = 0.02; // texels of level 0

vct_receiver vct_receiver_at(vec3 at, vec3 normal)
{
    vec3 size = abs(normal);
    vct_receiver r;
    r.axis = size.x >= max(size.y, size.z) ? vec3(1.0, 0.0, 0.0)
             : size.y >= size.z            ? vec3(0.0, 1.0, 0.0)
                                           : vec3(0.0, 0.0, 1.0);
    r.slope = normal / dot(r.axis, normal);
    r.height = dot(r.slope, at);
    // Heights vary linearly over a texel and over the filter between texels, together with a
    // variance of slope²/4 per axis. A uniform distribution of width w has w²/12.
    r.spread = sqrt(max(3.0 * (dot(r.slope, r.slope) - 1.0), 1e-6));
    return r;
}

// Opacity of the plane along its axis in a sample.
float vct_receiver_opacity(vct_receiver r, vec3 at, int level)
{
    float texel = float(1 << level), place = dot(r.axis, at) / texel - VCT_TEXEL_CENTRE,
          layer = floor(place), between = place - layer;
    float plane = (dot(r.axis, at) - dot(r.slope, at) + r.height) / texel - layer -
                  (VCT_TEXEL_CENTRE - 0.5); // from the start of the layer
    float tolerance = VCT_LAYER_TOLERANCE / texel;
    vec3 ends = vec3(0.0, 1.0, 2.0) - plane;
    vec3 before = clamp((ends - tolerance) / r.spread + 0.5, 0.0, 1.0),
         after = clamp((ends + tolerance) / r.spread + 0.5, 0.0, 1.0);
    return mix(after.y - before.x, after.z - before.y, between);
}

// A sample without the receiver's own sheet, as if the sheet were independent of other surfaces in
// it. weights: as of vct_sample_volume.
vct_volume_sample vct_sample_others(sampler3D light, vct_receiver r, vec3 at, vec3 direction,
                                    vec3 weights, int level)
{
    float weight;
    vec3 within = vct_within_volume(at, level, weight);
    vct_volume_sample s = vct_sample_volume(light, within, direction, weights, level);
    float plane = vct_receiver_opacity(r, within, level);
    // One volume for all directions cannot separate the sheet from surfaces above it.
    vec3 own = plane * (VCT_ANISOTROPIC ? abs(r.slope) : vec3(0.0));
    vec3 others = max(s.axes - own, vec3(0.0)) / max(1.0 - own, vec3(1e-3));
    float alpha = VCT_ANISOTROPIC ? dot(abs(weights), others) : others.x;
    s.light *= s.light.a > 0.0 ? alpha / s.light.a : 0.0;
    return vct_volume_sample(weight * s.light, weight * others);
}

#endif
