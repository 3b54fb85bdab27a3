#include "scene/builtin/movable_objects.h"

#include "scene/builtin/parts.h"

#include <math.h>

// The first six stand apart on the floor of @cornell, the others float.
static const struct movable_object CORNELL[] = {
    { { { -0.2f, 0.95f, 0.4f } }, 0.7f, 1.9f, 0.35f, 2, { { 0.2f, 0.35f, 0.8f } } },
    { { { -1.8f, 0.6f, 1.3f } }, 0.6f, 1.2f, 0, 0, { { 0.8f, 0.6f, 0.15f } } },
    { { { 1.7f, 0.85f, -0.7f } }, 0.55f, 1.7f, -0.5f, 1.5f, { { 0.7f, 0.7f, 0.7f } } },
    { { { -1.6f, 0.8f, -1.5f } }, 0.75f, 0, 0, 0, { { 0.75f, 0.3f, 0.6f } } },
    { { { 1.5f, 0.5f, 1.6f } }, 0.5f, 1, 0.25f, 3, { { 0.25f, 0.7f, 0.7f } } },
    { { { 0.5f, 0.7f, -1.9f } }, 0.6f, 1.4f, 0.6f, 1, { { 0.85f, 0.45f, 0.3f } } },
    { { { -1.2f, 2.6f, 0.1f } }, 0.6f, 0, 0, 0, { { 0.3f, 0.75f, 0.3f } } },
    { { { 1.4f, 2.9f, 0.3f } }, 0.5f, 1, 0, 0, { { 0.75f, 0.75f, 0.4f } } },
    { { { 0.2f, 3.4f, -1.5f } }, 0.55f, 1.3f, -0.35f, 2, { { 0.55f, 0.3f, 0.75f } } },
    { { { -1.9f, 3.7f, -1.3f } }, 0.45f, 0.9f, 0.5f, 4, { { 0.8f, 0.8f, 0.8f } } },
};

enum { RINGS = 27, SEGMENTS = 29, KNOT_RINGS = 62, KNOT_SEGMENTS = 12 };

static void add_solid(struct shape_builder *builder, const struct movable_object *object)
{
    vec2s profile[RINGS + 1];
    for (int i = 0; i <= RINGS; i++) {
        const float t = (float)i / RINGS;
        const float shape = 1.0f + object->wave * sinf(2.0f * GLM_PIf * object->cycles * t);
        const float most = 1.0f + fabsf(object->wave);
        const float radius = object->radius * sinf(GLM_PIf * t) * shape / most;
        profile[i] = (vec2s){ { i == 0 || i == RINGS ? 0.0f : radius, object->height * t } };
    }
    vec3s base = object->centre;
    base.y -= 0.5f * object->height;
    shape_lathe(builder, base, profile, RINGS + 1, SEGMENTS);
}

// A trefoil knot, within 1.
static vec3s knot(float t)
{
    const float a = 2.0f * GLM_PIf * t;
    return glms_vec3_scale(
        vec3_of(sinf(a) + 2.0f * sinf(2.0f * a), -sinf(3.0f * a), cosf(a) - 2.0f * cosf(2.0f * a)),
        1.0f / 3.0f);
}

static mat4s knot_frame(const struct movable_object *object, float t, float path)
{
    const vec3s along = glms_vec3_normalize(glms_vec3_sub(knot(t + 1e-3f), knot(t - 1e-3f)));
    const vec3s up = fabsf(along.y) < 0.9f ? vec3_of(0, 1, 0) : vec3_of(1, 0, 0);
    const vec3s x = glms_vec3_normalize(glms_vec3_cross(up, along));
    mat4s frame = glms_mat4_identity();
    frame.col[0] = vec4_of(x, 0);
    frame.col[1] = vec4_of(glms_vec3_cross(along, x), 0);
    frame.col[2] = vec4_of(along, 0);
    frame.col[3] = vec4_of(glms_vec3_muladds(knot(t), path, object->centre), 1);
    return frame;
}

static void add_knot(struct shape_builder *builder, const struct movable_object *object)
{
    const float pipe = 0.2f * object->radius, path = object->radius - pipe;
    mat4s frames[KNOT_RINGS + 1];
    for (int i = 0; i <= KNOT_RINGS; i++)
        frames[i] = knot_frame(object, (float)(i % KNOT_RINGS) / KNOT_RINGS, path);
    shape_sweep(builder, &(struct shape_pipe){ .frames = frames,
                                               .count = KNOT_RINGS + 1,
                                               .radius = pipe,
                                               .segments = KNOT_SEGMENTS });
}

bool movable_object_add(struct scene *scene, const struct movable_object *object)
{
    const int material = builtin_diffuse(scene, "object", object->reflectance);
    struct shape_builder builder;
    if (material < 0) return false;
    shape_begin(&builder, scene);
    if (object->height > 0.0f)
        add_solid(&builder, object);
    else
        add_knot(&builder, object);
    const int instance = shape_emit(&builder, "object", material);
    if (instance >= 0) scene->instances[instance].movable = true;
    return instance >= 0;
}

bool cornell_add_objects(struct scene *scene, int count)
{
    for (int i = 0; i < count; i++)
        if (!movable_object_add(scene, &CORNELL[i])) return false;
    return true;
}

// The lower half of a spherical shell.
bool cornell_add_bowl(struct scene *scene)
{
    enum { STEPS = 14, POINTS = 2 * (STEPS + 1) };
    const float outer = 1.2f, inner = 1.05f;
    vec2s profile[POINTS];
    struct shape_builder builder;
    const int material = builtin_diffuse(scene, "bowl", vec3_of(0.8f, 0.7f, 0.5f));
    if (material < 0) return false;
    for (int i = 0; i <= STEPS; i++) {
        const float angle = GLM_PI_2f * (float)i / STEPS;
        const float across = i == 0 ? 0.0f : sinf(angle), down = i == STEPS ? 0.0f : cosf(angle);
        profile[i] = (vec2s){ { outer * across, outer * (1.0f - down) } };
        profile[POINTS - 1 - i] = (vec2s){ { inner * across, outer - inner * down } };
    }
    shape_begin(&builder, scene);
    shape_lathe(&builder, vec3_of(0.0f, 0.8f, 0.5f), profile, POINTS, 2 * STEPS);
    const int instance = shape_emit(&builder, "bowl", material);
    if (instance >= 0) scene->instances[instance].movable = true;
    return instance >= 0;
}
