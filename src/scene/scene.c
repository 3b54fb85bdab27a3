// Creation and destruction of a scene, and scene_add_* for everything but meshes (scene_mesh.c).
// Each function checks its argument before it changes the scene: a failure leaves it unchanged.
#include "scene/scene.h"

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
    scene->name = arena_strdup(&scene->arena, name_or_empty(name));
    if (!scene->name) goto fail;
    return scene;
fail:
    scene_destroy(scene);
    return NULL;
}

void scene_destroy(struct scene *scene)
{
    if (!scene) return;
    struct host *host = scene->host;
    arena_finish(&scene->arena);
    host_free(host, scene);
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

static bool refuse(struct scene *scene, const char *kind, const char *name, const char *why)
{
    return host_fail(scene->host, FAIL_ARGUMENT, "%s \"%s\" in %s: %s", kind, name_or_empty(name),
                     scene->name, why);
}

int scene_add_image(struct scene *scene, const struct scene_image *image)
{
    if (image->width < 1 || image->height < 1 || image->width > SCENE_MAX_IMAGE_SIZE ||
        image->height > SCENE_MAX_IMAGE_SIZE || !image->rgba) {
        refuse(scene, "image", image->name,
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

int scene_add_material(struct scene *scene, const struct material *material)
{
    const char *why = NULL;
    if (!is_colour(vec3_xyz(material->base_color)) || !is_fraction(material->base_color.w)) {
        why = "its base colour is negative or not finite";
    } else if (!is_fraction(material->metallic) || !is_fraction(material->roughness)) {
        why = "its metallic or roughness factor is not in 0…1";
    } else if (!is_fraction(material->specular) || !is_colour(material->specular_color)) {
        why = "its specular weight is not in 0…1, or its specular colour negative or not finite";
    } else if (!isfinite(material->ior) || (material->ior != 0.0f && !(material->ior >= 1.0f))) {
        why = "its index of refraction is neither 0 nor at least 1";
    } else if (!limits_light(material->emissive)) {
        why = "its emission is not within 0 to 1e15 cd/m²";
    } else if (!isfinite(material->normal_scale) || !isfinite(material->alpha_cutoff)) {
        why = "its normal scale or alpha cutoff is not finite";
    } else if (!texture_use_is_valid(scene, &material->base_color_map) ||
               !texture_use_is_valid(scene, &material->metallic_roughness_map) ||
               !texture_use_is_valid(scene, &material->normal_map) ||
               !texture_use_is_valid(scene, &material->emissive_map) ||
               !texture_use_is_valid(scene, &material->specular_map) ||
               !texture_use_is_valid(scene, &material->specular_color_map)) {
        why = "a texture refers to an image or coordinate set that does not exist";
    }
    if (why) {
        refuse(scene, "material", material->name, why);
        return -1;
    }
    struct material copy = *material;
    if (copy.unlit) material_clear_emission(&copy);
    if (!copy_name(scene, &copy.name)) return -1;
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
        refuse(scene, "node", node->name, why);
        return -1;
    }
    if (!copy.has_matrix) copy.rotation = glms_quat_normalize(copy.rotation);
    if (!copy_name(scene, &copy.name)) return -1;
    if (copy.extras && !(copy.extras = arena_strdup(&scene->arena, copy.extras))) return -1;
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

int scene_add_instance(struct scene *scene, const struct instance *instance)
{
    const char *why = NULL;
    if (!index_is_valid(instance->node, scene->node_count)) {
        why = "its node does not exist";
    } else if (!index_is_valid(instance->mesh, scene->mesh_count)) {
        why = "its mesh does not exist";
    } else if (instance->skin != -1 && !index_is_valid(instance->skin, scene->skin_count)) {
        why = "its skin does not exist";
    } else if (instance->skin != -1 &&
               !skin_fits_mesh(&scene->skins[instance->skin], &scene->meshes[instance->mesh])) {
        why = "its mesh uses joints that the skin does not have";
    }
    if (why) {
        refuse(scene, "instance", "", why);
        return -1;
    }
    struct instance copy = *instance;
    size_t morph_count = (size_t)scene->meshes[copy.mesh].morph_count;
    copy.morph_weights = NULL;
    if (morph_count > 0) {
        if (instance->morph_weights && !floats_are_finite(instance->morph_weights, morph_count)) {
            refuse(scene, "instance", "", "a morph weight is not finite");
            return -1;
        }
        copy.morph_weights =
            instance->morph_weights
                ? scene_copy(scene, instance->morph_weights, morph_count,
                             sizeof *copy.morph_weights)
                : arena_alloc(&scene->arena, morph_count, sizeof *copy.morph_weights);
        if (!copy.morph_weights) return -1;
    }
    return APPEND(scene, instances, instance, copy);
}

// The cone of a spot: 0 ≤ inner < outer ≤ π/2.
static bool cone_is_valid(const struct light *light)
{
    return light->inner_rad >= 0.0f && light->inner_rad < light->outer_rad &&
           light->outer_rad <= GLM_PI_2f + 1e-6f;
}

int scene_add_light(struct scene *scene, const struct light *light)
{
    const char *why = NULL;
    if (!index_is_valid(light->node, scene->node_count)) {
        why = "its node does not exist";
    } else if (light->type != LIGHT_SUN && light->type != LIGHT_POINT &&
               light->type != LIGHT_SPOT) {
        why = "its type is unknown";
    } else if (!limits_light(light->intensity)) {
        why = "its intensity is not within 0 to 1e15 lux or candela";
    } else if (light->type == LIGHT_SPOT && !cone_is_valid(light)) {
        why = "its cone is not 0 ≤ inner < outer ≤ 90 degrees";
    } else if (!isfinite(light->range_m) || light->range_m < 0.0f) {
        why = "its range is negative or not finite";
    }
    if (why) {
        refuse(scene, "light", light->name, why);
        return -1;
    }
    struct light copy = *light;
    if (!copy_name(scene, &copy.name)) return -1;
    return APPEND(scene, lights, light, copy);
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
        refuse(scene, "camera", camera->name, why);
        return -1;
    }
    struct camera copy = *camera;
    if (!copy_name(scene, &copy.name)) return -1;
    return APPEND(scene, cameras, camera, copy);
}

int scene_add_node_looking(struct scene *scene, const char *name, vec3s position, vec3s direction)
{
    direction = vec3_unit(direction);
    if (!vec3_is_finite(position) || glms_vec3_norm(direction) == 0.0f) {
        refuse(scene, "node", name, "its position is not finite or its direction has length zero");
        return -1;
    }
    vec3s back = glms_vec3_negate(direction);
    // Up is nearest to +y; for a vertical direction it is -z or +z.
    vec3s reference = fabsf(back.y) < 0.9999f ? vec3_of(0, 1, 0) : vec3_of(0, 0, -back.y);
    vec3s right = glms_vec3_normalize(glms_vec3_cross(reference, back));
    vec3s up = glms_vec3_cross(back, right);
    struct node node = node_default();
    node.name = name;
    node.has_matrix = true;
    node.matrix.col[0] = vec4_of(right, 0);
    node.matrix.col[1] = vec4_of(up, 0);
    node.matrix.col[2] = vec4_of(back, 0);
    node.matrix.col[3] = vec4_of(position, 1);
    return scene_add_node(scene, &node);
}

void scene_remove_lights(struct scene *scene)
{
    scene->light_count = 0;
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

size_t scene_triangle_count(const struct scene *scene)
{
    size_t count = 0;
    for (int i = 0; i < scene->instance_count; i++) {
        count += scene->meshes[scene->instances[i].mesh].index_count / 3;
    }
    return count;
}

bool scene_has_emission(const struct scene *scene)
{
    for (int i = 0; i < scene->instance_count; i++) {
        const struct mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        vec3s emissive = scene->materials[mesh->material].emissive;
        if (mesh->index_count > 0 && luminance(emissive) > 0.0f) return true;
    }
    return false;
}

size_t scene_memory_bytes(const struct scene *scene)
{
    return sizeof *scene + scene->arena.bytes;
}
