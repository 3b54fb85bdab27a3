#include "visibility.h"

#include <math.h>

static enum ag_result read_layer(struct ag_reference *reference, const char *layer,
                                 struct ag_image **out)
{
    return out ? ag_reference_read(reference, layer, out) : AG_OK;
}

enum ag_result visibility_trace(const struct bench *bench, struct ag_scene *scene,
                                const struct visibility_desc *desc, struct ag_image **obscurance,
                                struct ag_image **ambient_occlusion, struct ag_image **depth)
{
    struct ag_reference_desc d;
    ag_reference_desc_default(&d);
    d.width = bench->width;
    d.height = bench->height;
    d.camera = *desc->camera;
    d.direct_only = true; // the light is not used
    d.bounces = 0;
    d.obscurance_radius_m = desc->radius_m;
    d.occlusion_decay_per_m = desc->decay_per_m;
    struct ag_reference *reference = NULL;
    enum ag_result result = ag_reference_create(scene, &d, &reference);
    if (result == AG_OK) result = ag_reference_render(reference, desc->spp, NULL, NULL);
    if (result == AG_OK) result = read_layer(reference, "obscurance", obscurance);
    if (result == AG_OK) result = read_layer(reference, "ambient_occlusion", ambient_occlusion);
    if (result == AG_OK) result = read_layer(reference, "depth", depth);
    ag_reference_destroy(reference);
    return result;
}

struct visibility_error visibility_compare(const struct ag_image *visibility,
                                           const struct ag_image *reference,
                                           const struct ag_image *depth)
{
    const size_t pixels = (size_t)reference->width * (size_t)reference->height;
    double absolutes = 0.0, squares = 0.0, sum = 0.0, count = 0.0;
    for (size_t i = 0; i < pixels; i++) {
        if (depth->pixels[i] <= 0.0f) continue;
        const double d = (double)visibility->pixels[i] - (double)reference->pixels[i];
        absolutes += fabs(d);
        squares += d * d;
        sum += d;
        count += 1.0;
    }
    const double n = fmax(count, 1.0);
    return (struct visibility_error){ absolutes / n, sqrt(squares / n), sum / n };
}
