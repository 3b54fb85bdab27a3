// Painted light of a GI stack.
#include "techniques/gi_state.h"

#include "techniques/registry.h"

enum { LIST_SIZE = 256 };

static int find_term(const struct gi *gi)
{
    for (int i = 0; i < gi->spec.count; i++)
        if (gi->spec.technique[i]->paint) return i;
    return -1;
}

static bool takes_paint(const struct technique *technique)
{
    return technique->paint != NULL;
}

static bool fail_paint(const struct gi *gi)
{
    char list[LIST_SIZE];
    technique_list(takes_paint, list, sizeof list);
    return host_fail(gi->host, FAIL_ARGUMENT,
                     "painted light: no technique of the GI stack takes it; these do: %s", list);
}

bool gi_paint(struct gi *gi, const struct light_map_area *area)
{
    const int term = find_term(gi);
    if (term < 0) return fail_paint(gi);
    const struct technique *technique = gi->spec.technique[term];
    gpu_owner_push(gi->gpu, technique->name);
    const bool ok = light_map_paint_set(technique->paint(gi->state[term]), area);
    gpu_owner_pop(gi->gpu);
    return ok;
}

float gi_painted(const struct gi *gi)
{
    const int term = find_term(gi);
    return term < 0 ? 0.0f : gi->spec.technique[term]->paint(gi->state[term])->most;
}
