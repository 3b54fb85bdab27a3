// Compute dispatches over the scene's triangles; static and dynamic draws.
#include "frame/frame_fixture.h"

#include "frame/scene/scene_gpu.h"
#include "frame_test_shaders.h"

#include <stdlib.h>

struct totals {
    uint32_t triangles, solid, area; // area in 1/1024 m²
};

struct reader {
    gpu_pipeline opaque, masked;
    gpu_buffer totals;
    int dynamic_count;
    bool dynamic[16]; // by instance
};

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct reader *r = user;
    gpu_fill_buffer(cmd, r->totals, 0, sizeof(struct totals), 0);
    r->dynamic_count = view->scene->dynamic_count;
    for (int i = 0; i < view->scene->draw_count; i++) {
        const struct scene_draw *draw = &view->scene->draws[i];
        r->dynamic[draw->instance] = draw->dynamic;
        const struct gpu_binding own = { .name = "totals", .buffer = r->totals };
        scene_gpu_dispatch(view->scene, cmd,
                           &(struct scene_dispatch_call){
                               .pipeline = draw->variant & VARIANT_MASKED ? r->masked : r->opaque,
                               .draw = draw,
                               .bindings = &own,
                               .binding_count = 1 });
    }
}

static void begin(struct frame_fixture *s, struct reader *r, struct gpu *gpu)
{
    fixture_init(s, gpu);
    *r = (struct reader){ .opaque = test_gpu_compute(gpu, &shader_triangle_areas_comp) };
    const struct gpu_constant is_masked = { SCENE_CONSTANT_MASKED, true };
    assert_true(gpu_compute_pipeline_create(gpu, "test.masked", &shader_triangle_areas_comp,
                                            &is_masked, 1, &r->masked));
    r->totals = test_gpu_buffer(gpu, sizeof(struct totals));
    s->indirect = (struct frame_indirect){ .record = record, .user = r };
}

static struct totals render(struct frame_fixture *s, struct reader *r)
{
    struct totals t;
    fixture_render(s);
    assert_true(gpu_buffer_download(s->gpu, r->totals, 0, &t, sizeof t));
    return t;
}

static void finish(struct frame_fixture *s, struct reader *r)
{
    gpu_pipeline_destroy(s->gpu, &r->opaque);
    gpu_pipeline_destroy(s->gpu, &r->masked);
    gpu_buffer_destroy(s->gpu, &r->totals);
    fixture_finish(s);
}

// Many small meshes, whose indices begin at various alignments.
TEST_GPU(every_triangle_is_dispatched_once_in_world_space)
{
    struct frame_fixture s;
    struct reader r;
    begin(&s, &r, gpu);
    const int matte = fixture_matte(&s, vec3_of(1, 1, 1));
    fixture_floor(&s, 2, matte);                                         // 16 m²
    fixture_box(&s, vec3_of(-1, 0, -1), vec3_of(0, 1, 1), false, matte); // 10 m²
    struct node twice = node_default();
    twice.scale = vec3_of(-2, 1, 2); // mirrored
    twice.translation = vec3_of(5, 6, 7);
    fixture_instance(&s, 0, &twice); // 64 m²
    fixture_open(&s);
    const struct totals t = render(&s, &r);
    assert_int_equal(t.triangles, 16);
    assert_int_equal(t.solid, 16);
    CHECK_NEAR(t.area / 1024.0, 90.0, 1e-2);
    finish(&s, &r);
}

// More indices than one alignment, and more triangles than one workgroup.
TEST_GPU(long_meshes_are_dispatched_completely)
{
    enum { STRIPES = 333 };
    struct frame_fixture s;
    struct reader r;
    begin(&s, &r, gpu);
    vec3s positions[2 * (STRIPES + 1)], normals[2 * (STRIPES + 1)];
    uint32_t indices[6 * STRIPES];
    for (uint32_t i = 0; i <= STRIPES; i++)
        for (uint32_t k = 0; k < 2; k++) {
            positions[2 * i + k] = vec3_of((float)i, 0, (float)k);
            normals[2 * i + k] = vec3_of(0, 1, 0);
        }
    for (uint32_t i = 0; i < STRIPES; i++) {
        const uint32_t quad[6] = { 0, 1, 3, 0, 3, 2 };
        for (uint32_t k = 0; k < 6; k++) indices[6 * i + k] = 2 * i + quad[k];
    }
    const int matte = fixture_matte(&s, vec3_of(1, 1, 1));
    fixture_floor(&s, 1, matte); // 4 m²
    const int mesh = scene_add_mesh(s.scene, &(struct mesh){ .name = "stripes",
                                                             .vertex_count = 2 * (STRIPES + 1),
                                                             .index_count = 6 * STRIPES,
                                                             .positions = positions,
                                                             .normals = normals,
                                                             .indices = indices,
                                                             .material = matte });
    fixture_instance(&s, mesh, NULL);
    fixture_open(&s);
    const struct totals t = render(&s, &r);
    assert_int_equal(t.triangles, 2 + 2 * STRIPES);
    CHECK_NEAR(t.area / 1024.0, 4.0 + STRIPES, 1e-2);
    finish(&s, &r);
}

// The mask cuts the right half of a quad, with the centroid of one of its two triangles.
TEST_GPU(masked_centroids_are_not_solid)
{
    struct frame_fixture s;
    struct reader r;
    begin(&s, &r, gpu);
    uint8_t pixels[2 * 4] = { 255, 255, 255, 255, 255, 255, 255, 0 };
    const int image = scene_add_image(
        s.scene, &(struct scene_image){
                     .name = "half", .width = 2, .height = 1, .rgba = pixels, .has_alpha = true });
    struct material m = material_default();
    m.alpha_mode = ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    m.base_color_map.image = image;
    m.base_color_map.nearest = true;
    fixture_floor(&s, 1, fixture_material(&s, &m));
    m.base_color_map.image = -1;
    m.base_color.w = 0.4f;
    fixture_floor(&s, 1, fixture_material(&s, &m)); // all of it
    fixture_open(&s);
    const struct totals t = render(&s, &r);
    assert_int_equal(t.triangles, 4);
    assert_int_equal(t.solid, 1);
    finish(&s, &r);
}

TEST_GPU(draws_are_dynamic_from_their_first_movement)
{
    struct frame_fixture s;
    struct reader r;
    begin(&s, &r, gpu);
    const int matte = fixture_matte(&s, vec3_of(1, 1, 1));
    fixture_floor(&s, 2, matte);
    fixture_floor(&s, 1, matte);
    fixture_open(&s);
    render(&s, &r);
    CHECK(r.dynamic_count == 0); // the first frame has no movement
    render(&s, &r);
    CHECK(r.dynamic_count == 0);
    s.pose.world_from_node[s.scene->instances[1].node].raw[3][1] += 0.1f;
    s.input.camera_cut = true; // resets motion, keeps the dynamic flag
    render(&s, &r);
    CHECK(r.dynamic_count == 1 && !r.dynamic[0] && r.dynamic[1]);
    s.input.camera_cut = false;
    render(&s, &r);
    CHECK(r.dynamic_count == 1 && r.dynamic[1]);
    finish(&s, &r);
}
