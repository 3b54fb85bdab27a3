// Nodes, instances, lights, cameras and skins of a glTF file.
#include "scene/import/gltf/gltf.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <string.h>

// {"afterglow_mobility": "static" or "movable"} in the extras of a node.
static void load_mobility(struct import *import, json_t *extras, struct node *out)
{
    json_t *mobility = json_object_get(extras, "afterglow_mobility");
    const char *text = json_string_value(mobility);
    if (text && strcmp(text, "static") == 0)
        out->mobility = MOBILITY_STATIC;
    else if (text && strcmp(text, "movable") == 0)
        out->mobility = MOBILITY_MOVABLE;
    else if (mobility)
        import_note(import, "values of afterglow_mobility other than static and movable");
}

// The text of the node's extras. Other types than objects, which glTF allows, are ignored.
static bool load_extras(struct gltf_object node, struct node *out)
{
    json_t *extras = json_object_get(node.json, "extras");
    if (!json_is_object(extras)) return true;
    size_t size = json_dumpb(extras, NULL, 0, JSON_COMPACT);
    char *text = import_alloc(node.gltf->import, size + 1, 1);
    if (!text) return false;
    json_dumpb(extras, text, size, JSON_COMPACT);
    out->extras = text;
    load_mobility(node.gltf->import, extras, out);
    return true;
}

static bool load_node(struct gltf *gltf, size_t i)
{
    struct gltf_object object = gltf_element(gltf, gltf->nodes, "node", i);
    struct node *node = &gltf->import->scene->nodes[gltf->scene_node[i]];
    int parent = node->parent; // set by set_children
    *node = node_default();
    node->parent = parent;
    node->name = import_name(gltf->import, gltf_string(object, "name"), "node", i);
    gltf_floats(object, "translation", 3, node->translation.raw);
    gltf_floats(object, "scale", 3, node->scale.raw);
    if (gltf_floats(object, "rotation", 4, node->rotation.raw)) {
        float length = glms_quat_norm(node->rotation);
        if (!(length > 0.0f) || !isfinite(length)) {
            return gltf_wrong(object, "its rotation is not a unit quaternion");
        }
        node->rotation = glms_quat_normalize(node->rotation);
    }
    float matrix[16];
    if (gltf_floats(object, "matrix", 16, matrix)) {
        node->has_matrix = true;
        memcpy(&node->matrix, matrix, sizeof matrix);
        // Affine by definition: removes rounding errors from the last row.
        for (int k = 0; k < 4; k++) node->matrix.raw[k][3] = k == 3 ? 1.0f : 0.0f;
    }
    return node->name && load_extras(object, node) && !gltf->failed;
}

static void set_children(struct gltf *gltf, size_t i)
{
    json_t *children = json_object_get(json_array_get(gltf->nodes, i), "children"), *value;
    size_t k;
    json_array_foreach(children, k, value)
    {
        struct node *child =
            &gltf->import->scene->nodes[gltf->scene_node[json_integer_value(value)]];
        child->parent = (int)gltf->scene_node[i];
    }
}

// Default morph weights: the node's, else the mesh's, else zero.
static bool rest_weights(struct gltf *gltf, struct gltf_object node, int gltf_mesh,
                         struct instance *instance)
{
    int count = gltf->import->scene->meshes[instance->mesh].morph_count;
    if (count == 0) return true;
    instance->morph_weights = import_alloc(gltf->import, (size_t)count, sizeof(float));
    if (!instance->morph_weights) return false;
    struct gltf_object mesh = gltf_element(gltf, gltf->meshes, "mesh", (size_t)gltf_mesh);
    if (!gltf_floats(node, "weights", count, instance->morph_weights)) {
        gltf_floats(mesh, "weights", count, instance->morph_weights);
    }
    return !gltf->failed;
}

static bool load_instances(struct gltf *gltf, size_t i)
{
    struct scene *scene = gltf->import->scene;
    struct gltf_object object = gltf_element(gltf, gltf->nodes, "node", i);
    int mesh = gltf_index(object, "mesh", gltf->meshes);
    int skin = gltf_index(object, "skin", gltf->skins);
    if (mesh < 0) return !gltf->failed;
    for (int k = 0; k < gltf->mesh_parts[mesh]; k++) {
        struct instance *instance = &scene->instances[scene->instance_count++];
        *instance = (struct instance){ .node = (int)gltf->scene_node[i],
                                       .mesh = gltf->first_mesh[mesh] + k,
                                       .skin = skin };
        if (!scene->meshes[instance->mesh].joints) instance->skin = -1;
        if (!rest_weights(gltf, object, mesh, instance)) return false;
    }
    return !gltf->failed;
}

static bool load_spot(struct gltf_object object, struct light *light)
{
    struct gltf_object spot = gltf_child(object, "spot");
    light->outer_rad =
        gltf_float(spot, "outerConeAngle", GLM_PIf / 4.0f, 1e-4f, GLM_PIf / 2.0f + 1e-4f);
    light->inner_rad = gltf_float(spot, "innerConeAngle", 0.0f, 0.0f, GLM_PIf);
    light->outer_rad = fminf(light->outer_rad, GLM_PIf / 2.0f);
    // Files have equal angles for a hard edge; the falloff needs a nonzero width.
    light->inner_rad = fminf(light->inner_rad, 0.999f * light->outer_rad);
    return !object.gltf->failed;
}

// {"afterglow_lightmap": {"indirect": false}} in the extras of a light: the bake of the light map
// was without it, and it emits nothing.
static bool is_left_out(json_t *light)
{
    json_t *map = json_object_get(json_object_get(light, "extras"), "afterglow_lightmap");
    return json_is_false(json_object_get(map, "indirect"));
}

// KHR_lights_punctual.
static bool load_light(struct gltf *gltf, size_t i)
{
    struct scene *scene = gltf->import->scene;
    struct gltf_object node = gltf_element(gltf, gltf->nodes, "node", i);
    int index = gltf_index(gltf_extension(node, "KHR_lights_punctual"), "light", gltf->lights);
    if (index < 0) return !gltf->failed;
    struct gltf_object object = gltf_element(gltf, gltf->lights, "light", (size_t)index);
    if (gltf_is_environment_sun(object.json)) return !gltf->failed;
    const char *type = gltf_string(object, "type");
    struct light *light = &scene->lights[scene->light_count];
    *light = (struct light){ .node = (int)gltf->scene_node[i], .off = is_left_out(object.json) };
    light->name = import_name(gltf->import, gltf_string(object, "name"), "light", (size_t)index);
    light->intensity = vec3_of(1.0f, 1.0f, 1.0f);
    gltf_floats(object, "color", 3, light->intensity.raw);
    float intensity = gltf_float(object, "intensity", 1.0f, 0.0f, 1e18f);
    for (int k = 0; k < 3; k++) {
        light->intensity.raw[k] = fminf(fmaxf(light->intensity.raw[k], 0.0f), 1e18f) * intensity;
    }
    light->range_m = gltf_float(object, "range", 0.0f, 0.0f, FLT_MAX);
    if (gltf->failed || !light->name) return false;
    if (type && strcmp(type, "directional") == 0)
        light->type = LIGHT_SUN;
    else if (type && strcmp(type, "point") == 0)
        light->type = LIGHT_POINT;
    else if (type && strcmp(type, "spot") == 0)
        light->type = LIGHT_SPOT;
    else
        return gltf_wrong(object, "its type is not directional, point or spot");
    if (light->type == LIGHT_SPOT && !load_spot(object, light)) return false;
    scene->light_count++;
    return true;
}

static bool load_camera(struct gltf *gltf, size_t i)
{
    struct scene *scene = gltf->import->scene;
    struct gltf_object node = gltf_element(gltf, gltf->nodes, "node", i);
    int index = gltf_index(node, "camera", gltf->cameras);
    if (index < 0) return !gltf->failed;
    struct gltf_object object = gltf_element(gltf, gltf->cameras, "camera", (size_t)index);
    struct gltf_object perspective = gltf_child(object, "perspective");
    if (!perspective.json) {
        import_note(gltf->import, "orthographic cameras");
        return !gltf->failed;
    }
    struct camera *camera = &scene->cameras[scene->camera_count];
    *camera = (struct camera){ .node = (int)gltf->scene_node[i] };
    camera->name = import_name(gltf->import, gltf_string(object, "name"), "camera", (size_t)index);
    camera->vertical_fov_rad = gltf_float(perspective, "yfov", 1.0f, 1e-3f, GLM_PIf - 1e-3f);
    camera->near_m = gltf_float(perspective, "znear", 0.01f, 1e-6f, FLT_MAX);
    scene->camera_count++;
    return camera->name && !gltf->failed;
}

// Instances multiply the triangles, vertices and joints of a file. A million instanced triangles
// are allowed for nothing, then one for each byte of the file.
static const size_t INSTANCE_ALLOWANCE_BYTES = (size_t)256 << 20;
static const size_t INSTANCED_TRIANGLE_BYTES = 64; // of ray acceleration, on the CPU or the GPU

static size_t bytes_of_instance(const struct gltf *gltf, int mesh_index, int skin)
{
    const struct mesh *mesh = &gltf->import->scene->meshes[mesh_index];
    size_t bytes = sizeof(struct instance) + mesh->index_count / 3 * INSTANCED_TRIANGLE_BYTES;
    size_t joints =
        skin < 0
            ? 0
            : json_array_size(json_object_get(json_array_get(gltf->skins, (size_t)skin), "joints"));
    if (joints > 0 || mesh->morph_count > 0) // a vertex is deformed by each of its morph targets
        bytes +=
            mesh->vertex_count * (sizeof(vec3s) * 2 + sizeof(vec4s) + (size_t)mesh->morph_count);
    return bytes + joints * sizeof(mat4s) + (size_t)mesh->morph_count * sizeof(float);
}

static bool charge_instances(struct gltf *gltf, int mesh, int skin, size_t *spent)
{
    struct import *import = gltf->import;
    size_t limit = import_limit(import, INSTANCE_ALLOWANCE_BYTES);
    for (int k = 0; k < gltf->mesh_parts[mesh]; k++)
        *spent += bytes_of_instance(gltf, gltf->first_mesh[mesh] + k, skin);
    if (*spent <= limit) return true;
    return host_fail(import->host, FAIL_MEMORY,
                     "%s: its instances need more memory than its %zu bytes justify", import->path,
                     import->source_bytes);
}

// Allocates nodes, instances, lights and cameras.
static bool reserve(struct gltf *gltf)
{
    struct scene *scene = gltf->import->scene;
    size_t nodes = json_array_size(gltf->nodes), instances = 0, lights = 0, cameras = 0;
    size_t spent = 0;
    for (size_t i = 0; i < nodes; i++) {
        struct gltf_object object = gltf_element(gltf, gltf->nodes, "node", i);
        int mesh = gltf_index(object, "mesh", gltf->meshes);
        int skin = gltf_index(object, "skin", gltf->skins);
        if (mesh >= 0) instances += (size_t)gltf->mesh_parts[mesh];
        if (mesh >= 0 && !charge_instances(gltf, mesh, skin, &spent)) return false;
        lights += gltf_has(gltf_extension(object, "KHR_lights_punctual"), "light");
        cameras += gltf_has(object, "camera");
    }
    if (instances > INT_MAX || gltf->failed)
        return gltf_wrong(gltf_element(gltf, gltf->nodes, "node", 0), "too many instances");
    scene->nodes = import_alloc(gltf->import, nodes, sizeof *scene->nodes);
    scene->instances = import_alloc(gltf->import, instances, sizeof *scene->instances);
    scene->lights = import_alloc(gltf->import, lights, sizeof *scene->lights);
    scene->cameras = import_alloc(gltf->import, cameras, sizeof *scene->cameras);
    return scene->nodes && scene->instances && scene->lights && scene->cameras;
}

// Parents come before their children.
static void inherit_mobility(struct scene *scene)
{
    for (int i = 0; i < scene->node_count; i++) {
        struct node *node = &scene->nodes[i];
        if (node->mobility == MOBILITY_INHERITED && node->parent >= 0)
            node->mobility = scene->nodes[node->parent].mobility;
    }
    for (int i = 0; i < scene->instance_count; i++) {
        struct instance *instance = &scene->instances[i];
        instance->movable = scene->nodes[instance->node].mobility == MOBILITY_MOVABLE;
    }
}

bool gltf_load_nodes(struct gltf *gltf)
{
    struct scene *scene = gltf->import->scene;
    size_t count = json_array_size(gltf->nodes);
    if (!reserve(gltf)) return false;
    scene->node_count = (int)count;
    for (size_t i = 0; i < count; i++) scene->nodes[i].parent = -1;
    for (size_t i = 0; i < count; i++) set_children(gltf, i);
    for (size_t i = 0; i < count; i++) {
        if (!load_node(gltf, i)) return false;
        if (!gltf->in_scene[i]) continue;
        if (!load_instances(gltf, i) || !load_light(gltf, i) || !load_camera(gltf, i)) return false;
    }
    inherit_mobility(scene);
    return true;
}

static bool load_skin(struct gltf *gltf, size_t i)
{
    struct import *import = gltf->import;
    struct gltf_object object = gltf_element(gltf, gltf->skins, "skin", i);
    struct skin *skin = &import->scene->skins[i];
    json_t *joints = gltf_array(object, "joints");
    size_t count = json_array_size(joints);
    int matrices = gltf_index(object, "inverseBindMatrices", gltf->accessors);
    if (gltf->failed) return false;
    if (count == 0 || count > UINT16_MAX + 1) return gltf_wrong(object, "has %zu joints", count);
    skin->joints = import_alloc(import, count, sizeof *skin->joints);
    skin->joint_from_mesh = import_alloc(import, count, sizeof *skin->joint_from_mesh);
    if (!skin->joints || !skin->joint_from_mesh) return false;
    for (size_t k = 0; k < count; k++) {
        int node = gltf_index_value(object, "joints", json_array_get(joints, k), gltf->nodes);
        if (node < 0) return false;
        skin->joints[k] = (int)gltf->scene_node[node];
        skin->joint_from_mesh[k] = glms_mat4_identity();
    }
    skin->joint_count = (int)count;
    if (matrices < 0) return true;
    size_t given = gltf_accessor_count(gltf, matrices);
    const float *values = given ? gltf_floats_of(gltf, matrices, 16) : NULL;
    if (!values) return false;
    if (given < count) return gltf_wrong(object, "has %zu joints, but %zu matrices", count, given);
    for (size_t k = 0; k < 16 * count; k++) {
        if (!isfinite(values[k])) return gltf_wrong(object, "an inverse bind matrix is not finite");
    }
    memcpy(skin->joint_from_mesh, values, count * sizeof *skin->joint_from_mesh);
    return true;
}

// Every joint index of a skinned instance must exist in its skin.
static bool check_joints(struct gltf *gltf)
{
    const struct scene *scene = gltf->import->scene;
    for (int i = 0; i < scene->instance_count; i++) {
        const struct instance *instance = &scene->instances[i];
        if (instance->skin < 0) continue;
        const struct mesh *mesh = &scene->meshes[instance->mesh];
        int joint_count = scene->skins[instance->skin].joint_count;
        // Charged, because many instances of one mesh multiply this work.
        if (!import_charge(gltf->import, mesh->vertex_count, 1)) return false;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            for (int k = 0; k < 4; k++) {
                if (mesh->joints[v][k] < joint_count) continue;
                struct gltf_object skin =
                    gltf_element(gltf, gltf->skins, "skin", (size_t)instance->skin);
                return gltf_wrong(skin, "mesh %s uses joint %u of %d",
                                  import_printable(mesh->name).s, mesh->joints[v][k], joint_count);
            }
        }
    }
    return true;
}

bool gltf_load_skins(struct gltf *gltf)
{
    struct scene *scene = gltf->import->scene;
    size_t count = json_array_size(gltf->skins);
    scene->skins = import_alloc(gltf->import, count, sizeof *scene->skins);
    if (!scene->skins) return false;
    for (size_t i = 0; i < count; i++) {
        if (!load_skin(gltf, i)) return false;
        scene->skin_count++;
    }
    return check_joints(gltf);
}
