// The files of a probe volume, which docs/probes.md describes.
#pragma once

#include "cli/session.h"
#include "cli/files/folder.h"

#define PROBES_JSON       "probes.json"
#define PROBES_ATLAS      "probes.exr"
#define PROBES_VISIBILITY "visibility.exr"

// Into the temporary folder.
enum status probe_files_write(struct ag_context *context, const struct ag_probes *probes,
                              const char *gi, const struct folder *folder);
