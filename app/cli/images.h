// Images that commands compare: read from files, free of what is no number.
#pragma once

#include "session.h"

// A layer of an EXR (NULL: color), or a PNG. What files hold is no matter of usage: all failures
// are FAILED.
enum status image_load(struct session *session, const char *path, const char *layer,
                       struct ag_image **out);
// Of linear Rec. 709.
double image_luminance(const float rgb[3]);
// Pixels with a channel that is NaN or infinite, where the mask (one channel, or NULL) is above 0.
// They are an error unless
// --ignore-nan makes them a note; `name` is whose they are.
enum status image_check(const struct session *session, const struct ag_image *image,
                        const struct ag_image *mask, const char *name);
