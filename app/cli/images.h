// Images to compare: read from files, checked for NaN.
#pragma once

#include "session.h"

// Reads a layer of an EXR (NULL: color) or a PNG. All failures are FAILED.
enum status image_load(struct session *session, const char *path, const char *layer,
                       struct ag_image **out);
// Luminance of linear Rec. 709.
double image_luminance(const float rgb[3]);
// Automatic EV of the surfaces in a radiance image: pixels with a depth above 0.
enum ag_result image_exposure(const struct session *session, const struct ag_image *radiance,
                              const struct ag_image *depth, float *ev);
// Counts NaN and infinite pixels where the mask (one channel, or NULL) is above 0. They are an
// error, with --ignore-nan a note. `name` describes the image in the message.
enum status image_check(const struct session *session, const struct ag_image *image,
                        const struct ag_image *mask, const char *name);
