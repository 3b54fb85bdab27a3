// Probes of radiosity: what moves is not in the bake, and is lit by them.
#include "frame/frame_fixture.h"
#include "techniques/bake_bytes.h"
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#include <string.h>

#define SMALL "radiosity:texels=4096,rays=128,sources=24"

static struct bake *bake_of(const struct frame_fixture *s)
{
    struct bake *bake = bake_of_gi(SMALL, &s->pose, 0);
    assert_non_null(bake);
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 2 }));
    return bake;
}

TEST_GPU(a_movable_object_changes_no_byte_of_the_bake)
{
    struct frame_fixture s[2];
    struct bake *bake[2];
    char key[2][HASH128_TEXT];
    for (int i = 0; i < 2; i++) {
        fixture_init_furnace(&s[i], gpu, 0.5f, 10);
        if (i == 1)
            trial_add_movable_box(&s[i], vec3_of(0, 1, 0), 1, fixture_emissive(&s[i], 0.2f, 30));
        fixture_open(&s[i]);
        bake[i] = bake_of(&s[i]);
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
        fixture_finish(&s[i]);
    }
}

// Radiance is the same from everywhere: bands above 0 are noise of the rays.
TEST_GPU(an_object_in_a_furnace_has_the_walls_irradiance)
{
    trial_object_in_furnace(gpu, "radiosity:texels=4096");
}
