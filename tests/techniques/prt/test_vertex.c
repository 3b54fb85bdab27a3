// Transfer at vertices: which vertices are receivers, closed forms of their transfer, and the light
// of texels of the same scene.
#include "techniques/bake_bytes.h"
#include "techniques/prt/prt_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct prt_vertices vertices_of(const struct prt_fixture *f)
{
    struct prt_vertices v;
    CHECK(prt_vertices_init(&v, test_host(), &f->statics.pose));
    return v;
}

// ---- receivers

// Two triangles of six vertices with coordinates of their own.
static void add_unshared_quad(struct prt_fixture *f, bool double_sided)
{
    static const vec3s AT[6] = { { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 1, 1, 0 } },
                                 { { 0, 0, 0 } }, { { 1, 1, 0 } }, { { 0, 1, 0 } } };
    vec3s positions[6], normals[6];
    vec2s uv[6];
    uint32_t indices[6];
    struct material m = material_default();
    m.double_sided = double_sided;
    memcpy(positions, AT, sizeof positions);
    for (uint32_t i = 0; i < 6; i++) {
        normals[i] = vec3_of(i == 5 ? -0.0f : 0.0f, 0, 1);
        uv[i] = (vec2s){ { (float)i, 0 } };
        indices[i] = i;
    }
    const int mesh =
        scene_add_mesh(f->s.scene, &(struct mesh){ .name = "quad",
                                                   .vertex_count = 6,
                                                   .index_count = 6,
                                                   .positions = positions,
                                                   .normals = normals,
                                                   .uv = { uv },
                                                   .indices = indices,
                                                   .material = fixture_material(&f->s, &m) });
    assert_true(mesh >= 0);
    fixture_instance(&f->s, mesh, NULL);
}

TEST(vertices_of_one_position_and_normal_are_one_receiver)
{
    struct prt_fixture f;
    prt_fixture_init(&f);
    add_unshared_quad(&f, false);
    fixture_box(&f.s, vec3_of(2, 0, 0), vec3_of(3, 1, 1), false, prt_fixture_diffuse(&f, 0.5f));
    prt_fixture_open(&f, "rays=16");
    struct prt_vertices v = vertices_of(&f);
    CHECK(v.count == 4 + 24 && v.front_count == v.count && v.triangle_count == 2 + 12);
    CHECK(v.corners[0][0] == v.corners[1][0] && v.corners[0][2] == v.corners[1][1]);
    for (size_t t = 0; t < 2 * v.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            CHECK((v.corners[t][k] == PRT_NO_VERTEX) == (t >= v.triangle_count));
    prt_vertices_finish(&v);
    prt_fixture_close(&f);
}

TEST(double_sided_materials_have_receivers_on_both_sides)
{
    struct prt_fixture f;
    prt_fixture_init(&f);
    add_unshared_quad(&f, false);
    add_unshared_quad(&f, true);
    add_unshared_quad(&f, true);
    prt_fixture_open(&f, "rays=16");
    struct prt_vertices v = vertices_of(&f);
    CHECK(v.front_count == 12 && v.count == 20);
    for (uint32_t t = 0; t < 2; t++) {
        CHECK(prt_vertices_of(&v, 0, t, true)[0] == PRT_NO_VERTEX);
        for (int i = 1; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                const struct prt_vertex *front = &v.at[prt_vertices_of(&v, i, t, false)[k]];
                const struct prt_vertex *back = &v.at[prt_vertices_of(&v, i, t, true)[k]];
                CHECK(front->instance == i && back->instance == i);
                CHECK(front->normal.z == 1 && back->normal.z == -1);
                CHECK(memcmp(&front->position, &back->position, sizeof front->position) == 0);
            }
    }
    prt_vertices_finish(&v);
    prt_fixture_close(&f);
}

// The mean over choices is interpolated light.
TEST(a_point_sends_the_light_of_a_corner_with_the_probability_of_its_weight)
{
    enum { CHOICES = 1000 };
    struct prt_fixture f;
    struct prt_receivers r = { .at_vertices = true };
    int count[3] = { 0 };
    prt_fixture_init(&f);
    add_unshared_quad(&f, false);
    prt_fixture_open(&f, "rays=16");
    r.vertices = vertices_of(&f);
    struct prt_point point = { .triangle = 1, .u = 0.2f, .v = 0.3f };
    for (int i = 0; i < CHOICES; i++) {
        const uint32_t at = prt_receiver_at(&r, &point, ((float)i + 0.5f) / CHOICES);
        for (int k = 0; k < 3; k++) count[k] += at == r.vertices.corners[1][k];
    }
    CHECK(count[0] == 500 && count[1] == 200 && count[2] == 300);
    point.back = true;
    CHECK(prt_receiver_at(&r, &point, 0.5f) == CHART_NONE);
    prt_vertices_finish(&r.vertices);
    prt_fixture_close(&f);
}

// All but the outermost columns are hidden: those left of the middle show the left one.
TEST(hidden_vertices_show_the_nearest_along_edges)
{
    struct prt_fixture f;
    prt_fixture_init(&f);
    prt_fixture_grid(&f, 4, 8, prt_fixture_diffuse(&f, 0.5f));
    prt_fixture_open(&f, "rays=16");
    struct prt_vertices v = vertices_of(&f);
    bool *hidden = calloc(v.count, sizeof *hidden);
    assert_non_null(hidden);
    for (uint32_t i = 0; i < v.count; i++) hidden[i] = fabsf(v.at[i].position.x) < 3.5f;
    uint32_t *nearest_valid = prt_vertices_fill(&v, hidden);
    for (uint32_t i = 0; i < v.count; i++) {
        const vec3s p = v.at[i].position, q = v.at[nearest_valid[i]].position;
        CHECK(!hidden[nearest_valid[i]] && (hidden[i] || nearest_valid[i] == i));
        if (p.x != 0) CHECK(p.z == q.z && p.x * q.x > 0);
    }
    host_free(test_host(), nearest_valid);
    for (uint32_t i = 0; i < v.count; i++) hidden[i] = true;
    nearest_valid = prt_vertices_fill(&v, hidden);
    for (uint32_t i = 0; i < v.count; i++) CHECK(nearest_valid[i] == i);
    host_free(test_host(), nearest_valid);
    free(hidden);
    prt_vertices_finish(&v);
    prt_fixture_close(&f);
}

TEST(glossy_transfer_at_vertices_is_refused)
{
    struct prt_fixture f;
    prt_fixture_init(&f);
    add_unshared_quad(&f, false);
    prt_fixture_open(&f, "rays=16");
    CHECK(!bake_of_gi("prt:at=vertex,glossy=true", &f.s.pose, 0));
    CHECK(strstr(test_last_message(), "prt: glossy=true needs the texels of a light map"));
    prt_fixture_close(&f);
}

// ---- closed forms

// The bands of the clamped cosine (Ramamoorthi & Hanrahan 2001).
TEST(unshadowed_vectors_are_the_clamped_cosine_around_the_normal)
{
    static const float BAND[5] = { GLM_PIf, 2 * GLM_PIf / 3, GLM_PIf / 4, 0, -GLM_PIf / 24 };
    const vec3s center = vec3_of(0.5f, 1, -0.25f);
    struct prt_fixture f;
    double worst = 0;
    prt_fixture_init(&f);
    prt_fixture_sphere(&f, center, 1.5f, 16, 0, false, prt_fixture_diffuse(&f, 0.5f));
    prt_fixture_open(&f, "rays=16,coefficients=25,transfer=unshadowed");
    struct prt_baked baked = prt_fixture_bake(&f, "at=vertex", 0);
    struct prt_vertices v = vertices_of(&f);
    for (uint32_t i = 0; i < v.count; i++) {
        const vec3s n = glms_vec3_divs(glms_vec3_sub(v.at[i].position, center), 1.5f);
        float y[SH_MAX_COUNT];
        sh_eval(5, n, y);
        for (int k = 0, l = 0; k < SH_COUNT(5); k++) {
            if (k == SH_COUNT(l + 1)) l++;
            const float got = prt_coefficient(&baked, i, (size_t)k).x;
            worst = fmax(worst, (double)fabsf(got - BAND[l] * y[k]));
        }
    }
    print_message("%u vertices: at most %.2g off\n", v.count, worst);
    CHECK(v.count > 400 && worst < 1e-3);
    prt_vertices_finish(&v);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

TEST(a_uniform_sky_on_a_sphere_is_pi)
{
    struct prt_fixture f;
    struct prt_light sky;
    double least = HUGE_VAL, most = 0;
    prt_fixture_init(&f);
    prt_fixture_sphere(&f, vec3_of(0, 1, 0), 1, 24, 0, false, prt_fixture_diffuse(&f, 0.5f));
    prt_fixture_open(&f, "rays=256,transfer=shadowed");
    struct prt_baked baked = prt_fixture_bake(&f, "at=vertex", 0);
    struct prt_vertices v = vertices_of(&f);
    prt_uniform_light(&sky);
    for (uint32_t i = 0; i < v.count; i++) {
        float e[3];
        CHECK(prt_is_open(&baked, i));
        prt_irradiance(&baked, i, &sky, e);
        least = fmin(least, (double)e[0] / GLM_PI);
        most = fmax(most, (double)e[0] / GLM_PI);
    }
    print_message("%.5f to %.5f of π\n", least, most);
    CHECK(least > 0.99 && most < 1.001);
    prt_vertices_finish(&v);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// The form factor of a disk of radius 1, parallel to the floor at a height h, from a place at a
// distance a from its axis.
static double disk_form_factor(double h, double a)
{
    const double z = h * h + a * a + 1;
    return 0.5 * (1 - (z - 2) / sqrt(z * z - 4 * a * a));
}

TEST(irradiance_below_a_black_disk_is_that_of_its_form_factor)
{
    enum { RAYS = 1024 };
    static const float HEIGHT[] = { 0.5f, 3 };
    for (int n = 0; n < 2; n++) {
        struct prt_fixture f;
        struct prt_light sky;
        double worst = 0, rms = 0;
        int count = 0;
        prt_fixture_init(&f);
        prt_fixture_grid(&f, 1, 20, prt_fixture_diffuse(&f, 0.8f));
        prt_fixture_disk(&f, vec3_of(0, HEIGHT[n], 0), 1, prt_fixture_diffuse(&f, 0));
        prt_fixture_open(&f, "rays=1024,transfer=shadowed");
        struct prt_baked baked = prt_fixture_bake(&f, "at=vertex", 0);
        struct prt_vertices v = vertices_of(&f);
        const float *point = tensors_find(baked.tensors, LIGHT_MAP_POINT)->data;
        prt_uniform_light(&sky);
        for (uint32_t i = 0; i < v.count; i++) {
            float e[3];
            if (v.at[i].normal.y < 0.5f) continue;
            const double a = (double)hypotf(point[4 * i], point[4 * i + 2]);
            const double share = disk_form_factor((double)HEIGHT[n], a);
            prt_irradiance(&baked, i, &sky, e);
            const double error = fabs((double)e[0] - GLM_PI * (1 - share)) /
                                 (GLM_PI * sqrt(share * (1 - share) / RAYS));
            worst = fmax(worst, error);
            rms += error * error;
            count++;
        }
        rms = sqrt(rms / count);
        print_message("disk at %g: %.2f standard errors at worst, %.2f in the mean\n",
                      (double)HEIGHT[n], worst, rms);
        CHECK(count == 21 * 21 && worst < 3 && rms < 1);
        prt_vertices_finish(&v);
        prt_baked_finish(&baked);
        prt_fixture_close(&f);
    }
}

// A cube of edges of 4 m whose walls face its inside, turned so that they are not exactly planar.
static void add_turned_room(struct prt_fixture *f, int material)
{
    static const float AROUND[4][2] = { { -2, -2 }, { 2, -2 }, { 2, 2 }, { -2, 2 } };
    const mat4s turn = glms_rotate_make(0.7f, vec3_of(1, 2, 3));
    for (int wall = 0; wall < 6; wall++) {
        const int axis = wall / 2, side = wall % 2;
        vec3s corner[4];
        for (int k = 0; k < 4; k++) {
            const float *around = AROUND[side ? 3 - k : k];
            vec3s p;
            p.raw[axis] = side ? 2 : -2;
            p.raw[(axis + 1) % 3] = around[0];
            p.raw[(axis + 2) % 3] = around[1];
            corner[k] = mat4_point(turn, p);
        }
        fixture_quad(&f->s, corner[0], corner[1], corner[2], corner[3], material);
    }
}

// Corners are in the planes of two other walls, within rounding.
TEST(no_sky_enters_a_closed_room)
{
    struct prt_fixture f;
    prt_fixture_init(&f);
    add_turned_room(&f, prt_fixture_diffuse(&f, 0.5f));
    prt_fixture_open(&f, "rays=1024");
    struct prt_baked baked = prt_fixture_bake(&f, "at=vertex", 0);
    CHECK(tensors_find(baked.tensors, LIGHT_MAP_POINT)->shape[0] == 24);
    for (uint32_t i = 0; i < 24; i++) {
        CHECK(prt_is_open(&baked, i));
        for (size_t k = 0; k < 9; k++) CHECK(prt_coefficient(&baked, i, k).x == 0);
    }
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// A block stands on the floor: vertices below it are inside.
TEST(vertices_inside_geometry_are_hidden)
{
    struct prt_fixture f;
    prt_fixture_init(&f);
    prt_fixture_grid(&f, 4, 16, prt_fixture_diffuse(&f, 0.5f));
    fixture_box(&f.s, vec3_of(-1.1f, -1, -1.1f), vec3_of(1.1f, 1, 1.1f), false,
                prt_fixture_diffuse(&f, 0.5f));
    prt_fixture_open(&f, "rays=64");
    struct prt_baked baked = prt_fixture_bake(&f, "at=vertex", 0);
    struct prt_vertices v = vertices_of(&f);
    for (uint32_t i = 0; i < 17 * 17; i++) {
        const vec3s p = v.at[i].position;
        const float outside = fmaxf(fabsf(p.x), fabsf(p.z));
        // Vertices at 1 are inside, too, but their triangles reach beyond the block.
        CHECK(prt_is_open(&baked, i) == (outside > 0.75f));
    }
    prt_vertices_finish(&v);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// ---- bounces

// The integrating sphere of test_transfer.c.
TEST(bounces_in_a_sphere_with_a_hole_are_their_geometric_series)
{
    enum { RINGS = 32, OPEN = 6 };
    const double hole = 0.5 * (1 - cos(GLM_PI * OPEN / RINGS)), ratio = 0.6 * (1 - hole);
    struct prt_fixture f;
    double direct = 0, bounced = 0;
    prt_fixture_init(&f);
    prt_fixture_sphere(&f, vec3_of(0, 0, 0), 1, RINGS, OPEN, true, prt_fixture_diffuse(&f, 0.6f));
    prt_fixture_open(&f, "rays=512,bounces=64,threshold=0");
    struct prt_baked baked = prt_fixture_bake(&f, "at=vertex", 0);
    struct prt_vertices v = vertices_of(&f);
    for (uint32_t i = 0; i < v.count; i++) {
        const vec4s t = prt_coefficient(&baked, i, 0);
        const double weight = sqrt(fmax(0.0, 1.0 - (double)(v.at[i].normal.y * v.at[i].normal.y)));
        CHECK(t.y == t.z && t.y == t.w);
        direct += weight * (double)t.x;
        bounced += weight * (double)t.y;
    }
    print_message("bounced %.4f of %.4f of the direct light\n", bounced / direct,
                  ratio / (1 - ratio));
    CHECK_RELATIVE(bounced / direct, ratio / (1 - ratio), 0.015);
    prt_vertices_finish(&v);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// ---- texels

struct mean {
    double light[3], area;
};

static void add(struct mean *m, const float e[3], double area)
{
    for (int c = 0; c < 3; c++) m->light[c] += area * (double)e[c];
    m->area += area;
}

static struct mean mean_of_texels(const struct prt_fixture *f, const struct prt_light *light)
{
    struct prt_baked baked = prt_fixture_bake(f, "", 0);
    struct mean m = { 0 };
    for (uint32_t i = 0; i < f->charts.side_texel_count; i++) {
        float e[3];
        prt_irradiance(&baked, i, light, e);
        add(&m, e, (double)chart_texel_of(&f->charts, i)->area_m2);
    }
    prt_baked_finish(&baked);
    return m;
}

static struct mean mean_of_vertices(const struct prt_fixture *f, const struct prt_light *light)
{
    struct prt_baked baked = prt_fixture_bake(f, "at=vertex", 0);
    struct prt_vertices v = vertices_of(f);
    struct mean m = { 0 };
    for (size_t t = 0; t < v.triangle_count; t++) {
        const uint32_t *corner = v.corners[t];
        const vec3s a = v.at[corner[0]].position;
        const vec3s b = glms_vec3_sub(v.at[corner[1]].position, a);
        const vec3s c = glms_vec3_sub(v.at[corner[2]].position, a);
        const double area = 0.5 * (double)glms_vec3_norm(glms_vec3_cross(b, c));
        for (int k = 0; k < 3; k++) {
            float e[3];
            prt_irradiance(&baked, corner[k], light, e);
            add(&m, e, area / 3);
        }
    }
    prt_vertices_finish(&v);
    prt_baked_finish(&baked);
    return m;
}

TEST(light_of_vertices_is_that_of_texels)
{
    struct prt_fixture f;
    struct prt_light light;
    prt_fixture_init(&f);
    prt_fixture_grid(&f, 3, 40, fixture_matte(&f.s, vec3_of(0.8f, 0.5f, 0.2f)));
    prt_fixture_sphere(&f, vec3_of(0, 1.3f, 0), 1, 24, 0, false,
                       fixture_matte(&f.s, vec3_of(0.2f, 0.5f, 0.9f)));
    prt_fixture_sphere(&f, vec3_of(1.5f, 1, 1), 0.8f, 24, 4, true, prt_fixture_diffuse(&f, 0.7f));
    prt_fixture_open(&f, "texels=4096,rays=512");
    prt_random_light(3, &light);
    for (int c = 0; c < 3; c++) light.direct[0].raw[c] = light.bounced[0].raw[c] = 6;
    const struct mean at = mean_of_vertices(&f, &light), texels = mean_of_texels(&f, &light);
    for (int c = 0; c < 3; c++) {
        const double a = at.light[c] / at.area, b = texels.light[c] / texels.area;
        print_message("%.4f lx at vertices, %.4f lx at texels\n", a, b);
        CHECK_RELATIVE(a, b, 0.02);
    }
    prt_fixture_close(&f);
}
