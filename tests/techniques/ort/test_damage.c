// Damaged bakes of ort: each tensor that is missing or of another shape, and offsets beyond the
// light map, are refused by name; weights of any value are read within their bounds.
#include "techniques/damage_fixture.h"

#define SMALL "ort:texels=512,offsets=60,rays=64"

TEST_GPU(a_bake_without_a_tensor_or_with_another_shape_is_refused)
{
    struct damage_fixture u;
    damage_open_room(&u, gpu, SMALL);
    damage_check_tensors(&u);
    damage_close(&u);
}

TEST_GPU(a_bake_with_an_offset_beyond_the_light_map_is_refused)
{
    static const int32_t BEYOND[] = { 1 << 14, -(1 << 14), INT32_MAX, INT32_MIN };
    struct damage_fixture u;
    damage_open_room(&u, gpu, SMALL);
    const size_t i = damage_index(&u, "offsets");
    const size_t count = u.at[i].bytes / sizeof(int32_t), places[] = { 0, 1, count / 2, count - 1 };
    for (size_t k = 0; k < 16; k++) {
        ((int32_t *)damage_own(&u, i))[places[k / 4]] = BEYOND[k % 4];
        damage_check_refused(&u, "beyond the light map");
        damage_restore(&u, i);
    }
    damage_close(&u);
}

TEST_GPU(a_bake_with_a_value_that_is_not_finite_is_refused)
{
    struct damage_fixture u;
    damage_open_room(&u, gpu, SMALL);
    damage_check_finite(&u);
    damage_close(&u);
}

// The validation layers, and the sanitizer where it is on, report reads beyond bounds.
TEST_GPU(a_bake_of_hostile_weights_draws_within_its_bounds)
{
    static const char *const SPECS[] = { SMALL, SMALL ",order=slices", SMALL ",precision=byte" };
    for (size_t i = 0; i < sizeof SPECS / sizeof *SPECS; i++) {
        struct damage_fixture u;
        damage_open_room(&u, gpu, SPECS[i]);
        damage_check_halves(&u, "maps");
        damage_close(&u);
    }
}
