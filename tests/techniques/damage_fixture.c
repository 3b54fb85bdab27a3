#include "techniques/damage_fixture.h"

#include "core/rng.h"

#include <math.h>
#include <string.h>

void damage_open(struct damage_fixture *u, const char *text, int term)
{
    fixture_open(&u->s);
    CHECK(gi_spec_parse(&u->spec, test_host(), text));
    CHECK(gi_bake_all(&u->baked, test_host(), &u->spec, &u->s.pose));
    u->term = term;
    u->from = u->baked.bakes.of_term[term];
    u->at = host_alloc(test_host(), u->from->count, sizeof *u->at);
    assert_non_null(u->at);
    memcpy(u->at, u->from->at, u->from->count * sizeof *u->at);
    u->set = (struct tensors){ .at = u->at, .count = u->from->count };
}

void damage_close(struct damage_fixture *u)
{
    host_free(test_host(), u->at);
    gi_baked_finish(&u->baked);
    gi_spec_finish(&u->spec);
    fixture_finish(&u->s);
}

size_t damage_index(const struct damage_fixture *u, const char *tensor)
{
    for (size_t i = 0; i < u->set.count; i++)
        if (strcmp(u->at[i].name, tensor) == 0) return i;
    fail_msg("the bake lacks %s", tensor);
    return 0;
}

void *damage_own(struct damage_fixture *u, size_t tensor)
{
    struct tensor *of = &u->at[tensor];
    void *data = host_alloc(test_host(), 1, of->bytes);
    assert_non_null(data);
    memcpy(data, of->data, of->bytes);
    of->data = data;
    return data;
}

void damage_restore(struct damage_fixture *u, size_t tensor)
{
    const struct tensor *saved = &u->from->at[tensor];
    if (u->at[tensor].data != saved->data) host_free(test_host(), (void *)u->at[tensor].data);
    u->at[tensor] = *saved;
}

bool damage_loads(struct damage_fixture *u)
{
    struct gi_bakes bakes = u->baked.bakes;
    bakes.of_term[u->term] = &u->set;
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

void damage_check_refused(struct damage_fixture *u, const char *message)
{
    CHECK(!damage_loads(u));
    const char *newline = strchr(test_last_message(), '\n');
    if (!strstr(test_last_message(), message) || newline) fail_msg("%s", test_last_message());
}

void damage_open_room(struct damage_fixture *u, struct gpu *gpu, const char *text)
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

void damage_check_tensors(struct damage_fixture *u)
{
    CHECK(damage_loads(u));
    for (size_t i = 0; i < u->set.count; i++) {
        u->at[i].name = "another";
        damage_check_refused(u, u->from->at[i].name);
        damage_restore(u, i);
        for (int axis = 0; axis < u->at[i].rank; axis++) {
            u->at[i].shape[axis]--;
            damage_check_refused(u, u->at[i].name);
            damage_restore(u, i);
        }
    }
    print_message("%zu tensors\n", u->set.count);
}

void damage_check_finite(struct damage_fixture *u)
{
    int changed = 0;
    for (size_t i = 0; i < u->set.count; i++) {
        const size_t size = tensor_type_bytes(u->at[i].type), middle = u->at[i].bytes / size / 2;
        static const float NOT_FINITE[] = { NAN, INFINITY };
        if (u->at[i].type != TENSOR_F16 && u->at[i].type != TENSOR_F32) continue;
        for (int k = 0; k < 2; k++) {
            void *data = damage_own(u, i);
            if (u->at[i].type == TENSOR_F16)
                ((uint16_t *)data)[middle] = k ? 0x7c00 : 0x7e00;
            else
                ((float *)data)[middle] = NOT_FINITE[k];
            damage_check_refused(u, u->at[i].name);
            damage_restore(u, i);
            changed++;
        }
    }
    print_message("%d tensors with a value that is not finite were refused\n", changed);
    CHECK(changed >= 6);
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

void damage_check_halves(struct damage_fixture *u, const char *tensor)
{
    static uint16_t (*const KINDS[])(uint64_t) = { huge, negative, noise };
    const size_t i = damage_index(u, tensor);
    for (size_t kind = 0; kind < sizeof KINDS / sizeof *KINDS; kind++) {
        uint16_t *data = damage_own(u, i);
        for (size_t k = 0; k < u->at[i].bytes / sizeof *data; k++) data[k] = KINDS[kind](k);
        CHECK(damage_loads(u));
        damage_restore(u, i);
    }
}
