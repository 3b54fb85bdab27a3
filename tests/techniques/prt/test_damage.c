// Damaged bakes of prt: each tensor that is missing or of another shape is refused by name;
// transfer vectors of any value are drawn.
#include "techniques/damage_fixture.h"

#include <stdio.h>

#define SMALL "prt:texels=512,rays=64"

static void check_tensors(struct gpu *gpu, const char *text)
{
    struct damage_fixture u;
    damage_open_room(&u, gpu, text);
    print_message("%s: ", text);
    damage_check_tensors(&u);
    damage_close(&u);
}

TEST_GPU(a_bake_without_a_tensor_or_with_another_shape_is_refused)
{
    check_tensors(gpu, SMALL);
    check_tensors(gpu, SMALL ",transfer=shadowed");
    check_tensors(gpu, SMALL ",compression=vq");
    check_tensors(gpu, SMALL ",compression=cpca");
    check_tensors(gpu, SMALL ",glossy=true");
    check_tensors(gpu, SMALL ",glossy=true,compression=cpca,clusters=4");
    check_tensors(gpu, SMALL ",at=vertex");
    check_tensors(gpu, SMALL ",at=vertex,transfer=shadowed");
    check_tensors(gpu, SMALL ",at=vertex,compression=cpca");
}

static void check_finite(struct gpu *gpu, const char *text)
{
    struct damage_fixture u;
    damage_open_room(&u, gpu, text);
    damage_check_finite(&u);
    damage_close(&u);
}

TEST_GPU(a_bake_with_a_value_that_is_not_finite_is_refused)
{
    check_finite(gpu, SMALL);
    check_finite(gpu, SMALL ",at=vertex");
}

TEST_GPU(a_bake_with_a_cluster_that_it_has_not_is_refused)
{
    struct damage_fixture u;
    damage_open_room(&u, gpu, SMALL ",compression=cpca,clusters=8");
    CHECK(damage_loads(&u));
    const size_t i = damage_index(&u, "compressed/cluster");
    const size_t count = u.at[i].bytes / sizeof(uint16_t), places[] = { 0, count / 2, count - 1 };
    for (size_t k = 0; k < 3; k++) {
        ((uint16_t *)damage_own(&u, i))[places[k]] = k == 1 ? UINT16_MAX : 8;
        damage_check_refused(&u, "is in cluster");
        damage_restore(&u, i);
    }
    damage_close(&u);
}

// The validation layers, and the sanitizer where it is on, report reads beyond bounds.
TEST_GPU(a_bake_of_hostile_vectors_draws)
{
    static const char *const MORE[] = { "", ",compression=cpca", ",glossy=true" };
    static const char *const NAMES[3][2] = { { "transfer/direct", "transfer/bounce" },
                                             { "compressed/rows", "compressed/weight" },
                                             { "glossy/matrix", "probes/matrix" } };
    for (int kind = 0; kind < 3; kind++) {
        struct damage_fixture u;
        char text[64];
        snprintf(text, sizeof text, SMALL "%s", MORE[kind]);
        damage_open_room(&u, gpu, text);
        for (int i = 0; i < 2; i++) damage_check_halves(&u, NAMES[kind][i]);
        damage_close(&u);
    }
}
