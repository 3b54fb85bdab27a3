// Host code of the reflective shadow map pass.
#include "frame/rsm/rsm.h"

#include "frame/light_projection.h"
#include "frame/projection.h"

#include "frame_shaders.h"

#include <math.h>

// Reflective shadow maps ignore normal maps and emission.
static const uint32_t VARIANT_BITS =
    VARIANT_BASE_COLOR_MAP | VARIANT_METALLIC_ROUGHNESS_MAP | VARIANT_MASKED;

struct push {
    struct scene_push draw;
    uint32_t face;
    float reflects; // 0: its light is left to a delta
};

bool rsm_init(struct rsm *r, struct host *host, struct gpu *gpu, uint32_t size)
{
    *r = (struct rsm){ .host = host, .gpu = gpu, .size = size };
    return true;
}

static void destroy_images(struct rsm *r)
{
    gpu_image_destroy(r->gpu, &r->depth);
    gpu_image_destroy(r->gpu, &r->normal);
    gpu_image_destroy(r->gpu, &r->flux);
    host_free(r->host, r->faces);
    host_free(r->host, r->cache);
    r->faces = NULL;
    r->cache = NULL;
    r->capacity = 0;
}

void rsm_finish(struct rsm *r)
{
    if (!r->gpu) return;
    destroy_images(r);
    for (int v = 0; v < VARIANT_COUNT; v++) gpu_pipeline_destroy(r->gpu, &r->pipelines[v]);
    *r = (struct rsm){ 0 };
}

int rsm_faces_of(uint32_t light_type)
{
    return light_type == FRAME_LIGHT_POINT ? 6 : 1;
}

static bool make_pipeline(struct rsm *r, uint32_t variant)
{
    struct gpu_constant constants[SCENE_CONSTANT_COUNT];
    gpu_constants_of_bits(variant, constants, SCENE_CONSTANT_COUNT);
    struct gpu_graphics_desc desc = {
        .name = "frame.rsm",
        .vertex = &shader_rsm_vert,
        .fragment = &shader_rsm_frag,
        .constants = constants,
        .constant_count = SCENE_CONSTANT_COUNT,
        .color_formats = { GPU_RG16F, GPU_RGBA8_SRGB },
        .depth_format = GPU_D32F,
        .depth_compare = GPU_GREATER,
        .depth_write = true,
    };
    return gpu_graphics_pipeline_create(r->gpu, &desc, &r->pipelines[variant]);
}

static bool make_array(struct rsm *r, const char *name, enum gpu_format format, int layers,
                       gpu_image *out)
{
    struct gpu_image_desc desc = {
        .name = name,
        .dimension = GPU_2D_ARRAY,
        .format = format,
        .width = r->size,
        .height = r->size,
        .depth = (uint32_t)layers,
        .usage = GPU_SAMPLED | GPU_ATTACHMENT,
    };
    return gpu_image_create(r->gpu, &desc, out);
}

static bool make_images(struct rsm *r, int faces)
{
    if (faces == r->capacity) return true;
    destroy_images(r);
    if (faces == 0) return true;
    if ((uint32_t)faces > gpu_limits(r->gpu)->max_layers) {
        return host_fail(r->host, FAIL_UNSUPPORTED,
                         "frame reflective shadow maps: %d faces, device %s supports %u", faces,
                         gpu_info(r->gpu)->name, gpu_limits(r->gpu)->max_layers);
    }
    r->faces = host_alloc(r->host, (size_t)faces, sizeof *r->faces);
    r->cache = host_alloc(r->host, (size_t)faces, sizeof *r->cache);
    if (!r->faces || !r->cache || !make_array(r, "frame.rsm_depth", GPU_D32F, faces, &r->depth) ||
        !make_array(r, "frame.rsm_normal", GPU_RG16F, faces, &r->normal) ||
        !make_array(r, "frame.rsm_flux", GPU_RGBA8_SRGB, faces, &r->flux)) {
        return false;
    }
    r->capacity = faces;
    return true;
}

bool rsm_prepare(struct rsm *r, int face_count, uint32_t variants)
{
    if (!make_images(r, face_count)) return false;
    if (face_count == 0) return true;
    for (uint32_t v = 0; v < VARIANT_COUNT; v++) {
        if (!(variants >> v & 1u) || r->pipelines[v & VARIANT_BITS].id) continue;
        if (!make_pipeline(r, v & VARIANT_BITS)) return false;
    }
    return true;
}

bool rsm_compile(struct gpu *compiler, uint32_t variants)
{
    struct rsm scratch = { .gpu = compiler };
    for (uint32_t v = 0; v < VARIANT_COUNT; v++) {
        if (!(variants >> v & 1u) || scratch.pipelines[v & VARIANT_BITS].id) continue;
        if (!make_pipeline(&scratch, v & VARIANT_BITS)) return false;
    }
    return true;
}

// Covers the whole scene and does not follow the camera, so that indirect light is stable.
static void place_sun(const struct rsm *r, struct rsm_face *face, const struct frame_light *light,
                      struct box3 bounds)
{
    struct box3 box = box3_transform(light_space(light->direction), bounds);
    vec3s size = box3_size(box), centre = box3_centre(box);
    float half = fmaxf(0.5f * fmaxf(size.x, size.y), 1e-3f) * 1.001f, depth_m;
    float texel = 2.0f * half / (float)r->size;
    face->tan_half = half;
    face->intensity = glms_vec3_scale(light->intensity, texel * texel);
    face->position = vec3_of(0, 0, 0);
    face->clip_from_world =
        light_orthographic(light->direction, centre.x, centre.y, half, bounds, &depth_m);
}

static void place_face(const struct rsm *r, struct rsm_face *face, int index,
                       const struct frame_light *light, struct box3 bounds)
{
    face->type = light->type;
    face->direction = light->direction;
    if (light->type == FRAME_LIGHT_SUN) {
        place_sun(r, face, light, bounds);
    } else {
        bool point = light->type == FRAME_LIGHT_POINT;
        float near_m = light_near(bounds);
        face->intensity = light->intensity;
        face->position = light->position;
        face->tan_half = point ? 1.0f : light_spot_tan(light->cos_outer);
        face->clip_from_world =
            point ? light_cube_face(light->position, index, face->tan_half, near_m)
                  : light_spot_face(light->position, light->direction, face->tan_half, near_m);
    }
    face->world_from_clip = projection_inverse(face->clip_from_world);
}

void rsm_place(struct rsm *r, const struct frame_light *lights, int light_count, struct box3 bounds)
{
    if (box3_is_empty(bounds)) bounds = (struct box3){ vec3_of(-1, -1, -1), vec3_of(1, 1, 1) };
    r->face_count = 0;
    for (int i = 0; i < light_count; i++) {
        int count = rsm_faces_of(lights[i].type);
        if (count > r->capacity - r->face_count) continue;
        for (int k = 0; k < count; k++) {
            struct rsm_face *face = &r->faces[r->face_count++];
            *face = (struct rsm_face){ .light = (uint32_t)i };
            place_face(r, face, k, &lights[i], bounds);
        }
    }
}

static void record_face(const struct rsm *r, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                        int face, const struct gpu_binding bindings[3])
{
    uint32_t layer = (uint32_t)face;
    struct push push = { .face = layer };
    gpu_render_begin(cmd, &(struct gpu_render_desc){
                              .color = { { .image = r->normal, .layer = layer },
                                         { .image = r->flux, .layer = layer } },
                              .color_count = 2,
                              .depth = { .image = r->depth, .layer = layer },
                              .width = r->size,
                              .height = r->size,
                              .reads = scene->reads,
                              .read_count = scene->read_count,
                          });
    for (int i = 0; i < scene->draw_count; i++) {
        const struct scene_draw *draw = &scene->draws[i];
        if (!projection_may_see(r->faces[face].clip_from_world, draw->bounds)) continue;
        push.reflects = draw->left ? 0.0f : 1.0f;
        scene_gpu_draw(scene, cmd,
                       &(struct scene_draw_call){
                           .pipeline = r->pipelines[draw->variant & VARIANT_BITS],
                           .draw = draw,
                           .push = &push,
                           .push_bytes = sizeof push,
                           .cull = GPU_CULL_NONE,
                           .bindings = bindings,
                           .binding_count = 3,
                       });
    }
    gpu_render_end(cmd);
}

void rsm_record(struct rsm *r, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                const struct frame_light *lights, const struct gpu_binding bindings[3], bool reuse)
{
    static const char *const scopes[] = { "rsm.sun", "rsm.point", "rsm.spot" };
    r->drawn = 0;
    for (int i = 0; i < r->face_count; i++) {
        const struct rsm_face *face = &r->faces[i];
        const bool valid = cached_map_is_valid(&r->cache[i], scene, &lights[face->light],
                                               face->clip_from_world, true);
        gpu_scope_begin(cmd, scopes[face->type]);
        if (!valid || !reuse) {
            record_face(r, cmd, scene, i, bindings);
            r->drawn++;
        }
        gpu_scope_end(cmd);
    }
}
