// Light that specular lobes reflect, from the cells at a pixel.
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// All light is reflected, in every direction of the viewer: by multiple scattering.
static int white_metal(struct frame_fixture *s, float roughness)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(1, 1, 1), 1);
    m.metallic = 1;
    m.roughness = roughness;
    return fixture_material(s, &m);
}

// Specular light of the pixels that show the object from instance `first` on.
struct lobes {
    double mean, of_irradiance; // radiance, and over E/π
    double worst;               // distance of the latter from 1
};

static struct lobes lobes_of(struct frame_fixture *s, const char *gi, int first)
{
    struct lobes out = { 0 };
    double irradiance = 0;
    int count = 0;
    s->input.want_id_layer = true;
    fixture_open(s);
    struct gi *stack = gi_fixture_light(s, gi);
    fixture_render(s);
    float *specular = fixture_read(s, READ_SPECULAR), *e = fixture_read(s, READ_IRRADIANCE),
          *id = fixture_read(s, READ_ID);
    for (size_t p = 0; p < (size_t)s->width * s->height; p++) {
        if ((int)id[2 * p] < first) continue;
        const double l = (double)specular[3 * p + 1], mean = (double)e[3 * p + 1] / GLM_PI;
        out.mean += l;
        irradiance += mean;
        out.worst = fmax(out.worst, fabs(l / mean - 1));
        count++;
    }
    CHECK(count > 8);
    out.of_irradiance = out.mean / irradiance;
    out.mean /= count;
    free(specular);
    free(e);
    free(id);
    gi_destroy(stack);
    return out;
}

static const char *const techniques[] = { "lpv", "holpv" };
static const float roughnesses[] = { 0.1f, 0.4f, 1 };

// ---- furnaces

TEST_GPU(metal_under_a_sky_has_its_radiance)
{
    for (int i = 0; i < 6; i++) {
        struct frame_fixture s;
        fixture_init(&s, gpu);
        fixture_box(&s, vec3_of(-1, -1, -1), vec3_of(1, 1, 1), false,
                    white_metal(&s, roughnesses[i / 2]));
        fixture_look(&s, vec3_of(2.5f, 2, 3), vec3_of(0, 0, 0));
        s.input.environment.sky = vec3_of(1, 1, 1);
        const struct lobes got = lobes_of(&s, techniques[i % 2], 0);
        print_message("%s: roughness %.1f under a sky of 1 cd/m2: %.3f, of irradiance %.3f\n",
                      techniques[i % 2], (double)roughnesses[i / 2], got.mean, got.of_irradiance);
        CHECK_NEAR(got.mean, 1, 0.05);
        CHECK_NEAR(got.of_irradiance, 1, 0.05);
        fixture_finish(&s);
    }
}

// The cells of a closed room lack some of its light, of which E/π is the mean radiance.
TEST_GPU(metal_in_a_room_of_one_radiance_has_the_mean_of_its_light)
{
    for (int i = 0; i < 6; i++) {
        struct frame_fixture s;
        fixture_init_furnace(&s, gpu, 0.5f, 10);
        const int first = s.scene->instance_count;
        fixture_box(&s, vec3_of(-0.5f, 0.5f, -0.5f), vec3_of(0.5f, 1.5f, 0.5f), false,
                    white_metal(&s, roughnesses[i / 2]));
        const struct lobes got = lobes_of(&s, techniques[i % 2], first);
        print_message("%s: roughness %.1f in a furnace: %.3f of the mean radiance, at most %.3f "
                      "from it\n",
                      techniques[i % 2], (double)roughnesses[i / 2], got.of_irradiance, got.worst);
        CHECK_NEAR(got.of_irradiance, 1, 0.05);
        fixture_finish(&s);
    }
}

// ---- light from one side

// A room with a metal floor, seen from x; a spot lights the wall −x.
static void lit_room(struct frame_fixture *s, struct gpu *gpu, float roughness, float x)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    fixture_box(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true,
                fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f)));
    fixture_quad(s, vec3_of(-1.99f, 0.01f, 1.99f), vec3_of(1.99f, 0.01f, 1.99f),
                 vec3_of(1.99f, 0.01f, -1.99f), vec3_of(-1.99f, 0.01f, -1.99f),
                 white_metal(s, roughness));
    fixture_add_spot(s, vec3_of(0, 1.5f, 0), vec3_of(-1, 0, 0), 0.4f, 0.6f, vec3_of(100, 100, 100));
    fixture_look(s, vec3_of(x, 1, 0), vec3_of(0, 0.01f, 0));
    fixture_open(s);
}

// Radiance that the middle of the floor reflects to the camera.
static double seen_from(struct gpu *gpu, const char *gi, float roughness, float x)
{
    struct frame_fixture s;
    lit_room(&s, gpu, roughness, x);
    struct gi *stack = gi_fixture_light(&s, gi);
    fixture_render(&s);
    const double seen = (double)fixture_pixel(&s, READ_SPECULAR, s.width / 2, s.height / 2).x;
    gi_destroy(stack);
    fixture_finish(&s);
    return seen;
}

// Polished metal has the mean radiance from both sides.
TEST_GPU(metal_reflects_the_side_that_light_comes_from)
{
    for (int i = 0; i < 2; i++) {
        const double towards = seen_from(gpu, techniques[i], 0.4f, 1),
                     away = seen_from(gpu, techniques[i], 0.4f, -1);
        print_message("%s: towards the lit wall %.2f cd/m2, away from it %.2f\n", techniques[i],
                      towards, away);
        CHECK(towards > 1.5 * away && away >= 0);
        const double mean = seen_from(gpu, techniques[i], 0, 1);
        CHECK_RELATIVE(mean, seen_from(gpu, techniques[i], 0, -1), 0.1);
        CHECK(mean > away && mean < towards);
    }
}

// ---- the option

static float *layer_of(struct gpu *gpu, const char *gi, enum frame_readback layer, size_t *bytes)
{
    struct frame_fixture s;
    lit_room(&s, gpu, 0.4f, 1);
    struct gi *stack = gi_fixture_light(&s, gi);
    fixture_render(&s);
    float *out = fixture_read(&s, layer);
    *bytes = 3 * (size_t)s.width * s.height * sizeof *out;
    gi_destroy(stack);
    fixture_finish(&s);
    return out;
}

// Also where cascades blend: the camera's is smaller than the room.
TEST_GPU(irradiance_is_the_same_with_and_without_specular_light)
{
    size_t bytes;
    float *with = layer_of(gpu, "lpv:dim=8,cell=0.2", READ_IRRADIANCE, &bytes);
    float *without = layer_of(gpu, "lpv:dim=8,cell=0.2,specular=false", READ_IRRADIANCE, &bytes);
    CHECK(memcmp(with, without, bytes) == 0);
    free(with);
    free(without);
}

// The camera's cascade ends on the floor.
TEST_GPU(specular_light_has_no_edge_where_cascades_blend)
{
    size_t bytes;
    float *l = layer_of(gpu, "lpv:dim=16,cell=0.125", READ_SPECULAR, &bytes);
    double steepest = 0;
    for (int y = 16; y < 31; y++)
        for (int x = 0; x < 32; x++) {
            const double a = (double)l[3 * (32 * y + x)], b = (double)l[3 * (32 * (y + 1) + x)];
            CHECK(a > 0);
            steepest = fmax(steepest, fabs(a - b) / (a + b));
        }
    print_message("steepest step between pixels: %.3f of their sum\n", steepest);
    CHECK(steepest < 0.05);
    free(l);
}
