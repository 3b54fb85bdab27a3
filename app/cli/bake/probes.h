// afterglow bake --probes: irradiance probes of a scene, as files.
#pragma once

#include "cli/session.h"

// Checks options, loads the scene, renders and writes the folder.
enum status probes_bake(const struct arguments *arguments);
