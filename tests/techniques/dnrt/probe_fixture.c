#include "techniques/dnrt/probe_fixture.h"

#include <math.h>
#include <stdlib.h>

static float lookup(const float *image, int width, int height, const float at[3], int channel)
{
    float sum = 0;
    for (int k = 0; k < 8; k++) {
        float weight = 1;
        int p[3];
        for (int i = 0; i < 3; i++) {
            const float low = floorf(at[i]);
            p[i] = (int)low + (k >> i & 1);
            weight *= k >> i & 1 ? at[i] - low : 1 - (at[i] - low);
        }
        if (weight > 0)
            sum +=
                weight * image[4 * (((size_t)p[2] * (size_t)height + (size_t)p[1]) * (size_t)width +
                                    (size_t)p[0]) +
                               (size_t)channel];
    }
    return sum;
}

void probe_fixture_at(struct baked_fixture *run, struct frame_fixture *s, vec3s point,
                      float c[3][9])
{
    struct probe_volume probes;
    CHECK(gi_probes(run->gi, &probes));
    const struct gpu_image_desc *desc = gpu_image_info(s->gpu, probes.image);
    const size_t floats = 4 * (size_t)desc->width * desc->height * desc->depth;
    float *image = malloc(floats * sizeof *image);
    CHECK(gpu_image_download_float(s->gpu, probes.image, 0, 0, image, 4, floats));
    const int count[] = { probes.grid.count_x, probes.grid.count_y, probes.grid.count_z };
    for (int value = 0; value < 27; value++) {
        float at[3];
        for (int i = 0; i < 3; i++)
            at[i] =
                fminf(fmaxf((point.raw[i] - probes.grid.first_m.raw[i]) / probes.grid.spacing_m, 0),
                      (float)(count[i] - 1));
        at[2] += (float)(value / 4 * probes.grid.slab);
        c[value % 3][value / 3] =
            lookup(image, (int)desc->width, (int)desc->height, at, value % 4) /
            frame_radiance_scale(s->frame);
    }
    free(image);
}
