// Shadow maps: cascades for suns, one perspective map for spots, six for points.
#include "frame/shadow/shadow.h"

#include "frame/light_projection.h"
#include "frame_shaders.h"

#include <math.h>
#include <string.h>

static const float CONSTANT_BIAS = 0.1f; // texels

bool shadow_init(struct shadow *s, struct host *host, struct gpu *gpu, uint32_t sun_size,
                 uint32_t cascades)
{
    *s = (struct shadow){ .host = host,
                          .gpu = gpu,
                          .sun_size = sun_size,
                          .size = sun_size / 2,
                          .cascades = cascades,
                          .sun_capacity = -1 };
    struct gpu_sampler_desc sampler = {
        .name = "frame.shadow_sampler",
        .filter = GPU_LINEAR,
        .mip_filter = GPU_NEAREST,
        .wrap_u = GPU_CLAMP,
        .wrap_v = GPU_CLAMP,
        .wrap_w = GPU_CLAMP,
        .compare_greater = true,
    };
    struct gpu_sampler_desc nearest = {
        .name = "frame.nearest", .wrap_u = GPU_CLAMP, .wrap_v = GPU_CLAMP, .wrap_w = GPU_CLAMP
    };
    return gpu_sampler_get(gpu, &sampler, &s->sampler) &&
           gpu_sampler_get(gpu, &nearest, &s->nearest) && shadow_casters_init(&s->casters, gpu) &&
           gpu_compute_pipeline_create(gpu, "frame.shadow_blocks", &shader_shadow_blocks_comp, NULL,
                                       0, &s->block_pipeline) &&
           shadow_prepare(s, 0, 0);
}

static void destroy_maps(struct shadow *s)
{
    gpu_image_destroy(s->gpu, &s->sun_maps);
    gpu_image_destroy(s->gpu, &s->maps);
    gpu_image_destroy(s->gpu, &s->sun_blocks);
    host_free(s->host, s->faces);
    host_free(s->host, s->cache);
    host_free(s->host, s->has_blocks);
    s->faces = NULL;
    s->cache = NULL;
    s->has_blocks = NULL;
    s->sun_capacity = s->capacity = -1;
}

void shadow_finish(struct shadow *s)
{
    if (!s->gpu) return;
    shadow_casters_finish(&s->casters);
    gpu_pipeline_destroy(s->gpu, &s->block_pipeline);
    destroy_maps(s);
    *s = (struct shadow){ 0 };
}

int shadow_faces_of(const struct shadow *s, uint32_t light_type)
{
    if (light_type == FRAME_LIGHT_SUN) return (int)s->cascades;
    return light_type == FRAME_LIGHT_POINT ? 6 : 1;
}

static bool make_array(struct shadow *s, const char *name, uint32_t size, int layers,
                       enum gpu_format format, gpu_image *out)
{
    struct gpu_image_desc desc = {
        .name = name,
        .dimension = GPU_2D_ARRAY,
        .format = format,
        .width = layers ? size : 8,
        .height = layers ? size : 8,
        .depth = layers ? (uint32_t)layers : 1,
        .usage = GPU_SAMPLED | (format == GPU_D32F ? GPU_ATTACHMENT : GPU_STORAGE),
    };
    return gpu_image_create(s->gpu, &desc, out);
}

bool shadow_prepare(struct shadow *s, int sun_faces, int faces)
{
    if (sun_faces == s->sun_capacity && faces == s->capacity) return true;
    int most = sun_faces > faces ? sun_faces : faces;
    if ((uint32_t)most > gpu_limits(s->gpu)->max_layers) {
        return host_fail(s->host, FAIL_UNSUPPORTED, "frame shadows: %d maps, device %s supports %u",
                         most, gpu_info(s->gpu)->name, gpu_limits(s->gpu)->max_layers);
    }
    destroy_maps(s);
    size_t count = (size_t)sun_faces + (size_t)faces;
    s->faces = host_alloc(s->host, count + FRAME_MAX_CASCADES, sizeof *s->faces);
    s->cache = host_alloc(s->host, count + 1, sizeof *s->cache);
    s->has_blocks = host_alloc(s->host, count + 1, sizeof *s->has_blocks);
    const uint32_t blocks = gpu_groups(s->sun_size, SHADOW_BLOCK);
    if (!s->faces || !s->cache || !s->has_blocks ||
        !make_array(s, "frame.shadow_sun_maps", s->sun_size, sun_faces, GPU_D32F, &s->sun_maps) ||
        !make_array(s, "frame.shadow_sun_blocks", blocks, sun_faces, GPU_RGBA16F, &s->sun_blocks) ||
        !make_array(s, "frame.shadow_maps", s->size, faces, GPU_D32F, &s->maps)) {
        return false;
    }
    s->sun_capacity = sun_faces;
    s->capacity = faces;
    return true;
}

// A face of a point or spot light, widened by the filter radius.
static void place_perspective(const struct shadow *s, struct shadow_face *face, int index,
                              const struct frame_light *light, const struct shadow_view *view)
{
    bool point = light->type == FRAME_LIGHT_POINT;
    float rim = 4.0f * ((float)view->filter_radius + 2.0f);
    float tan_half = point ? 1.0f : light_spot_tan(light->cos_outer);
    tan_half /= fmaxf(1.0f - rim / (float)s->size, 0.25f);
    float near_m = light_near(view->bounds);
    *face = (struct shadow_face){
        .clip_from_world =
            point ? light_cube_face(light->position, index, tan_half, near_m)
                  : light_spot_face(light->position, light->direction, tan_half, near_m),
        .texel_m = 2.0f * tan_half / (float)s->size,
        .size = (float)s->size,
    };
    // Depth is near / distance, w the distance, and a texel's edge texel_m · distance.
    face->depth_scale = 1.0f + CONSTANT_BIAS * face->texel_m;
    face->depth_texels = 1.0f / (near_m * face->texel_m);
}

// Cascades that cover the whole scene use the last cascade's map.
static void place_layers(struct shadow_face *faces, int count, int first)
{
    const struct shadow_face *last = &faces[count - 1];
    for (int k = 0; k < count; k++) {
        const bool equal = memcmp(&faces[k].clip_from_world, &last->clip_from_world,
                                  sizeof last->clip_from_world) == 0;
        faces[k].layer = first + (equal ? count - 1 : k);
    }
}

void shadow_place(struct shadow *s, struct frame_light *lights, int light_count,
                  const struct shadow_view *view)
{
    int used[2] = { 0, 0 }; // layers: of suns, of other lights
    const int capacity[2] = { s->sun_capacity, s->capacity };
    s->face_count = 0;
    for (int i = 0; i < light_count; i++) {
        struct frame_light *light = &lights[i];
        int count = shadow_faces_of(s, light->type), array = light->type != FRAME_LIGHT_SUN;
        light->shadow_first = -1;
        light->shadow_count = 0;
        if (count > capacity[array] - used[array]) continue;
        struct shadow_face *faces = &s->faces[s->face_count];
        if (light->type == FRAME_LIGHT_SUN) {
            shadow_place_sun(s, faces, count, light->direction, view);
        } else {
            for (int k = 0; k < count; k++) place_perspective(s, &faces[k], k, light, view);
        }
        place_layers(faces, count, used[array]);
        used[array] += count;
        light->shadow_first = s->face_count;
        light->shadow_count = count;
        s->face_count += count;
    }
}

static void record_face(const struct shadow *s, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                        const struct shadow_face *face, bool sun)
{
    const struct shadow_map_target target = {
        .maps = sun ? s->sun_maps : s->maps,
        .layer = (uint32_t)face->layer,
        .size = sun ? s->sun_size : s->size,
        .clip_from_world = face->clip_from_world,
        .bounds = box3_empty(),
    };
    shadow_casters_record(&s->casters, cmd, scene, &target);
}

void shadow_record(struct shadow *s, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                   const struct frame_light *lights, int light_count, bool reuse)
{
    s->drawn = 0;
    static const char *const scopes[] = { "shadow.sun", "shadow.point", "shadow.spot" };
    for (int i = 0; i < light_count; i++) {
        if (lights[i].shadow_count == 0) continue;
        gpu_scope_begin(cmd, scopes[lights[i].type]);
        for (int k = 0; k < lights[i].shadow_count; k++) {
            const int index = lights[i].shadow_first + k;
            const struct shadow_face *face = &s->faces[index];
            const struct shadow_face *last = face + (lights[i].shadow_count - 1 - k);
            if (face != last && face->layer == last->layer) continue;
            const bool valid = cached_map_is_valid(&s->cache[index], scene, &lights[i],
                                                   face->clip_from_world, false);
            if (valid && reuse) continue;
            s->has_blocks[index] = false;
            record_face(s, cmd, scene, face, lights[i].type == FRAME_LIGHT_SUN);
            s->drawn++;
        }
        gpu_scope_end(cmd);
    }
}

static void record_blocks(const struct shadow *s, struct gpu_cmd *cmd,
                          const struct shadow_face *face)
{
    const struct shadow_blocks_push push = { face->layer, face->depth_texels };
    const uint32_t groups = gpu_groups(s->sun_size, 8 * SHADOW_BLOCK);
    gpu_dispatch(cmd, s->block_pipeline,
                 GPU_BIND({ "shadow_sun_depths", .image = s->sun_maps, .sampler = s->nearest },
                          { "shadow_blocks", .image = s->sun_blocks }),
                 &push, sizeof push, groups, groups, 1);
}

bool shadow_record_blocks(struct shadow *s, struct gpu_cmd *cmd, const struct frame_light *sun)
{
    if (s->drawn > 0 || sun->shadow_count == 0) return false;
    gpu_scope_begin(cmd, "shadow.blocks");
    for (int k = 0; k < sun->shadow_count; k++) {
        const int index = sun->shadow_first + k;
        const int last = sun->shadow_first + sun->shadow_count - 1;
        const bool shared = index != last && s->faces[index].layer == s->faces[last].layer;
        if (shared || s->has_blocks[index]) continue;
        record_blocks(s, cmd, &s->faces[index]);
        s->has_blocks[index] = true;
    }
    gpu_scope_end(cmd);
    return true;
}
