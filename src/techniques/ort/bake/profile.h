// Profiles of subsurface scattering: the share of the light that enters a plane at a point and
// leaves it at a distance r, by the dipole of Jensen, Marschner, Levoy & Hanrahan 2001, "A
// Practical Model for Subsurface Light Transport", or an exponential fall-off. Both are divided by
// their integral over the plane, the diffuse reflectance: the colour of a surface is that of its
// texture.
#pragma once

#include "techniques/ort/ort_options.h"

// The profile of one colour. Lengths are in mm.
struct ort_profile {
    bool exponential;
    double falloff; // mean distance along a ray of the plane, of the exponential
    double attenuation, alpha, real, virtual; // σ_tr, α′, depths of the sources, of the dipole
    double total;                             // integral over the plane
};

struct ort_profile ort_profile_of(const struct ort_options *options, int colour);
// 1/mm².
double ort_profile_at(const struct ort_profile *profile, double r);
// Share of the light beyond a distance.
double ort_profile_beyond(const struct ort_profile *profile, double r);
// The distance beyond which this share of the light leaves.
double ort_profile_reach(const struct ort_profile *profile, double share);
