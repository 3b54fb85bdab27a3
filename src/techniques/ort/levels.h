// Prefiltered first-order light: an offset stands for its Voronoi region, so the gather reads light
// that is averaged over about as many texels. Level 0 is the light of single texels. Level l
// convolves level l − 1 with (1, 4, 6, 4, 1)/16 along both axes, taps 3^(l − 1) texels apart
// (the à-trous scheme of Holschneider et al. 1989), and stays where texels are linked, with its
// sum.
#pragma once

#include "techniques/ort/ort_maps.h"

// There is no wider one: light would go around curved objects. FLIP of a head of 256² texels is
// .29 without levels, .27 with these, .33 with the next one.

// The level of each offset: that whose standard deviation is the nearest to half the radius of a
// disk of the region's area, by their ratio. level: [maps->count].
bool ort_find_levels(const struct ort_maps *maps, uint8_t *level);

// Linked texels to the left, the right, above and below of each place, at most 255, as four bytes.
// links: ORT_LINKS; steps: [width][height].
void ort_find_steps(const struct ort_map *map, const uint8_t *links, uint32_t *steps);
