// Distant light as coefficients of spherical harmonics.
#pragma once

#include "frame/frame.h"

#include "techniques/prt/prt_options.h"
#include "techniques/prt/prt_shared.h"

// Projects the environment, and with `suns` those: their illuminance times Y_i(to_light).
void prt_project(const struct prt_options *options, const struct frame_view *view,
                 struct prt_light *out);
