// State of a light map, shared by lightmap.c, lightmap_pages.c and lightmap_report.c.
#pragma once

#include "api/bake_state.h"

#include "lightmap/quality/quality.h"
#include "lightmap/write.h"

struct ag_lightmap {
    struct ag_context *context;
    struct ag_scene *scene;
    struct lightmap map;
    struct lightmap_tracing tracing; // while it is made
    struct lightmap_facts facts;
    struct lightmap_noise noise;
    bool no_light;
    char *gi;
    float wanted_density;            // texels per metre; 0: not given
    struct lightmap_record record;   // zero: not by paths
    struct lightmap_quality quality; // zero without ag_lightmap_desc.report
    struct report *report;           // of it; NULL likewise
};

static inline struct ag_context *api_lightmap_context(const struct ag_lightmap *l)
{
    return l ? l->context : NULL;
}

// lightmap_report.c
bool api_lightmap_write_report(struct ag_lightmap *l);

// lightmap_pages.c

// The term of a spec that has a light map; -1: none.
int api_lightmap_term(const struct gi_spec *spec);
// Checks the side of pages. function: the public one.
enum ag_result api_lightmap_check_page(const char *function, struct ag_context *context, int page);
