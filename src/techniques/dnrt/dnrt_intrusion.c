// Depth maps around objects (Giuffrida 2016, section 5.2.3): cube maps from the centre of an
// object's bounding sphere, without the object. They are kept while nothing moves within reach.
#include "techniques/dnrt/dnrt_state.h"

#include "frame/light_projection.h"

#include <math.h>

enum { FACES = 6 };

bool dnrt_make_maps(struct dnrt *s)
{
    const int most = (int)(gpu_limits(s->gpu)->max_layers / FACES);
    const int count = s->objects.count < most ? s->objects.count : most;
    if (s->options.intrusion == DNRT_INTRUSION_OFF) return true;
    for (int i = 0; i < s->map_count; i++) s->maps[i].updates = 0;
    if (count <= s->map_count) return true;
    const struct gpu_image_desc desc = { .name = "depth_maps",
                                         .dimension = GPU_2D_ARRAY,
                                         .format = GPU_D32F,
                                         .width = (uint32_t)s->options.map_size,
                                         .height = (uint32_t)s->options.map_size,
                                         .depth = (uint32_t)(FACES * count),
                                         .usage = GPU_SAMPLED | GPU_ATTACHMENT };
    gpu_image_destroy(s->gpu, &s->map_image);
    host_free(s->host, s->maps);
    s->map_count = 0;
    s->maps = host_alloc(s->host, (size_t)count, sizeof *s->maps);
    if (!s->maps || !gpu_image_create(s->gpu, &desc, &s->map_image)) return false;
    s->map_count = count;
    return true;
}

static bool is_same(const struct dnrt_map *a, const struct dnrt_map *b)
{
    return glms_vec3_eqv(a->centre, b->centre) && a->radius == b->radius && a->reach == b->reach &&
           a->first_instance == b->first_instance && a->instance_count == b->instance_count;
}

static struct box3 box_of(const struct dnrt_map *map)
{
    return (struct box3){ glms_vec3_subs(map->centre, map->reach),
                          glms_vec3_adds(map->centre, map->reach) };
}

static void record_map(const struct dnrt *s, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                       const struct dnrt_map *map, int index)
{
    for (int face = 0; face < FACES; face++)
        shadow_casters_record(&s->casters, cmd, scene,
                              &(struct shadow_map_target){
                                  .maps = s->map_image,
                                  .layer = (uint32_t)(FACES * index + face),
                                  .size = (uint32_t)s->options.map_size,
                                  .clip_from_world = light_cube_face(
                                      map->centre, face, 1.0f, (float)DNRT_NEAR * map->radius),
                                  .first_instance = map->first_instance,
                                  .instance_count = map->instance_count,
                                  .bounds = box_of(map),
                              });
}

// Whether it is the one of the previous frame.
static bool is_valid(struct dnrt_map *map, const struct dnrt_map *now,
                     const struct frame_view *view)
{
    const bool valid = view->keep && map->updates + 1 == now->updates && is_same(map, now) &&
                       scene_gpu_unchanged_around(view->scene, box_of(now), now->first_instance,
                                                  now->instance_count);
    *map = *now;
    return valid;
}

void dnrt_record_maps(struct dnrt *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    for (int i = 0; i < s->map_count && i < s->objects.count; i++) {
        const struct dnrt_gpu_object *object = &s->gpu_objects[i];
        if (object->shape < 0 || (s->views == 1 && !dnrt_in_view(s, view, i))) continue;
        const struct dnrt_map now = {
            .centre = object->centre,
            .radius = object->half_m / s->options.reach,
            .reach = object->half_m * fmaxf(s->options.fade, 1.0f) * sqrtf(3.0f),
            .first_instance = object->first_instance,
            .instance_count = object->instance_count,
            .updates = view->scene->updates,
        };
        if (is_valid(&s->maps[i], &now, view)) continue;
        gpu_scope_begin(cmd, "maps");
        record_map(s, cmd, view->scene, &now, i);
        gpu_scope_end(cmd);
    }
}
