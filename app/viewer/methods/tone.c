#include "tone.h"

#include "viewer/operations.h"

#include <stdio.h>
#include <string.h>

const char *const viewer_curves[3] = {
    [AG_TONEMAP_NEUTRAL] = "neutral",
    [AG_TONEMAP_AGX] = "agx",
    [AG_TONEMAP_LINEAR] = "linear",
};

int viewer_curve_of(const char *name)
{
    for (int i = 0; i < (int)(sizeof viewer_curves / sizeof *viewer_curves); i++)
        if (strcmp(name, viewer_curves[i]) == 0) return i;
    return -1;
}

// The options of the command line, with another curve. false: they are too long.
static bool options_with(const char *given, const char *curve, char *out, size_t size)
{
    static const char key[] = "tonemap=";
    size_t used = 0;
    out[0] = '\0';
    while (given && *given) {
        const size_t length = strcspn(given, ",");
        if (strncmp(given, key, sizeof key - 1) != 0)
            used += (size_t)snprintf(out + used, size - used, "%.*s,", (int)length, given);
        if (used >= size) return false;
        given += length + (given[length] == ',');
    }
    return used + (size_t)snprintf(out + used, size - used, "%s%s", key, curve) < size;
}

bool viewer_set_tonemap(struct viewer *v, enum ag_tonemap curve)
{
    char options[sizeof v->frame_options];
    if (curve == v->tonemap) return true;
    if (!options_with(v->desc->frame_options, viewer_curves[curve], options, sizeof options)) {
        viewer_warn(v, "cannot change the tone curve: the frame options are too long");
        return false;
    }
    if (!viewer_check(v, ag_renderer_set_frame_options(v->main.renderer, options)) ||
        (v->other.renderer &&
         !viewer_check(v, ag_renderer_set_frame_options(v->other.renderer, options))))
        return false;
    memcpy(v->frame_options, options, sizeof options);
    v->tonemap = curve;
    viewer_touch(v);
    if (v->truth) viewer_change(v); // its image is shown by the curve, too
    return true;
}

const char *viewer_frame_options(const struct viewer *v)
{
    return v->frame_options[0] ? v->frame_options : v->desc->frame_options;
}
