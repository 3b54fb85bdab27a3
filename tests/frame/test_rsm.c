// Reflective shadow maps through rsm_fetch: their total flux is the flux that the lights emit.
#include "frame/frame_fixture.h"

#include "frame_test_shaders.h"

#include <math.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

struct texel {
    float valid, flux[3], position[3], normal[3];
};
_Static_assert(sizeof(struct texel) == 40, "as rsm_totals.comp writes it");

struct reader {
    gpu_pipeline pipeline;
    gpu_sampler nearest;
    gpu_buffer texels;
    uint32_t size;
    int faces;
};

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct reader *r = user;
    r->faces = view->rsm_face_count;
    r->size = view->rsm_size;
    gpu_dispatch(cmd, r->pipeline,
                 GPU_BIND(view->constants_binding, view->rsm_faces_binding,
                          { "rsm_depth", .image = view->rsm_depth, .sampler = r->nearest },
                          { "rsm_normal", .image = view->rsm_normal, .sampler = r->nearest },
                          { "rsm_flux", .image = view->rsm_flux, .sampler = r->nearest },
                          { "texels", .buffer = r->texels }),
                 &r->size, sizeof r->size, gpu_groups(r->size, 8), gpu_groups(r->size, 8),
                 (uint32_t)r->faces);
}

static void begin(struct frame_fixture *s, struct reader *r, struct gpu *gpu)
{
    fixture_init(s, gpu);
    *r = (struct reader){ .pipeline = test_gpu_compute(gpu, &shader_rsm_totals_comp) };
    struct gpu_sampler_desc nearest = { .name = "test.nearest" };
    assert_true(gpu_sampler_get(gpu, &nearest, &r->nearest));
    r->texels = test_gpu_buffer(gpu, 64 * 64 * 12 * sizeof(struct texel));
    s->indirect = (struct frame_indirect){ .record = record, .user = r, .needs = FRAME_NEEDS_RSM };
}

// The texels of all faces, in physical lumen; owned by the caller.
static struct texel *render(struct frame_fixture *s, struct reader *r)
{
    fixture_render(s);
    size_t count = (size_t)r->faces * r->size * r->size;
    struct texel *t = malloc(count * sizeof *t);
    assert_non_null(t);
    assert_true(gpu_buffer_download(s->gpu, r->texels, 0, t, count * sizeof *t));
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) t[i].flux[k] /= frame_radiance_scale(s->frame);
    return t;
}

static void finish(struct frame_fixture *s, struct reader *r)
{
    gpu_pipeline_destroy(s->gpu, &r->pipeline);
    gpu_buffer_destroy(s->gpu, &r->texels);
    fixture_finish(s);
}

static double total(const struct reader *r, const struct texel *t, int channel)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)r->faces * r->size * r->size; i++)
        sum += (double)t[i].flux[channel];
    return sum;
}

TEST_GPU(a_closed_box_reflects_all_flux_of_a_point_light)
{
    struct frame_fixture s;
    struct reader r;
    begin(&s, &r, gpu);
    fixture_box(&s, vec3_of(-1, -2, -1.5f), vec3_of(2, 1, 1), true,
                fixture_matte(&s, vec3_of(1, 0.5f, 0)));
    fixture_add_point(&s, vec3_of(0.3f, -0.2f, 0.1f), vec3_of(10, 20, 30));
    fixture_open(&s);
    struct texel *t = render(&s, &r);
    CHECK(r.faces == 6);
    CHECK_RELATIVE(total(&r, t, 0), 4 * PI * 10, 1e-3);
    CHECK_RELATIVE(total(&r, t, 1), 4 * PI * 20 * 0.5, 1e-2); // 8 bits of reflectance
    CHECK(total(&r, t, 2) == 0);
    free(t);
    finish(&s, &r);
}

TEST_GPU(texels_lie_on_surfaces_and_face_the_light)
{
    struct frame_fixture s;
    struct reader r;
    begin(&s, &r, gpu);
    // Normals point outwards: the light inside sees back faces.
    fixture_box(&s, vec3_of(-1, -1, -1), vec3_of(1, 1, 1), false,
                fixture_matte(&s, vec3_of(1, 1, 1)));
    vec3s light = vec3_of(0.3f, -0.2f, 0.1f);
    fixture_add_point(&s, light, vec3_of(10, 10, 10));
    fixture_open(&s);
    struct texel *t = render(&s, &r);
    for (size_t i = 0; i < (size_t)r.faces * r.size * r.size; i++) {
        CHECK(t[i].valid == 1);
        vec3s p = vec3_of(t[i].position[0], t[i].position[1], t[i].position[2]);
        vec3s n = vec3_of(t[i].normal[0], t[i].normal[1], t[i].normal[2]);
        CHECK_NEAR(fmaxf(fabsf(p.x), fmaxf(fabsf(p.y), fabsf(p.z))), 1, 1e-4);
        CHECK(glms_vec3_dot(n, glms_vec3_sub(light, p)) > 0);
    }
    free(t);
    finish(&s, &r);
}

TEST_GPU(suns_flux_on_a_plane_is_lux_times_projected_area)
{
    for (int i = 0; i < 4; i++) {
        struct frame_fixture s;
        struct reader r;
        begin(&s, &r, gpu);
        fixture_floor(&s, 2, fixture_matte(&s, vec3_of(1, 1, 1)));
        float angle = 0.4f * (float)i;
        fixture_add_sun(&s, vec3_of(-sinf(angle), -cosf(angle), 0), vec3_of(1000, 1000, 1000));
        fixture_open(&s);
        struct texel *t = render(&s, &r);
        // 16 m² at an angle; each border is exact to half a texel of 64.
        CHECK_RELATIVE(total(&r, t, 0), 1000 * 16 * (double)cosf(angle), 0.06);
        free(t);
        finish(&s, &r);
    }
}

TEST_GPU(spots_flux_is_the_integral_of_its_intensity)
{
    struct frame_fixture s;
    struct reader r;
    begin(&s, &r, gpu);
    fixture_floor(&s, 20, fixture_matte(&s, vec3_of(1, 1, 1)));
    double inner = 0.3, outer = 0.7;
    fixture_add_spot(&s, vec3_of(0, 3, 0), vec3_of(0, -1, 0), (float)inner, (float)outer,
                     vec3_of(100, 100, 100));
    fixture_open(&s);
    struct texel *t = render(&s, &r);
    // ∫ over the cone: full to the inner angle, then ((cos θ − cos outer) / (cos inner − cos
    // outer))²; a third of it.
    double expected = 100 * 2 * PI * (1 - cos(inner) + (cos(inner) - cos(outer)) / 3);
    CHECK_RELATIVE(total(&r, t, 0), expected, 0.01);
    free(t);
    finish(&s, &r);
}

// A box of this material, and its flux over that of a white matte one.
static double flux_of(struct gpu *gpu, const struct material *material, float range_m)
{
    struct frame_fixture s;
    struct reader r;
    begin(&s, &r, gpu);
    fixture_box(&s, vec3_of(-1, -1, -1), vec3_of(1, 1, 1), true, fixture_material(&s, material));
    fixture_add_point(&s, vec3_of(0, 0, 0), vec3_of(10, 10, 10))->range_m = range_m;
    fixture_open(&s);
    struct texel *t = render(&s, &r);
    const double flux = total(&r, t, 0) / (4 * PI * 10);
    free(t);
    finish(&s, &r);
    return flux;
}

// The hemispherical albedo of a metal: white reflects all light, black what Fresnel's term gives.
TEST_GPU(metals_reflect_the_albedo_of_their_lobe)
{
    struct material m = material_default();
    m.metallic = 1;
    m.roughness = 0.5f;
    CHECK_RELATIVE(flux_of(gpu, &m, 0), 1, 1e-2); // 8 bits of reflectance
    m.base_color = vec4_of(vec3_of(0.5f, 0.5f, 0.5f), 1);
    const double half = flux_of(gpu, &m, 0);
    CHECK(half > 0.45 && half < 0.6);
    m.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    const double black = flux_of(gpu, &m, 0);
    CHECK(black > 0.01 && black < 0.08);
}

TEST_GPU(surfaces_beyond_the_range_reflect_no_flux)
{
    const struct material m = material_default();
    CHECK(flux_of(gpu, &m, 0.9f) == 0);
}

TEST_GPU(face_count_follows_the_lights)
{
    struct frame_fixture s;
    struct reader r;
    begin(&s, &r, gpu);
    fixture_floor(&s, 2, fixture_matte(&s, vec3_of(1, 1, 1)));
    fixture_add_sun(&s, vec3_of(0, -1, 0), vec3_of(1, 1, 1));
    fixture_add_point(&s, vec3_of(0, 1, 0), vec3_of(1, 1, 1));
    fixture_open(&s);
    free(render(&s, &r));
    CHECK(r.faces == 7);
    s.input.light_count = 1;
    free(render(&s, &r));
    CHECK(r.faces == 1);
    finish(&s, &r);
}
