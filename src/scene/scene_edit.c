#include "scene/scene_edit.h"

#include "scene/environment/environment_map.h"
#include "scene/mesh_geometry.h"
#include "scene/scene_check.h"

#include <string.h>

// ---- Nodes of one object ------------------------------------------------------------------------

// A node for one object, by preference one that was released. `name` is a literal, or a node's.
static int acquire_node(struct scene *scene, const char *name)
{
    const int node = scene->free_node;
    struct node fresh = node_default();
    fresh.name = name;
    fresh.has_matrix = true;
    if (node < 0) return scene_add_node(scene, &fresh);
    scene->free_node = scene->nodes[node].next_free;
    scene->nodes[node] = fresh;
    return node;
}

static void release_node(struct scene *scene, int node)
{
    scene->nodes[node].next_free = scene->free_node;
    scene->free_node = node;
}

// Gives an object a node of its own where it shares one. False when out of memory.
static bool own_node(struct scene *scene, const char *name, int *node, bool *own)
{
    const int acquired = *own ? *node : acquire_node(scene, name);
    if (acquired < 0) return false;
    *node = acquired;
    *own = true;
    return true;
}

// ---- Instances ----------------------------------------------------------------------------------

bool scene_set_instance_transform(struct scene *scene, int instance, mat4s world_from_mesh)
{
    struct instance *it = &scene->instances[instance];
    if (it->skin >= 0)
        return scene_refuse(scene, "instance", scene->nodes[it->node].name,
                            "its skin places it: move the joints");
    if (!own_node(scene, scene->nodes[it->node].name, &it->node, &it->own_node)) return false;
    scene->nodes[it->node].matrix = world_from_mesh;
    scene_changed(scene, &scene->revisions.transforms);
    scene_set_instance_movable(scene, instance, true);
    return true;
}

void scene_set_instance_movable(struct scene *scene, int instance, bool movable)
{
    if (scene->instances[instance].movable == movable) return;
    scene->instances[instance].movable = movable;
    scene_changed(scene, &scene->revisions.instances);
}

void scene_remove_instance(struct scene *scene, int instance)
{
    struct instance *it = &scene->instances[instance];
    if (it->own_node) release_node(scene, it->node);
    if (!it->movable) scene_changed(scene, &scene->revisions.statics);
    // Node 0 exists: an instance has one.
    *it = (struct instance){ .mesh = -1, .skin = -1 };
    if (scene->free_instance_count++ == 0 || instance < scene->first_free_instance)
        scene->first_free_instance = instance;
    scene_changed(scene, &scene->revisions.layout);
    scene_changed(scene, &scene->revisions.instances);
}

int scene_add_placed_instance(struct scene *scene, int mesh, mat4s world_from_mesh, bool movable)
{
    struct instance instance = {
        .node = acquire_node(scene, "instance"), .mesh = mesh, .skin = -1, .movable = movable
    };
    if (instance.node < 0) return -1;
    instance.own_node = true;
    scene->nodes[instance.node].matrix = world_from_mesh;
    const int index = scene_add_instance(scene, &instance);
    if (index < 0) release_node(scene, instance.node);
    return index;
}

// ---- Meshes and materials -----------------------------------------------------------------------

static bool own_arrays(struct scene *scene, struct mesh *mesh)
{
    if (mesh->own_arrays) return true;
    const size_t count = mesh->vertex_count;
    vec3s *positions = scene_copy(scene, mesh->positions, count, sizeof *positions),
          *normals = scene_copy(scene, mesh->normals, count, sizeof *normals);
    vec4s *tangents =
        mesh->tangents ? scene_copy(scene, mesh->tangents, count, sizeof *tangents) : NULL;
    if (!positions || !normals || (mesh->tangents && !tangents)) return false;
    mesh->positions = positions;
    mesh->normals = normals;
    mesh->tangents = tangents;
    return mesh->own_arrays = true;
}

static void copy_vertices(struct mesh *mesh, const vec3s *positions, const vec3s *normals)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t from = mesh->source ? mesh->source[v] : v;
        mesh->positions[v] = positions[from];
        if (!normals) continue;
        const float length = glms_vec3_norm(normals[from]);
        mesh->normals[v] =
            length > 0.0f ? glms_vec3_scale(normals[from], 1.0f / length) : vec3_of(0, 1, 0);
    }
}

bool scene_update_mesh(struct scene *scene, int mesh, const vec3s *positions, const vec3s *normals)
{
    struct mesh *it = &scene->meshes[mesh];
    const struct mesh given = { .vertex_count = it->source ? it->source_count : it->vertex_count,
                                .positions = (vec3s *)positions,
                                .normals = (vec3s *)normals };
    const char *why = scene_vertices_fault(&given);
    if (why) return scene_refuse(scene, "mesh", it->name, why);
    if (!own_arrays(scene, it)) return false;
    copy_vertices(it, positions, normals);
    if (normals)
        it->flat_normals = false;
    else if (it->flat_normals)
        mesh_update_normals(it);
    it->bounds = mesh_bounds(it);
    it->revision = scene_changed(scene, &scene->revisions.vertices);
    for (int i = 0; i < scene->instance_count; i++)
        if (scene->instances[i].mesh == mesh) scene_set_instance_movable(scene, i, true);
    return mesh_update_tangents(scene->host, it, &scene->materials[it->material].normal_map);
}

bool scene_set_material(struct scene *scene, int material, const struct material *values)
{
    struct material *it = &scene->materials[material];
    const char *why = scene_material_fault(scene, values);
    if (why) return scene_refuse(scene, "material", it->name, why);
    it->base_color = values->base_color;
    it->metallic = values->metallic;
    it->roughness = values->roughness;
    it->ior = values->ior;
    it->specular = values->specular;
    it->specular_color = values->specular_color;
    it->emissive = values->unlit ? vec3_of(0, 0, 0) : values->emissive;
    it->normal_scale = values->normal_scale;
    it->alpha_cutoff = values->alpha_cutoff;
    it->double_sided = values->double_sided;
    it->unlit = values->unlit;
    it->revision = scene_changed(scene, &scene->revisions.materials);
    return true;
}

// ---- Light --------------------------------------------------------------------------------------

// The light with a valid node, or NULL and a message.
static const struct light *checked(struct scene *scene, const struct placed_light *from,
                                   struct light *light, mat4s *world_from_node)
{
    const char *why = NULL;
    *light = from->light;
    if (!scene_looking(from->position, from->direction, world_from_node))
        why = "its position is not finite or its direction has length zero";
    light->node = 0;
    if (!why && scene->node_count > 0) why = scene_light_fault(scene, light);
    if (why) scene_refuse(scene, "light", light->name, why);
    return why ? NULL : light;
}

int scene_add_placed_light(struct scene *scene, const struct placed_light *from)
{
    struct light light;
    mat4s world_from_node;
    if (!checked(scene, from, &light, &world_from_node)) return -1;
    light.node = acquire_node(scene, "light");
    if (light.node < 0) return -1;
    light.own_node = true;
    scene->nodes[light.node].matrix = world_from_node;
    const int index = scene_append_light(scene, &light);
    if (index < 0) release_node(scene, light.node);
    return index;
}

bool scene_set_light(struct scene *scene, int index, const struct placed_light *from)
{
    struct light *it = &scene->lights[index], light;
    mat4s world_from_node;
    if (!checked(scene, from, &light, &world_from_node)) return false;
    if (!own_node(scene, "light", &it->node, &it->own_node)) return false;
    light.name = it->name;
    light.node = it->node;
    light.own_node = true;
    *it = light;
    scene->nodes[it->node].matrix = world_from_node;
    scene_changed(scene, &scene->revisions.lights);
    return true;
}

void scene_remove_lights(struct scene *scene)
{
    for (int i = 0; i < scene->light_count; i++)
        if (scene->lights[i].own_node) release_node(scene, scene->lights[i].node);
    scene->light_count = 0;
    scene_changed(scene, &scene->revisions.lights);
}

void scene_set_sky(struct scene *scene, vec3s radiance)
{
    scene->environment.sky = radiance;
    scene_changed(scene, &scene->revisions.lights);
}

void scene_set_environment_map(struct scene *scene, const struct environment_map *map,
                               float strength, float rotation_rad)
{
    struct environment *environment = &scene->environment;
    environment_map_retain(map);
    environment_map_release(environment->map);
    environment->map = map;
    environment->strength = strength;
    environment->rotation_rad = rotation_rad;
    scene_changed(scene, &scene->revisions.lights);
}
