// Numbers, vectors, sizes, lights and numbered paths from text.
#include "values.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_SIZE = 16384, SPEC_SIZE = 512, MAX_PARTS = 6 };

// strtod skips white space, which is not part of a value.
static bool begins(const char *text)
{
    return text[0] && !isspace((unsigned char)text[0]);
}

bool value_int(const char *text, long low, long high, long *out)
{
    char *end;
    errno = 0;
    long value = strtol(text, &end, 10);
    if (!begins(text) || *end || errno || value < low || value > high) return false;
    *out = value;
    return true;
}

bool value_seed(const char *text, uint64_t *out)
{
    char *end;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 0);
    if (!isdigit((unsigned char)text[0]) || *end || errno) return false;
    *out = value;
    return true;
}

bool value_number(const char *text, double *out)
{
    char *end;
    double value = strtod(text, &end);
    if (!begins(text) || *end || !isfinite(value)) return false;
    *out = value;
    return true;
}

bool value_floats(const char *text, int count, float *out)
{
    for (int i = 0; i < count; i++) {
        char *end;
        float value = strtof(text, &end);
        char after = i + 1 < count ? ',' : 0;
        if (!begins(text) || end == text || *end != after || !isfinite(value)) return false;
        out[i] = value;
        text = end + 1;
    }
    return true;
}

bool value_size(const char *text, int *width, int *height)
{
    char *end;
    if (!isdigit((unsigned char)text[0])) return false;
    errno = 0;
    long w = strtol(text, &end, 10);
    if (errno || w < 1 || w > MAX_SIZE || *end != 'x' || !isdigit((unsigned char)end[1]))
        return false;
    long h;
    if (!value_int(end + 1, 1, MAX_SIZE, &h)) return false;
    *width = (int)w;
    *height = (int)h;
    return true;
}

// ---- lights

// Splits at colons; returns the number of parts.
static int split(char *text, char *parts[MAX_PARTS])
{
    int count = 0;
    for (char *part; count < MAX_PARTS && (part = strsep(&text, ":"));) parts[count++] = part;
    return text ? MAX_PARTS + 1 : count;
}

static bool read_intensity(const char *text, float out[3], const char **why)
{
    if (!value_floats(text, 3, out)) return false;
    *why = "the intensity is negative";
    return out[0] >= 0 && out[1] >= 0 && out[2] >= 0;
}

static bool read_direction(const char *text, float out[3], const char **why)
{
    if (!value_floats(text, 3, out)) return false;
    *why = "the direction is zero";
    float length = hypotf(hypotf(out[0], out[1]), out[2]);
    if (!(length > 0.0f) || !isfinite(length)) return false;
    *why = NULL;
    return true;
}

static bool read_cone(const char *inner, const char *outer, struct ag_light_desc *out,
                      const char **why)
{
    double inner_deg, outer_deg;
    if (!value_number(inner, &inner_deg) || !value_number(outer, &outer_deg)) return false;
    *why = "the half-angles must be 0 to 90 degrees, the inner below the outer";
    if (!(inner_deg >= 0.0 && inner_deg < outer_deg && outer_deg <= 90.0)) return false;
    out->inner_rad = radians(inner_deg);
    out->outer_rad = radians(outer_deg);
    *why = NULL;
    return true;
}

static bool read_sun(char **parts, int count, struct light_value *out, const char **why)
{
    *why = "a sun is sun:dx,dy,dz:r,g,b";
    if (count != 3) return false;
    ag_light_desc_default(&out->punctual, AG_LIGHT_SUN);
    return read_direction(parts[1], out->punctual.direction, why) &&
           read_intensity(parts[2], out->punctual.intensity, why);
}

static bool read_point(char **parts, int count, struct light_value *out, const char **why)
{
    *why = "a point light is point:x,y,z:r,g,b";
    if (count != 3) return false;
    ag_light_desc_default(&out->punctual, AG_LIGHT_POINT);
    return value_floats(parts[1], 3, out->punctual.position) &&
           read_intensity(parts[2], out->punctual.intensity, why);
}

static bool read_spot(char **parts, int count, struct light_value *out, const char **why)
{
    *why = "a spot is spot:x,y,z:dx,dy,dz:innerDEG:outerDEG:r,g,b";
    if (count != 6) return false;
    ag_light_desc_default(&out->punctual, AG_LIGHT_SPOT);
    return value_floats(parts[1], 3, out->punctual.position) &&
           read_direction(parts[2], out->punctual.direction, why) &&
           read_cone(parts[3], parts[4], &out->punctual, why) &&
           read_intensity(parts[5], out->punctual.intensity, why);
}

static bool read_size(const char *text, struct ag_area_light_desc *out, const char **why)
{
    float size[2];
    if (!value_floats(text, 2, size)) return false;
    *why = "width and height must be above 0";
    if (!(size[0] > 0.0f && size[1] > 0.0f && isfinite(size[0] * size[1]))) return false;
    out->width = size[0];
    out->height = size[1];
    *why = NULL;
    return true;
}

static bool read_area(char **parts, int count, struct light_value *out, const char **why)
{
    *why = "an area light is area:x,y,z:dx,dy,dz:w,h:r,g,b";
    if (count != 5) return false;
    ag_area_light_desc_default(&out->area);
    out->is_area = true;
    return value_floats(parts[1], 3, out->area.position) &&
           read_direction(parts[2], out->area.direction, why) &&
           read_size(parts[3], &out->area, why) &&
           read_intensity(parts[4], out->area.radiance, why);
}

bool value_light(const char *text, struct light_value *out, const char **why)
{
    static const struct {
        const char *name;
        bool (*read)(char **parts, int count, struct light_value *out, const char **why);
    } kinds[] = {
        { "sun", read_sun }, { "point", read_point }, { "spot", read_spot }, { "area", read_area }
    };
    char copy[SPEC_SIZE];
    char *parts[MAX_PARTS];
    *why = "a light is sun:…, point:…, spot:… or area:…";
    if (strlen(text) >= sizeof copy) return false;
    memcpy(copy, text, strlen(text) + 1);
    int count = split(copy, parts);
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (strcmp(parts[0], kinds[i].name) != 0) continue;
        const char *form = NULL, *reason = NULL;
        *out = (struct light_value){ 0 };
        bool ok = kinds[i].read(parts, count, out, &reason);
        kinds[i].read(parts, 0, out, &form); // the expected form, for a malformed value
        *why = reason ? reason : form;
        return ok;
    }
    return false;
}

// ---- paths

bool has_extension(const char *path, const char *extension)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    return dot && dot > name && strcasecmp(dot + 1, extension) == 0;
}

// Length of "%d", "%4d" or "%04d" at `text`, else 0.
static size_t number_length(const char *text)
{
    size_t length = 1;
    if (text[0] != '%') return 0;
    while (isdigit((unsigned char)text[length]) && length < 4) length++;
    return text[length] == 'd' ? length + 1 : 0;
}

bool value_frame_path(const char *pattern, int frame, char *out, size_t size, bool *is_pattern)
{
    *is_pattern = false;
    size_t used = 0;
    while (*pattern) {
        size_t length = number_length(pattern);
        char number[64] = { pattern[0], 0 };
        if (length) {
            if (*is_pattern) return false;
            *is_pattern = true;
            bool zeros = pattern[1] == '0';
            int width = atoi(pattern + 1);
            snprintf(number, sizeof number, zeros ? "%0*d" : "%*d", width > 32 ? 32 : width, frame);
        }
        int wrote = snprintf(out + used, size - used, "%s", number);
        if (wrote < 0 || (size_t)wrote >= size - used) return false;
        used += (size_t)wrote;
        pattern += length ? length : 1;
    }
    return used > 0;
}

int value_index(const char *list, const char *word)
{
    const size_t length = strlen(word);
    for (int i = 0; list[0]; i++) {
        const size_t next = strcspn(list, " ");
        if (next == length && memcmp(list, word, length) == 0) return i;
        list += next + (list[next] == ' ');
    }
    return -1;
}
