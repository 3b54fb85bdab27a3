// Bakes of the techniques in a GI spec.
#pragma once

#include "bake/bake.h"
#include "techniques/gi.h"

// How many techniques of the spec bake; *term is that of the index-th one, -1 past the last.
int gi_spec_bakes(const struct gi_spec *spec, int index, int *term);
// The technique in a bake's identity: another one where both have the same bake.
const char *gi_bake_name(const struct technique *technique);
// The options that are part of a bake's identity, "a=1,b=2": those of effect REBAKE. Owned by the
// caller.
char *gi_bake_options(struct host *host, const struct technique *technique, const void *options);
// Replaces options that leave a choice to the scene.
bool gi_bake_resolve(struct host *host, const struct technique *technique,
                     const struct scene_pose *pose, void *options);
// A bake with the stages of the technique for its resolved options; nothing has run. how->pose
// outlives the bake. identity: its seed and texts; technique, version and options are set here.
struct bake *gi_bake_create(struct host *host, const struct technique *technique,
                            const struct technique_bake *how, struct bake_identity identity);
