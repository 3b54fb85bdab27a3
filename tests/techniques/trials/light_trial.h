// Physical trials of indirect light: small scenes made by code, and their irradiance by a technique
// or by the reference with the same lights.
#pragma once

#include "frame/frame_fixture.h"

// A small dictionary of mrt or drt: texels along an edge of a wall, modes of bases and responses.
#define TRIAL_DICTIONARY(texels, prior, modes) ":" TRIAL_DICTIONARY_OPTIONS(texels, prior, modes)
#define TRIAL_DICTIONARY_OPTIONS(texels, prior, modes)                                             \
    "texels=" #texels ",rays=256,prior_modes=" #prior ",modes=" #modes                             \
    ",lightfield_positions=4,lightfield_directions=6,lightfield_modes=16,response_modes=" #modes   \
    ",block_probes=2"

// Irradiance over the pixels of the camera's image, scene's own unit (lux).
struct trial_irradiance {
    double mean[3], least, most; // least and most: of all channels
};

// All three open the fixture, which must not be open, and leave it to be finished. Pixels without a
// surface do not count.
struct trial_irradiance trial_technique(struct frame_fixture *s, const char *gi);
// All pixels of the technique's image, RGB. The caller frees them.
float *trial_pixels(struct frame_fixture *s, const char *gi);
// Light of the same kinds as the technique's: without direct light of punctual lights, with that of
// specular lobes in bounces. All bounces, or `bounces` of them; −1: all.
struct trial_irradiance trial_reference(struct frame_fixture *s, int bounces, int samples);
// Images of irradiance, of the technique over that of the reference with all bounces. FLIP is that
// of display values: the reference's mean is 0.3.
struct trial_error {
    double energy, flip;
};
typedef void (*trial_build)(struct frame_fixture *s, struct gpu *gpu);
struct trial_error trial_error_of(struct gpu *gpu, trial_build build, const char *gi, int samples);
// Irradiance (green) over that of the reference with `bounces`: of squares of `size` pixels, whose
// mean has less noise and is at least a tenth of the image's, and of the image. All pixels see a
// surface.
struct trial_squares {
    double least, most, mean;
};
struct trial_squares trial_squares_of(struct gpu *gpu, trial_build build, const char *gi,
                                      int bounces, int samples, int size);
// Bounds of the energy of a technique over that of the reference with all bounces.
struct trial_bounds {
    const char *gi;
    double least, most;
};
// Checks both views of a scene.
void trial_check_energy(struct gpu *gpu,
                        void (*build)(struct frame_fixture *s, struct gpu *gpu, bool view),
                        int samples, const struct trial_bounds *bounds, size_t count);
// Renders an open fixture: the pixels of this instance and later ones.
struct trial_irradiance trial_object_irradiance(struct frame_fixture *s, int first);
// Root mean square of the relative differences of pixels from the mean of the square around them,
// of an image of size × size pixels (RGB, of which green counts), but for `reach` along its edges.
double trial_mottle(const float *image, int size, int reach);
// A movable box in a furnace of albedo 0.5 gets the irradiance of the walls, within 1 %.
void trial_object_in_furnace(struct gpu *gpu, const char *gi);
