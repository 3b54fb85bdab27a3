// Diagnostics of a scene that does not suit the grid, logged once at creation.
#pragma once

#include "core/host.h"
#include "scene/pose.h"

struct lpv_options;

void lpv_diagnose(struct host *host, const char *technique, const struct lpv_options *options,
                  const struct scene_pose *pose);
