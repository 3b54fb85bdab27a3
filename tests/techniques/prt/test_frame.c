// The light map of the GPU against sums on the CPU: random distant light, suns, emissive surfaces.
#include "techniques/prt/prt_fixture.h"

#include "core/half.h"
#include "scene/scene_edit.h"
#include "techniques/gi.h"
#include "techniques/prt/prt_state.h"
#include "techniques/technique_rules.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The technique with the light of a test in place of the scene's.
static struct {
    const struct prt_light *light;
    struct prt *state; // of the newest update
} test;

static void update(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    test.state = state;
    test.state->light = *test.light;
    prt_record_update(state, cmd, view);
}

struct gpu_side {
    struct gi_spec spec;
    struct technique technique;
    struct gi *gi;
};

// light: NULL: that of the scene.
static void open_stack(struct gpu_side *g, struct prt_fixture *f, const struct prt_baked *baked,
                       struct gpu *gpu, const char *more, const struct prt_light *light)
{
    struct frame_fixture *s = &f->s;
    char text[256];
    const struct gi_bakes bakes = { .of_term = { baked->tensors } };
    *g = (struct gpu_side){ 0 };
    s->gpu = gpu;
    fixture_open_frame(s);
    snprintf(text, sizeof text, "prt:%s%s%s", f->options, more[0] ? "," : "", more);
    CHECK(gi_spec_parse(&g->spec, test_host(), text));
    g->technique = *g->spec.technique[0];
    test.light = light;
    if (light) g->technique.update = update;
    g->spec.technique[0] = &g->technique;
    g->gi = gi_create_baked(test_host(), gpu, &g->spec, &bakes, &s->pose, s->width, s->height);
    assert_non_null(g->gi);
    s->indirect = gi_hook(g->gi);
}

static void close_stack(struct gpu_side *g)
{
    gi_destroy(g->gi);
    gi_spec_finish(&g->spec);
}

// Floor, box and slab: shadows and bounces of two colours.
static void make_scene(struct prt_fixture *f)
{
    prt_fixture_init(f);
    fixture_floor(&f->s, 2, fixture_matte(&f->s, vec3_of(0.8f, 0.5f, 0.2f)));
    fixture_box(&f->s, vec3_of(-1, 0, -1), vec3_of(0, 1, 0), false,
                fixture_matte(&f->s, vec3_of(0.2f, 0.5f, 0.9f)));
    fixture_box(&f->s, vec3_of(-1, 1.3f, -1), vec3_of(1, 1.4f, 1), false,
                fixture_matte(&f->s, vec3_of(0.7f, 0.7f, 0.7f)));
    fixture_look(&f->s, vec3_of(2, 2.5f, 3), vec3_of(0, 0.5f, 0));
}

// Irradiance x and vector irradiance yzw of a texel, by colour; in the units of the frame.
static vec4s texel_light(const uint32_t *words, uint32_t texels, uint32_t texel, uint32_t colour)
{
    const uint32_t *at = words + 2 * ((size_t)colour * texels + texel);
    vec4s out;
    for (int k = 0; k < 4; k++) out.raw[k] = float_from_half((uint16_t)(at[k / 2] >> 16 * (k % 2)));
    return out;
}

// Largest difference of the irradiance of a texel over the largest irradiance.
static double compare_texels(struct prt_fixture *f, const struct prt_baked *baked,
                             const struct prt_light *light, float factor)
{
    const uint32_t texels = f->charts.side_texel_count;
    const size_t room = light_map_table_capacity(3 * (size_t)texels);
    double worst = 0, most = 0;
    uint32_t *words = calloc(2 * room, sizeof *words);
    assert_non_null(words);
    CHECK(gpu_image_download(f->s.gpu, test.state->tables.texel_light, 0, 0, words,
                             2 * room * sizeof *words));
    for (uint32_t i = 0; i < texels; i++) {
        const vec3s normal = chart_texel_normal(&f->charts, i);
        float expected[3];
        prt_irradiance(baked, i, light, expected);
        for (uint32_t c = 0; c < 3; c++) {
            const vec4s got = texel_light(words, texels, i, c);
            const float e = fmaxf(expected[c], 0.0f) * factor;
            most = fmax(most, (double)e);
            worst = fmax(worst, (double)fabsf(got.x - e));
            for (int a = 0; a < 3; a++)
                worst = fmax(worst, (double)fabsf(got.raw[1 + a] - e * normal.raw[a]));
        }
    }
    free(words);
    CHECK(most > 0.1);
    return worst / most;
}

// Largest difference of the radiance that texels reflect towards the camera, over the largest.
static double compare_reflected(struct prt_fixture *f, const struct prt_baked *baked,
                                const struct prt_light *light)
{
    const uint32_t texels = f->charts.side_texel_count;
    const size_t room = light_map_table_capacity(texels);
    const float *point = tensors_find(baked->tensors, LIGHT_MAP_POINT)->data;
    double worst = 0, most = 0;
    uint32_t *words = calloc(2 * room, sizeof *words);
    assert_non_null(words);
    CHECK(gpu_image_download(f->s.gpu, test.state->tables.texel_radiance, 0, 0, words,
                             2 * room * sizeof *words));
    for (uint32_t i = 0; i < texels; i++) {
        const float *at = point + 4 * (size_t)i;
        const vec3s way = glms_vec3_sub(f->s.input.camera.eye, vec3_of(at[0], at[1], at[2]));
        float expected[3];
        if (!prt_is_open(baked, i)) continue;
        prt_reflected(baked, i, light, glms_vec3_normalize(way), expected);
        const vec4s got = texel_light(words, texels, i, 0);
        for (int c = 0; c < 3; c++) {
            const double e = (double)fmaxf(expected[c], 0.0f);
            most = fmax(most, e);
            worst = fmax(worst, fabs((double)got.raw[c] - e));
        }
    }
    free(words);
    CHECK(most > 0.1);
    return worst / most;
}

// Half floats of a texel.
TEST_GPU(light_of_texels_is_the_sum_of_their_transfer_vectors)
{
    static const char *const MORE[] = { "coefficients=4",
                                        "",
                                        "coefficients=16",
                                        "coefficients=25",
                                        "transfer=shadowed",
                                        "transfer=shadowed,coefficients=25",
                                        "transfer=unshadowed,coefficients=16",
                                        "compression=pca",
                                        "compression=vq,clusters=100",
                                        "compression=cpca,clusters=16",
                                        "compression=cpca,clusters=9,vectors=3,coefficients=25",
                                        "compression=cpca,clusters=8,vectors=5,transfer=shadowed",
                                        "compression=pca,vectors=32,transfer=shadowed" };
    for (size_t i = 0; i < sizeof MORE / sizeof *MORE; i++) {
        struct prt_fixture f;
        struct prt_light light;
        struct gpu_side g;
        make_scene(&f);
        prt_fixture_open(&f, "texels=1024,rays=64");
        struct prt_baked baked = prt_fixture_bake(&f, MORE[i], 0);
        prt_random_light((uint32_t)i, &light);
        open_stack(&g, &f, &baked, gpu, MORE[i], &light);
        fixture_render(&f.s);
        const double worst = compare_texels(&f, &baked, &light, 1);
        print_message("%s: %.2g off\n", MORE[i], worst);
        CHECK(worst <= 0x1p-11 + 2e-6);
        close_stack(&g);
        prt_baked_finish(&baked);
        prt_fixture_close(&f);
    }
}

TEST_GPU(reflections_of_texels_are_the_products_of_their_matrices)
{
    static const char *const MORE[] = { "coefficients=4", "coefficients=25", "transfer=shadowed",
                                        "compression=cpca,clusters=9,vectors=6",
                                        "compression=vq,clusters=50,transfer=shadowed" };
    for (size_t i = 0; i < sizeof MORE / sizeof *MORE; i++) {
        struct prt_fixture f;
        struct prt_light light;
        struct gpu_side g;
        make_scene(&f);
        prt_fixture_open(&f, "texels=512,rays=64,glossy=true,emitters=false");
        struct prt_baked baked = prt_fixture_bake(&f, MORE[i], 0);
        prt_random_light((uint32_t)i, &light);
        open_stack(&g, &f, &baked, gpu, MORE[i], &light);
        fixture_render(&f.s);
        const double worst = compare_reflected(&f, &baked, &light);
        print_message("%s: %.2g off\n", MORE[i], worst);
        CHECK(worst <= 0x1p-11 + 2e-5);
        close_stack(&g);
        prt_baked_finish(&baked);
        prt_fixture_close(&f);
    }
}

// ---- vertices

// Irradiance of a vertex by distant light, or NULL: by emissive surfaces.
static void vertex_irradiance(const struct prt_baked *baked, uint32_t vertex,
                              const struct prt_light *light, float out[3])
{
    const float *emitted = tensors_find(baked->tensors, LIGHT_MAP_EMITTED)->data;
    const float *bounced = tensors_find(baked->tensors, PRT_EMITTED)->data;
    if (light) prt_irradiance(baked, vertex, light, out);
    for (size_t c = 0; c < 3; c++)
        out[c] = light ? fmaxf(out[c], 0.0f)
                       : emitted[12 * (size_t)vertex + 4 * c] + bounced[3 * (size_t)vertex + c];
}

// Barycentric weights of the point where a pixel's ray meets the triangle's plane.
static vec3s weights_at(const struct prt_fixture *f, uint32_t x, uint32_t y, const vec3s corner[3],
                        vec3s normal)
{
    const vec3s p = fixture_ray_on_plane(&f->s, x, y, normal, glms_vec3_dot(normal, corner[0]));
    vec3s weight;
    for (int k = 0; k < 3; k++) {
        const vec3s from = corner[(k + 1) % 3], edge = glms_vec3_sub(corner[(k + 2) % 3], from);
        const vec3s height = glms_vec3_cross(normal, edge);
        weight.raw[k] = glms_vec3_dot(glms_vec3_sub(p, from), height) /
                        glms_vec3_dot(glms_vec3_sub(corner[k], from), height);
    }
    return weight;
}

// The weighted light of a pixel's triangle, of the vertices of its side. False: no surface.
static bool expect_pixel(const struct prt_fixture *f, const struct prt_vertices *v,
                         const struct prt_baked *baked, const struct prt_light *light,
                         const float *ids, uint32_t x, uint32_t y, float out[3])
{
    const float *id = ids + 2 * ((size_t)y * f->s.width + x);
    vec3s corner[3];
    if (id[0] < 0) return false;
    const uint32_t triangle = (uint32_t)id[1];
    const vec3s normal = v->face[v->triangle_0[(int)id[0]] + triangle];
    const uint32_t *front = prt_vertices_of(v, (int)id[0], triangle, false);
    for (int k = 0; k < 3; k++) corner[k] = v->at[front[k]].position;
    const vec3s weight = weights_at(f, x, y, corner, normal);
    const bool back = glms_vec3_dot(normal, fixture_ray(&f->s, (float)x, (float)y)) > 0;
    out[0] = out[1] = out[2] = 0;
    for (int k = 0; k < 3; k++) {
        float e[3];
        vertex_irradiance(baked, prt_vertices_of(v, (int)id[0], triangle, back)[k], light, e);
        for (int c = 0; c < 3; c++) out[c] += weight.raw[k] * e[c];
    }
    return true;
}

// Largest difference of a pixel over the largest irradiance. Those without a surface have none.
static double compare_pixels(struct prt_fixture *f, const struct prt_baked *baked,
                             const struct prt_light *light)
{
    struct prt_vertices v;
    double worst = 0, most = 0;
    int count = 0;
    CHECK(prt_vertices_init(&v, test_host(), &f->statics.pose));
    float *ids = fixture_read(&f->s, READ_ID), *got = fixture_read(&f->s, READ_IRRADIANCE);
    const float factor = light ? frame_radiance_scale(f->s.frame) : 1;
    for (uint32_t i = 0; i < f->s.width * f->s.height; i++) {
        float expected[3];
        if (!expect_pixel(f, &v, baked, light, ids, i % f->s.width, i / f->s.width, expected)) {
            for (size_t c = 0; c < 3; c++) CHECK(got[3 * (size_t)i + c] == 0);
            continue;
        }
        for (size_t c = 0; c < 3; c++) {
            most = fmax(most, (double)expected[c]);
            worst = fmax(worst, fabs((double)(got[3 * (size_t)i + c] * factor - expected[c])));
        }
        count++;
    }
    free(ids);
    free(got);
    prt_vertices_finish(&v);
    CHECK(count > 100 && (uint32_t)count < f->s.width * f->s.height && most > 0.1);
    return worst / most;
}

// With a sphere of shared vertices, and a double-sided quad that is seen from behind.
static void make_vertex_scene(struct prt_fixture *f, bool emits)
{
    struct material m = material_default();
    m.double_sided = true;
    make_scene(f);
    fixture_quad(&f->s, vec3_of(0.5f, 0, -0.5f), vec3_of(-0.5f, 0, 1), vec3_of(-0.5f, 1, 1),
                 vec3_of(0.5f, 1, -0.5f), fixture_material(&f->s, &m));
    m.emissive = vec3_of(10, 20, 30);
    if (emits)
        fixture_quad(&f->s, vec3_of(2, 0, -1), vec3_of(2, 0, -2), vec3_of(2, 1, -2),
                     vec3_of(2, 1, -1), fixture_material(&f->s, &m));
    else
        prt_fixture_sphere(f, vec3_of(1, 0.5f, 1), 0.5f, 8, 0, false, prt_fixture_diffuse(f, 1));
}

TEST_GPU(pixels_have_the_weighted_light_of_their_vertices)
{
    static const char *const MORE[] = { "at=vertex", "at=vertex,compression=cpca,clusters=8",
                                        "at=vertex,specular=false", "at=vertex" };
    for (size_t i = 0; i < sizeof MORE / sizeof *MORE; i++) {
        struct prt_fixture f;
        struct prt_light light;
        struct gpu_side g;
        const bool emits = i == 3;
        make_vertex_scene(&f, emits);
        f.s.width = 96;
        f.s.height = 80;
        prt_fixture_open(&f, "texels=64,rays=64");
        struct prt_baked baked = prt_fixture_bake(&f, MORE[i], 0);
        prt_random_light((uint32_t)i, &light);
        if (emits) light = (struct prt_light){ 0 };
        open_stack(&g, &f, &baked, gpu, MORE[i], &light);
        fixture_render(&f.s);
        const double worst = compare_pixels(&f, &baked, emits ? NULL : &light);
        print_message("%s: %.2g off\n", MORE[i], worst);
        CHECK(worst < 2e-3);
        close_stack(&g);
        prt_baked_finish(&baked);
        prt_fixture_close(&f);
    }
}

// An object that the camera moves along with looks the same.
TEST_GPU(moved_instances_keep_the_light_of_their_vertices)
{
    struct prt_fixture f;
    struct prt_light light;
    struct gpu_side g;
    double worst = 0, most = 0;
    prt_fixture_init(&f);
    prt_fixture_sphere(&f, vec3_of(0, 0, 0), 1, 8, 0, false, prt_fixture_diffuse(&f, 1));
    fixture_look(&f.s, vec3_of(0, 0, 3), vec3_of(0, 0, 0));
    prt_fixture_open(&f, "texels=64,rays=64");
    struct prt_baked baked = prt_fixture_bake(&f, "at=vertex", 0);
    prt_random_light(1, &light);
    light.direct[0] = (vec4s){ { 5, 6, 7, 0 } };
    open_stack(&g, &f, &baked, gpu, "at=vertex", &light);
    float *images[2];
    for (int i = 0; i < 2; i++) {
        gi_follow(g.gi, &f.s.pose, true);
        fixture_render(&f.s);
        images[i] = fixture_read(&f.s, READ_IRRADIANCE);
        const vec3s by = vec3_of(2, -1, 1);
        CHECK(scene_set_instance_transform(f.s.scene, 0, glms_translate_make(by)));
        CHECK(pose_follow(&f.s.pose));
        pose_update(&f.s.pose, -1, 0);
        fixture_look(&f.s, glms_vec3_add(by, vec3_of(0, 0, 3)), by);
    }
    CHECK(strstr(test_last_message(), "static geometry changed"));
    for (size_t i = 0; i < (size_t)3 * f.s.width * f.s.height; i++) {
        most = fmax(most, (double)images[0][i]);
        worst = fmax(worst, (double)fabsf(images[1][i] - images[0][i]));
    }
    print_message("%.2g off of %.2g\n", worst, most);
    CHECK(most > 0 && worst < 2e-3 * most);
    free(images[0]);
    free(images[1]);
    close_stack(&g);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// ---- pixels

// A floor without anything else: all texels have one irradiance, which pixels show.
TEST_GPU(pixels_of_an_open_floor_have_its_irradiance)
{
    struct prt_fixture f;
    struct prt_light light;
    struct gpu_side g;
    float e[3];
    prt_fixture_init(&f);
    fixture_floor(&f.s, 2, prt_fixture_diffuse(&f, 0.5f));
    fixture_look(&f.s, vec3_of(0, 1, 0.5f), vec3_of(0, 0, 0));
    prt_fixture_open(&f, "texels=256");
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    prt_random_light(1, &light);
    light.direct[0] = (vec4s){ { 5, 6, 7, 0 } };
    prt_irradiance(&baked, 0, &light, e);
    open_stack(&g, &f, &baked, gpu, "", &light);
    fixture_render(&f.s);
    const vec3s got = fixture_pixel(&f.s, READ_IRRADIANCE, f.s.width / 2, f.s.height / 2);
    const float scale = frame_radiance_scale(f.s.frame);
    print_message("%.4f %.4f %.4f of %.4f %.4f %.4f\n", (double)(got.x * scale),
                  (double)(got.y * scale), (double)(got.z * scale), (double)e[0], (double)e[1],
                  (double)e[2]);
    for (int c = 0; c < 3; c++) CHECK_RELATIVE(got.raw[c] * scale, e[c], 0.01f);
    close_stack(&g);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// ---- light of the scene

static double mean_irradiance(struct prt_fixture *f)
{
    double sum = 0;
    const size_t count = (size_t)3 * f->s.width * f->s.height;
    float *e = fixture_read(&f->s, READ_IRRADIANCE);
    for (size_t i = 0; i < count; i++) sum += (double)e[i];
    free(e);
    return sum / (double)count;
}

// The sun of 1000 lux from above, without and with a sky.
static double mean_of(struct gpu *gpu, const char *more, bool sun, float sky)
{
    struct prt_fixture f;
    struct gpu_side g;
    make_scene(&f);
    if (sun) fixture_add_sun(&f.s, vec3_of(0.3f, -1, 0.2f), vec3_of(1000, 1000, 1000));
    f.s.input.environment.sky = vec3_of(sky, sky, sky);
    prt_fixture_open(&f, "texels=1024,rays=64");
    struct prt_baked baked = prt_fixture_bake(&f, more, 0);
    open_stack(&g, &f, &baked, gpu, more, NULL);
    fixture_render(&f.s);
    const double mean = mean_irradiance(&f);
    close_stack(&g);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
    return mean;
}

TEST_GPU(suns_give_bounced_light_alone)
{
    const double sky = mean_of(gpu, "", false, 100), sun = mean_of(gpu, "", true, 0),
                 both = mean_of(gpu, "", true, 100);
    print_message("sky %.2f lx, sun %.2f lx, both %.2f lx\n", sky, sun, both);
    CHECK(sun > 1 && sky > 1);
    CHECK_RELATIVE(sky + sun, both, 0.05); // negative sums are 0
    CHECK(mean_of(gpu, "suns=false", true, 0) == 0);
    CHECK(mean_of(gpu, "transfer=shadowed", true, 0) == 0);
    CHECK_RELATIVE(mean_of(gpu, "suns=false", true, 100), sky, 2e-3);
}

TEST_GPU(twice_the_sky_is_twice_the_light)
{
    CHECK_RELATIVE(2 * mean_of(gpu, "", false, 100), mean_of(gpu, "", false, 200), 1e-3);
}

// ---- emissive surfaces

TEST_GPU(an_emissive_disk_lights_the_floor_below)
{
    static const char *const MORE[] = { "transfer=unshadowed", "transfer=shadowed", "",
                                        "emitters=false" };
    for (int i = 0; i < 4; i++) {
        struct prt_fixture f;
        struct gpu_side g;
        struct material m = material_default();
        prt_fixture_init(&f);
        fixture_floor(&f.s, 2, prt_fixture_diffuse(&f, 0.5f));
        m.base_color = vec4_of(vec3_of(0, 0, 0), 1);
        m.metallic = m.specular = 0;
        m.emissive = vec3_of(100, 100, 100);
        prt_fixture_disk(&f, vec3_of(0, 1, 0), 0.5f, fixture_material(&f.s, &m));
        fixture_look(&f.s, vec3_of(0, 0.8f, 0.5f), vec3_of(0, 0, 0));
        prt_fixture_open(&f, "texels=2048,rays=1024");
        struct prt_baked baked = prt_fixture_bake(&f, MORE[i], 0);
        open_stack(&g, &f, &baked, gpu, MORE[i], NULL);
        fixture_render(&f.s);
        const float e = fixture_pixel(&f.s, READ_IRRADIANCE, f.s.width / 2, f.s.height / 2).x;
        // On the axis of a disk: πL r² / (r² + h²).
        const float expected = i == 3 ? 0 : GLM_PIf * 100 * 0.25f / 1.25f;
        print_message("%s: %.2f of %.2f lx\n", MORE[i], (double)e, (double)expected);
        CHECK_NEAR(e, expected, 0.02f * expected);
        close_stack(&g);
        prt_baked_finish(&baked);
        prt_fixture_close(&f);
    }
}

TEST_GPU(a_point_light_is_warned_of_once)
{
    struct prt_fixture f;
    struct gpu_side g;
    make_scene(&f);
    const int node =
        scene_add_node_looking(f.s.scene, "light", vec3_of(0, 3, 0), vec3_of(0, -1, 0));
    CHECK(scene_add_light(f.s.scene, &(struct light){ .name = "light",
                                                      .type = LIGHT_POINT,
                                                      .node = node,
                                                      .intensity = vec3_of(1, 1, 1) }) >= 0);
    prt_fixture_open(&f, "texels=512,rays=16");
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    open_stack(&g, &f, &baked, gpu, "", NULL);
    gi_follow(g.gi, &f.s.pose, true);
    CHECK(strstr(test_last_message(), "prt: 1 point or spot light gives no indirect light"));
    CHECK(strstr(test_last_message(), "--gi radiosity"));
    close_stack(&g);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}
