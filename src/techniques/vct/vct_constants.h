// Specialization constants of the shaders, for C and GLSL. 0 to 4 are those of
// frame/scene/scene.glsl.
#ifndef AG_VCT_CONSTANTS_H
#define AG_VCT_CONSTANTS_H

#define VCT_CONSTANT_EMISSIVE       5  // voxelize/add.glsl: the draw emits
#define VCT_CONSTANT_COLUMNS        8  // cones/gather.comp: along columns, otherwise rows
#define VCT_CONSTANT_EACH_PIXEL     9  // cones/gather.comp: at full resolution
#define VCT_CONSTANT_ANISOTROPIC    10 // volume/directions.glsl
#define VCT_CONSTANT_HAS_DYNAMIC    11 // volume/prefilter.glsl, rays/ray.glsl: dynamic voxels
#define VCT_CONSTANT_OCCLUSION      12 // volume/directions.glsl: opacity alone (vctao)
#define VCT_CONSTANT_CLIPS          13 // clipmap/clipmap.glsl: levels of the clip map
#define VCT_CONSTANT_SMALL_EMITTERS 14 // voxelize/add.glsl, cones/small_emitters.glsl
#define VCT_CONSTANT_BLOCK          15 // lighting/bounce.comp: texels along a block's side
#define VCT_CONSTANT_HAS_LIGHTS     16 // lighting/inject.comp
#define VCT_CONSTANT_RAYS           17 // rays/ray.glsl: rays instead of cones
#define VCT_CONSTANT_MAP            18 // frame/environment_map.glsl: the environment has a map
#define VCT_CONSTANT_CLAMP          19 // cones/temporal.comp: the history is clamped
#define VCT_CONSTANT_INTERLEAVE     20 // cones/gather.comp: side of a block

#endif
