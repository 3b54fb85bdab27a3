// Transfer maps for other programs: bins as images of halves, and an index of their pieces.
// docs/techniques/ort.md describes the files.
#pragma once

#include "techniques/ort/bins.h"
#include "techniques/ort/ort_maps.h"

#define ORT_EXPORT_FORMAT "afterglow-ort-bins"
#define ORT_EXPORT_INDEX  "index.json"
#define ORT_EXPORT_BIN    "bin-%03u.exr"
enum { ORT_EXPORT_VERSION = 1 };

struct ort_export {
    struct host *host;
    const char *folder;
    const struct ort_options *options;
    struct ort_map map;
    struct ort_maps maps;
    struct ort_bins bins;
    const float *energy; // ORT_ENERGY
};

// Into an existing folder; the index last. A `bake_export` of struct technique.
bool ort_bake_export(struct host *host, const struct tensors *bake,
                     const struct technique_bake *how, const char *folder);

// ---- export_index.c
bool ort_export_index(const struct ort_export *from);
