// Scattered light by points on all surfaces, none of it of ort's texels and transfer maps.
#pragma once

#include <afterglow/afterglow.h>

struct scattering_reference;

struct scattering_desc {
    const char *scene; // file or built-in
    const char *gi;    // "ort:material=…,mm_per_unit=…"
    int points;        // on all surfaces, about
};
// False: the scene or the GI spec is refused, which is logged, or there is no memory.
bool scattering_reference_open(const struct scattering_desc *desc,
                               struct scattering_reference **out);
void scattering_reference_close(struct scattering_reference *reference); // accepts NULL
// Traces the light of the points: their irradiance along the surface's normal, with shadows.
void scattering_reference_light(struct scattering_reference *reference,
                                const struct ag_light_desc *light);
// Irradiance of the light that leaves at each position: 3 channels, lux; 0 where there is none.
void scattering_reference_gather(const struct scattering_reference *reference,
                                 const struct ag_image *positions, struct ag_image *out);
