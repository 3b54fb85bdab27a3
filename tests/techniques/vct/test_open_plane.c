// An open plane of any orientation and position gets the whole sky and none of its own light.
#include "techniques/trials/light_trial.h"

#include <math.h>

static const float HALF_M = 3, SUN_LUX = 1000;

struct plane {
    vec3s normal;
    float height_m; // along the normal
    bool double_sided;
};

static vec3s grey(float value)
{
    return vec3_of(value, value, value);
}

static int material_of(struct frame_fixture *s, bool double_sided)
{
    struct material m = material_default();
    m.base_color = vec4_of(grey(0.7f), 1);
    m.metallic = 0;
    m.roughness = 1;
    m.specular = 0;
    m.double_sided = double_sided;
    return fixture_material(s, &m);
}

// A camera above the middle of the plane sees it alone.
static void make_scene(struct frame_fixture *s, struct gpu *gpu, const struct plane *plane)
{
    const vec3s n = glms_vec3_normalize(plane->normal);
    const vec3s u =
        glms_vec3_scale(glms_vec3_normalize(glms_vec3_cross(vec3_of(0.3f, 0.2f, 1), n)), HALF_M);
    const vec3s v = glms_vec3_cross(n, u), middle = glms_vec3_scale(n, plane->height_m);
    const vec3s a = glms_vec3_add(u, v), b = glms_vec3_sub(v, u);
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    fixture_quad(s, glms_vec3_sub(middle, a), glms_vec3_sub(middle, b), glms_vec3_add(middle, a),
                 glms_vec3_add(middle, b), material_of(s, plane->double_sided));
    fixture_look(s, glms_vec3_muladds(n, 4, middle), middle);
}

static struct trial_irradiance irradiance(struct gpu *gpu, const struct plane *plane, bool sun,
                                          const char *gi)
{
    struct frame_fixture s;
    make_scene(&s, gpu, plane);
    if (sun)
        fixture_add_sun(&s, vec3_of(0.1f, -1, 0.2f), grey(SUN_LUX));
    else
        s.input.environment.sky = grey(1);
    const struct trial_irradiance e = trial_technique(&s, gi);
    fixture_finish(&s);
    return e;
}

// A cube's faces, edges and corners, and slopes between them.
static const float NORMALS[][3] = { { 0, 1, 0 },       { 1, 1, 0 },       { 1, 1, 1 },
                                    { 0.1f, 1, 0 },    { 0.5f, 1, 0 },    { 0.3f, 1, 0.2f },
                                    { 0.6f, 1, 0.9f }, { 1, 0.4f, 0.1f }, { 0, 1, -0.36f } };
enum { NORMAL_COUNT = sizeof NORMALS / sizeof NORMALS[0], HEIGHTS = 3 };

static void check_planes(struct gpu *gpu, const char *gi, bool sun, double least, double most)
{
    const double whole = sun ? (double)SUN_LUX : GLM_PI;
    for (int i = 0; i < NORMAL_COUNT * HEIGHTS * 2; i += 5) {
        const float *n = NORMALS[i / 2 / HEIGHTS];
        // Heights in steps of a fraction of a texel, 0.2 m with 64 voxels.
        const struct plane plane = { vec3_of(n[0], n[1], n[2]), 0.07f * (float)(i / 2 % HEIGHTS),
                                     i % 2 };
        const struct trial_irradiance e = irradiance(gpu, &plane, sun, gi);
        print_message("%s: normal %.1f %.1f %.1f, height %.2f m, %s: %.4f, %.4f to %.4f\n", gi,
                      (double)n[0], (double)n[1], (double)n[2], (double)plane.height_m,
                      plane.double_sided ? "double-sided" : "single-sided", e.mean[1] / whole,
                      e.least / whole, e.most / whole);
        CHECK(e.mean[1] / whole >= least && e.mean[1] / whole <= most);
    }
}

TEST_GPU(an_open_plane_gets_the_whole_sky)
{
    check_planes(gpu, "vct", false, 0.98, 1.01);
}

TEST_GPU(an_open_plane_gets_nothing_of_its_own_light)
{
    check_planes(gpu, "vct", true, 0, 0.01);
}
