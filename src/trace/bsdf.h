// How a surface reflects: the frame's brdf.glsl on the CPU, with a sampler for it.
#pragma once

#include "core/vec.h"

struct bsdf {
    vec3s normal, tangent, bitangent; // an orthonormal frame
    vec3s to_eye;                     // unit
    vec3s diffuse;                    // Lambert's constant, 1/sr: albedo · (1 − metallic) / π
    vec3s f0;                         // reflectance at normal incidence
    float alpha;                      // roughness², at least 0.045²
    float gloss_share;                // probability of sampling the glossy lobe; 0: there is none
    float n_v, smith_v;               // |n·v| and the root of Smith's term for the viewer
    vec3s eye, local_eye;             // to_eye on the normal's side, in world space and in the frame
    bool turned;                      // `eye` is not to_eye: an interpolated normal turns away from the viewer
};

// normal and to_eye: unit. diffuse_only: Lambert's term alone.
struct bsdf bsdf_of(vec3s normal, vec3s to_eye, vec3s albedo, float metallic, float roughness,
                    bool diffuse_only);
// At least `share` of the samples go to Lambert's lobe, whatever the surface reflects: for those who measure irradiance.
void bsdf_sample_evenly(struct bsdf *bsdf, float share);

struct reflection {
    vec3s f;   // 1/sr, without the cosine; 0 below the horizon
    float pdf; // of bsdf_sample, 1/sr
};
struct reflection bsdf_reflect(const struct bsdf *bsdf, vec3s to_light); // to_light: unit
// A direction; choice picks the lobe, both from the unit interval and square. Below the horizon now and then: the light is
// lost there.
vec3s bsdf_sample(const struct bsdf *bsdf, float choice, vec2s u);
