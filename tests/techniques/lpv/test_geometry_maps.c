// The geometry volume from maps: equality with the plain C twin, bitwise invariants.
#include "techniques/lpv/geometry_fixture.h"

#include <math.h>
#include <stdlib.h>

// Perpendicular area in m² of a texel: of a beam, or of a cone at its distance.
static double texel_across(const struct rsm_fixture *rsm, int face, uint32_t x, uint32_t y,
                           vec3s to_light)
{
    const double edge = 2.0 * (double)rsm->faces[face].tan_half / GEOMETRY_SIZE;
    if (rsm->faces[face].type == FRAME_LIGHT_SUN) return edge * edge;
    const double u = ((double)x + 0.5) * edge - (double)rsm->faces[face].tan_half,
                 v = ((double)y + 0.5) * edge - (double)rsm->faces[face].tan_half;
    const double distance2 = (double)glms_vec3_norm2(to_light);
    return edge * edge / pow(1.0 + u * u + v * v, 1.5) * distance2;
}

static void add_face(struct geometry_twin *twin, const struct rsm_fixture *rsm, int face)
{
    for (uint32_t y = 0; y < GEOMETRY_SIZE; y++)
        for (uint32_t x = 0; x < GEOMETRY_SIZE; x++) {
            const struct rsm_fixture_texel *texel =
                &rsm->texels[((uint32_t)face * GEOMETRY_SIZE + y) * GEOMETRY_SIZE + x];
            if (texel->depth == 0.0f) continue;
            const vec3s position = rsm_fixture_texel_position(rsm, face, x, y);
            const vec3s to_light = rsm->faces[face].type == FRAME_LIGHT_SUN
                                       ? glms_vec3_negate(rsm->faces[face].direction)
                                       : glms_vec3_sub(rsm->faces[face].position, position);
            geometry_twin_surfel(twin, position, rsm_fixture_rounded_normal(texel->normal),
                                 glms_vec3_normalize(to_light),
                                 texel_across(rsm, face, x, y, to_light));
        }
    geometry_twin_merge(twin);
}

// The visible wall, whose pixels are parallelograms.
static void add_camera(struct geometry_twin *twin, const struct rsm_fixture *rsm, vec3s normal)
{
    const mat4s m = rsm->constants.world_from_clip;
    const vec3s u = glms_vec3_scale(vec3_xyz(m.col[0]), 2.0f / GEOMETRY_WIDTH),
                v = glms_vec3_scale(vec3_xyz(m.col[1]), 2.0f / GEOMETRY_HEIGHT);
    for (int y = 0; y < GEOMETRY_HEIGHT; y++)
        for (int x = 0; x < GEOMETRY_WIDTH; x++) {
            const vec3s position =
                mat4_point(m, vec3_of(((float)x + 0.5f) * 2.0f / GEOMETRY_WIDTH - 1.0f,
                                      ((float)y + 0.5f) * 2.0f / GEOMETRY_HEIGHT - 1.0f, 0.5f));
            const vec3s to_viewer =
                glms_vec3_normalize(glms_vec3_sub(rsm->constants.camera_position, position));
            geometry_twin_surfel(twin, position, rsm_fixture_rounded_normal(normal), to_viewer,
                                 fabs((double)glms_vec3_dot(glms_vec3_cross(u, v), to_viewer)));
        }
    geometry_twin_merge(twin);
}

static void twin_of(struct geometry_twin *twin, const struct lpv *lpv,
                    const struct rsm_fixture *rsm)
{
    geometry_twin_init(twin, lpv->cascades[0].grid, LPV_GEOMETRY_MAPS);
    add_camera(twin, rsm, vec3_of(0.2f, 0.9f, 0.1f));
    for (int face = 0; face < rsm->view.rsm_face_count; face++) add_face(twin, rsm, face);
}

TEST_GPU(lpv_geometry_from_maps_equals_the_twin)
{
    struct rsm_fixture rsm;
    geometry_scatter(&rsm, gpu);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=8,steps=1,geometry=maps");
    for (int faces = 2; faces > 0; faces--) {
        struct geometry_twin twin;
        rsm.view.rsm_face_count = faces;
        lpv_fixture_render(lpv, &rsm);
        twin_of(&twin, lpv, &rsm);
        geometry_check(lpv, &twin, 2e-3); // halves
        geometry_twin_finish(&twin);
    }
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}

TEST_GPU(lpv_light_occluded_by_maps_equals_the_twin)
{
    const char *options[] = { "lpv:dim=8,steps=1,geometry=maps", "lpv:dim=8,steps=6,geometry=maps",
                              "lpv:dim=8,steps=7,geometry=maps,occlusion=0.7,precision=float",
                              "holpv:dim=8,steps=5,geometry=maps" };
    struct rsm_fixture rsm;
    geometry_scatter(&rsm, gpu);
    for (int i = 0; i < 4; i++) {
        struct lpv *lpv = lpv_fixture_create(gpu, options[i]);
        struct geometry_twin twin;
        lpv_fixture_render(lpv, &rsm);
        twin_of(&twin, lpv, &rsm);
        geometry_check_light(lpv, &twin);
        geometry_twin_finish(&twin);
        lpv_fixture_destroy(lpv);
    }
    rsm_fixture_finish(&rsm);
}

TEST_GPU(lpv_geometry_from_maps_is_independent_of_the_order_of_lights)
{
    struct rsm_fixture rsm;
    geometry_scatter(&rsm, gpu);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=8,steps=1,geometry=maps");
    lpv_fixture_render(lpv, &rsm);
    float *before = geometry_read(lpv);
    for (uint32_t i = 0; i < GEOMETRY_SIZE * GEOMETRY_SIZE; i++) {
        const struct rsm_fixture_texel texel = rsm.texels[i];
        rsm.texels[i] = rsm.texels[GEOMETRY_SIZE * GEOMETRY_SIZE + i];
        rsm.texels[GEOMETRY_SIZE * GEOMETRY_SIZE + i] = texel;
    }
    const struct rsm_face face = rsm.faces[0];
    rsm.faces[0] = rsm.faces[1];
    rsm.faces[1] = face;
    rsm_fixture_upload(&rsm);
    lpv_fixture_render(lpv, &rsm);
    float *swapped = geometry_read(lpv);
    assert_memory_equal(before, swapped, geometry_floats(lpv) * sizeof *before);
    free(before);
    free(swapped);
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}

// Several lights that see the same surface do not increase its occlusion.
TEST_GPU(lpv_geometry_counts_a_surface_once)
{
    struct rsm_fixture rsm;
    geometry_scatter(&rsm, gpu);
    for (uint32_t i = 0; i < GEOMETRY_SIZE * GEOMETRY_SIZE; i++)
        rsm.texels[GEOMETRY_SIZE * GEOMETRY_SIZE + i] = rsm.texels[i];
    rsm.faces[1] = rsm.faces[0];
    rsm.faces[1].light = 1;
    rsm_fixture_upload(&rsm);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=8,steps=1,geometry=maps");
    lpv_fixture_render(lpv, &rsm);
    float *two = geometry_read(lpv);
    rsm.view.rsm_face_count = 1;
    lpv_fixture_render(lpv, &rsm);
    float *one = geometry_read(lpv);
    assert_memory_equal(one, two, geometry_floats(lpv) * sizeof *one);
    free(one);
    free(two);
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}
