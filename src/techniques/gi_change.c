// Changes of a running GI stack: options in place, and other techniques.
#include "techniques/gi_state.h"

#include "techniques/gi_spec.h"

// Whether a running technique can take these options: set_options knows LIVE and INVALIDATE.
static bool may_continue(const struct technique *technique, const void *now, const void *next)
{
    const int effect = option_difference(&technique->options, now, next);
    return effect < 0 || (effect <= INVALIDATE && technique->set_options);
}

static void set_options(const struct technique *technique, void *state, void *now, const void *next)
{
    const int effect = option_difference(&technique->options, now, next);
    if (effect < 0) return;
    option_copy_live(&technique->options, next, now);
    technique->set_options(state, now);
    if (effect == INVALIDATE && technique->invalidate)
        technique->invalidate(state, CHANGED_OPTIONS);
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

bool gi_set_options(struct gi *gi, const struct gi_spec *spec)
{
    if (spec->count != gi->spec.count) return false;
    for (int i = 0; i < spec->count; i++)
        if (gi_continues(gi, spec, i) != i) return false;
    for (int i = 0; i < spec->count; i++)
        set_options(gi->spec.technique[i], gi->state[i], gi->spec.options[i], spec->options[i]);
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

// Takes over `next` and `created`: the states of the terms that do not continue.
static void exchange(struct gi *gi, struct gi_spec *next, void *const created[GI_MAX_TERMS])
{
    struct gi before = *gi;
    gi->spec = *next;
    for (int i = 0; i < next->count; i++) {
        const int from = gi_continues(&before, next, i);
        gi->state[i] = created[i];
        if (from < 0) continue;
        gi->state[i] = before.state[from];
        before.state[from] = NULL;
        set_options(next->technique[i], gi->state[i], before.spec.options[from], next->options[i]);
    }
    if (gi->debug_name) move_debug_view(gi, before.spec.technique[before.debug_term]);
    for (int i = 0; i < before.spec.count; i++)
        gi_destroy_state(gi, before.spec.technique[i], before.state[i]);
    gi_spec_finish(&before.spec);
}

bool gi_change(struct gi *gi, const struct gi_spec *spec, const struct gi_bakes *bakes,
               const struct scene_pose *pose)
{
    struct gi_spec next;
    void *created[GI_MAX_TERMS] = { NULL };
    if (gi_set_options(gi, spec)) return true;
    if (!gi_spec_copy(&next, spec)) return false;
    for (int i = 0; i < next.count; i++)
        if (gi_continues(gi, &next, i) < 0 &&
            !gi_create_state(gi, next.technique[i], next.options[i], bakes->of_term[i], pose,
                             &created[i]))
            goto fail;
    exchange(gi, &next, created);
    return true;
fail:
    for (int i = 0; i < next.count; i++) gi_destroy_state(gi, next.technique[i], created[i]);
    gi_spec_finish(&next);
    return false;
}
