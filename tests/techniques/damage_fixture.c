#include "techniques/damage_fixture.h"

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
