// The options of vct and vctao.
#pragma once

#include "core/option.h"
#include "techniques/technique.h"
#include "techniques/vct/cones/cone_sets.h"
#include "techniques/vct/vct_shared.h"
#include "techniques/vct/voxelize/voxelize.h"

enum vct_storage { VCT_MIPS, VCT_SVO }; // choices of the options
enum vct_trace_by { VCT_BY_CONES, VCT_BY_RAYS };
enum vct_specular_by { VCT_SPECULAR_NONE, VCT_SPECULAR_METALS, VCT_SPECULAR_TRACED };

// Options of vct and vctao.
struct vct_options {
#define OPTION       OPTION_FIELD
#define VCT_OPTION   OPTION_FIELD
#define VCTAO_OPTION OPTION_FIELD
#include "techniques/vct/vct_options.def"
#undef VCTAO_OPTION
#undef VCT_OPTION
#undef OPTION
    bool occlusion;        // vctao: cones measure visibility, not light
    int32_t fitted_levels; // with levels=0, by the size of the scene; 0: not known
};

// Chooses fitted_levels: technique.fit.
void vct_fit_options(void *options, float scene_size_m);
// The options of a technique, with fixed values for those that it lacks.
struct vct_options vct_light_options(const void *options);
struct vct_options vct_occlusion_options(const void *options);
// False if options contradict each other or exceed limits of the device.
bool vct_check_options(const char *technique, const struct technique_create *how,
                       const struct vct_options *options);
