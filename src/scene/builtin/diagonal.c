// @diagonal: a square floor with an upright area light near one corner that faces the centre, after
// Martin 2012, section 5.2: shows how a grid propagates light along its diagonal. The camera
// `above` faces straight down; the light is in the image's upper left corner, so that the image's
// diagonal is the floor's.
#include "scene/builtin/parts.h"

#include <math.h>

struct diagonal_options {
#define OPTION OPTION_FIELD
#include "diagonal_options.def"
#undef OPTION
};

#define OPTION(...) OPTION_ROW(struct diagonal_options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "diagonal_options.def"
};
#undef OPTION

static bool build_floor(struct scene *scene, float size)
{
    int material = builtin_diffuse(scene, "floor", vec3_of(0.7f, 0.7f, 0.7f));
    if (material < 0) return false;
    struct shape_builder builder;
    shape_begin(&builder, scene);
    float half = 0.5f * size;
    shape_box(&builder, vec3_of(-half, -0.04f * size, -half), vec3_of(half, 0, half));
    return shape_emit(&builder, "floor", material) >= 0;
}

// The light is at 80% of the distance to the corner (-x, -z): a panel with an emissive quad in
// front. Sizes are fractions of the floor's.
static bool build_light(struct scene *scene, float size, float cd_m2)
{
    int dark = builtin_diffuse(scene, "panel", vec3_of(0.1f, 0.1f, 0.1f));
    int emitter = builtin_emitter(scene, "light", vec3_of(cd_m2, cd_m2, cd_m2));
    if (dark < 0 || emitter < 0) return false;
    struct shape_builder builder;
    shape_begin(&builder, scene);
    float at = -0.4f * size, half = 0.1f * size, low = 0.02f * size, high = 0.16f * size;
    float depth = 0.01f * size;
    // The panel's local +z is (1, 0, 1)/√2.
    builder.scene_from_shape = glms_rotate_y(glms_translate_make(vec3_of(at, 0, at)), GLM_PI_4f);
    shape_box(&builder, vec3_of(-half, low, -depth), vec3_of(half, high, 0));
    if (shape_emit(&builder, "panel", dark) < 0) return false;
    float front = 0.001f * size;
    shape_quad(&builder, vec3_of(-half, low, front), vec3_of(half, low, front),
               vec3_of(half, high, front), vec3_of(-half, high, front));
    return shape_emit(&builder, "light", emitter) >= 0;
}

static bool build_diagonal(struct scene *scene, const void *options)
{
    const struct diagonal_options *o = options;
    float size = o->size;
    return build_floor(scene, size) && build_light(scene, size, o->luminance) &&
           builtin_camera(scene, "main", vec3_of(0.85f * size, 0.9f * size, 0.55f * size),
                          vec3_of(-0.03f * size, 0, 0), glm_rad(45.0f)) &&
           builtin_camera(scene, "above", vec3_of(0, 1.25f * size, 0), vec3_of(0, 0, 0),
                          glm_rad(45.0f));
}

const struct builtin_scene builtin_diagonal = {
    .name = "diagonal",
    .title = "a square floor lit along its diagonal by an upright area light",
    .options = OPTION_TABLE(struct diagonal_options, rows, NULL),
    .build = build_diagonal,
};
