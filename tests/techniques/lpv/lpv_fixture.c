#include "techniques/lpv/lpv_fixture.h"

#include <stdlib.h>
#include <string.h>

struct lpv *lpv_fixture_create(struct gpu *gpu, const char *gi)
{
    const char *colon = strchr(gi, ':');
    const struct technique *technique =
        strncmp(gi, "holpv", 5) == 0 ? &technique_holpv : &technique_lpv;
    struct lpv *lpv = calloc(1, technique->state_size);
    struct lpv_options options;
    const char *plain = technique == &technique_lpv
                            ? "cascades=1,bounces=0,specular=false,steps=64"
                            : "cascades=1,bounces=0,specular=false,steps=32";
    option_defaults(&technique->options, &options);
    CHECK(option_parse(test_host(), &technique->options, "lpv", plain, &options));
    CHECK(option_parse(test_host(), &technique->options, "lpv", colon ? colon + 1 : "", &options));
    const struct technique_create how = { .host = test_host(), .gpu = gpu, .options = &options };
    CHECK(technique->check(&how));
    CHECK(technique_create(technique, lpv, &how));
    return lpv;
}

void lpv_fixture_destroy(struct lpv *lpv)
{
    technique_destroy(&technique_lpv, lpv->gpu, lpv, &lpv->options);
    free(lpv);
}

void lpv_fixture_render(struct lpv *lpv, struct rsm_fixture *rsm)
{
    struct gpu_cmd *cmd = gpu_frame_begin(rsm->gpu);
    assert_non_null(cmd);
    technique_lpv.update(lpv, cmd, &rsm->view);
    technique_lpv.record(lpv, cmd, &rsm->view);
    CHECK(gpu_frame_end(rsm->gpu, cmd));
    CHECK(gpu_wait(rsm->gpu));
}

float *lpv_fixture_read(struct lpv *lpv, gpu_image volume, int colour)
{
    return lpv_fixture_read_cascade(lpv, &lpv->cascades[0], volume, colour);
}

float *lpv_fixture_read_cascade(struct lpv *lpv, const struct lpv_cascade *cascade,
                                gpu_image volume, int colour)
{
    const size_t dim = (size_t)lpv->options.dim, slab = dim * dim * dim * 4;
    const size_t count = slab * lpv_slabs(&lpv->options);
    const size_t coefficients = (size_t)SH_COUNT(lpv->options.bands);
    float *all = malloc(count * sizeof *all);
    CHECK(gpu_image_download_float(lpv->gpu, volume, 0, 0, all, 4, count));
    const int32_t *cells = cascade->grid.cells;
    const struct lpv_params *params = &cascade->params;
    const float unit = params->fixed_from_flux * params->grid_from_fixed; // grid_from_flux
    float *out =
        malloc((size_t)cells[0] * (size_t)cells[1] * (size_t)cells[2] * coefficients * sizeof *out);
    size_t at = 0;
    for (size_t z = 0; z < (size_t)cells[2]; z++)
        for (size_t y = 0; y < (size_t)cells[1]; y++)
            for (size_t x = 0; x < (size_t)cells[0]; x++)
                for (size_t i = 0; i < coefficients; i++) {
                    const size_t number = 3 * i + (size_t)colour;
                    const size_t texel = (z * dim + y) * dim + x;
                    out[at++] = all[number / 4 * slab + 4 * texel + number % 4] / unit;
                }
    free(all);
    return out;
}

void lpv_fixture_inject_twin(struct twin *twin, const struct rsm_fixture *rsm, int colour)
{
    for (int i = 0; i < rsm->view.emitter_count; i++) {
        const struct frame_emitter *point = &rsm->view.emitters[i];
        twin_inject(twin, point->position, point->normal, (double)point->flux.raw[colour]);
    }
    const uint32_t size = rsm->view.rsm_size;
    for (int face = 0; face < rsm->view.rsm_face_count; face++)
        for (uint32_t i = 0; i < size * size; i++) {
            const struct rsm_fixture_texel *texel = &rsm->texels[(size_t)face * size * size + i];
            if (texel->depth == 0.0f) continue;
            twin_inject(twin, rsm_fixture_texel_position(rsm, face, i % size, i / size),
                        rsm_fixture_rounded_normal(texel->normal),
                        (double)rsm_fixture_texel_flux(rsm, face, i % size, i / size).raw[colour]);
        }
}
