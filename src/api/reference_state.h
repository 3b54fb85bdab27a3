// State of a reference, shared by reference.c and reference_bake.c.
#pragma once

#include "api/objects.h"

#include "trace/trace.h"

struct ag_reference {
    struct ag_context *context;
    struct ag_scene *scene;
    struct reference *reference;
    char checkpoint[48];
};

struct reference_options api_reference_options(const struct ag_reference_desc *desc);
// Checks of ag_reference_create and ag_bake_create_reference.
enum ag_result api_reference_check(const char *function, const struct ag_scene *scene,
                                   const struct ag_reference_desc *desc);
// Makes a public reference of one, and owns it. NULL: it could not be made; says so.
enum ag_result api_reference_give(struct ag_scene *scene, struct reference *reference,
                                  struct ag_reference **out);
