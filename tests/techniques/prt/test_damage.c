// Damaged bakes of prt: each tensor that is missing or of another shape is refused by name;
// transfer vectors of any value are drawn.
#include "techniques/damage_fixture.h"

#include "core/half.h"
#include "core/rng.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SMALL "prt:texels=512,rays=64"

// A closed room with a light and an emissive block.
static void open_subject(struct damage_fixture *u, struct gpu *gpu, const char *text)
{
    struct material m = material_default();
    *u = (struct damage_fixture){ 0 };
    m.metallic = 0;
    fixture_init(&u->s, gpu);
    fixture_box(&u->s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, fixture_material(&u->s, &m));
    m.emissive = vec3_of(10, 10, 10);
    fixture_box(&u->s, vec3_of(-0.5f, 0.5f, -0.5f), vec3_of(0.5f, 1, 0.5f), false,
                fixture_material(&u->s, &m));
    fixture_add_point(&u->s, vec3_of(0, 2, 0), vec3_of(100, 100, 100));
    fixture_look(&u->s, vec3_of(-1.7f, 2.6f, 1.7f), vec3_of(0.2f, 0.8f, -0.2f));
    damage_open(u, text, 0);
}

static void check_refused(struct damage_fixture *u, const char *message)
{
    CHECK(!damage_loads(u));
    const char *newline = strchr(test_last_message(), '\n');
    if (!strstr(test_last_message(), message) || newline) fail_msg("%s", test_last_message());
}

static void check_tensors(struct gpu *gpu, const char *text)
{
    struct damage_fixture u;
    open_subject(&u, gpu, text);
    CHECK(damage_loads(&u));
    for (size_t i = 0; i < u.set.count; i++) {
        u.at[i].name = "another";
        check_refused(&u, u.from->at[i].name);
        damage_restore(&u, i);
        for (int axis = 0; axis < u.at[i].rank; axis++) {
            u.at[i].shape[axis]--;
            check_refused(&u, u.at[i].name);
            damage_restore(&u, i);
        }
    }
    print_message("%s: %zu tensors\n", text, u.set.count);
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

// One element of each tensor of floats.
static void check_finite(struct gpu *gpu, const char *text)
{
    struct damage_fixture u;
    int changed = 0;
    open_subject(&u, gpu, text);
    for (size_t i = 0; i < u.set.count; i++) {
        const size_t size = tensor_type_bytes(u.at[i].type), middle = u.at[i].bytes / size / 2;
        static const float NOT_FINITE[] = { NAN, INFINITY };
        if (u.at[i].type != TENSOR_F16 && u.at[i].type != TENSOR_F32) continue;
        for (int k = 0; k < 2; k++) {
            void *data = damage_own(&u, i);
            if (u.at[i].type == TENSOR_F16)
                ((uint16_t *)data)[middle] = k ? 0x7c00 : 0x7e00;
            else
                ((float *)data)[middle] = NOT_FINITE[k];
            check_refused(&u, u.at[i].name);
            damage_restore(&u, i);
            changed++;
        }
    }
    print_message("%d tensors with a value that is not finite were refused\n", changed);
    CHECK(changed >= 6);
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
    open_subject(&u, gpu, SMALL ",compression=cpca,clusters=8");
    CHECK(damage_loads(&u));
    const size_t i = damage_index(&u, "compressed/cluster");
    const size_t count = u.at[i].bytes / sizeof(uint16_t), places[] = { 0, count / 2, count - 1 };
    for (size_t k = 0; k < 3; k++) {
        ((uint16_t *)damage_own(&u, i))[places[k]] = k == 1 ? UINT16_MAX : 8;
        check_refused(&u, "is in cluster");
        damage_restore(&u, i);
    }
    damage_close(&u);
}

static void fill(struct damage_fixture *u, const char *name, uint16_t (*weight)(uint64_t i))
{
    const size_t i = damage_index(u, name);
    uint16_t *data = damage_own(u, i);
    for (size_t k = 0; k < u->at[i].bytes / sizeof *data; k++) data[k] = weight(k);
    CHECK(damage_loads(u));
    damage_restore(u, i);
}

static uint16_t huge(uint64_t i)
{
    return i % 2 ? 0x7bff : 0xfbff; // ±65504
}
static uint16_t negative(uint64_t i)
{
    (void)i;
    return 0xbc00;
}
static uint16_t noise(uint64_t i)
{
    return rng_mix(i) & 0xbfff; // finite
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
        open_subject(&u, gpu, text);
        for (int i = 0; i < 2; i++) {
            fill(&u, NAMES[kind][i], huge);
            fill(&u, NAMES[kind][i], negative);
            fill(&u, NAMES[kind][i], noise);
        }
        damage_close(&u);
    }
}
