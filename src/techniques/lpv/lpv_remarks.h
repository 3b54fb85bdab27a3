// What the grid makes of a scene that does not suit it, in sentences for the log. Said once, when
// the technique is created.
#pragma once

#include "core/host.h"
#include "scene/pose.h"

struct lpv_options;

void lpv_remark_on_scene(struct host *host, const char *technique,
                         const struct lpv_options *options, const struct scene_pose *pose);
