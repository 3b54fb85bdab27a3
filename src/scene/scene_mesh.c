// scene_add_mesh: checks a mesh, copies it into the scene, generates missing normals and tangents.
#include "scene/mesh_geometry.h"
#include "scene/scene_check.h"

#include <math.h>

static const char *check_indices(const struct scene *scene, const struct mesh *mesh)
{
    // -1 asks for a new default material, and so does 0 in a scene without any.
    if (mesh->material < -1 || (mesh->material > 0 && mesh->material >= scene->material_count)) {
        return "its material does not exist";
    }
    if (mesh->index_count % 3 != 0) return "its index count is not a multiple of 3";
    if (mesh->index_count > 0 && !mesh->indices) return "it has no indices";
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        if (mesh->indices[i] >= mesh->vertex_count) return "an index exceeds its vertices";
    }
    return NULL;
}

const char *scene_vertices_fault(const struct mesh *mesh)
{
    size_t count = mesh->vertex_count;
    if (count > 0 && !mesh->positions) return "it has no positions";
    if (!mesh->joints != !mesh->weights)
        return "it has joints without weights, or weights without joints";
    for (size_t v = 0; v < count; v++) {
        if (!vec3_is_finite(mesh->positions[v])) return "a position is not finite";
        if (mesh->normals && !vec3_is_finite(mesh->normals[v])) return "a normal is not finite";
        if (mesh->tangents && !vec4_is_finite(mesh->tangents[v])) return "a tangent is not finite";
        if (mesh->colors && !vec4_is_finite(mesh->colors[v])) return "a colour is not finite";
        for (int set = 0; set < 2; set++) {
            if (mesh->uv[set] && !vec2_is_finite(mesh->uv[set][v])) {
                return "a texture coordinate is not finite";
            }
        }
        if (!mesh->weights) continue;
        vec4s w = mesh->weights[v];
        if (!vec4_is_finite(w) || w.x < 0 || w.y < 0 || w.z < 0 || w.w < 0) {
            return "a joint weight is negative or not finite";
        }
    }
    return NULL;
}

static const char *check_morphs(const struct mesh *mesh)
{
    if (mesh->morph_count < 0 || (mesh->morph_count > 0 && !mesh->morphs)) {
        return "it counts morph targets and has none";
    }
    for (int m = 0; m < mesh->morph_count; m++) {
        const struct morph_target *morph = &mesh->morphs[m];
        if (!morph->positions) return "a morph target has no positions";
        for (size_t v = 0; v < mesh->vertex_count; v++) {
            if (!vec3_is_finite(morph->positions[v]) ||
                (morph->normals && !vec3_is_finite(morph->normals[v]))) {
                return "a morph target is not finite";
            }
        }
    }
    return NULL;
}

static bool choose_material(struct scene *scene, struct mesh *mesh)
{
    if (index_is_valid(mesh->material, scene->material_count)) return true;
    struct material material = material_default();
    mesh->material = scene_add_material(scene, &material);
    return mesh->material >= 0;
}

#define COPY(field, count)                                                                         \
    do {                                                                                           \
        if (!mesh->field) break;                                                                   \
        mesh->field = scene_copy(scene, mesh->field, (count), sizeof *mesh->field);                \
        if (!mesh->field) return false;                                                            \
    } while (0)

// Replaces the arrays of *mesh by copies in the scene's arena.
static bool copy_arrays(struct scene *scene, struct mesh *mesh)
{
    mesh->name = arena_strdup(&scene->arena, name_or_empty(mesh->name));
    if (!mesh->name) return false;
    size_t count = mesh->vertex_count;
    COPY(positions, count);
    COPY(normals, count);
    COPY(tangents, count);
    COPY(uv[0], count);
    COPY(uv[1], count);
    COPY(colors, count);
    COPY(joints, count);
    COPY(weights, count);
    COPY(indices, mesh->index_count);
    if (mesh->morph_count == 0) mesh->morphs = NULL;
    COPY(morphs, (size_t)mesh->morph_count);
    for (int m = 0; mesh->morphs && m < mesh->morph_count; m++) {
        COPY(morphs[m].positions, count);
        COPY(morphs[m].normals, count);
    }
    return true;
}

// Rounding of the squared length of a unit vector. What is unit but for it stays, to the bit.
static const float ROUNDING = 1e-6f;

static bool is_unit(vec3s v)
{
    return fabsf(glms_vec3_norm2(v) - 1.0f) <= ROUNDING;
}

static vec3s unit_or_up(vec3s v)
{
    if (is_unit(v)) return v;
    float length = glms_vec3_norm(v);
    return length > 0.0f ? glms_vec3_scale(v, 1.0f / length) : vec3_of(0, 1, 0);
}

static vec4s unit_tangent(vec3s normal, vec4s tangent)
{
    const vec3s t = vec3_xyz(tangent);
    const bool whole = is_unit(t) && fabsf(glms_vec3_dot(t, normal)) <= ROUNDING;
    return whole && fabsf(tangent.w) == 1.0f ? tangent : mesh_unit_tangent(normal, tangent);
}

// Normals of length 1, tangents orthogonal to them, joint weights that sum to 1.
static void normalise(struct mesh *mesh)
{
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        mesh->normals[v] = unit_or_up(mesh->normals[v]);
        if (mesh->tangents) mesh->tangents[v] = unit_tangent(mesh->normals[v], mesh->tangents[v]);
        if (!mesh->weights) continue;
        vec4s w = mesh->weights[v];
        float sum = w.x + w.y + w.z + w.w;
        mesh->weights[v] = sum > 0.0f ? glms_vec4_scale(w, 1.0f / sum) : (vec4s){ { 1, 0, 0, 0 } };
    }
}

static bool generate_missing(struct scene *scene, struct mesh *mesh)
{
    if (!mesh->normals && !mesh_make_normals(&scene->arena, mesh)) return false;
    normalise(mesh);
    mesh->bounds = mesh_bounds(mesh);
    const struct texture_use *normal_map = &scene->materials[mesh->material].normal_map;
    if (mesh->tangents || normal_map->image < 0) return true;
    return mesh_make_tangents(&scene->arena, mesh, normal_map);
}

int scene_add_mesh(struct scene *scene, const struct mesh *mesh)
{
    const char *why = check_indices(scene, mesh);
    if (!why) why = scene_vertices_fault(mesh);
    if (!why) why = check_morphs(mesh);
    if (why) {
        host_fail(scene->host, FAIL_ARGUMENT, "mesh \"%s\" in %s: %s", name_or_empty(mesh->name),
                  scene->name, why);
        return -1;
    }
    struct mesh copy = *mesh;
    if (!copy_arrays(scene, &copy) || !choose_material(scene, &copy) ||
        !generate_missing(scene, &copy) ||
        !scene_reserve(scene, (void **)&scene->meshes, scene->mesh_count, &scene->capacity.meshes,
                       sizeof copy)) {
        return -1;
    }
    copy.own_arrays = true;
    copy.revision = scene_changed(scene, &scene->revisions.resources);
    scene->meshes[scene->mesh_count] = copy;
    return scene->mesh_count++;
}
