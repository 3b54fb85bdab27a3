// Materials of files and their closed forms: purely diffuse rooms, unlit surfaces, range of lights.
#include "trace/trace_fixture.h"

#include <math.h>
#include <stdio.h>

static const double PI = 3.14159265358979323846;

// A closed box that emits 1 cd/m², seen from within. The faces look inwards.
static const char box[] = "mtllib room.mtl\nusemtl wall\n"
                          "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
                          "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                          "f 1 2 3 4\nf 6 5 8 7\nf 5 1 4 8\nf 2 6 7 3\nf 5 6 2 1\nf 4 3 7 8\n";

static void write_text(const char *name, const char *text)
{
    FILE *file = fopen(test_path(name), "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static double mean_of_room(const char *specular)
{
    char mtl[128];
    snprintf(mtl, sizeof mtl, "newmtl wall\nKd 0.5 0.5 0.5\nKe 1 1 1\n%s", specular);
    write_text("room.mtl", mtl);
    write_text("room.obj", box);
    struct trace_fixture s = { .width = 16, .height = 16, .samples = 256 };
    s.options = reference_options_default();
    s.scene = scene_load(test_host(), test_path("room.obj"));
    if (!s.scene) fail_msg("%s", test_last_message());
    fixture_aim_camera(&s, vec3_of(0.2f, 0.1f, 0.3f), vec3_of(-1, -0.7f, -0.4f), 1.2f);
    double mean = fixture_mean(&s, REFERENCE_COLOR).mean[1];
    fixture_finish(&s);
    return mean;
}

// A uniformly emitting closed room of albedo ρ has the radiance Le/(1 − ρ) everywhere.
TEST(an_obj_room_without_specular_is_lambertian)
{
    CHECK_RELATIVE(mean_of_room("Ks 0 0 0\nillum 2\n"), 2, 0.005);
    CHECK_RELATIVE(mean_of_room("Ks 0.5 0.5 0.5\nillum 1\n"), 2, 0.005);
    CHECK(mean_of_room("Ks 0.5 0.5 0.5\nillum 2\n") > 2.03);
}

static vec3s grey(float v)
{
    return vec3_of(v, v, v);
}

static void add_floor(struct trace_fixture *s, int material)
{
    fixture_quad(s, vec3_of(-5, 0, 5), vec3_of(5, 0, 5), vec3_of(5, 0, -5), vec3_of(-5, 0, -5),
                 material);
}

// KHR_lights_punctual: I/d² · max(min(1 − (d/range)⁴, 1), 0).
TEST(range_ends_the_light_of_points_and_spots)
{
    static const double ranges[] = { 1.5, 2.5, 10 };
    for (int i = 0; i < 6; i++) {
        struct trace_fixture s;
        fixture_init(&s);
        s.samples = 1;
        add_floor(&s, fixture_diffuse(&s, grey(1), grey(0)));
        fixture_light(&s, i % 2 ? LIGHT_SPOT : LIGHT_POINT, vec3_of(0, 2, 0), vec3_of(0, -1, 0),
                      grey(100));
        double range = ranges[i / 2], window = fmax(1 - pow(2 / range, 4), 0);
        s.scene->lights[0].range_m = (float)range;
        fixture_aim_camera(&s, vec3_of(0.3f, 0.2f, 0.1f), vec3_of(0, 0, 0), 0.01f);
        CHECK_NEAR(fixture_mean(&s, REFERENCE_DIRECT).mean[1] * PI, 25 * window, 0.01);
        fixture_finish(&s);
    }
}

static int unlit_material(struct trace_fixture *s, vec3s color)
{
    struct material m = material_default();
    m.base_color = vec4_of(color, 1);
    m.emissive = grey(50);
    m.unlit = true;
    return fixture_material(s, &m);
}

// White is shown as a white diffuse surface under the sun.
TEST(unlit_surfaces_show_their_color_and_light_nothing)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.samples = 16;
    s.options.diffuse_only = false;
    add_floor(&s, unlit_material(&s, vec3_of(0.2f, 0.4f, 0.8f)));
    fixture_light(&s, LIGHT_SUN, vec3_of(0, 1, 0), vec3_of(1, -1, 0), grey(314.159265f));
    fixture_aim_camera(&s, vec3_of(0, 2, 0.1f), vec3_of(0, 0, 0), 0.5f);
    struct layer_mean m = fixture_mean(&s, REFERENCE_COLOR);
    CHECK_RELATIVE(m.mean[0], 20, 1e-5);
    CHECK_RELATIVE(m.mean[2], 80, 1e-5);
    CHECK_NEAR(fixture_mean(&s, REFERENCE_INDIRECT).mean[1], 0, 0);
    CHECK_RELATIVE(fixture_mean(&s, REFERENCE_ALBEDO).mean[1], 0.4, 1e-6);
    fixture_finish(&s);
}

// A white floor in a closed unlit room, which occludes the sun.
TEST(unlit_surfaces_occlude)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.samples = 16;
    fixture_room(&s, 4, unlit_material(&s, grey(1)));
    fixture_quad(&s, vec3_of(-1, 0, 1), vec3_of(1, 0, 1), vec3_of(1, 0, -1), vec3_of(-1, 0, -1),
                 fixture_diffuse(&s, grey(1), grey(0)));
    fixture_light(&s, LIGHT_SUN, vec3_of(0, 1, 0), vec3_of(0.1f, -1, 0), grey(1000));
    s.scene->environment.sky = grey(10);
    fixture_aim_camera(&s, vec3_of(0, 1, 0.1f), vec3_of(0, 0, 0), 0.3f);
    CHECK_NEAR(fixture_mean(&s, REFERENCE_COLOR).mean[1], 0, 0);
    fixture_finish(&s);
}
