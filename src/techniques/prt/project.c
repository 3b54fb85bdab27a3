#include "techniques/prt/project.h"

#include "scene/environment.h"

static void project_environment(const struct frame_view *view, int bands, struct prt_light *out)
{
    float sh[3][SH_MAX_COUNT];
    environment_sh(view->environment, bands, sh);
    for (int i = 0; i < SH_COUNT(bands); i++)
        for (int c = 0; c < 3; c++)
            out->direct[i].raw[c] = sh[c][i] * view->constants->radiance_scale;
}

// The intensity of a sun is in the units of the frame.
static void add_sun(const struct frame_light *sun, int bands, struct prt_light *out)
{
    float y[SH_MAX_COUNT];
    sh_eval(bands, glms_vec3_negate(sun->direction), y);
    for (int i = 0; i < SH_COUNT(bands); i++)
        for (int c = 0; c < 3; c++) out->bounced[i].raw[c] += sun->intensity.raw[c] * y[i];
}

static void apply_window(int bands, float width, struct prt_light *out)
{
    for (int band = 0, i = 0; band < bands; band++)
        for (; i < SH_COUNT(band + 1); i++)
            for (int c = 0; c < 3; c++) {
                out->direct[i].raw[c] *= sh_window(band, width);
                out->bounced[i].raw[c] *= sh_window(band, width);
            }
}

void prt_project(const struct prt_options *options, const struct frame_view *view,
                 struct prt_light *out)
{
    const int bands = prt_bands(options);
    *out = (struct prt_light){ 0 };
    project_environment(view, bands, out);
    for (int i = 0; i < SH_COUNT(bands); i++) out->bounced[i] = out->direct[i];
    for (int i = 0; options->suns && i < view->light_count; i++)
        if (view->lights[i].type == FRAME_LIGHT_SUN) add_sun(&view->lights[i], bands, out);
    apply_window(bands, options->window, out);
}
