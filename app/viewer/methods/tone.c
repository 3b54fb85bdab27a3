#include "tone.h"

#include "viewer/operations.h"

#include <stdio.h>
#include <string.h>

const char *const viewer_curves[3] = {
    [AG_TONEMAP_NEUTRAL] = "neutral",
    [AG_TONEMAP_AGX] = "agx",
    [AG_TONEMAP_LINEAR] = "linear",
};

const char *const viewer_meterings[2] = {
    [AG_METERING_MEAN] = "mean",
    [AG_METERING_HIGHLIGHTS] = "highlights",
};

static int index_of(const char *const *names, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(name, names[i]) == 0) return (int)i;
    return -1;
}

int viewer_curve_of(const char *name)
{
    return index_of(viewer_curves, sizeof viewer_curves / sizeof *viewer_curves, name);
}

int viewer_metering_of(const char *name)
{
    return index_of(viewer_meterings, sizeof viewer_meterings / sizeof *viewer_meterings, name);
}

// Options of the frame that the viewer chooses.
static bool is_chosen(const char *option)
{
    static const char *const keys[2] = { "tonemap=", "metering=" };
    return strncmp(option, keys[0], strlen(keys[0])) == 0 ||
           strncmp(option, keys[1], strlen(keys[1])) == 0;
}

// The options of the command line, with others of the display. false: they are too long.
static bool options_with(const char *given, enum ag_tonemap curve, enum ag_metering metering,
                         char *out, size_t size)
{
    size_t used = 0;
    out[0] = '\0';
    while (given && *given) {
        const size_t length = strcspn(given, ",");
        if (!is_chosen(given))
            used += (size_t)snprintf(out + used, size - used, "%.*s,", (int)length, given);
        if (used >= size) return false;
        given += length + (given[length] == ',');
    }
    return used + (size_t)snprintf(out + used, size - used, "tonemap=%s%s%s", viewer_curves[curve],
                                   metering ? ",metering=" : "",
                                   metering ? viewer_meterings[metering] : "") <
           size;
}

static bool set_display(struct viewer *v, enum ag_tonemap curve, enum ag_metering metering)
{
    char options[sizeof v->frame_options];
    if (!options_with(v->desc->frame_options, curve, metering, options, sizeof options)) {
        viewer_warn(v, "cannot change the display: the frame options are too long");
        return false;
    }
    if (!viewer_check(v, ag_renderer_set_frame_options(v->main.renderer, options)) ||
        (v->other.renderer &&
         !viewer_check(v, ag_renderer_set_frame_options(v->other.renderer, options))))
        return false;
    memcpy(v->frame_options, options, sizeof options);
    v->tonemap = curve;
    v->metering = metering;
    viewer_touch(v);
    if (v->truth) viewer_change(v); // its image is shown likewise
    return true;
}

bool viewer_set_tonemap(struct viewer *v, enum ag_tonemap curve)
{
    return curve == v->tonemap || set_display(v, curve, v->metering);
}

bool viewer_set_metering(struct viewer *v, enum ag_metering metering)
{
    return metering == v->metering || set_display(v, v->tonemap, metering);
}

const char *viewer_frame_options(const struct viewer *v)
{
    return v->frame_options[0] ? v->frame_options : v->desc->frame_options;
}
