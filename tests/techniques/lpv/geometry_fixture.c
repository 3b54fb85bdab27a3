#include "techniques/lpv/geometry_fixture.h"

#include "core/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static size_t slabs_of(const struct lpv *lpv)
{
    return lpv->options.geometry == LPV_GEOMETRY_MAPS ? 1 : 2;
}

float *geometry_read(struct lpv *lpv)
{
    const size_t dim = (size_t)lpv->options.dim, floats = dim * dim * dim * 4 * slabs_of(lpv);
    float *all = malloc(floats * sizeof *all);
    CHECK(
        gpu_image_download_float(lpv->gpu, lpv->cascades[0].geometry.volume, 0, 0, all, 4, floats));
    const int32_t *cells = lpv->cascades[0].grid.cells;
    size_t out = 0;
    for (size_t slab = 0; slab < slabs_of(lpv); slab++)
        for (size_t z = slab * dim; z < slab * dim + (size_t)cells[2]; z++)
            for (size_t y = 0; y < (size_t)cells[1]; y++, out += 4 * (size_t)cells[0])
                memmove(all + out, all + (z * dim + y) * dim * 4,
                        4 * (size_t)cells[0] * sizeof *all);
    return all;
}

size_t geometry_floats(const struct lpv *lpv)
{
    return slabs_of(lpv) * 4 * (size_t)lpv->cascades[0].grid.cells[0] *
           (size_t)lpv->cascades[0].grid.cells[1] * (size_t)lpv->cascades[0].grid.cells[2];
}

// Texel (x, y, z) is the corner (x + 1, y + 1, z + 1) for maps, the cell (x, y, z) for the scene,
// whose second slab has the light that moves down.
static double expected_at(const struct geometry_twin *twin, const int cell[3], int slab, int i)
{
    if (twin->kind == LPV_GEOMETRY_MAPS)
        return geometry_twin_at(twin, cell[0] + 1, cell[1] + 1, cell[2] + 1)[i];
    int from[3] = { cell[0], cell[1], cell[2] };
    if (i == 3) return 0.0;
    if (slab == 0) from[i]--;
    return geometry_twin_occluded(twin, from, i, slab == 0 ? 1 : -1);
}

void geometry_check(struct lpv *lpv, const struct geometry_twin *twin, double tolerance)
{
    const int32_t *cells = lpv->cascades[0].grid.cells;
    float *got = geometry_read(lpv);
    double most = 0.0;
    size_t at = 0;
    for (int slab = 0; slab < (int)slabs_of(lpv); slab++)
        for (int k = 0; k < cells[0] * cells[1] * cells[2]; k++) {
            const int cell[3] = { k % cells[0], k / cells[0] % cells[1], k / cells[0] / cells[1] };
            for (int i = 0; i < 4; i++, at++) {
                const double expected = expected_at(twin, cell, slab, i);
                CHECK_NEAR((double)got[at], expected, tolerance);
                most = fmax(most, fabs(expected));
            }
        }
    CHECK(most > 0.3);
    free(got);
}

void geometry_scatter(struct rsm_fixture *rsm, struct gpu *gpu)
{
    struct rng rng = rng_for(7, 0, 0);
    rsm_fixture_init(rsm, gpu, GEOMETRY_WIDTH, GEOMETRY_HEIGHT, GEOMETRY_SIZE, 2);
    rsm->view.bounds = (struct box3){ vec3_of(-2.1f, 0.3f, 1.2f), vec3_of(1.9f, 3.3f, 4.7f) };
    rsm_fixture_set_face(rsm, 0, vec3_of(-2.5f, 0.2f, 1.1f), vec3_of(4.6f, 0.3f, 0.1f),
                         vec3_of(0.2f, 3.2f, 0.3f), vec3_of(0.1f, -0.2f, 3.6f), vec3_of(3, 2, 1));
    rsm_fixture_set_face(rsm, 1, vec3_of(1.7f, 3.1f, 4.6f), vec3_of(-3.3f, 0.3f, 0.1f),
                         vec3_of(0.2f, 0.2f, -3.2f), vec3_of(0.1f, -2.6f, 0.2f),
                         vec3_of(0.01f, 40, 1));
    rsm->faces[0].direction = glms_vec3_normalize(vec3_of(0.1f, -0.2f, 1));
    rsm->faces[0].tan_half = 3.7f;
    rsm->faces[1].type = FRAME_LIGHT_POINT;
    rsm->faces[1].light = 1;
    rsm->faces[1].position = vec3_of(0.3f, 4.1f, 2.9f);
    rsm->faces[1].tan_half = 1.7f;
    for (int face = 0; face < 2; face++)
        for (uint32_t i = 0; i < GEOMETRY_SIZE * GEOMETRY_SIZE; i++) {
            struct rsm_fixture_texel texel = { .depth = i % 7 == 0 ? 0.0f : rng_float(&rng),
                                               .normal = glms_vec3_normalize(vec3_of(
                                                   rng_float(&rng) - 0.5f, rng_float(&rng) - 0.5f,
                                                   rng_float(&rng) - 0.5f)),
                                               .reflectance = { 200, 200, 200 } };
            *rsm_fixture_texel(rsm, face, i % GEOMETRY_SIZE, i / GEOMETRY_SIZE) = texel;
        }
    rsm_fixture_show_wall(rsm, vec3_of(-2, 0.5f, 1.5f), vec3_of(3.5f, 0.2f, 0.1f),
                          vec3_of(0.1f, 0.3f, 3), vec3_of(0.2f, 0.9f, 0.1f));
    rsm->constants.camera_position = vec3_of(0.1f, 3, 2.5f);
    rsm->constants.viewer = vec4_of(rsm->constants.camera_position, 1.0f);
    rsm_fixture_upload(rsm);
}

static void inject(struct twin *twin, struct lpv *lpv)
{
    const size_t coefficients = (size_t)SH_COUNT(lpv->options.bands);
    float *injected = lpv_fixture_read(lpv, lpv->injection.injected, 1);
    for (size_t i = 0; i < twin_cells(twin); i++)
        for (size_t k = 0; k < coefficients; k++)
            twin->light[i][k] = twin->accumulated[i][k] = (double)injected[coefficients * i + k];
    free(injected);
}

void geometry_check_light(struct lpv *lpv, const struct geometry_twin *geometry)
{
    const size_t coefficients = (size_t)SH_COUNT(lpv->options.bands);
    struct twin twin;
    twin_init_as(&twin, lpv);
    twin.geometry = geometry;
    twin.occlusion = (double)lpv->options.occlusion;
    inject(&twin, lpv);
    twin_accumulate(&twin, &lpv->options);
    float *got = lpv_fixture_read(lpv, lpv->cascades[0].light, 1);
    double most = 0.0;
    for (size_t i = 0; i < twin_cells(&twin); i++) most = fmax(most, fabs(twin.accumulated[i][0]));
    CHECK(most > 0.0);
    // Transmittance has 8 bits, the geometry volume 11.
    for (size_t i = 0; i < twin_cells(&twin); i++)
        for (size_t k = 0; k < coefficients; k++)
            CHECK_NEAR((double)got[coefficients * i + k], twin.accumulated[i][k], 3e-3 * most);
    free(got);
    twin_finish(&twin);
}
