// Objects that come, go, or get another shape while frames are rendered. An object whose mesh and
// stretch are in the bake has that volume; others need another bake, of their meshes alone.
#include "techniques/dnrt/dnrt_state.h"

// Room for objects along the edges of a cube of volumes; those of an object lie along x.
static void count_slots(const struct dnrt *s, int slots[3])
{
    const int normals = dnrt_normals(&s->options);
    int edge = 1;
    do {
        slots[0] = edge < normals ? 1 : edge / normals;
        slots[1] = slots[2] = edge++;
    } while (slots[0] * slots[1] * slots[2] < s->objects.count);
}

static bool make_image(struct dnrt *s)
{
    const uint32_t size = (uint32_t)dnrt_size(&s->options);
    int n[3];
    count_slots(s, n);
    const struct gpu_image_desc desc = { .name = "volumes",
                                         .dimension = GPU_3D,
                                         .format = GPU_RGBA16F,
                                         .width =
                                             size * (uint32_t)(n[0] * dnrt_normals(&s->options)),
                                         .height = size * (uint32_t)n[1],
                                         .depth = size * (uint32_t)n[2],
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    const size_t entries = (size_t)(n[0] * n[1] * n[2]) * DNRT_COEFFICIENTS * DNRT_LIGHT_PARTS;
    const struct gpu_buffer_desc light = { "light", entries * sizeof(vec3s), GPU_BUFFER_STORAGE };
    s->stale = true;
    if (s->image.id && n[2] <= s->slots[2]) return true;
    gpu_image_destroy(s->gpu, &s->image);
    gpu_buffer_destroy(s->gpu, &s->light);
    for (int i = 0; i < 3; i++) s->slots[i] = n[i];
    return gpu_image_create(s->gpu, &desc, &s->image) &&
           gpu_buffer_create(s->gpu, &light, &s->light);
}

bool dnrt_make_tiles(struct dnrt *s)
{
    const size_t words =
        s->most_tiles * (DNRT_TILE_BITS + gpu_groups((uint32_t)s->objects.count, 32));
    if (words <= s->tiles_words) return true;
    uint32_t *tiles = host_realloc(s->host, s->tiles, words, sizeof *tiles);
    if (!tiles) return false;
    s->tiles = tiles;
    s->tiles_words = words;
    return true;
}

// Once.
static void warn(struct dnrt *s, int without)
{
    if (s->warned || (without == 0 && s->objects.count <= DNRT_MAX_OBJECTS)) return;
    s->warned = true;
    if (without > 0)
        host_log(
            s->host, LOG_WARNING,
            "dnrt: %d dynamic objects are not in its bake and change no light; bake again, which "
            "takes their meshes alone, and give the bake to the renderer "
            "(docs/techniques/dnrt.md#objects-that-come-later)",
            without);
    else
        host_log(s->host, LOG_WARNING, "dnrt: of %d dynamic objects the first %d change the light",
                 s->objects.count, DNRT_MAX_OBJECTS);
}

static bool make_images(struct dnrt *s, const struct scene *scene)
{
    host_free(s->host, s->gpu_objects);
    s->gpu_objects = host_alloc(s->host, DNRT_MAX_OBJECTS, sizeof *s->gpu_objects);
    if (s->gpu_objects && dnrt_make_tiles(s) &&
        (s->baked.count == 0 || s->objects.count == 0 ||
         (make_image(s) && dnrt_make_maps(s) && dnrt_make_own(s, scene))))
        return true;
    s->objects.count = 0;
    return false;
}

bool dnrt_find_objects(struct dnrt *s, const struct scene_pose *pose)
{
    struct dnrt_objects found;
    int without = 0;
    if (!dnrt_objects_init(&found, s->host, pose, s->options.keys, false)) {
        dnrt_objects_finish(&found);
        s->objects.count = 0;
        return false;
    }
    dnrt_objects_finish(&s->objects);
    s->objects = found;
    for (int i = 0; i < found.count; i++) {
        found.at[i].shape = dnrt_find_shape(&s->baked, &found, pose, i);
        without += found.at[i].shape < 0;
    }
    s->without = without;
    warn(s, without);
    if (s->objects.count > DNRT_MAX_OBJECTS) s->objects.count = DNRT_MAX_OBJECTS;
    s->revisions = pose->scene->revisions;
    return make_images(s, pose->scene);
}

bool dnrt_lacks_bake(const void *state)
{
    const struct dnrt *s = state;
    return s->without > 0;
}

// Once. Light between the parts of an object is not linear in its reflectance.
static void check_materials(struct dnrt *s, const struct scene *scene)
{
    for (int i = 0; i < s->baked.shape_count && !s->warned_materials; i++) {
        const struct dnrt_shape *shape = &s->baked.shapes[i];
        for (int k = shape->first; k < shape->first + shape->count; k++) {
            const int m = scene->meshes[s->baked.meshes[k]].material;
            if (s->warned_materials || m >= s->material_count ||
                material_reflects_alike(&s->materials[m], &scene->materials[m]))
                continue;
            s->warned_materials = true;
            host_log(s->host, LOG_WARNING,
                     "dnrt: material %s of a dynamic object: its reflectance changed, but the "
                     "light that the object reflects stays; bake the changed scene",
                     scene->materials[m].name ? scene->materials[m].name : "");
        }
    }
}

void dnrt_follow(void *state, const struct scene_pose *pose, bool wait)
{
    struct dnrt *s = state;
    const struct scene_revisions *now = &pose->scene->revisions;
    (void)wait;
    if (now->materials != s->revisions.materials) {
        s->revisions.materials = now->materials;
        check_materials(s, pose->scene);
    }
    if (now->layout != s->revisions.layout || now->instances != s->revisions.instances ||
        now->transforms != s->revisions.transforms)
        dnrt_find_objects(s, pose);
}
