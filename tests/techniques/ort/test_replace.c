// Light that scatters below surfaces replaces the diffuse reflection of direct light at pixels.
#include "techniques/baked_fixture.h"
#include "techniques/ort/bake/profile.h"
#include "techniques/ort/ort_map.h"

#include <math.h>
#include <stdlib.h>

// A light map, irradiance and direct light are rounded to half floats, in turn.
static const double ROUNDING = 4 * 0x1p-10;

// A plane of 60 mm that a slab above it shades for x < 0, seen from above.
static void half_lit(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    fixture_floor(s, 1, fixture_matte(s, vec3_of(0.8f, 0.5f, 0.3f)));
    fixture_box(s, vec3_of(-3, 1, -3), vec3_of(0, 1.2f, 3), false,
                fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f)));
    fixture_add_sun(s, vec3_of(0, -1, 0), vec3_of(100, 100, 100));
    fixture_look(s, vec3_of(0, 0.9f, 0.3f), vec3_of(0, 0, 0));
}

// ---- the light map at a pixel

struct map_image {
    struct charts charts;
    float *rgb[3]; // E and the vector irradiance
    double scale;
};

static void read_map(struct frame_fixture *s, const struct baked_fixture *run, struct map_image *m)
{
    int term;
    gpu_image image;
    CHECK(ort_charts(&s->pose, run->spec.options[0], test_host(), NULL, &m->charts));
    CHECK(gi_light_map(run->gi, &term, &image));
    m->scale = (double)frame_radiance_scale(s->frame);
    for (uint32_t c = 0; c < 3; c++) {
        const size_t count = (size_t)4 * m->charts.width * m->charts.height;
        m->rgb[c] = calloc(count, sizeof(float));
        CHECK(gpu_image_download_float(s->gpu, image, 0, c, m->rgb[c], 4, count));
    }
}

static void map_finish(struct map_image *m)
{
    for (int c = 0; c < 3; c++) free(m->rgb[c]);
    charts_finish(&m->charts);
}

// The place of a point of a plane's triangle in the atlas.
static vec2s place_of(const struct chart_triangle *t, vec3s at)
{
    const vec3s a = glms_vec3_sub(t->corner[1], t->corner[0]);
    const vec3s b = glms_vec3_sub(t->corner[2], t->corner[0]);
    const vec3s p = glms_vec3_sub(at, t->corner[0]);
    const float area = glms_vec3_dot(glms_vec3_cross(a, b), t->normal);
    const float u = glms_vec3_dot(glms_vec3_cross(p, b), t->normal) / area;
    const float v = glms_vec3_dot(glms_vec3_cross(a, p), t->normal) / area;
    const vec2s across = glms_vec2_scale(glms_vec2_sub(t->place[1], t->place[0]), u);
    const vec2s down = glms_vec2_scale(glms_vec2_sub(t->place[2], t->place[0]), v);
    return glms_vec2_add(t->place[0], glms_vec2_add(across, down));
}

// Along the normal of the plane, +y.
static double value_of(const float *texel)
{
    return 0.5 * ((double)texel[0] + (double)texel[2]);
}

static double bilinear(const struct map_image *m, int colour, vec2s place)
{
    const float x = floorf(place.x - 0.5f), y = floorf(place.y - 0.5f);
    const double u = (double)(place.x - 0.5f - x), v = (double)(place.y - 0.5f - y);
    const float *row = m->rgb[colour] + 4 * ((size_t)y * m->charts.width + (size_t)x);
    const float *next = row + (size_t)4 * m->charts.width;
    return ((1 - v) * ((1 - u) * value_of(row) + u * value_of(row + 4)) +
            v * ((1 - u) * value_of(next) + u * value_of(next + 4))) /
           m->scale;
}

static double map_at(const struct map_image *m, const float id[2], vec3s at, int colour)
{
    const size_t triangle = m->charts.triangle_0[(size_t)id[0]] + (size_t)id[1];
    return bilinear(m, colour,
                    place_of(&m->charts.triangles[m->charts.chart_triangle[triangle]], at));
}

// ---- pixels

struct pixels {
    float *id, *position, *irradiance, *direct, *albedo;
    size_t count;
};

static void render(struct frame_fixture *s, struct pixels *p)
{
    fixture_render(s);
    *p = (struct pixels){ .id = fixture_read(s, READ_ID),
                          .position = fixture_read(s, READ_POSITION),
                          .irradiance = fixture_read(s, READ_IRRADIANCE),
                          .direct = fixture_read(s, READ_DIRECT),
                          .albedo = fixture_read(s, READ_ALBEDO),
                          .count = (size_t)s->width * s->height };
}

static void pixels_finish(struct pixels *p)
{
    free(p->id);
    free(p->position);
    free(p->irradiance);
    free(p->direct);
    free(p->albedo);
}

static double direct_irradiance(const struct pixels *p, size_t value)
{
    return GLM_PI * (double)p->direct[value] / (double)p->albedo[value];
}

// The sum of a pixel is the scattered light.
static double sum_at(const struct pixels *p, size_t pixel, size_t colour)
{
    const size_t value = 3 * pixel + colour;
    return (double)p->irradiance[value] + direct_irradiance(p, value);
}

static vec3s position_at(const struct pixels *p, size_t pixel)
{
    return vec3_of(p->position[3 * pixel], p->position[3 * pixel + 1], p->position[3 * pixel + 2]);
}

// ---- half a plane

#define SKIN "ort:transfer=scattering,material=skin1,rays=16,"

TEST_GPU(pixels_have_the_light_that_leaves_the_light_map)
{
    struct frame_fixture s;
    struct baked_fixture run;
    struct map_image m;
    struct pixels p;
    half_lit(&s, gpu);
    baked_fixture_open(&run, &s, SKIN "texels=2048,offsets=100,mm_per_unit=30");
    render(&s, &p);
    read_map(&s, &run, &m);
    double worst = 0.0, most = 0.0;
    for (size_t i = 0; i < p.count; i++)
        for (int c = 0; c < 3; c++) {
            const double expected = map_at(&m, p.id + 2 * i, position_at(&p, i), c);
            worst = fmax(worst, fabs(sum_at(&p, i, (size_t)c) - expected));
            most = fmax(most, expected);
        }
    print_message("sums differ by %.4f of %.2f lux\n", worst, most);
    CHECK(most > 50.0 && worst <= ROUNDING * most);
    pixels_finish(&p);
    map_finish(&m);
    baked_fixture_close(&run, &s);
}

// Share of the light of a lit half of a plane that leaves at a distance from its edge, > 0 in the
// lit half: ∫ P(r) 2 acos(d / r) r dr beyond the edge.
static double share_at(const struct ort_profile *profile, double from_edge_mm)
{
    enum { STEPS = 2000 };
    const double d = fabs(from_edge_mm), step = ort_profile_reach(profile, 1e-4) / STEPS;
    double beyond = 0.0;
    for (int i = 0; i < STEPS; i++) {
        const double r = d + (i + 0.5) * step;
        beyond += ort_profile_at(profile, r) * 2.0 * acos(d / r) * r * step;
    }
    return from_edge_mm > 0.0 ? 1.0 - beyond : beyond;
}

// Pixels apart from two texels beside the edge, by colour.
static double error_beside_edge(const struct pixels *p, const struct ort_profile *profile, int c,
                                double mm, double lux)
{
    static const double TEXELS_M = 2 * 2.0 / 64;
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < p->count; i++) {
        const double x = (double)p->position[3 * i];
        if (fabs(x) < TEXELS_M) continue;
        const double error = sum_at(p, i, (size_t)c) / lux - share_at(profile, x * mm);
        sum += error * error;
        count += 1.0;
    }
    return sqrt(sum / count);
}

// The error of the offsets is some percent, see test_scattering.c.
TEST_GPU(shadows_have_the_edges_of_the_profile)
{
    struct frame_fixture s;
    struct baked_fixture run;
    struct pixels p;
    half_lit(&s, gpu);
    baked_fixture_open(&run, &s, SKIN "texels=4096,offsets=400,mm_per_unit=30");
    render(&s, &p);
    for (int c = 0; c < 3; c++) {
        const struct ort_profile profile = ort_profile_of(run.spec.options[0], c);
        const double error = error_beside_edge(&p, &profile, c, 30, 100);
        print_message("colour %d: error %.4f\n", c, error);
        CHECK(error <= 0.03);
    }
    pixels_finish(&p);
    baked_fixture_close(&run, &s);
}

// ---- a plane of 240 mm, all of which is lit

// Its vertex normals lean by `lean` towards x.
static void lit_plane(struct frame_fixture *s, struct gpu *gpu, float metallic, float lean)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(0.8f, 0.5f, 0.3f), 1);
    m.metallic = metallic;
    m.roughness = 0.5f;
    fixture_init(s, gpu);
    fixture_floor(s, 1, fixture_material(s, &m));
    const struct mesh *plane = &s->scene->meshes[s->scene->mesh_count - 1];
    for (size_t i = 0; i < plane->vertex_count; i++)
        plane->normals[i] = glms_vec3_normalize(vec3_of(lean, 1, 0));
    fixture_add_sun(s, vec3_of(0.5f, -1, 0.2f), vec3_of(100, 80, 60));
    fixture_look(s, vec3_of(0.1f, 0.6f, 0.1f), vec3_of(0, 0, 0)); // 120 mm of it
}

// The largest difference of a pixel's colour to that of direct light alone, over the latter.
static double change_by(struct gpu *gpu, float metallic, float lean, const char *gi)
{
    struct frame_fixture s;
    struct baked_fixture run;
    double worst = 0.0;
    lit_plane(&s, gpu, metallic, lean);
    baked_fixture_open(&run, &s, gi);
    fixture_render(&s);
    float *color = fixture_read(&s, READ_COLOR), *direct = fixture_read(&s, READ_DIRECT);
    for (size_t i = 0; i < (size_t)3 * s.width * s.height; i++)
        worst = fmax(worst, fabs((double)color[i] / (double)direct[i] - 1.0));
    free(color);
    free(direct);
    baked_fixture_close(&run, &s);
    return worst;
}

TEST_GPU(even_light_stays_with_its_highlights)
{
    const double change = change_by(gpu, 0, 0, SKIN "texels=1024,offsets=100,mm_per_unit=120");
    print_message("change %.4f\n", change);
    CHECK(change <= 0.01);
}

// The plane's own normal would receive 0.78 times as much light.
TEST_GPU(shading_normals_receive_light_that_scatters)
{
    const double change = change_by(gpu, 0, -0.5f, SKIN "texels=1024,offsets=100,mm_per_unit=120");
    print_message("change %.4f\n", change);
    CHECK(change <= 0.01);
}

TEST_GPU(metals_do_not_scatter)
{
    const double change = change_by(gpu, 1, 0, SKIN "texels=1024,offsets=100,mm_per_unit=120");
    print_message("change %.4f\n", change);
    CHECK(change == 0.0);
}

TEST_GPU(radiosity_leaves_direct_light_alone)
{
    CHECK(change_by(gpu, 0, 0, "ort:texels=1024,offsets=100,rays=16") == 0.0);
}
