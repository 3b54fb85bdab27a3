// Changes of a running GI stack: options in place, and other techniques.
#include "techniques/gi_state.h"

#include "techniques/gi_spec.h"

#include <string.h>

// Whether a running technique can take these options.
static bool may_continue(const struct technique *technique, const void *now, const void *next)
{
    return option_difference(&technique->options, now, next) <= INVALIDATE;
}

static void apply_options(const struct technique *technique, void *state, const void *options)
{
    if (state) technique_set_options(technique, state, options);
}

// Sets the options of a running term in all views.
static void set_options(struct gi *gi, int term, void *now, const void *next)
{
    const struct technique *technique = gi->spec.technique[term];
    if (option_difference(&technique->options, now, next) < 0) return;
    option_copy_live(&technique->options, next, now);
    apply_options(technique, gi->state[term], now);
    for (int v = 1; v < FRAME_MAX_VIEWS; v++)
        apply_options(technique, gi->views[v].state[term], now);
}

int gi_continues(const struct gi *gi, const struct gi_spec *spec, int term)
{
    for (int i = 0; i < gi->spec.count; i++) {
        const struct technique *technique = gi->spec.technique[i];
        if (technique == spec->technique[term])
            return may_continue(technique, gi->spec.options[i], spec->options[term]) ? i : -1;
    }
    return -1;
}

bool gi_lacks_bake(const struct gi *gi, int term)
{
    const struct technique *technique = gi->spec.technique[term];
    return technique->lacks_bake && technique->lacks_bake(gi->state[term]);
}

// The running term that stays; -1: it is created.
static int stays(const struct gi *gi, const struct gi_spec *next, const struct gi_bakes *bakes,
                 int term)
{
    const int from = gi_continues(gi, next, term);
    return from >= 0 && bakes->of_term[term] && gi_lacks_bake(gi, from) ? -1 : from;
}

static bool all_stay(const struct gi *gi, const struct gi_spec *next, const struct gi_bakes *bakes)
{
    for (int i = 0; i < next->count; i++)
        if (stays(gi, next, bakes, i) < 0) return false;
    return true;
}

bool gi_set_options(struct gi *gi, const struct gi_spec *spec)
{
    if (spec->count != gi->spec.count) return false;
    for (int i = 0; i < spec->count; i++)
        if (gi_continues(gi, spec, i) != i) return false;
    for (int i = 0; i < spec->count; i++) set_options(gi, i, gi->spec.options[i], spec->options[i]);
    return true;
}

// The debug view follows its technique, and ends with it.
static void move_debug_view(struct gi *gi, const struct technique *technique)
{
    for (int i = 0; gi->debug_name && i < gi->spec.count; i++) {
        if (gi->spec.technique[i] != technique) continue;
        gi->debug_term = i;
        return;
    }
    gi_set_debug_view(gi, NULL);
}

// States by view, of the terms that do not continue.
struct created {
    void *state[FRAME_MAX_VIEWS][GI_MAX_TERMS];
};

static void **state_of(struct gi *gi, int view, int term)
{
    return view ? &gi->views[view].state[term] : &gi->state[term];
}

// A term that stays keeps what was chosen for it beside the rows of the table.
static void keep_options(struct gi *gi, int term, void *now, void *next)
{
    set_options(gi, term, now, next);
    const size_t size = gi->spec.technique[term]->options.size;
    if (size > 0) memcpy(next, now, size);
}

// Takes over `next` and `created`.
static void exchange(struct gi *gi, struct gi_spec *next, const struct gi_bakes *bakes,
                     const struct created *created)
{
    struct gi before = *gi;
    gi->spec = *next;
    for (int i = 0; i < next->count; i++) {
        const int from = stays(&before, next, bakes, i);
        for (int v = 0; v < FRAME_MAX_VIEWS; v++) {
            *state_of(gi, v, i) = from < 0 ? created->state[v][i] : *state_of(&before, v, from);
            if (from >= 0) *state_of(&before, v, from) = NULL;
        }
        if (from >= 0) keep_options(gi, i, before.spec.options[from], next->options[i]);
    }
    for (int v = 0; v < FRAME_MAX_VIEWS; v++)
        for (int i = next->count; i < GI_MAX_TERMS; i++) *state_of(gi, v, i) = NULL;
    if (gi->debug_name) move_debug_view(gi, before.spec.technique[before.debug_term]);
    for (int i = 0; i < before.spec.count; i++)
        for (int v = 0; v < FRAME_MAX_VIEWS; v++)
            gi_destroy_state(gi, before.spec.technique[i], before.spec.options[i],
                             *state_of(&before, v, i));
    gi_spec_finish(&before.spec);
}

static bool create_term(const struct gi *gi, const struct gi_spec *next, int term,
                        const struct tensors *bake, const struct scene_pose *pose,
                        struct created *created)
{
    const struct technique *technique = next->technique[term];
    for (int v = 0; v < FRAME_MAX_VIEWS; v++) {
        const bool wanted = v == 0 || (gi->views[v].width > 0 && gi_is_per_view(technique));
        if (wanted && !gi_create_state(gi, technique, next->options[term], bake, pose, v,
                                       &created->state[v][term]))
            return false;
    }
    return true;
}

static void destroy_created(const struct gi *gi, const struct gi_spec *next,
                            const struct created *created)
{
    for (int i = 0; i < next->count; i++)
        for (int v = 0; v < FRAME_MAX_VIEWS; v++)
            gi_destroy_state(gi, next->technique[i], next->options[i], created->state[v][i]);
}

bool gi_change(struct gi *gi, const struct gi_spec *spec, const struct gi_bakes *bakes,
               const struct scene_pose *pose)
{
    struct gi_spec next;
    struct created created = { { { NULL } } };
    if (all_stay(gi, spec, bakes) && gi_set_options(gi, spec)) return true;
    if (!gi_spec_copy(&next, spec)) return false;
    gi_spec_fit_pose(&next, pose);
    for (int i = 0; i < next.count; i++)
        if (stays(gi, &next, bakes, i) < 0 &&
            !create_term(gi, &next, i, bakes->of_term[i], pose, &created))
            goto fail;
    exchange(gi, &next, bakes, &created);
    return true;
fail:
    destroy_created(gi, &next, &created);
    gi_spec_finish(&next);
    return false;
}
