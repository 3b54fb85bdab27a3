// Light as people choose it: by a colour temperature, by elevation and azimuth.
#pragma once

// Linear Rec. 709 colour of a black body, its largest component 1: Kim et al. 2002, the cubic
// approximation of the Planckian locus, 1667 K to 25000 K. Components out of gamut are 0.
void light_black_body(float kelvin, float rgb[3]);
// Elevation and azimuth, rad, of the point from which light of this direction comes; azimuth from
// −z towards +x, as that of a clear sky.
void light_angles(const float direction[3], float *elevation, float *azimuth);
// The unit direction of the light from there.
void light_direction(float elevation, float azimuth, float direction[3]);
