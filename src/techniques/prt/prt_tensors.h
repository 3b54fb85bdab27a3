// The content of a bake. README.md has units and axes.
#pragma once

#include "bake/bake.h"

#include "techniques/common/light_map/tensors.h"
#include "techniques/prt/receivers/receivers.h"
#include "techniques/technique.h"

#define PRT_DIRECT  "transfer/direct"  // F16 [coefficients][texels]
#define PRT_BOUNCE  "transfer/bounce"  // F16 [coefficients][texels][3], interreflected
#define PRT_EMITTED "transfer/emitted" // F32 [texels][3]: bounces of emitted light, interreflected

// With `glossy`:
#define PRT_MATRIX    "glossy/matrix"    // F16 [texels][PRT_OUTGOING][dimension]
#define PRT_NORMAL    "glossy/normal"    // F32 [texels][3]
#define PRT_ROUGHNESS "glossy/roughness" // F32 [texels]

#define PRT_PROBE_MATRIX  "probes/matrix"  // F16 [probes][prt_probe_rows][dimension]
#define PRT_PROBE_EMITTED "probes/emitted" // F32 [probes][prt_probe_rows][3], cd/m²
#define PRT_PROBE_PLACE   "probes/place"   // F32 [probes][4]
#define PRT_PROBE_DEPTH   "probes/depth"   // F16 [probes][9 · 9][2]

// In place of the vectors with compression:
#define PRT_CODEBOOK "compressed/rows"    // F16 [clusters · (1 + vectors)][dimension]
#define PRT_CLUSTER  "compressed/cluster" // U16 [texels]
#define PRT_WEIGHT   "compressed/weight"  // F16 [texels][vectors], if there are vectors
#define PRT_ERROR    "compressed/error" // F32 [2]: Σ |x − x̂|² and Σ |x − mean|² over the texels

// And of the matrices, of PRT_OUTGOING rows each:
#define PRT_GLOSSY_CODEBOOK                                                                        \
    "compressed/glossy_rows"                           // F16 [clusters · (1 + vectors)]
                                                       // [PRT_OUTGOING][dimension]
#define PRT_GLOSSY_CLUSTER "compressed/glossy_cluster" // U16 [texels]
#define PRT_GLOSSY_WEIGHT  "compressed/glossy_weight"  // F16 [texels][vectors]
#define PRT_GLOSSY_ERROR   "compressed/glossy_error"   // F32 [2]

// ---- bake/stages.c
bool prt_bake(struct bake_plan *plan, const struct technique_bake *how);
