// Values of options as numbers. Functions return false for malformed text, with *why (a static
// string or NULL) for the message. The program stays in the "C" locale, so the decimal separator
// is a point.
#pragma once

#include <afterglow/scene.h>

bool value_int(const char *text, long low, long high, long *out);
bool value_seed(const char *text, uint64_t *out);           // decimal or 0x…
bool value_number(const char *text, double *out);           // finite
bool value_floats(const char *text, int count, float *out); // "x,y,z", finite
// "WxH", each 1…16384.
bool value_size(const char *text, int *width, int *height);
// A light of the command line: punctual, or a rectangular emitter.
struct light_value {
    bool is_area;
    struct ag_light_desc punctual;
    struct ag_area_light_desc area;
};
// "point:x,y,z:r,g,b", "sun:dx,dy,dz:r,g,b", "spot:x,y,z:dx,dy,dz:innerDEG:outerDEG:r,g,b" or
// "area:x,y,z:dx,dy,dz:w,h:r,g,b".
bool value_light(const char *text, struct light_value *out, const char **why);
// Does the path end in ".EXTENSION", in any case?
bool has_extension(const char *path, const char *extension);
// The path of a frame for a pattern with "%d", "%4d" or "%04d"; is_pattern: it has one. False:
// more than one, or too long.
bool value_frame_path(const char *pattern, int frame, char *out, size_t size, bool *is_pattern);

static inline float radians(double degrees)
{
    return (float)(degrees * (3.14159265358979324 / 180.0));
}

static inline double degrees(float radians)
{
    return (double)radians * (180.0 / 3.14159265358979324);
}
// The position in a list "first second …"; -1: it is not in the list.
int value_index(const char *list, const char *word);
