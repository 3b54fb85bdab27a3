// A closed room of solid walls, thinner than voxels or not, is dark inside under a bright sky: rays
// of pixels and of voxels find the walls closed where they meet, wherever these are in the voxels.
#include "techniques/trials/light_trial.h"

#include <math.h>
#include <stdio.h>

static const float SUN_LUX = 1000;

struct shell {
    vec3s low, high; // of the room
    float wall_m;
};

// Floor and ceiling reach over the walls; two of the walls end between the others.
static void add_shell(struct frame_fixture *s, const struct shell *h)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(0.75f, 0.75f, 0.75f), 1);
    m.metallic = 0;
    m.roughness = 1;
    m.specular = 0;
    const int walls = fixture_material(s, &m);
    const vec3s a = h->low, b = h->high;
    const float t = h->wall_m;
    fixture_box(s, vec3_of(a.x - t, a.y - t, a.z - t), vec3_of(b.x + t, a.y, b.z + t), false,
                walls);
    fixture_box(s, vec3_of(a.x - t, b.y, a.z - t), vec3_of(b.x + t, b.y + t, b.z + t), false,
                walls);
    fixture_box(s, vec3_of(a.x - t, a.y, a.z - t), vec3_of(a.x, b.y, b.z + t), false, walls);
    fixture_box(s, vec3_of(b.x, a.y, a.z - t), vec3_of(b.x + t, b.y, b.z + t), false, walls);
    fixture_box(s, vec3_of(a.x, a.y, a.z - t), vec3_of(b.x, b.y, a.z), false, walls);
    fixture_box(s, vec3_of(a.x, a.y, b.z), vec3_of(b.x, b.y, b.z + t), false, walls);
}

static double irradiance_inside(struct gpu *gpu, const struct shell *h, int resolution, bool sun)
{
    struct frame_fixture s;
    char gi[96];
    snprintf(gi, sizeof gi, "vct:trace=rays,temporal=true,resolution=%d", resolution);
    fixture_init(&s, gpu);
    s.options.shadow_size = 1024;
    add_shell(&s, h);
    fixture_look(&s, glms_vec3_lerp(h->low, h->high, 0.85f), glms_vec3_lerp(h->low, h->high, 0.3f));
    if (sun)
        fixture_add_sun(&s, vec3_of(0.4f, -1, 0.3f), vec3_of(SUN_LUX, SUN_LUX, SUN_LUX));
    else
        s.input.environment.sky = vec3_of(1, 1, 1);
    const struct trial_irradiance e = trial_technique(&s, gi);
    fixture_finish(&s);
    return e.mean[1] / (sun ? (double)SUN_LUX : GLM_PI);
}

static void check_dark(struct gpu *gpu, bool sun)
{
    const struct shell shells[] = {
        { vec3_of(-3, 0, -2.5f), vec3_of(3, 2.8f, 2.5f), 0.2f },
        { vec3_of(-3.01f, 0, -2.57f), vec3_of(3.03f, 2.8f, 2.53f), 0.05f },
        { vec3_of(-1.83f, 0.11f, -2.21f), vec3_of(2.74f, 2.63f, 1.97f), 0.1f },
    };
    const int resolutions[] = { 16, 32, 64 };
    for (size_t i = 0; i < sizeof shells / sizeof shells[0]; i++)
        for (size_t k = 0; k < sizeof resolutions / sizeof resolutions[0]; k++) {
            const double e = irradiance_inside(gpu, &shells[i], resolutions[k], sun);
            print_message("%s, walls of %.0f cm, %d voxels: %.5f of what is outside\n",
                          sun ? "sun" : "sky", (double)shells[i].wall_m * 100, resolutions[k], e);
            CHECK(e <= 0.002);
        }
}

TEST_GPU(a_closed_room_under_a_sky_is_dark)
{
    check_dark(gpu, false);
}

TEST_GPU(a_closed_room_in_the_sun_is_dark)
{
    check_dark(gpu, true);
}
