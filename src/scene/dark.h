// Scenes that need default lighting.
#pragma once

#include "scene/pose.h"

// Whether the scene has no punctual light, no sky, and no emission that lights it: its emitters are
// dimmer than a luminaire, and their mean illuminance is below moonlight.
bool pose_is_dark(const struct scene_pose *pose);
