// Creation and destruction of a scene, and scene_add_* for everything but meshes (scene_mesh.c).
// Each function checks its argument before it changes the scene: a failure leaves it unchanged.
#include "scene/scene.h"

#include "scene/environment/environment_map.h"
#include "scene/limits.h"
#include "scene/scene_check.h"

#include <limits.h>
#include <math.h>
#include <string.h>

struct scene *scene_create(struct host *host, const char *name)
{
    struct scene *scene = host_alloc(host, 1, sizeof *scene);
    if (!scene) return NULL;
    scene->host = host;
    arena_init(&scene->arena, host);
    scene->free_node = -1;
    scene->scale = 1.0f;
    scene->name = arena_strdup(&scene->arena, name_or_empty(name));
    scene->warned_of_unwraps = arena_alloc(&scene->arena, 1, sizeof *scene->warned_of_unwraps);
    if (!scene->name || !scene->warned_of_unwraps) goto fail;
    return scene;
fail:
    scene_destroy(scene);
    return NULL;
}

void scene_destroy(struct scene *scene)
{
    if (!scene) return;
    struct host *host = scene->host;
    environment_map_release(scene->environment.map);
    arena_finish(&scene->arena);
    host_free(host, scene);
}

void scene_set_host(struct scene *scene, struct host *host)
{
    scene->host = host;
    scene->arena.host = host;
}

void *scene_copy(struct scene *scene, const void *source, size_t count, size_t size)
{
    void *copy = arena_alloc(&scene->arena, count, size);
    if (copy && count > 0)
        memcpy(copy, source, count * size); // the product was checked by arena_alloc
    return copy;
}

bool scene_reserve(struct scene *scene, void **array, int count, int *capacity, size_t size)
{
    if (count < *capacity) return true;
    if (count > INT_MAX / 2) {
        return host_fail(scene->host, FAIL_MEMORY, "scene %s: more than %d elements of one kind",
                         scene->name, INT_MAX / 2);
    }
    // The arena keeps the old arrays: with doubling they take no more than the new one.
    int doubled = count < 4 ? 8 : 2 * count;
    void *grown = arena_alloc(&scene->arena, (size_t)doubled, size);
    if (!grown) return false;
    if (count > 0) memcpy(grown, *array, (size_t)count * size);
    *array = grown;
    *capacity = doubled;
    return true;
}

uint64_t scene_changed(struct scene *scene, uint64_t *part)
{
    return *part = ++scene->revisions.newest;
}

// Appends *element to scene->plural; -1 when out of memory.
#define APPEND(scene, plural, singular, element)                                                   \
    (scene_reserve((scene), (void **)&(scene)->plural, (scene)->singular##_count,                  \
                   &(scene)->capacity.plural, sizeof *(scene)->plural)                             \
         ? ((scene)->plural[(scene)->singular##_count] = (element), (scene)->singular##_count++)   \
         : -1)

static bool copy_name(struct scene *scene, const char **name)
{
    *name = arena_strdup(&scene->arena, name_or_empty(*name));
    return *name != NULL;
}

bool scene_refuse(struct scene *scene, const char *kind, const char *name, const char *why)
{
    return host_fail(scene->host, FAIL_ARGUMENT, "%s \"%s\" in %s: %s", kind, name_or_empty(name),
                     scene->name, why);
}

int scene_add_image(struct scene *scene, const struct scene_image *image)
{
    if (image->width < 1 || image->height < 1 || image->width > SCENE_MAX_IMAGE_SIZE ||
        image->height > SCENE_MAX_IMAGE_SIZE || !image->rgba) {
        scene_refuse(scene, "image", image->name,
                     "its size is not 1 to 8192 pixels, or it has no pixels");
        return -1;
    }
    struct scene_image copy = *image;
    size_t texels = (size_t)image->width * (size_t)image->height;
    copy.rgba = scene_copy(scene, image->rgba, texels, 4);
    if (!copy.rgba || !copy_name(scene, &copy.name)) return -1;
    copy.has_alpha = false;
    for (size_t i = 0; i < texels && !copy.has_alpha; i++) {
        copy.has_alpha = copy.rgba[4 * i + 3] != 255;
    }
    scene_changed(scene, &scene->revisions.resources);
    return APPEND(scene, images, image, copy);
}

static bool texture_use_is_valid(const struct scene *scene, const struct texture_use *use)
{
    if (use->image == -1) return true;
    return index_is_valid(use->image, scene->image_count) && index_is_valid(use->uv_set, 2) &&
           floats_are_finite(use->uv_offset, 2) && floats_are_finite(use->uv_scale, 2) &&
           isfinite(use->uv_rotation_rad);
}

static bool is_fraction(float value)
{
    return value >= 0.0f && value <= 1.0f;
}

static bool is_colour(vec3s value)
{
    return vec3_is_finite(value) && value.x >= 0.0f && value.y >= 0.0f && value.z >= 0.0f;
}

const char *scene_material_fault(const struct scene *scene, const struct material *material)
{
    if (!is_colour(vec3_xyz(material->base_color)) || !is_fraction(material->base_color.w))
        return "its base colour is negative or not finite";
    if (!is_fraction(material->metallic) || !is_fraction(material->roughness))
        return "its metallic or roughness factor is not in 0…1";
    if (!is_fraction(material->specular) || !is_colour(material->specular_color))
        return "its specular weight is not in 0…1, or its specular colour negative or not finite";
    if (!isfinite(material->ior) || (material->ior != 0.0f && !(material->ior >= 1.0f)))
        return "its index of refraction is neither 0 nor at least 1";
    if (!limits_light(material->emissive)) return "its emission is not within 0 to 1e15 cd/m²";
    if (!isfinite(material->normal_scale) || !isfinite(material->alpha_cutoff))
        return "its normal scale or alpha cutoff is not finite";
    const struct texture_use *maps[] = {
        &material->base_color_map, &material->metallic_roughness_map, &material->normal_map,
        &material->emissive_map,   &material->specular_map,           &material->specular_color_map,
    };
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (!texture_use_is_valid(scene, maps[i]))
            return "a texture refers to an image or coordinate set that does not exist";
    return NULL;
}

int scene_add_material(struct scene *scene, const struct material *material)
{
    const char *why = scene_material_fault(scene, material);
    if (why) {
        scene_refuse(scene, "material", material->name, why);
        return -1;
    }
    struct material copy = *material;
    if (copy.unlit) material_clear_emission(&copy);
    if (!copy_name(scene, &copy.name)) return -1;
    copy.revision = scene_changed(scene, &scene->revisions.resources);
    return APPEND(scene, materials, material, copy);
}

static bool matrix_is_finite(const mat4s *matrix)
{
    for (int column = 0; column < 4; column++) {
        if (!vec4_is_finite(matrix->col[column])) return false;
    }
    return true;
}

int scene_add_node(struct scene *scene, const struct node *node)
{
    struct node copy = *node;
    float rotation_length = glms_quat_norm(copy.rotation);
    const char *why = NULL;
    if (copy.parent < -1 || copy.parent >= scene->node_count) {
        why = "its parent is not an earlier node";
    } else if (copy.has_matrix && !matrix_is_finite(&copy.matrix)) {
        why = "its matrix is not finite";
    } else if (!copy.has_matrix &&
               (!vec3_is_finite(copy.translation) || !vec3_is_finite(copy.scale) ||
                !isfinite(rotation_length) || rotation_length <= 0.0f)) {
        why = "its translation, rotation or scale is not finite";
    }
    if (why) {
        scene_refuse(scene, "node", node->name, why);
        return -1;
    }
    if (!copy.has_matrix) copy.rotation = glms_quat_normalize(copy.rotation);
    if (!copy_name(scene, &copy.name)) return -1;
    if (copy.extras && !(copy.extras = arena_strdup(&scene->arena, copy.extras))) return -1;
    copy.next_free = -1;
    scene_changed(scene, &scene->revisions.layout);
    return APPEND(scene, nodes, node, copy);
}

// Every joint index of the mesh must exist in the skin.
static bool skin_fits_mesh(const struct skin *skin, const struct mesh *mesh)
{
    if (!mesh->joints || !mesh->weights) return false;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (int k = 0; k < 4; k++) {
            if (mesh->joints[v][k] >= skin->joint_count) return false;
        }
    }
    return true;
}

static const char *instance_fault(const struct scene *scene, const struct instance *instance)
{
    if (!index_is_valid(instance->node, scene->node_count)) return "its node does not exist";
    if (!index_is_valid(instance->mesh, scene->mesh_count)) return "its mesh does not exist";
    const struct mesh *mesh = &scene->meshes[instance->mesh];
    if (instance->skin != -1 && !index_is_valid(instance->skin, scene->skin_count))
        return "its skin does not exist";
    if (instance->skin != -1 && !skin_fits_mesh(&scene->skins[instance->skin], mesh))
        return "its mesh uses joints that the skin does not have";
    if (instance->morph_weights &&
        !floats_are_finite(instance->morph_weights, (size_t)mesh->morph_count))
        return "a morph weight is not finite";
    return NULL;
}

static bool copy_weights(struct scene *scene, const struct instance *from, struct instance *to)
{
    const size_t count = (size_t)scene->meshes[from->mesh].morph_count;
    to->morph_weights = NULL;
    if (count == 0) return true;
    to->morph_weights =
        from->morph_weights
            ? scene_copy(scene, from->morph_weights, count, sizeof *to->morph_weights)
            : arena_alloc(&scene->arena, count, sizeof *to->morph_weights);
    return to->morph_weights != NULL;
}

static int free_instance(struct scene *scene)
{
    if (scene->free_instance_count == 0) return -1;
    int i = scene->first_free_instance;
    while (scene->instances[i].mesh >= 0) i++;
    scene->first_free_instance = i + 1;
    scene->free_instance_count--;
    return i;
}

int scene_add_instance(struct scene *scene, const struct instance *instance)
{
    const char *why = instance_fault(scene, instance);
    if (why) {
        scene_refuse(scene, "instance", "", why);
        return -1;
    }
    struct instance copy = *instance;
    if (!copy_weights(scene, instance, &copy)) return -1;
    const int index = free_instance(scene);
    scene_changed(scene, &scene->revisions.layout);
    if (!copy.movable) scene_changed(scene, &scene->revisions.statics);
    copy.added = scene_changed(scene, &scene->revisions.instances);
    if (index < 0) return APPEND(scene, instances, instance, copy);
    scene->instances[index] = copy;
    return index;
}

// The cone of a spot: 0 ≤ inner < outer ≤ π/2.
static bool cone_is_valid(const struct light *light)
{
    return light->inner_rad >= 0.0f && light->inner_rad < light->outer_rad &&
           light->outer_rad <= GLM_PI_2f + 1e-6f;
}

const char *scene_light_fault(const struct scene *scene, const struct light *light)
{
    if (!index_is_valid(light->node, scene->node_count)) return "its node does not exist";
    if (light->type != LIGHT_SUN && light->type != LIGHT_POINT && light->type != LIGHT_SPOT)
        return "its type is unknown";
    if (!limits_light(light->intensity))
        return "its intensity is not within 0 to 1e15 lux or candela";
    if (light->type == LIGHT_SPOT && !cone_is_valid(light))
        return "its cone is not 0 ≤ inner < outer ≤ 90 degrees";
    if (!isfinite(light->range_m) || light->range_m < 0.0f)
        return "its range is negative or not finite";
    return NULL;
}

int scene_append_light(struct scene *scene, const struct light *light)
{
    scene_changed(scene, &scene->revisions.lights);
    return APPEND(scene, lights, light, *light);
}

int scene_add_light(struct scene *scene, const struct light *light)
{
    const char *why = scene_light_fault(scene, light);
    if (why) {
        scene_refuse(scene, "light", light->name, why);
        return -1;
    }
    struct light copy = *light;
    return copy_name(scene, &copy.name) ? scene_append_light(scene, &copy) : -1;
}

int scene_add_camera(struct scene *scene, const struct camera *camera)
{
    const char *why = NULL;
    if (!index_is_valid(camera->node, scene->node_count)) {
        why = "its node does not exist";
    } else if (!(camera->vertical_fov_rad > 0.0f && camera->vertical_fov_rad < GLM_PIf)) {
        why = "its field of view is not between 0 and 180 degrees";
    } else if (!(camera->near_m > 0.0f && isfinite(camera->near_m))) {
        why = "the distance of its near plane is not positive and finite";
    }
    if (why) {
        scene_refuse(scene, "camera", camera->name, why);
        return -1;
    }
    struct camera copy = *camera;
    if (!copy_name(scene, &copy.name)) return -1;
    return APPEND(scene, cameras, camera, copy);
}

bool scene_looking(vec3s position, vec3s direction, mat4s *world_from_node)
{
    direction = vec3_unit(direction);
    if (!vec3_is_finite(position) || glms_vec3_norm(direction) == 0.0f) return false;
    vec3s back = glms_vec3_negate(direction);
    // Up is nearest to +y; for a vertical direction it is -z or +z.
    vec3s reference = fabsf(back.y) < 0.9999f ? vec3_of(0, 1, 0) : vec3_of(0, 0, -back.y);
    vec3s right = glms_vec3_normalize(glms_vec3_cross(reference, back));
    vec3s up = glms_vec3_cross(back, right);
    *world_from_node = (mat4s){ .col = { vec4_of(right, 0), vec4_of(up, 0), vec4_of(back, 0),
                                         vec4_of(position, 1) } };
    return true;
}

int scene_add_node_looking(struct scene *scene, const char *name, vec3s position, vec3s direction)
{
    struct node node = node_default();
    node.name = name;
    node.has_matrix = true;
    if (scene_looking(position, direction, &node.matrix)) return scene_add_node(scene, &node);
    scene_refuse(scene, "node", name,
                 "its position is not finite or its direction has length zero");
    return -1;
}

struct material material_default(void)
{
    return (struct material){
        .name = "",
        .base_color = { { 1, 1, 1, 1 } },
        .metallic = 0.0f,
        .roughness = 1.0f,
        .normal_scale = 1.0f,
        .alpha_cutoff = 0.5f,
        .alpha_mode = ALPHA_OPAQUE,
        .base_color_map = texture_use_none(),
        .metallic_roughness_map = texture_use_none(),
        .normal_map = texture_use_none(),
        .emissive_map = texture_use_none(),
        .specular_map = texture_use_none(),
        .specular_color_map = texture_use_none(),
        .ior = MATERIAL_DEFAULT_IOR,
        .specular = 1.0f,
        .specular_color = { { 1, 1, 1 } },
    };
}

void material_clear_emission(struct material *m)
{
    m->emissive = vec3_of(0, 0, 0);
    m->emissive_map = texture_use_none();
}

vec3s material_specular_f0(const struct material *m)
{
    float root = (m->ior - 1.0f) / (m->ior + 1.0f);
    return glms_vec3_scale(m->specular_color, root * root);
}

static bool same_colors(vec3s a, vec3s b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool material_reflects_alike(const struct material *a, const struct material *b)
{
    return same_colors(vec3_xyz(a->base_color), vec3_xyz(b->base_color)) &&
           a->metallic == b->metallic && a->roughness == b->roughness && a->ior == b->ior &&
           a->specular == b->specular && same_colors(a->specular_color, b->specular_color) &&
           a->unlit == b->unlit;
}

bool material_has_default_specular(const struct material *m)
{
    return m->ior == MATERIAL_DEFAULT_IOR && m->specular == 1.0f && m->specular_color.x == 1.0f &&
           m->specular_color.y == 1.0f && m->specular_color.z == 1.0f &&
           m->specular_map.image < 0 && m->specular_color_map.image < 0;
}

struct node node_default(void)
{
    return (struct node){
        .name = "",
        .parent = -1,
        .rotation = { { 0, 0, 0, 1 } },
        .scale = { { 1, 1, 1 } },
        .matrix = glms_mat4_identity(),
    };
}

struct texture_use texture_use_none(void)
{
    return (struct texture_use){ .image = -1, .uv_scale = { 1, 1 } };
}

size_t scene_memory_bytes(const struct scene *scene)
{
    return sizeof *scene + scene->arena.bytes;
}
