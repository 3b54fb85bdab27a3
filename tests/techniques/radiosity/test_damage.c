// Damaged bakes of radiosity: each tensor that is missing, of another shape, or out of range is
// refused by name; what cannot be told from a bake is read within its bounds.
#include "techniques/damage_fixture.h"

#include "core/half.h"
#include "core/rng.h"

#include <stdlib.h>
#include <string.h>

#define SMALL "radiosity:texels=2048,rays=64,sources=8"

static void open_subject(struct damage_fixture *u, struct gpu *gpu, const char *text)
{
    struct material m = material_default();
    m.metallic = 0;
    *u = (struct damage_fixture){ 0 };
    fixture_init(&u->s, gpu);
    fixture_box(&u->s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, fixture_material(&u->s, &m));
    fixture_look(&u->s, vec3_of(-1.7f, 2.6f, 1.7f), vec3_of(0.2f, 0.8f, -0.2f));
    damage_open(u, text, 0);
}

TEST_GPU(a_bake_without_a_tensor_or_with_another_shape_is_refused)
{
    struct damage_fixture u;
    open_subject(&u, gpu, SMALL);
    CHECK(damage_loads(&u));
    for (size_t i = 0; i < u.set.count; i++) {
        u.at[i].name = "another";
        CHECK(!damage_loads(&u) && strstr(test_last_message(), u.from->at[i].name));
        damage_restore(&u, i);
        for (int axis = 0; axis < u.at[i].rank; axis++) {
            u.at[i].shape[axis]--;
            CHECK(!damage_loads(&u) && strstr(test_last_message(), u.at[i].name));
            damage_restore(&u, i);
        }
    }
    damage_close(&u);
}

// ---- values

struct damage {
    const char *tensor;
    union {
        uint32_t u32;
        uint16_t u16;
        uint8_t u8;
    } value;
    const char *message;
};

// The first element of the first row, of one within and of the last. Rows of clusters have room for
// clusters of two parts: the first half is in use.
static void check_value(struct damage_fixture *u, const struct damage *d)
{
    const size_t i = damage_index(u, d->tensor), size = tensor_type_bytes(u->at[i].type);
    const int rank = u->at[i].rank;
    const size_t row = rank > 1 ? u->at[i].shape[rank - 1] : 1, rows = u->at[i].bytes / size / row;
    const size_t used = strncmp(d->tensor, "clusters/", 9) == 0 ? rows / 2 : rows;
    const size_t places[] = { 0, used / 2 * row, (used - 1) * row };
    for (size_t k = 0; k < 3; k++) {
        uint8_t *data = damage_own(u, i);
        memcpy(data + places[k] * size, &d->value, size);
        if (damage_loads(u))
            fail_msg("%s: element %zu was changed and it loaded", d->tensor, places[k]);
        if (!strstr(test_last_message(), d->message)) fail_msg("%s", test_last_message());
        damage_restore(u, i);
    }
}

#define BEYOND                                                                                     \
    {                                                                                              \
        .u32 = 1u << 30                                                                            \
    }
#define HALF_2                                                                                     \
    {                                                                                              \
        .u16 = 0x4000                                                                              \
    }
#define HALF_NAN                                                                                   \
    {                                                                                              \
        .u16 = 0x7e00                                                                              \
    }

TEST_GPU(a_bake_with_a_value_out_of_range_is_refused)
{
    static const struct damage damages[] = {
        { "blocks/source", BEYOND, "a source of light is beyond" },
        { "blocks/share", HALF_2, "a form factor is not in 0…2" },
        { "clusters/source", BEYOND, "a source of light is beyond" },
        { "texels/factor", HALF_2, "a form factor is not in 0…2" },
        { "clusters/factor", HALF_2, "a form factor is not in 0…2" },
        { "texels/factor", HALF_NAN, "texels/factor" },
        { "texels/part", { .u8 = 2 }, "part 2 of a texel" },
        { "probes/source", BEYOND, "a probe's source of light is beyond" },
    };
    struct damage_fixture u;
    open_subject(&u, gpu, SMALL);
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) check_value(&u, &damages[i]);
    CHECK(damage_loads(&u));
    damage_close(&u);
}

// ---- anything

// Finite: exponents have one bit less.
static void fill_random(const struct tensor *tensor, uint8_t *data, uint64_t seed)
{
    const size_t size = tensor_type_bytes(tensor->type);
    for (size_t i = 0; i < tensor->bytes; i++) data[i] = (uint8_t)rng_mix(seed + i);
    if (tensor->type != TENSOR_F16 && tensor->type != TENSOR_F32) return;
    for (size_t i = size - 1; i < tensor->bytes; i += size) data[i] &= 0xbf;
}

// A tensor of noise is either refused or read within its bounds: the validation layers, and the
// sanitizer where it is on, say so.
TEST_GPU(a_bake_of_noise_is_read_within_its_bounds)
{
    struct damage_fixture u;
    int accepted = 0, refused = 0;
    open_subject(&u, gpu, SMALL);
    for (size_t i = 0; i < u.set.count; i++) {
        fill_random(&u.at[i], damage_own(&u, i), i << 32);
        ++*(damage_loads(&u) ? &accepted : &refused);
        damage_restore(&u, i);
    }
    print_message("%d tensors of noise were refused, %d not\n", refused, accepted);
    CHECK(refused > 0 && accepted > 0);
    damage_close(&u);
}
