// Deferred neighboring radiance transfer (Giuffrida 2016): changes by dynamic objects to the light
// of a source that ignores them. Each reflects light onto its surroundings and occludes light
// behind it, by a volume of transfer vectors. The volume is baked once for the object's mesh and
// multiplied by the light at the object in every frame.
#include "techniques/dnrt/dnrt.h"

#include "techniques/dnrt/dnrt_bake.h"
#include "techniques/dnrt/dnrt_keys.h"
#include "techniques/dnrt/dnrt_part.h"
#include "techniques/dnrt/dnrt_state.h"

#include "technique_shaders.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define OPTION(...) OPTION_ROW(struct dnrt_options, __VA_ARGS__)
static const struct option_row option_rows[] = {
#include "techniques/dnrt/dnrt_options.def"
};
#undef OPTION

static const struct technique_preset presets[] = {
    { "low", "size=16,bits=8" },
    { "medium", "" },
    { "high", "coefficients=9,rays=512" },
    { NULL, NULL },
};

// ---- creation

static bool resize(void *state, int view, uint32_t width, uint32_t height)
{
    struct dnrt *s = state;
    const size_t tiles = (size_t)gpu_groups(width, DNRT_TILE) * gpu_groups(height, DNRT_TILE);
    if (width > 0 && view >= s->views) s->views = view + 1;
    if (tiles > s->most_tiles) s->most_tiles = tiles;
    return dnrt_make_tiles(s);
}

// A matrix without an inverse leaves zero.
static bool find_frames(struct dnrt *s, const struct scene_pose *pose)
{
    mat3s stretch;
    s->frames = host_alloc(s->host, (size_t)s->baked.shape_count, sizeof *s->frames);
    for (int i = 0; s->frames && i < s->baked.shape_count; i++)
        if (!dnrt_object_frame(&s->baked, pose, s->baked.shapes[i].object, &s->frames[i], &stretch))
            s->frames[i] = (struct dnrt_frame){ .scale = 0.0f };
    return s->frames != NULL;
}

static bool copy_materials(struct dnrt *s, const struct scene *scene)
{
    const size_t count = (size_t)scene->material_count;
    s->materials = host_alloc(s->host, count, sizeof *s->materials);
    s->material_count = scene->material_count;
    if (s->materials && count > 0)
        memcpy(s->materials, scene->materials, count * sizeof *s->materials);
    return s->materials;
}

static bool create(void *state, const struct technique_create *how)
{
    struct dnrt *s = state;
    s->host = how->host;
    s->gpu = how->gpu;
    if (!how->pose) return true;
    s->animation = how->pose->animation;
    if (!dnrt_objects_init(&s->baked, s->host, how->pose, s->options.keys, false)) return false;
    s->keys = dnrt_volume_keys(s->host, &s->baked, how->pose, s->options.keys);
    s->volumes = host_alloc(s->host, (size_t)s->baked.volume_count, sizeof *s->volumes);
    if (s->baked.count == 0)
        host_log(s->host, LOG_WARNING,
                 "dnrt: %s has no dynamic objects: it changes nothing (docs/library.md: mobility)",
                 how->pose->scene->name);
    return s->keys && s->volumes && copy_materials(s, how->pose->scene) &&
           find_frames(s, how->pose) && resize(s, 0, how->width, how->height) &&
           dnrt_find_objects(s, how->pose);
}

#define MEMBER(thing) offsetof(struct dnrt, thing)

static void objects(const void *options, int view, uint32_t width, uint32_t height,
                    struct gpu_objects *out)
{
    const struct dnrt_options *o = options;
    const bool maps = o->intrusion == DNRT_INTRUSION_SHADOW;
    const struct gpu_constant constants[] = {
        { 0, o->grid == DNRT_GRID_QUADRATIC }, { 1, (uint32_t)dnrt_normals(o) },
        { 2, (uint32_t)dnrt_coefficients(o) }, { 3, o->bits == DNRT_BITS_8 },
        { 4, (uint32_t)dnrt_planes(o) },
    };
    (void)view, (void)width, (void)height;
    memcpy(out->constants, constants, sizeof constants);
#define PIPELINE(name, thing, when, shader_, bits)                                                 \
    { GPU_PIPELINE, name, MEMBER(thing), .consts = (bits),                                         \
      .shader = (when) ? &shader_dnrt_##shader_##_comp : NULL }
    GPU_ADD(out, 0, PIPELINE("light", light_pipeline[0], true, light_grid, 0),
            PIPELINE("light", light_pipeline[1], true, light_depths, 0),
            PIPELINE("bounce", bounce_pipeline, true, bounce, 31),
            PIPELINE("volumes", volumes_pipeline, true, volumes, 30),
            PIPELINE("punctual", punctual_pipeline, o->direct, punctual, 0),
            PIPELINE("self", self_pipeline, o->self, self, 1u << 2 | 1u << 4),
            PIPELINE("apply", apply_pipeline[0][0], !maps, apply_plain, 3),
            PIPELINE("apply", apply_pipeline[0][1], maps, apply_plain_maps, 3),
            PIPELINE("apply", apply_pipeline[1][0], !maps, apply_id, 3),
            PIPELINE("apply", apply_pipeline[1][1], maps, apply_id_maps, 3),
            { GPU_SAMPLER, "volumes", .member = MEMBER(linear) },
            { GPU_BUFFER, "changed", MEMBER(changed), .bytes = sizeof(struct dnrt_changed),
              .usage = GPU_BUFFER_INDIRECT });
    // Their sizes are those of the bake and of the scene.
    GPU_ADD(out, 0, { GPU_BUFFER, .member = MEMBER(shapes) },
            { GPU_BUFFER, .member = MEMBER(samples) },
            { GPU_BUFFER, .member = MEMBER(patch_buffer) },
            { GPU_BUFFER, .member = MEMBER(point_buffer) }, { GPU_BUFFER, .member = MEMBER(light) },
            { GPU_IMAGE, .member = MEMBER(image) }, { GPU_IMAGE, .member = MEMBER(map_image) });
}

static bool load(void *state, const struct tensors *bake)
{
    struct dnrt *s = state;
    return s->baked.count == 0 ||
           (dnrt_upload(s, bake) && (s->options.intrusion != DNRT_INTRUSION_SHADOW ||
                                     shadow_casters_init(&s->casters, s->gpu)));
}

// ---- frames

static uint32_t slot_of(const struct dnrt *s, int object)
{
    const int n = dnrt_size(&s->options), across = s->slots[0], layer = across * s->slots[1];
    const int x = object % across * dnrt_normals(&s->options) * n,
              y = object / across % s->slots[1] * n;
    return (uint32_t)(x | y << 10 | object / layer * n << 20);
}

// A shape in the pose: its volumes at the key frames before and after, and their interpolation.
struct shape_now {
    int volume, next;
    float part;
    struct dnrt_volume mean;
};

static struct shape_now shape_at(const struct dnrt *s, const struct scene_pose *pose, int index)
{
    const struct dnrt_shape *shape = &s->baked.shapes[index];
    struct dnrt_between at = { 0, 0, 0.0f };
    if (shape->keys > 1 && pose->animation == s->animation)
        at = dnrt_keys_around(pose, shape->keys);
    const struct dnrt_volume *a = &s->volumes[shape->volume + at.first];
    const struct dnrt_volume *b = &s->volumes[shape->volume + at.next];
    const struct dnrt_volume mean = { glms_vec3_lerp(a->centre, b->centre, at.part),
                                      a->radius + at.part * (b->radius - a->radius),
                                      glms_vec3_lerp(a->box_centre, b->box_centre, at.part),
                                      glms_vec3_lerp(a->box_half, b->box_half, at.part) };
    return (struct shape_now){ shape->volume + at.first, shape->volume + at.next, at.part, mean };
}

static void place_object(struct dnrt *s, const struct scene_pose *pose, int object)
{
    const struct dnrt_object *of = &s->objects.at[object];
    struct dnrt_gpu_object *to = &s->gpu_objects[object];
    struct dnrt_frame frame;
    mat3s stretch;
    *to = (struct dnrt_gpu_object){ .shape = -1 };
    if (of->shape < 0 || !dnrt_object_frame(&s->objects, pose, object, &frame, &stretch)) return;
    const struct shape_now now = shape_at(s, pose, of->shape);
    const struct dnrt_volume *volume = &now.mean;
    const versors turn = glms_quat_normalize(glms_mat3_quat(frame.rotation));
    *to = (struct dnrt_gpu_object){
        .centre = mat4_point(dnrt_world_from_object(&frame), volume->centre),
        .half_m = volume->radius * s->options.reach * frame.scale,
        .rotation = { turn.x, turn.y, turn.z, turn.w },
        .shape = volume->radius > 0.0f ? now.volume : -1,
        .next = now.next,
        .part = now.part,
        .slot = slot_of(s, object),
        .first_instance = (uint32_t)s->objects.instances[of->first],
        .instance_count = (uint32_t)of->count,
        .box_centre =
            glms_vec3_scale(glms_vec3_sub(volume->box_centre, volume->centre), frame.scale),
        .box_half = glms_vec3_scale(volume->box_half, frame.scale),
    };
}

static void set_probes(void *state, const struct probe_volume *source)
{
    struct dnrt *s = state;
    s->source = *source;
}

static struct gpu_binding objects_binding(const struct dnrt *s, struct gpu_cmd *cmd)
{
    return gpu_transient(cmd, "dnrt_objects", s->gpu_objects,
                         (size_t)s->objects.count * sizeof *s->gpu_objects);
}

static bool has_bounces(const struct dnrt *s)
{
    return s->objects.count > 1 && s->options.bounces > 1;
}

static uint32_t punctual_of(const struct dnrt *s)
{
    return DNRT_LIGHT_PUNCTUAL * (uint32_t)s->objects.count * DNRT_COEFFICIENTS;
}

static void record_punctual(struct dnrt *s, struct gpu_cmd *cmd, const struct frame_view *view,
                            struct gpu_binding objects)
{
    const struct dnrt_punctual_push push = { (uint32_t)s->objects.count, punctual_of(s),
                                             s->options.reach, view->shadow_radius };
    if (!s->options.direct) return;
    gpu_scope_begin(cmd, "punctual");
    gpu_dispatch(cmd, s->punctual_pipeline,
                 GPU_BIND(FRAME_LIGHT_BINDINGS(view), objects,
                          { .name = "dnrt_light", .buffer = s->light },
                          { .name = "dnrt_changed", .buffer = s->changed }),
                 &push, sizeof push, gpu_groups(push.objects, DNRT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

static void record_light(struct dnrt *s, struct gpu_cmd *cmd, struct gpu_binding objects)
{
    // The changes of an object's light by other objects are not compared: all are computed again.
    const bool bounces = has_bounces(s);
    const struct dnrt_light_push push = { s->source.grid, (uint32_t)s->objects.count,
                                          (uint32_t)dnrt_normals(&s->options),
                                          s->stale || bounces };
    gpu_scope_begin(cmd, "light");
    gpu_fill_buffer(cmd, s->changed, offsetof(struct dnrt_changed, groups_y), sizeof(uint32_t), 0);
    gpu_dispatch(
        cmd, s->light_pipeline[s->source.depth.id != 0],
        GPU_BIND({ .name = "probes", .image = s->source.image, .sampler = s->linear },
                 { .name = "probe_depths", .image = s->source.depth, .sampler = s->linear },
                 objects, { .name = "dnrt_light", .buffer = s->light },
                 { .name = "dnrt_changed", .buffer = s->changed }),
        &push, sizeof push, gpu_groups(push.objects, DNRT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
    s->stale = bounces;
}

// Returns the first entry of the newest light.
static uint32_t record_bounces(struct dnrt *s, struct gpu_cmd *cmd, struct gpu_binding objects)
{
    const uint32_t count = (uint32_t)s->objects.count, part = count * DNRT_COEFFICIENTS;
    struct dnrt_bounce_push push = { .objects = count,
                                     .punctual = punctual_of(s),
                                     .size = (uint32_t)dnrt_size(&s->options),
                                     .fade = s->options.fade,
                                     .reach = s->options.reach };
    if (!has_bounces(s)) return 0;
    gpu_scope_begin(cmd, "bounces");
    for (int bounce = 1; bounce < s->options.bounces; bounce++) {
        push.to = (bounce % 2 ? 1 : 2) * part;
        gpu_dispatch(cmd, s->bounce_pipeline,
                     GPU_BIND(objects, { .name = "dnrt_light", .buffer = s->light },
                              { .name = "dnrt_shapes", .buffer = s->shapes },
                              { .name = "dnrt_samples", .buffer = s->samples }),
                     &push, sizeof push, count, 1, 1);
        push.from = push.to;
    }
    gpu_scope_end(cmd);
    return push.from;
}

// Only of objects whose light or shape has changed: none in a still scene.
static void record_volumes(struct dnrt *s, struct gpu_cmd *cmd, struct gpu_binding objects,
                           uint32_t light)
{
    const struct dnrt_volumes_push push = { (uint32_t)dnrt_size(&s->options), light,
                                            punctual_of(s) };
    gpu_scope_begin(cmd, "volumes");
    gpu_dispatch_indirect(cmd, s->volumes_pipeline,
                          GPU_BIND(objects, { .name = "dnrt_light", .buffer = s->light },
                                   { .name = "dnrt_shapes", .buffer = s->shapes },
                                   { .name = "dnrt_samples", .buffer = s->samples },
                                   { .name = "dnrt_changed", .buffer = s->changed },
                                   { .name = "volumes", .image = s->image }),
                          &push, sizeof push, s->changed, 0);
    gpu_scope_end(cmd);
}

static void update(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct dnrt *s = state;
    if (s->objects.count == 0 || s->image.id == 0) return;
    for (int i = 0; i < s->objects.count; i++) place_object(s, view->pose, i);
    dnrt_place_own(s, view->pose->scene);
    if (s->map_count > 0) dnrt_record_maps(s, cmd, view);
    const struct gpu_binding objects = objects_binding(s, cmd);
    record_punctual(s, cmd, view, objects);
    record_light(s, cmd, objects);
    s->newest_light = record_bounces(s, cmd, objects);
    record_volumes(s, cmd, objects, s->newest_light);
}

// Only tiles that may have pixels of an object read FRAME_ID.
static void record_tiles(struct dnrt *s, struct gpu_cmd *cmd, const struct frame_view *view,
                         struct gpu_binding objects, struct gpu_binding table,
                         struct dnrt_tile_counts tiles)
{
    struct dnrt_apply_push push = { .words = gpu_groups((uint32_t)s->objects.count, 32),
                                    .tiles_x = gpu_groups(view->width, DNRT_TILE),
                                    .size = (uint32_t)dnrt_size(&s->options),
                                    .fade = s->options.fade,
                                    .map_size = (uint32_t)s->options.map_size,
                                    .map_count = (uint32_t)s->map_count,
                                    .reach = s->options.reach };
    const uint32_t own = view->layers[FRAME_ID].id != 0 ? tiles.own : 0;
    const uint32_t first[2] = { own, 0 }, end[2] = { tiles.all, own };
    for (int id = 0; id < 2; id++) {
        push.first_tile = first[id];
        if (first[id] == end[id]) continue;
        gpu_dispatch(cmd, s->apply_pipeline[id][s->map_count > 0],
                     GPU_BIND(view->constants_binding,
                              { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                              { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                              { .name = "id", .image = view->layers[FRAME_ID] }, objects, table,
                              { .name = "volumes", .image = s->image, .sampler = s->linear },
                              { .name = "depth_maps", .image = s->map_image },
                              { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] }),
                     &push, sizeof push, end[id] - first[id], 1, 1);
    }
}

static void record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct dnrt *s = state;
    if (s->objects.count == 0 || s->image.id == 0) return;
    const uint32_t words = gpu_groups((uint32_t)s->objects.count, 32);
    const struct dnrt_tile_counts tiles = dnrt_find_tiles(s, view, words, s->tiles);
    if (tiles.all == 0) return;
    const size_t bytes = (size_t)tiles.all * (DNRT_TILE_BITS + words) * sizeof *s->tiles;
    const struct gpu_binding objects = gpu_transient(cmd, "dnrt_objects", s->gpu_objects,
                                                     DNRT_MAX_OBJECTS * sizeof *s->gpu_objects),
                             table = gpu_transient(cmd, "dnrt_tiles", s->tiles, bytes);
    gpu_scope_begin(cmd, "apply");
    record_tiles(s, cmd, view, objects, table, tiles);
    gpu_scope_end(cmd);
    if (tiles.own == 0) return;
    dnrt_record_self(s, cmd, view, objects, table,
                     &(struct dnrt_self_push){ words, gpu_groups(view->width, DNRT_TILE),
                                               s->own_count, s->newest_light, punctual_of(s) },
                     tiles.own);
}

static void destroy(void *state)
{
    struct dnrt *s = state;
    if (!s->host) return;
    shadow_casters_finish(&s->casters);
    host_free(s->host, s->maps);
    host_free(s->host, s->patches);
    host_free(s->host, s->own);
    host_free(s->host, s->gpu_objects);
    host_free(s->host, s->keys);
    host_free(s->host, s->materials);
    host_free(s->host, s->volumes);
    host_free(s->host, s->frames);
    host_free(s->host, s->tiles);
    dnrt_objects_finish(&s->objects);
    dnrt_objects_finish(&s->baked);
}

// Bytes of one object.
static uint64_t memory_estimate(const void *options)
{
    const struct dnrt_options *o = options;
    const uint64_t n = (uint64_t)dnrt_size(o), samples = n * n * n;
    const uint64_t maps = o->intrusion == DNRT_INTRUSION_SHADOW ? 6 : 0;
    return samples * (uint64_t)dnrt_normals(o) *
               ((uint64_t)(dnrt_planes(o) * dnrt_coefficients(o)) *
                    (o->bits == DNRT_BITS_16 ? 2 : 1) +
                8) +
           maps * (uint64_t)o->map_size * (uint64_t)o->map_size * 4;
}

const struct technique technique_dnrt = {
    .name = "dnrt",
    .title = "deferred neighboring radiance transfer",
    .paper = "Giuffrida 2016, Deferred Neighboring Radiance Transfer",
    .role = ROLE_DELTA,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS | NEEDS_BAKE,
    .needs = FRAME_WRITES_IRRADIANCE | FRAME_NEEDS_ID | FRAME_LEAVES_DYNAMIC,
    .bake_version = 7,
    .options = OPTION_TABLE(struct dnrt_options, option_rows, NULL),
    .presets = presets,
    .state_size = sizeof(struct dnrt),
    .bake = dnrt_bake,
    .objects = objects,
    .create = create,
    .load = load,
    .resize = resize,
    .follow = dnrt_follow,
    .lacks_bake = dnrt_lacks_bake,
    .set_probes = set_probes,
    .update = update,
    .record = record,
    .destroy = destroy,
    .memory_estimate = memory_estimate,
};
