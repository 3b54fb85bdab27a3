// Damaged bakes of radiosity: each tensor that is missing, of another shape, or out of range is
// refused by name; what cannot be told from a bake is read within its bounds.
#include "frame/frame_fixture.h"
#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"

#include "core/half.h"
#include "core/rng.h"

#include <stdlib.h>
#include <string.h>

#define SPARSE  "radiosity:texels=2048,rays=64,sources=8"
#define LOWRANK SPARSE ",transfer=lowrank,modes=16"

struct subject {
    struct frame_fixture s;
    struct gi_spec spec;
    struct technique_bake how;
    struct bake *bake;
    struct tensor *at; // a copy of the bake's, whose data may be replaced
    struct tensors set;
};

static void open_subject(struct subject *u, struct gpu *gpu, const char *text)
{
    struct material m = material_default();
    m.metallic = 0;
    fixture_init(&u->s, gpu);
    fixture_box(&u->s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, fixture_material(&u->s, &m));
    fixture_look(&u->s, vec3_of(-1.7f, 2.6f, 1.7f), vec3_of(0.2f, 0.8f, -0.2f));
    fixture_open(&u->s);
    CHECK(gi_spec_parse(&u->spec, test_host(), text));
    u->how = (struct technique_bake){ .pose = &u->s.pose, .options = u->spec.options[0] };
    u->bake = gi_bake_create(test_host(), u->spec.technique[0], &u->how,
                             (struct bake_identity){ .program = "test" });
    CHECK(u->bake && bake_run(u->bake, &(struct bake_run_options){ .threads = 2 }));
    const struct tensors *saved = bake_tensors(u->bake);
    u->at = host_alloc(test_host(), saved->count, sizeof *u->at);
    memcpy(u->at, saved->at, saved->count * sizeof *u->at);
    u->set = (struct tensors){ .at = u->at, .count = saved->count };
}

static void close_subject(struct subject *u)
{
    host_free(test_host(), u->at);
    bake_destroy(u->bake);
    gi_spec_finish(&u->spec);
    fixture_finish(&u->s);
}

// A copy of exactly its size: the sanitizer sees reads beyond it.
static void *own_data(struct tensor *tensor)
{
    void *data = host_alloc(test_host(), 1, tensor->bytes);
    memcpy(data, tensor->data, tensor->bytes);
    tensor->data = data;
    return data;
}

static void give_back(struct subject *u, size_t i)
{
    const struct tensor *saved = &bake_tensors(u->bake)->at[i];
    if (u->at[i].data != saved->data) host_free(test_host(), (void *)u->at[i].data);
    u->at[i] = *saved;
}

// Where it is accepted, light is also computed and looked up.
static bool loads(struct subject *u)
{
    const struct gi_bakes bakes = { { &u->set } };
    test_forget_messages();
    struct gi *gi = gi_create_baked(test_host(), u->s.gpu, &u->spec, &bakes, &u->s.pose, u->s.width,
                                    u->s.height);
    if (!gi) {
        CHECK(test_host()->failure == FAIL_FORMAT);
        return false;
    }
    u->s.indirect = gi_hook(gi);
    fixture_render(&u->s);
    gi_destroy(gi);
    return true;
}

static void check_shapes(struct gpu *gpu, const char *text)
{
    struct subject u;
    open_subject(&u, gpu, text);
    CHECK(loads(&u));
    for (size_t i = 0; i < u.set.count; i++) {
        u.at[i].name = "another";
        CHECK(!loads(&u) && strstr(test_last_message(), bake_tensors(u.bake)->at[i].name));
        give_back(&u, i);
        for (int axis = 0; axis < u.at[i].rank; axis++) {
            u.at[i].shape[axis]--;
            CHECK(!loads(&u) && strstr(test_last_message(), u.at[i].name));
            give_back(&u, i);
        }
    }
    close_subject(&u);
}

TEST_GPU(a_bake_without_a_tensor_or_with_another_shape_is_refused)
{
    check_shapes(gpu, SPARSE);
}

TEST_GPU(a_bake_of_low_rank_without_a_tensor_or_with_another_shape_is_refused)
{
    check_shapes(gpu, LOWRANK);
}

// ---- values

struct damage {
    const char *tensor;
    union {
        uint32_t u32;
        float f32;
        uint16_t u16;
        uint8_t u8;
    } value;
    const char *message;
};

static size_t index_of(const struct subject *u, const char *name)
{
    for (size_t i = 0; i < u->set.count; i++)
        if (strcmp(u->at[i].name, name) == 0) return i;
    fail_msg("the bake lacks %s", name);
    return 0;
}

// The first element of the first row, of one within and of the last. Rows of clusters have room for
// clusters of two parts: the first half is in use.
static void check_value(struct subject *u, const struct damage *d)
{
    const size_t i = index_of(u, d->tensor), size = tensor_type_bytes(u->at[i].type);
    const int rank = u->at[i].rank;
    const size_t row = rank > 1 ? u->at[i].shape[rank - 1] : 1, rows = u->at[i].bytes / size / row;
    const size_t used = strncmp(d->tensor, "clusters/", 9) == 0 ? rows / 2 : rows;
    const size_t places[] = { 0, used / 2 * row, (used - 1) * row };
    for (size_t k = 0; k < 3; k++) {
        uint8_t *data = own_data(&u->at[i]);
        memcpy(data + places[k] * size, &d->value, size);
        if (loads(u)) fail_msg("%s: element %zu was changed and it loaded", d->tensor, places[k]);
        if (!strstr(test_last_message(), d->message)) fail_msg("%s", test_last_message());
        give_back(u, i);
    }
}

static void check_values(struct gpu *gpu, const char *text, const struct damage *damages, size_t n)
{
    struct subject u;
    open_subject(&u, gpu, text);
    for (size_t i = 0; i < n; i++) check_value(&u, &damages[i]);
    CHECK(loads(&u));
    close_subject(&u);
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
#define HALF_INF                                                                                   \
    {                                                                                              \
        .u16 = 0xfc00                                                                              \
    }

TEST_GPU(a_bake_with_a_value_out_of_range_is_refused)
{
    static const struct damage damages[] = {
        { "texels/source", BEYOND, "a source of light is beyond" },
        { "clusters/source", BEYOND, "a source of light is beyond" },
        { "texels/factor", HALF_2, "a form factor is not in 0…2" },
        { "clusters/factor", HALF_2, "a form factor is not in 0…2" },
        { "texels/factor", HALF_NAN, "texels/factor" },
        { "texels/part", { .u8 = 2 }, "part 2 of a texel" },
        { "probes/source", BEYOND, "a probe's source of light is beyond" },
    };
    check_values(gpu, SPARSE, damages, sizeof damages / sizeof *damages);
}

TEST_GPU(a_bake_of_low_rank_with_a_value_out_of_range_is_refused)
{
    static const struct damage damages[] = {
        { "regions/source", BEYOND, "a region's source of light is beyond" },
        { "regions/source", { .u32 = UINT32_MAX }, "a region's source of light is beyond" },
        { "regions/scale", { .u32 = 0x7fc00000 }, "regions/scale" },
        { "regions/scale", { .u32 = 0x7f800000 }, "regions/scale" },
        { "regions/scale", { .f32 = -1e-6f }, "the scale -1e-06 of a mode is not in 0…0.0078" },
        { "regions/scale", { .f32 = 1.0f }, "the scale 1 of a mode is not in 0…0.0078" },
        { "regions/expand", HALF_NAN, "regions/expand" },
        { "regions/expand", HALF_INF, "regions/expand" },
        { "regions/expand", HALF_2, "the irradiance of a mode is not in -2…2" },
        { "regions/expand", { .u16 = 0xc000 }, "the irradiance of a mode is not in -2…2" },
    };
    check_values(gpu, LOWRANK, damages, sizeof damages / sizeof *damages);
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
static void check_noise(struct gpu *gpu, const char *text)
{
    struct subject u;
    int accepted = 0, refused = 0;
    open_subject(&u, gpu, text);
    for (size_t i = 0; i < u.set.count; i++) {
        fill_random(&u.at[i], own_data(&u.at[i]), i << 32);
        ++*(loads(&u) ? &accepted : &refused);
        give_back(&u, i);
    }
    print_message("%d tensors of noise were refused, %d not\n", refused, accepted);
    CHECK(refused > 0 && accepted > 0);
    close_subject(&u);
}

TEST_GPU(a_bake_of_noise_is_read_within_its_bounds)
{
    check_noise(gpu, SPARSE);
}

TEST_GPU(a_bake_of_low_rank_of_noise_is_read_within_its_bounds)
{
    check_noise(gpu, LOWRANK);
}
