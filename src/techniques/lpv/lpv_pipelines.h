// All compute pipelines.
#pragma once

#include <stdbool.h>

struct lpv;

bool lpv_pipelines_create(struct lpv *lpv);
void lpv_pipelines_destroy(struct lpv *lpv);
