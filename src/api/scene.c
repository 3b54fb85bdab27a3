// Scenes: checks arguments, forwards to scene/, and keeps a pose for queries at a moment.
#include "api/objects.h"

#include "scene/dark.h"
#include "scene/view/defaults.h"
#include "scene/environment/environment_map.h"
#include "scene/import/import.h"
#include "scene/limits.h"
#include "scene/rescale.h"

#include <stdio.h>
#include <string.h>

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

bool api_pose_at(const struct ag_scene *scene, struct scene_pose *pose, int animation,
                 double time_s)
{
    if (animation >= scene->scene->animation_count) animation = -1;
    if (!(fabs(time_s) <= MAX_TIME_S))
        return host_fail(host_of(scene), FAIL_ARGUMENT, "time %g s is beyond the largest, %g s",
                         time_s, MAX_TIME_S);
    if (!pose->scene)
        return pose_init(pose, scene->scene, animation, (float)time_s) && limits_pose(pose);
    if (!pose_follow(pose)) return false;
    pose_update(pose, animation, (float)time_s);
    return limits_pose(pose);
}

// The scene's own pose; NULL after a failure. A program asks for every light and camera at the same
// moment: the pose is then updated once.
static const struct scene_pose *pose_at(struct ag_scene *scene, int animation, double time_s)
{
    struct moment *last = &scene->pose_moment;
    const uint64_t revision = scene->scene->revisions.newest;
    if (last->valid && last->revision == revision && last->animation == animation &&
        last->time_s == time_s)
        return &scene->pose;
    last->valid = api_pose_at(scene, &scene->pose, animation, time_s);
    last->revision = revision;
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
    api_context_use(context);
    scene->context = context;
    scene->scene = made;
    *out = scene;
    return api_done(context, true);
}

static enum ag_result require_scale(const char *function, struct ag_context *context, float scale)
{
    AG_REQUIRE_FOR(function, context,
                   scale == 0.0f || (scale >= SCENE_SCALE_MIN && scale <= SCENE_SCALE_MAX),
                   "scale %g is not within %g to %g", (double)scale, (double)SCENE_SCALE_MIN,
                   (double)SCENE_SCALE_MAX);
    return AG_OK;
}

enum ag_result ag_scene_load_with(struct ag_context *context, const char *name,
                                  const struct ag_scene_load_desc *desc, struct ag_scene **out)
{
    static const struct ag_scene_load_desc defaults;
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, name && name[0], "name is empty");
    if (!desc) desc = &defaults;
    AG_REQUIRE_KNOWN(__func__, context, desc);
    enum ag_result result = require_scale(__func__, context, desc->scale);
    if (result != AG_OK) return result;
    const float scale = desc->scale > 0.0f ? desc->scale : 1.0f;
    return give(context, scene_load_scaled(&context->host, name, scale), out);
}

enum ag_result ag_scene_load(struct ag_context *context, const char *name, struct ag_scene **out)
{
    return ag_scene_load_with(context, name, NULL, out);
}

enum ag_result ag_scene_load_memory(struct ag_context *context,
                                    const struct ag_scene_memory_desc *desc, struct ag_scene **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE_POINTER(context, desc);
    AG_REQUIRE_KNOWN(__func__, context, desc);
    AG_REQUIRE(context, desc->bytes && desc->size > 0, "there are no bytes");
    AG_REQUIRE(context, !desc->folder || !desc->read, "both folder and read are given");
    AG_REQUIRE(context, !desc->folder || desc->folder[0], "folder is empty");
    enum ag_result result = require_scale(__func__, context, desc->scale);
    if (result != AG_OK) return result;
    const struct import_bytes from = { .data = desc->bytes,
                                       .size = desc->size,
                                       .name = desc->name ? desc->name : "memory",
                                       .folder = desc->folder,
                                       .read = desc->read,
                                       .user = desc->user,
                                       .scale = desc->scale };
    return give(context, import_memory(&context->host, &from), out);
}

enum ag_result ag_scene_create(struct ag_context *context, struct ag_scene **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    return give(context, scene_create(&context->host, "scene"), out);
}

static void free_scene(struct ag_scene *scene)
{
    struct ag_context *context = scene->context;
    pose_finish(&scene->pose);
    host_free(&context->host, scene->cameras_by_name);
    scene_destroy(scene->scene);
    host_free(&context->host, scene);
    api_context_release(context);
}

void api_scene_use(struct ag_scene *scene, int *users)
{
    lifetime_use(&scene->life);
    (*users)++;
}

void api_scene_release(struct ag_scene *scene, int *users)
{
    (*users)--;
    if (lifetime_release(&scene->life)) free_scene(scene);
}

void ag_scene_destroy(struct ag_scene *scene)
{
    if (scene && lifetime_destroy(&scene->life)) free_scene(scene);
}

enum ag_result ag_scene_transfer(struct ag_scene *scene, struct ag_context *to)
{
    struct ag_context *from = context_of(scene);
    AG_REQUIRE_POINTER(from, scene);
    AG_REQUIRE_POINTER(from, to);
    AG_REQUIRE(from, scene->life.users == 0,
               "the scene is in use by %d renderers, %d references and %d bakes", scene->renderers,
               scene->references, scene->bakes);
    AG_REQUIRE(from, api_same_memory(from, to), "the contexts have different allocators");
    struct environment *environment = &scene->scene->environment;
    if (environment->map) {
        const struct environment_map *map = environment_map_move(environment->map, &to->host);
        if (!map) return api_done(to, false);
        environment->map = map;
    }
    pose_finish(&scene->pose); // made again by the next query
    scene->pose = (struct scene_pose){ 0 };
    scene->pose_moment = (struct moment){ 0 };
    api_context_use(to);
    scene->context = to;
    scene_set_host(scene->scene, &to->host);
    api_context_release(from);
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
    AG_REQUIRE(context, vertical_fov_rad > 0.0f && vertical_fov_rad < GLM_PIf,
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
    *out = (struct ag_default_lighting){ 0 };
    out->needed = pose_is_dark(pose);
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
        result = api_add_light(scene, &sun, "default sun");
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
    api_store(out->sky, s->environment.sky);
    return AG_OK;
}

enum ag_result ag_scene_get_instance(struct ag_scene *scene, int index, int animation,
                                     double time_s, struct ag_instance_info *out)
{
    const struct scene_pose *pose = NULL;
    REQUIRE_ELEMENT(scene, out, "instance", index, instance_count);
    enum ag_result result = pose_for(__func__, scene, out, animation, time_s, &pose);
    if (result != AG_OK) return result;
    const struct instance *it = &scene->scene->instances[index];
    *out = (struct ag_instance_info){ .mesh = it->mesh, .name = "" };
    if (it->mesh < 0) return AG_OK;
    const mat4s world_from_mesh =
        it->skin >= 0 ? glms_mat4_identity() : pose->world_from_node[it->node];
    out->name = named(scene->scene->nodes[it->node].name);
    out->mobility = it->movable ? AG_MOBILITY_MOVABLE : AG_MOBILITY_STATIC;
    out->skinned = it->skin >= 0;
    memcpy(out->world_from_mesh, world_from_mesh.raw, sizeof out->world_from_mesh);
    return AG_OK;
}

enum ag_result ag_scene_get_mesh(struct ag_scene *scene, int index, struct ag_mesh_info *out)
{
    REQUIRE_ELEMENT(scene, out, "mesh", index, mesh_count);
    const struct mesh *mesh = &scene->scene->meshes[index];
    *out = (struct ag_mesh_info){
        .name = named(mesh->name),
        .vertex_count = mesh->source ? mesh->source_count : mesh->vertex_count,
        .index_count = mesh->index_count,
        .material = mesh->material,
    };
    api_store(out->bounds_min, mesh->bounds.min);
    api_store(out->bounds_max, mesh->bounds.max);
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
                                              .enabled = !light->off,
                                              .inner_rad = light->inner_rad,
                                              .outer_rad = light->outer_rad } };
    api_store(out->light.position, world.position);
    api_store(out->light.direction, world.direction);
    api_store(out->light.intensity, light->intensity);
    return AG_OK;
}

enum ag_result ag_scene_get_animation(struct ag_scene *scene, int index,
                                      struct ag_animation_info *out)
{
    REQUIRE_ELEMENT(scene, out, "animation", index, animation_count);
    const struct animation *animation = &scene->scene->animations[index];
    *out = (struct ag_animation_info){ .name = named(animation->name),
                                       .duration_s = (double)animation->duration_s };
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
                      .unlit = m->unlit,
                      .alpha_mode = (enum ag_alpha_mode)(AG_ALPHA_OPAQUE + (int)m->alpha_mode),
                      .alpha_cutoff = m->alpha_cutoff },
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
