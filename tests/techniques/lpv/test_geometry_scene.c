// The geometry volume from the scene's triangles: equality with the plain C twin, bitwise
// invariants.
#include "techniques/lpv/geometry_fixture.h"
#include "techniques/lpv/mesh_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Input with meshes of scattered triangles.
struct set {
    struct rsm_fixture rsm;
    struct mesh_fixture meshes;
};

static void set_init(struct set *set, struct gpu *gpu, int soups)
{
    geometry_scatter(&set->rsm, gpu);
    mesh_fixture_init(&set->meshes, &set->rsm);
    for (int i = 0; i < soups; i++) mesh_fixture_add_soup(&set->meshes, (uint32_t)i);
    mesh_fixture_place(&set->meshes);
}

static void set_finish(struct set *set)
{
    mesh_fixture_finish(&set->meshes);
    rsm_fixture_finish(&set->rsm);
}

static void twin_of(struct geometry_twin *twin, const struct lpv *lpv,
                    const struct mesh_fixture *meshes)
{
    geometry_twin_init(twin, lpv->cascades[0].grid, LPV_GEOMETRY_SCENE);
    for (int i = 0; i < meshes->scene->instance_count; i++) {
        const struct mesh *mesh = &meshes->scene->meshes[meshes->scene->instances[i].mesh];
        const mat4s m = pose_world_from_instance(&meshes->pose, i);
        for (uint32_t t = 0; t < mesh->index_count; t += 3) {
            vec3s corners[3];
            for (uint32_t k = 0; k < 3; k++)
                corners[k] = mat4_point(m, mesh->positions[mesh->indices[t + k]]);
            geometry_twin_triangle(twin, corners);
        }
    }
}

TEST_GPU(lpv_geometry_from_the_scene_equals_the_twin)
{
    const char *options[] = { "lpv:dim=8,steps=1", "lpv:dim=16,steps=1,cell_margin=1" };
    for (int i = 0; i < 2; i++) {
        struct set set;
        struct geometry_twin twin;
        set_init(&set, gpu, 1);
        struct lpv *lpv = lpv_fixture_create(gpu, options[i]);
        mesh_fixture_render(&set.meshes, lpv);
        twin_of(&twin, lpv, &set.meshes);
        geometry_check(lpv, &twin, 6e-4); // shares of at most 16 lines, in 11 bits
        geometry_twin_finish(&twin);
        lpv_fixture_destroy(lpv);
        set_finish(&set);
    }
}

TEST_GPU(lpv_light_occluded_by_the_scene_equals_the_twin)
{
    const char *options[] = { "lpv:dim=8,steps=1", "lpv:dim=8,steps=6",
                              "lpv:dim=8,steps=7,occlusion=0.7,precision=float",
                              "holpv:dim=8,steps=5", "lpv:dim=16,steps=9,neighbours=26" };
    struct set set;
    set_init(&set, gpu, 1);
    for (int i = 0; i < 5; i++) {
        struct lpv *lpv = lpv_fixture_create(gpu, options[i]);
        struct geometry_twin twin;
        mesh_fixture_render(&set.meshes, lpv);
        twin_of(&twin, lpv, &set.meshes);
        geometry_check_light(lpv, &twin);
        geometry_twin_finish(&twin);
        lpv_fixture_destroy(lpv);
    }
    set_finish(&set);
}

// A change of the option takes effect at once.
TEST_GPU(lpv_occlusion_applies_to_the_cached_volume)
{
    struct set set;
    set_init(&set, gpu, 1);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=8,steps=6,occlusion=0.2");
    mesh_fixture_render(&set.meshes, lpv);
    struct lpv_options options = lpv->options;
    options.occlusion = 2;
    technique_set_options(&technique_lpv, lpv, &options);
    mesh_fixture_render(&set.meshes, lpv);
    struct geometry_twin twin;
    twin_of(&twin, lpv, &set.meshes);
    geometry_check_light(lpv, &twin);
    geometry_twin_finish(&twin);
    lpv_fixture_destroy(lpv);
    set_finish(&set);
}

// Meshes start and stop moving; each frame equals a first frame.
TEST_GPU(lpv_cached_geometry_equals_that_of_a_first_frame)
{
    struct set set;
    set_init(&set, gpu, 3);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=8,steps=1");
    for (int frame = 0; frame < 6; frame++) {
        if (frame > 1 && frame < 5) mesh_fixture_move(&set.meshes, 1, 0.21f);
        if (frame == 3) mesh_fixture_move(&set.meshes, 2, -0.4f); // a second mesh starts to move
        mesh_fixture_render(&set.meshes, lpv);
        float *cached = geometry_read(lpv);
        struct lpv *fresh = lpv_fixture_create(gpu, "lpv:dim=8,steps=1");
        mesh_fixture_render(&set.meshes, fresh);
        float *first = geometry_read(fresh);
        assert_memory_equal(cached, first, geometry_floats(lpv) * sizeof *cached);
        free(cached);
        free(first);
        lpv_fixture_destroy(fresh);
    }
    lpv_fixture_destroy(lpv);
    set_finish(&set);
}

// Overwrites the static coverage; the marks stay until it is recomputed.
static bool is_recomputed(struct mesh_fixture *meshes, struct lpv *lpv)
{
    const size_t words = gpu_buffer_bytes(lpv->gpu, lpv->cascades[0].geometry.static_coverage) / 4;
    uint32_t *mark = malloc(words * sizeof *mark), *after = malloc(words * sizeof *mark);
    for (size_t i = 0; i < words; i++) mark[i] = 0x5555;
    CHECK(gpu_buffer_upload(lpv->gpu, lpv->cascades[0].geometry.static_coverage, 0, mark,
                            words * sizeof *mark));
    mesh_fixture_render(meshes, lpv);
    CHECK(gpu_buffer_download(lpv->gpu, lpv->cascades[0].geometry.static_coverage, 0, after,
                              words * sizeof *mark));
    const bool recomputed = memcmp(mark, after, words * sizeof *mark) != 0;
    free(mark);
    free(after);
    return recomputed;
}

TEST_GPU(lpv_static_geometry_is_computed_once)
{
    struct set set;
    set_init(&set, gpu, 2);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=8,steps=1");
    CHECK(is_recomputed(&set.meshes, lpv));
    CHECK(!is_recomputed(&set.meshes, lpv));
    mesh_fixture_move(&set.meshes, 1, 0.3f);
    CHECK(is_recomputed(&set.meshes, lpv)); // without the moving mesh
    mesh_fixture_move(&set.meshes, 1, 0.3f);
    CHECK(!is_recomputed(&set.meshes, lpv));
    CHECK(!is_recomputed(&set.meshes, lpv));
    technique_lpv.invalidate(lpv, CHANGED_LIGHT | CHANGED_CAMERA);
    CHECK(!is_recomputed(&set.meshes, lpv));
    technique_lpv.invalidate(lpv, CHANGED_GEOMETRY);
    CHECK(is_recomputed(&set.meshes, lpv));
    set.rsm.view.bounds.max.x += 3; // another grid
    CHECK(is_recomputed(&set.meshes, lpv));
    set.rsm.view.index = 0; // another scene
    CHECK(is_recomputed(&set.meshes, lpv));
    lpv_fixture_destroy(lpv);
    set_finish(&set);
}

// A wall of many triangles, whose edges lie on lines and on corners of cells: no gaps.
TEST_GPU(lpv_geometry_of_a_closed_wall_has_no_gaps)
{
    enum { N = 7 };
    struct set set;
    vec3s positions[(N + 1) * (N + 1)];
    uint32_t indices[6 * N * N];
    for (uint32_t i = 0; i < (N + 1) * (N + 1); i++) {
        const float u = (float)(i % (N + 1)) / N, v = (float)(i / (N + 1)) / N;
        // A slope that covers each column along z exactly once.
        positions[i] = vec3_of(8 * u, 8 * v, 2.3f + 3.1f * u);
    }
    for (uint32_t i = 0; i < N * N; i++) {
        const uint32_t a = i / N * (N + 1) + i % N;
        const uint32_t quad[6] = { a, a + 1, a + N + 2, a, a + N + 2, a + N + 1 };
        memcpy(&indices[6 * i], quad, sizeof quad);
    }
    geometry_scatter(&set.rsm, gpu);
    set.rsm.view.bounds = (struct box3){ vec3_of(0, 0, 0), vec3_of(8, 8, 8) };
    mesh_fixture_init(&set.meshes, &set.rsm);
    mesh_fixture_add(&set.meshes, positions, (N + 1) * (N + 1), indices, 6 * N * N);
    mesh_fixture_place(&set.meshes);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=16,steps=1");
    mesh_fixture_render(&set.meshes, lpv);
    const int32_t *cells = lpv->cascades[0].grid.cells;
    const size_t words = (size_t)(3 * cells[0] * cells[1] * cells[2]);
    uint32_t *masks = malloc(words * sizeof *masks);
    CHECK(gpu_buffer_download(lpv->gpu, lpv->cascades[0].geometry.static_coverage, 0, masks,
                              words * sizeof *masks));
    for (int y = 0; y < cells[1]; y++)
        for (int x = 0; x < cells[0]; x++) {
            // Columns along z that lie entirely over the slope cross it once.
            const float cell = lpv->cascades[0].grid.cell_m,
                        left = lpv->cascades[0].grid.origin_m.x + (float)x * cell,
                        low = lpv->cascades[0].grid.origin_m.y + (float)y * cell;
            if (left < 0 || low < 0 || left + cell > 8 || low + cell > 8) continue;
            int lines = 0;
            for (int z = 0; z < cells[2]; z++)
                lines += __builtin_popcount(masks[3 * ((z * cells[1] + y) * cells[0] + x) + 2] &
                                            0xffffu);
            assert_int_equal(lines, LPV_LINES * LPV_LINES);
        }
    free(masks);
    lpv_fixture_destroy(lpv);
    set_finish(&set);
}

TEST_GPU(lpv_geometry_of_an_empty_scene_is_zero)
{
    const char *options[] = { "lpv:dim=8,steps=3,geometry=maps", "lpv:dim=8,steps=3" };
    for (int i = 0; i < 2; i++) {
        struct set set;
        set_init(&set, gpu, 0);
        for (int face = 0; face < 2; face++)
            rsm_fixture_fill_face(&set.rsm, face, (struct rsm_fixture_texel){ .depth = 0 });
        // The camera sees a wall outside of the grid.
        rsm_fixture_show_wall(&set.rsm, vec3_of(90, 0, 0), vec3_of(1, 0, 0), vec3_of(0, 1, 0),
                              vec3_of(0, 0, 1));
        rsm_fixture_upload(&set.rsm);
        struct lpv *lpv = lpv_fixture_create(gpu, options[i]);
        mesh_fixture_render(&set.meshes, lpv);
        float *got = geometry_read(lpv);
        for (size_t k = 0; k < geometry_floats(lpv); k++) CHECK(got[k] == 0.0f);
        free(got);
        lpv_fixture_destroy(lpv);
        set_finish(&set);
    }
}

// Meshes with non-finite or far vertices do not affect other meshes.
TEST_GPU(lpv_geometry_ignores_vertices_out_of_range)
{
    struct set set;
    set_init(&set, gpu, 2);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=8,steps=1");
    mesh_fixture_move(&set.meshes, 1, 1e4f);
    mesh_fixture_render(&set.meshes, lpv);
    float *one = geometry_read(lpv);
    const float wrong[] = { NAN, INFINITY, -INFINITY, 3e38f, 1e20f };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        set.meshes.pose.world_from_node[set.meshes.scene->instances[1].node].raw[3][0] = wrong[i];
        mesh_fixture_render(&set.meshes, lpv);
        float *got = geometry_read(lpv);
        assert_memory_equal(one, got, geometry_floats(lpv) * sizeof *one);
        free(got);
    }
    free(one);
    lpv_fixture_destroy(lpv);
    set_finish(&set);
}
