// Denoising with Open Image Denoise, where the library was built with it.
#pragma once

#include "lightmap/lightmap.h"

bool lightmap_has_denoiser(void);
// Each chart is an image of its own: no light crosses to another one. Without Open Image Denoise a
// warning, and the map stays. False without memory, or where the denoiser fails.
bool lightmap_denoise(struct lightmap *map);
