// Pipelines for the options.
#pragma once

#include <stdbool.h>

struct vct;

bool vct_create_pipelines(struct vct *vct);
void vct_destroy_pipelines(struct vct *vct); // accepts any half-built state
