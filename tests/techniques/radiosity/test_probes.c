// Probes of radiosity: what moves is not in the bake, and is lit by them.
#include "frame/frame_fixture.h"
#include "techniques/baked_fixture.h"
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#include <string.h>

#define SMALL "radiosity:texels=4096,rays=128,sources=24"

static int gray(struct frame_fixture *s, float albedo, float emission)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(albedo, albedo, albedo), 1);
    m.emissive = vec3_of(emission, emission, emission);
    m.metallic = 0;
    m.roughness = 1;
    m.specular = 0;
    return fixture_material(s, &m);
}

static struct bake *bake_of(struct frame_fixture *s, struct gi_spec *spec)
{
    CHECK(gi_spec_parse(spec, test_host(), SMALL));
    const struct technique_bake how = { .pose = &s->pose, .options = spec->options[0] };
    struct bake *bake = gi_bake_create(test_host(), spec->technique[0], &how,
                                       (struct bake_identity){ .program = "test" });
    assert_non_null(bake);
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 2 }));
    return bake;
}

static void room(struct frame_fixture *s, struct gpu *gpu, float albedo, float emission)
{
    fixture_init(s, gpu);
    fixture_box(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, gray(s, albedo, emission));
    fixture_look(s, vec3_of(-1.7f, 2.6f, 1.7f), vec3_of(0.2f, 0.8f, -0.2f));
}

TEST_GPU(a_movable_object_changes_no_byte_of_the_bake)
{
    struct frame_fixture s[2];
    struct gi_spec spec[2];
    struct bake *bake[2];
    char key[2][HASH128_TEXT];
    for (int i = 0; i < 2; i++) {
        room(&s[i], gpu, 0.5f, 10);
        if (i == 1) trial_add_movable_box(&s[i], vec3_of(0, 1, 0), 1, gray(&s[i], 0.2f, 30));
        fixture_open(&s[i]);
        bake[i] = bake_of(&s[i], &spec[i]);
        bake_key(bake[i], key[i]);
    }
    assert_string_equal(key[0], key[1]);
    const struct tensors *a = bake_tensors(bake[0]), *b = bake_tensors(bake[1]);
    CHECK(a->count == b->count);
    for (size_t i = 0; i < a->count; i++) {
        CHECK(a->at[i].bytes == b->at[i].bytes);
        assert_memory_equal(a->at[i].data, b->at[i].data, a->at[i].bytes);
    }
    for (int i = 0; i < 2; i++) {
        bake_destroy(bake[i]);
        gi_spec_finish(&spec[i]);
        fixture_finish(&s[i]);
    }
}

// Radiance is the same from everywhere: bands above 0 are noise of the rays.
TEST_GPU(an_object_in_a_furnace_has_the_walls_irradiance)
{
    struct frame_fixture s;
    struct baked_fixture run;
    room(&s, gpu, 0.5f, 10);
    const int object =
        trial_add_movable_box(&s, vec3_of(0.2f, 0.8f, -0.2f), 1.2f, gray(&s, 0.5f, 0));
    baked_fixture_open(&run, &s, "radiosity:texels=4096");
    const double expected = GLM_PI * 10 / (1 - 0.5);
    const struct trial_irradiance e = trial_object_irradiance(&s, object);
    print_message("object in a furnace: %.4f to %.4f of L/(1 - albedo)\n", e.least / expected,
                  e.most / expected);
    CHECK(e.least > 0.99 * expected && e.most < 1.01 * expected);
    baked_fixture_close(&run, &s);
}
