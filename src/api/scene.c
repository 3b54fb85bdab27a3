// Scenes: checks arguments, forwards to scene/, and keeps a pose for queries at a moment.
#include "api/objects.h"

#include "scene/defaults.h"
#include "scene/limits.h"

#include <string.h>

_Static_assert((int)AG_LIGHT_SUN == (int)LIGHT_SUN && (int)AG_LIGHT_POINT == (int)LIGHT_POINT &&
                   (int)AG_LIGHT_SPOT == (int)LIGHT_SPOT,
               "types are converted by value");

static const float HALF_PI = 1.57079633f;
static const double MAX_TIME_S = 1e9;

static struct ag_context *context_of(const struct ag_scene *scene)
{
    return scene ? scene->context : NULL;
}

static struct host *host_of(const struct ag_scene *scene)
{
    return &scene->context->host;
}

// ---- moments

bool api_animation_exists(const struct ag_scene *scene, int animation)
{
    return animation == 0 || (animation >= -1 && animation < scene->scene->animation_count);
}

bool api_pose_at(const struct ag_scene *scene, struct scene_pose *pose, uint64_t *pose_version,
                 int animation, double time_s)
{
    if (animation >= scene->scene->animation_count) animation = -1;
    if (!(fabs(time_s) <= MAX_TIME_S))
        return host_fail(host_of(scene), FAIL_ARGUMENT, "time %g s is beyond the largest, %g s",
                         time_s, MAX_TIME_S);
    if (*pose_version == scene->version && pose->scene) {
        pose_update(pose, animation, (float)time_s);
        return limits_pose(pose);
    }
    pose_finish(pose);
    *pose = (struct scene_pose){ 0 };
    if (!pose_init(pose, scene->scene, animation, (float)time_s)) {
        pose_finish(pose);
        *pose = (struct scene_pose){ 0 };
        return false;
    }
    *pose_version = scene->version;
    return limits_pose(pose);
}

// The scene's own pose; NULL after a failure. A program asks for every light and camera at the same
// moment: the pose is then updated once.
static const struct scene_pose *pose_at(struct ag_scene *scene, int animation, double time_s)
{
    struct moment *last = &scene->pose_moment;
    if (last->valid && scene->pose_version == scene->version && last->animation == animation &&
        last->time_s == time_s)
        return &scene->pose;
    last->valid = api_pose_at(scene, &scene->pose, &scene->pose_version, animation, time_s);
    last->animation = animation;
    last->time_s = time_s;
    return last->valid ? &scene->pose : NULL;
}

// The argument checks of functions that fill `out` for a moment, and the scene's pose then.
static enum ag_result pose_for(const char *function, struct ag_scene *scene, const void *out,
                               int animation, double time_s, const struct scene_pose **pose)
{
    struct ag_context *context = context_of(scene);
    AG_REQUIRE_FOR(function, context, scene, "scene is NULL");
    AG_REQUIRE_FOR(function, context, out, "out is NULL");
    AG_REQUIRE_FOR(function, context, api_animation_exists(scene, animation),
                   "animation %d is not one of %d", animation, scene->scene->animation_count);
    AG_REQUIRE_FOR(function, context, isfinite(time_s), "time_s is not finite");
    *pose = pose_at(scene, animation, time_s);
    return api_done(context, *pose != NULL);
}

// The argument checks of functions that fill `out` for element `index` of `count`.
#define REQUIRE_ELEMENT(scene, out, what, index, member)                                           \
    do {                                                                                           \
        AG_REQUIRE_POINTER(context_of(scene), scene);                                              \
        AG_REQUIRE_POINTER((scene)->context, out);                                                 \
        AG_REQUIRE((scene)->context, (index) >= 0 && (index) < (scene)->scene->member,             \
                   what " %d is not one of %d", (index), (scene)->scene->member);                  \
    } while (0)

// ---- creation and destruction

// Wraps a scene and takes ownership, also on failure.
static enum ag_result give(struct ag_context *context, struct scene *made, struct ag_scene **out)
{
    struct ag_scene *scene = made ? host_alloc(&context->host, 1, sizeof *scene) : NULL;
    if (!scene) {
        if (made) scene_destroy(made);
        return api_done(context, false);
    }
    scene->context = context;
    scene->scene = made;
    *out = scene;
    return api_done(context, true);
}

enum ag_result ag_scene_load(struct ag_context *context, const char *name, struct ag_scene **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, name && name[0], "name is empty");
    return give(context, scene_load(&context->host, name), out);
}

enum ag_result ag_scene_create(struct ag_context *context, struct ag_scene **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    return give(context, scene_create(&context->host, "scene"), out);
}

void ag_scene_destroy(struct ag_scene *scene)
{
    if (!scene) return;
    pose_finish(&scene->pose);
    host_free(host_of(scene), scene->cameras_by_name);
    scene_destroy(scene->scene);
    host_free(host_of(scene), scene);
}

// ---- building

// The result of scene_add_…: an index, or negative on failure.
static enum ag_result added(struct ag_scene *scene, int index, int *out)
{
    scene->version++;
    if (out) *out = index;
    return api_done(scene->context, index >= 0);
}

#define REQUIRE_UNUSED(scene)                                                                      \
    AG_REQUIRE((scene)->context, (scene)->users == 0,                                              \
               "the scene is in use by a renderer or a bake: only its lights and sky may change")

// The argument checks of ag_scene_add_…, which set *index to -1 unless they succeed.
#define REQUIRE_ADDING(scene, desc, index)                                                         \
    do {                                                                                           \
        if (index) *(index) = -1;                                                                  \
        AG_REQUIRE_POINTER(context_of(scene), scene);                                              \
        AG_REQUIRE_POINTER((scene)->context, desc);                                                \
    } while (0)

void ag_material_desc_default(struct ag_material_desc *desc)
{
    if (!desc) return;
    *desc = (struct ag_material_desc){ .base_color = { 0.8f, 0.8f, 0.8f, 1.0f },
                                       .roughness = 1,
                                       .ior = MATERIAL_DEFAULT_IOR,
                                       .specular = 1,
                                       .specular_color = { 1, 1, 1 } };
}

static bool in_unit_range(const float *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!(values[i] >= 0.0f && values[i] <= 1.0f)) return false;
    return true;
}

enum ag_result ag_scene_add_material(struct ag_scene *scene, const struct ag_material_desc *desc,
                                     int *index)
{
    REQUIRE_ADDING(scene, desc, index);
    struct ag_context *context = scene->context;
    REQUIRE_UNUSED(scene);
    AG_REQUIRE(context, in_unit_range(desc->base_color, 4), "base_color is not within 0 to 1");
    AG_REQUIRE(context, in_unit_range(&desc->metallic, 1) && in_unit_range(&desc->roughness, 1),
               "metallic and roughness must be 0 to 1, not %g and %g", (double)desc->metallic,
               (double)desc->roughness);
    AG_REQUIRE(context, limits_light(api_vec3(desc->emissive)),
               "emissive is not within 0 to %g cd/m²", (double)SCENE_MAX_RADIANCE);
    AG_REQUIRE(context, desc->ior == 0 || api_finite_at_least(&desc->ior, 1, 1.0f),
               "ior must be 0 or at least 1, not %g", (double)desc->ior);
    AG_REQUIRE(context, in_unit_range(&desc->specular, 1), "specular must be 0 to 1, not %g",
               (double)desc->specular);
    AG_REQUIRE(context, api_finite_at_least(desc->specular_color, 3, 0.0f),
               "specular_color must be 0 or more");
    struct material material = material_default();
    memcpy(material.base_color.raw, desc->base_color, sizeof desc->base_color);
    material.metallic = desc->metallic;
    material.roughness = desc->roughness;
    material.emissive = api_vec3(desc->emissive);
    material.double_sided = desc->double_sided;
    material.ior = desc->ior;
    material.specular = desc->specular;
    material.specular_color = api_vec3(desc->specular_color);
    material.unlit = desc->unlit;
    return added(scene, scene_add_material(scene->scene, &material), index);
}

enum ag_result ag_scene_add_mesh(struct ag_scene *scene, const struct ag_mesh_desc *desc,
                                 int *index)
{
    REQUIRE_ADDING(scene, desc, index);
    struct ag_context *context = scene->context;
    REQUIRE_UNUSED(scene);
    AG_REQUIRE(context, desc->positions && desc->vertex_count > 0, "there are no positions");
    AG_REQUIRE(context, desc->indices && desc->index_count > 0, "there are no indices");
    AG_REQUIRE(context, desc->index_count % 3 == 0, "index_count %u is no multiple of 3",
               desc->index_count);
    AG_REQUIRE(context, desc->material >= 0 && desc->material < scene->scene->material_count,
               "material %d is not one of %d", desc->material, scene->scene->material_count);
    for (uint32_t i = 0; i < desc->index_count; i++)
        AG_REQUIRE(context, desc->indices[i] < desc->vertex_count,
                   "index %u at %u is not below vertex_count %u", desc->indices[i], i,
                   desc->vertex_count);
    struct mesh mesh = { .name = "mesh",
                         .vertex_count = desc->vertex_count,
                         .index_count = desc->index_count,
                         .positions = (vec3s *)desc->positions, // scene_add_mesh copies all arrays
                         .normals = (vec3s *)desc->normals,
                         .indices = (uint32_t *)desc->indices,
                         .material = desc->material };
    return added(scene, scene_add_mesh(scene->scene, &mesh), index);
}

enum ag_result ag_scene_add_instance(struct ag_scene *scene, int mesh, const float *world_from_mesh,
                                     int *index)
{
    struct ag_context *context = context_of(scene);
    if (index) *index = -1;
    AG_REQUIRE_POINTER(context, scene);
    REQUIRE_UNUSED(scene);
    AG_REQUIRE(context, mesh >= 0 && mesh < scene->scene->mesh_count, "mesh %d is not one of %d",
               mesh, scene->scene->mesh_count);
    struct node node = node_default();
    node.name = "instance";
    if (world_from_mesh) {
        const float *m = world_from_mesh;
        AG_REQUIRE(context, api_finite(m, 16), "world_from_mesh is not finite");
        AG_REQUIRE(context, m[3] == 0.0f && m[7] == 0.0f && m[11] == 0.0f && m[15] == 1.0f,
                   "world_from_mesh is not affine: its last row must be 0 0 0 1");
        node.has_matrix = true;
        memcpy(node.matrix.raw, m, 16 * sizeof *m);
    }
    int at = scene_add_node(scene->scene, &node);
    struct instance instance = { .node = at, .mesh = mesh, .skin = -1 };
    return added(scene, at < 0 ? -1 : scene_add_instance(scene->scene, &instance), index);
}

void ag_light_desc_default(struct ag_light_desc *desc, enum ag_light_type type)
{
    if (!desc) return;
    *desc = (struct ag_light_desc){
        .type = type, .direction = { 0, -1, 0 }, .intensity = { 1, 1, 1 }, .outer_rad = HALF_PI / 2
    };
}

static enum ag_result light_check(const char *function, struct ag_context *context,
                                  const struct ag_light_desc *desc)
{
    AG_REQUIRE_FOR(function, context, (unsigned)desc->type <= AG_LIGHT_SPOT, "type %d is unknown",
                   (int)desc->type);
    AG_REQUIRE_FOR(function, context, limits_light(api_vec3(desc->intensity)),
                   "intensity is not within 0 to %g lux or candela", (double)SCENE_MAX_RADIANCE);
    AG_REQUIRE_FOR(function, context,
                   desc->type == AG_LIGHT_SUN || limits_position(api_vec3(desc->position)),
                   "position is not within %g m of the origin", (double)SCENE_MAX_DISTANCE_M);
    float length = glms_vec3_norm(vec3_unit(api_vec3(desc->direction)));
    AG_REQUIRE_FOR(function, context, desc->type == AG_LIGHT_POINT || length > 0.0f,
                   "direction is zero or not finite");
    if (desc->type == AG_LIGHT_SPOT)
        AG_REQUIRE_FOR(function, context,
                       desc->inner_rad >= 0.0f && desc->inner_rad < desc->outer_rad &&
                           desc->outer_rad <= HALF_PI * (1 + 1e-6f),
                       "inner_rad %g and outer_rad %g are not 0 to half pi, inner below outer",
                       (double)desc->inner_rad, (double)desc->outer_rad);
    return AG_OK;
}

// Adds a node and the light on it. -1: out of memory.
static int add_light(struct scene *scene, const struct ag_light_desc *desc, const char *name)
{
    vec3s position = desc->type == AG_LIGHT_SUN ? vec3_of(0, 0, 0) : api_vec3(desc->position);
    vec3s direction = desc->type == AG_LIGHT_POINT ? vec3_of(0, -1, 0) : api_vec3(desc->direction);
    int node = scene_add_node_looking(scene, name, position, direction);
    if (node < 0) return -1;
    struct light light = { .name = name,
                           .type = (enum light_type)desc->type,
                           .node = node,
                           .intensity = api_vec3(desc->intensity),
                           .inner_rad = desc->inner_rad,
                           .outer_rad = fminf(desc->outer_rad, HALF_PI) };
    return scene_add_light(scene, &light);
}

enum ag_result ag_scene_add_light(struct ag_scene *scene, const struct ag_light_desc *desc,
                                  int *index)
{
    REQUIRE_ADDING(scene, desc, index);
    struct ag_context *context = scene->context;
    enum ag_result checked = light_check(__func__, context, desc);
    if (checked != AG_OK) return checked;
    return added(scene, add_light(scene->scene, desc, "light"), index);
}

void ag_area_light_desc_default(struct ag_area_light_desc *desc)
{
    if (!desc) return;
    *desc = (struct ag_area_light_desc){
        .direction = { 0, -1, 0 }, .width = 1, .height = 1, .radiance = { 1, 1, 1 }
    };
}

// Index of the instance; -1 if out of memory. The quad is in the xy plane of its node and faces -z,
// the viewing direction of nodes.
static int add_emissive_quad(struct scene *scene, const struct ag_area_light_desc *desc)
{
    static const char *const NAME = "area light";
    float x = 0.5f * desc->width, y = 0.5f * desc->height;
    vec3s corners[4] = { { { -x, -y, 0 } }, { { -x, y, 0 } }, { { x, y, 0 } }, { { x, -y, 0 } } };
    uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    struct material material = material_default();
    material.name = NAME;
    material.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    material.emissive = api_vec3(desc->radiance);
    struct mesh mesh = { .name = NAME,
                         .vertex_count = 4,
                         .index_count = 6,
                         .positions = corners,
                         .indices = indices,
                         .material = scene_add_material(scene, &material) };
    if (mesh.material < 0) return -1;
    struct instance instance = { .skin = -1, .mesh = scene_add_mesh(scene, &mesh) };
    if (instance.mesh < 0) return -1;
    instance.node =
        scene_add_node_looking(scene, NAME, api_vec3(desc->position), api_vec3(desc->direction));
    return instance.node < 0 ? -1 : scene_add_instance(scene, &instance);
}

enum ag_result ag_scene_add_area_light(struct ag_scene *scene,
                                       const struct ag_area_light_desc *desc, int *instance)
{
    REQUIRE_ADDING(scene, desc, instance);
    struct ag_context *context = scene->context;
    REQUIRE_UNUSED(scene);
    AG_REQUIRE(context, limits_position(api_vec3(desc->position)),
               "position is not within %g m of the origin", (double)SCENE_MAX_DISTANCE_M);
    AG_REQUIRE(context, glms_vec3_norm(vec3_unit(api_vec3(desc->direction))) > 0.0f,
               "direction is zero or not finite");
    AG_REQUIRE(context,
               desc->width > 0.0f && desc->height > 0.0f && isfinite(desc->width * desc->height),
               "width %g and height %g are not above 0", (double)desc->width, (double)desc->height);
    AG_REQUIRE(context, limits_light(api_vec3(desc->radiance)),
               "radiance is not within 0 to %g cd/m²", (double)SCENE_MAX_RADIANCE);
    return added(scene, add_emissive_quad(scene->scene, desc), instance);
}

enum ag_result ag_scene_remove_lights(struct ag_scene *scene)
{
    AG_REQUIRE(NULL, scene, "scene is NULL");
    scene_remove_lights(scene->scene);
    scene->version++;
    return AG_OK;
}

enum ag_result ag_scene_set_sky(struct ag_scene *scene, const float *radiance)
{
    AG_REQUIRE(NULL, scene, "scene is NULL");
    AG_REQUIRE(scene->context, radiance, "radiance is NULL");
    AG_REQUIRE(scene->context, limits_light(api_vec3(radiance)),
               "radiance is not within 0 to %g cd/m²", (double)SCENE_MAX_RADIANCE);
    scene->scene->sky = api_vec3(radiance);
    return AG_OK;
}

// ---- cameras

// Distance between a camera and its target: a metre, more when far from the origin, so that
// rounding of both positions does not rotate the view.
static float target_distance(vec3s eye)
{
    static const float NEAR_ORIGIN_M = 16.0f;
    int exponent = 0;
    float far = fmaxf(fmaxf(fabsf(eye.x), fabsf(eye.y)), fabsf(eye.z)) / NEAR_ORIGIN_M;
    if (far > 1.0f) frexpf(far, &exponent);
    return ldexpf(1.0f, exponent);
}

static struct ag_camera camera_out(const struct world_camera *camera)
{
    struct ag_camera out = { .vertical_fov_rad = camera->vertical_fov_rad,
                             .near_m = camera->near_m };
    api_store(out.eye, camera->eye);
    api_store(out.target,
              glms_vec3_muladds(camera->forward, target_distance(camera->eye), camera->eye));
    api_store(out.up, camera->up);
    return out;
}

enum ag_result ag_scene_look_at(struct ag_scene *scene, const float *eye, const float *target,
                                float vertical_fov_rad, struct ag_camera *out)
{
    struct ag_context *context = context_of(scene);
    AG_REQUIRE_POINTER(context, scene);
    AG_REQUIRE(context, eye && target && out, "eye, target or out is NULL");
    AG_REQUIRE(context, limits_position(api_vec3(eye)) && limits_position(api_vec3(target)),
               "eye or target is not within %g m of the origin", (double)SCENE_MAX_DISTANCE_M);
    vec3s forward = vec3_towards(api_vec3(eye), api_vec3(target));
    AG_REQUIRE(context, glms_vec3_norm(forward) > 0.0f, "eye and target are the same point");
    AG_REQUIRE(context, vertical_fov_rad > 0.0f && vertical_fov_rad < 2 * HALF_PI,
               "vertical_fov_rad %g is not between 0 and pi", (double)vertical_fov_rad);
    const struct scene_pose *pose = pose_at(scene, 0, 0.0);
    if (!pose) return api_done(context, false);
    struct world_camera camera =
        camera_look_at(api_vec3(eye), api_vec3(target), vertical_fov_rad, default_near(pose));
    *out = camera_out(&camera);
    memcpy(out->target, target, sizeof out->target); // as given, not at target_distance
    return api_done(context, true);
}

int ag_scene_camera_count(const struct ag_scene *scene)
{
    return scene ? scene->scene->camera_count : 0;
}

static const char *named(const char *name)
{
    return name ? name : "";
}

const char *ag_scene_camera_name(const struct ag_scene *scene, int index)
{
    if (!scene || index < 0 || index >= scene->scene->camera_count) return NULL;
    return named(scene->scene->cameras[index].name);
}

// "cannot find camera x in scene: it has a, b"; a long list is truncated.
static bool fail_camera(const struct ag_scene *scene, const char *name)
{
    char list[API_MESSAGE_SIZE / 4] = "none";
    size_t used = 0;
    for (int i = 0; i < scene->scene->camera_count && used < sizeof list; i++) {
        int wrote = snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "",
                             named(scene->scene->cameras[i].name));
        used += wrote > 0 ? (size_t)wrote : 0;
    }
    return host_fail(host_of(scene), FAIL_ARGUMENT, "cannot find camera %s in %s: it has %s", name,
                     named(scene->scene->name), list);
}

enum ag_result ag_scene_camera(struct ag_scene *scene, const char *name, int animation,
                               double time_s, struct ag_camera *out)
{
    const struct scene_pose *pose = NULL;
    struct ag_context *context = context_of(scene);
    AG_REQUIRE_POINTER(context, name);
    enum ag_result result = pose_for(__func__, scene, out, animation, time_s, &pose);
    if (result != AG_OK) return result;
    int found = -1;
    if (!api_find_camera(scene, name, &found)) return api_done(context, false);
    if (found < 0) return api_done(context, fail_camera(scene, name));
    struct world_camera camera = pose_camera(pose, found);
    *out = camera_out(&camera);
    return api_done(context, true);
}

enum ag_result ag_scene_default_camera(struct ag_scene *scene, int animation, double time_s,
                                       struct ag_camera *out, bool *made_up)
{
    const struct scene_pose *pose = NULL;
    enum ag_result result = pose_for(__func__, scene, out, animation, time_s, &pose);
    if (result != AG_OK) return result;
    bool none = scene->scene->camera_count == 0;
    struct world_camera camera = none ? default_camera(pose) : pose_camera(pose, 0);
    *out = camera_out(&camera);
    if (made_up) *made_up = none;
    return api_done(scene->context, host_of(scene)->failure == FAIL_NONE); // memory for the search
}

// ---- default lighting of dark scenes

enum ag_result ag_scene_default_lighting(struct ag_scene *scene, struct ag_default_lighting *out)
{
    const struct scene_pose *pose = NULL;
    enum ag_result result = pose_for(__func__, scene, out, 0, 0.0, &pose);
    if (result != AG_OK) return result;
    struct default_lighting lighting = default_lighting(pose);
    out->needed = scene_is_dark(scene->scene);
    api_store(out->sun_direction, lighting.sun_direction);
    api_store(out->sun_lux, lighting.sun_lux);
    api_store(out->sky, lighting.sky);
    return api_done(scene->context, host_of(scene)->failure == FAIL_NONE); // memory for the search
}

enum ag_result ag_scene_add_default_lighting(struct ag_scene *scene,
                                             struct ag_default_lighting *out)
{
    struct ag_default_lighting lighting = { 0 };
    enum ag_result result = ag_scene_default_lighting(scene, &lighting);
    if (result == AG_OK && lighting.needed) {
        struct ag_light_desc sun;
        ag_light_desc_default(&sun, AG_LIGHT_SUN);
        memcpy(sun.direction, lighting.sun_direction, sizeof sun.direction);
        memcpy(sun.intensity, lighting.sun_lux, sizeof sun.intensity);
        result = added(scene, add_light(scene->scene, &sun, "default sun"), NULL);
        if (result == AG_OK) result = ag_scene_set_sky(scene, lighting.sky);
    }
    if (result == AG_OK && out) *out = lighting;
    return result;
}

// ---- contents

enum ag_result ag_scene_get_info(struct ag_scene *scene, int animation, double time_s,
                                 struct ag_scene_info *out)
{
    const struct scene_pose *pose = NULL;
    enum ag_result result = pose_for(__func__, scene, out, animation, time_s, &pose);
    if (result != AG_OK) return result;
    const struct scene *s = scene->scene;
    *out = (struct ag_scene_info){ .meshes = s->mesh_count,
                                   .instances = s->instance_count,
                                   .materials = s->material_count,
                                   .images = s->image_count,
                                   .lights = s->light_count,
                                   .cameras = s->camera_count,
                                   .animations = s->animation_count,
                                   .skins = s->skin_count,
                                   .nodes = s->node_count,
                                   .triangles = scene_triangle_count(s),
                                   .memory_bytes = scene_memory_bytes(s),
                                   .emissive = scene_has_emission(s) };
    for (int i = 0; i < s->instance_count; i++)
        out->vertices += s->meshes[s->instances[i].mesh].vertex_count;
    api_store(out->bounds_min, pose->bounds.min);
    api_store(out->bounds_max, pose->bounds.max);
    api_store(out->sky, s->sky);
    return AG_OK;
}

enum ag_result ag_scene_get_light(struct ag_scene *scene, int index, int animation, double time_s,
                                  struct ag_light_info *out)
{
    const struct scene_pose *pose = NULL;
    REQUIRE_ELEMENT(scene, out, "light", index, light_count);
    enum ag_result result = pose_for(__func__, scene, out, animation, time_s, &pose);
    if (result != AG_OK) return result;
    const struct light *light = &scene->scene->lights[index];
    struct world_light world = pose_light(pose, index);
    *out = (struct ag_light_info){ .name = named(light->name),
                                   .light = { .type = (enum ag_light_type)world.type,
                                              .inner_rad = light->inner_rad,
                                              .outer_rad = light->outer_rad } };
    api_store(out->light.position, world.position);
    api_store(out->light.direction, world.direction);
    api_store(out->light.intensity, world.intensity);
    return AG_OK;
}

enum ag_result ag_scene_get_animation(struct ag_scene *scene, int index,
                                      struct ag_animation_info *out)
{
    REQUIRE_ELEMENT(scene, out, "animation", index, animation_count);
    const struct animation *animation = &scene->scene->animations[index];
    *out = (struct ag_animation_info){ named(animation->name), (double)animation->duration_s };
    return AG_OK;
}

static const char *alpha_name(enum alpha_mode mode)
{
    switch (mode) {
    case ALPHA_OPAQUE:
        return "opaque";
    case ALPHA_MASK:
        return "mask";
    case ALPHA_BLEND:
        break;
    }
    return "blend";
}

enum ag_result ag_scene_get_material(struct ag_scene *scene, int index,
                                     struct ag_material_info *out)
{
    REQUIRE_ELEMENT(scene, out, "material", index, material_count);
    const struct material *m = &scene->scene->materials[index];
    *out = (struct ag_material_info){
        .name = named(m->name),
        .material = { .base_color = { m->base_color.x, m->base_color.y, m->base_color.z,
                                      m->base_color.w },
                      .metallic = m->metallic,
                      .roughness = m->roughness,
                      .emissive = { m->emissive.x, m->emissive.y, m->emissive.z },
                      .double_sided = m->double_sided,
                      .ior = m->ior,
                      .specular = m->specular,
                      .specular_color = { m->specular_color.x, m->specular_color.y,
                                          m->specular_color.z },
                      .unlit = m->unlit },
        .base_color_map = m->base_color_map.image >= 0,
        .metallic_roughness_map = m->metallic_roughness_map.image >= 0,
        .normal_map = m->normal_map.image >= 0,
        .emissive_map = m->emissive_map.image >= 0,
        .specular_map = m->specular_map.image >= 0,
        .specular_color_map = m->specular_color_map.image >= 0,
        .alpha_mode = alpha_name(m->alpha_mode),
    };
    return AG_OK;
}
