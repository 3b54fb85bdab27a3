// Building blocks of scenes: materials, meshes, instances, lights.
#include "api/scene_parts.h"

#include "scene/limits.h"

_Static_assert((int)AG_LIGHT_SUN == (int)LIGHT_SUN && (int)AG_LIGHT_POINT == (int)LIGHT_POINT &&
                   (int)AG_LIGHT_SPOT == (int)LIGHT_SPOT,
               "types are converted by value");

void ag_material_desc_default(struct ag_material_desc *desc)
{
    if (!desc) return;
    *desc = (struct ag_material_desc){ .base_color = { 0.8f, 0.8f, 0.8f, 1.0f },
                                       .roughness = 1,
                                       .ior = MATERIAL_DEFAULT_IOR,
                                       .specular = 1,
                                       .specular_color = { 1, 1, 1 },
                                       .alpha_cutoff = 0.5f };
}

enum ag_result ag_scene_add_material(struct ag_scene *scene, const struct ag_material_desc *desc,
                                     int *index)
{
    REQUIRE_ADDING(scene, desc, index);
    REQUIRE_NO_BAKE(scene);
    struct material material = material_default();
    const enum ag_result checked = parts_material(__func__, scene, desc, &material);
    if (checked != AG_OK) return checked;
    if (desc->maps) {
        const enum ag_result mapped = parts_maps(__func__, scene, desc->maps, &material);
        if (mapped != AG_OK) return mapped;
    }
    return parts_added(scene, scene_add_material(scene->scene, &material), index);
}

static enum ag_result mesh_check(const char *function, const struct ag_scene *scene,
                                 const struct ag_mesh_desc *desc)
{
    struct ag_context *context = scene->context;
    AG_REQUIRE_KNOWN(function, context, desc);
    AG_REQUIRE_FOR(function, context, desc->positions && desc->vertex_count > 0,
                   "there are no positions");
    AG_REQUIRE_FOR(function, context, desc->indices && desc->index_count > 0,
                   "there are no indices");
    AG_REQUIRE_FOR(function, context, desc->index_count % 3 == 0,
                   "index_count %u is not a multiple of 3", desc->index_count);
    for (uint32_t i = 0; i < desc->index_count; i++)
        AG_REQUIRE_FOR(function, context, desc->indices[i] < desc->vertex_count,
                       "index %u at %u is not below vertex_count %u", desc->indices[i], i,
                       desc->vertex_count);
    for (uint32_t v = 0; desc->colors && v < desc->vertex_count; v++)
        AG_REQUIRE_FOR(function, context, api_in_unit_range(&desc->colors[4 * (size_t)v], 4),
                       "the colour of vertex %u is not within 0 to 1", v);
    return AG_OK;
}

enum ag_result ag_scene_add_mesh(struct ag_scene *scene, const struct ag_mesh_desc *desc,
                                 int *index)
{
    REQUIRE_ADDING(scene, desc, index);
    REQUIRE_NO_BAKE(scene);
    const enum ag_result checked = mesh_check(__func__, scene, desc);
    if (checked != AG_OK) return checked;
    REQUIRE_INDEX(scene, "material", desc->material, material_count);
    const bool mapped = scene->scene->materials[desc->material].normal_map.image >= 0;
    struct mesh mesh = { .name = "mesh",
                         .vertex_count = desc->vertex_count,
                         .index_count = desc->index_count,
                         .positions = (vec3s *)desc->positions, // scene_add_mesh copies all arrays
                         .normals = (vec3s *)desc->normals,
                         .tangents = desc->normals && mapped ? (vec4s *)desc->tangents : NULL,
                         .uv = { (vec2s *)desc->uv[0], (vec2s *)desc->uv[1] },
                         .colors = (vec4s *)desc->colors,
                         .indices = (uint32_t *)desc->indices,
                         .material = desc->material };
    return parts_added(scene, scene_add_mesh(scene->scene, &mesh), index);
}

enum ag_result ag_scene_add_instance(struct ag_scene *scene, int mesh, const float *world_from_mesh,
                                     int *index)
{
    mat4s matrix;
    if (index) *index = -1;
    AG_REQUIRE_POINTER(parts_context(scene), scene);
    REQUIRE_NO_BAKE(scene);
    REQUIRE_INDEX(scene, "mesh", mesh, mesh_count);
    const enum ag_result checked = parts_matrix(__func__, scene, world_from_mesh, &matrix);
    if (checked != AG_OK) return checked;
    return parts_added(scene, scene_add_placed_instance(scene->scene, mesh, matrix, false), index);
}

void ag_light_desc_default(struct ag_light_desc *desc, enum ag_light_type type)
{
    if (!desc) return;
    *desc = (struct ag_light_desc){ .type = type,
                                    .direction = { 0, -1, 0 },
                                    .intensity = { 1, 1, 1 },
                                    .outer_rad = GLM_PI_4f,
                                    .enabled = true };
}

enum ag_result api_add_light(struct ag_scene *scene, const struct ag_light_desc *desc,
                             const char *name)
{
    struct placed_light light = { .light.name = name };
    const enum ag_result checked = parts_light(__func__, scene, desc, &light);
    if (checked != AG_OK) return checked;
    return parts_added(scene, scene_add_placed_light(scene->scene, &light), NULL);
}

enum ag_result ag_scene_add_light(struct ag_scene *scene, const struct ag_light_desc *desc,
                                  int *index)
{
    struct placed_light light = { .light.name = "light" };
    REQUIRE_ADDING(scene, desc, index);
    const enum ag_result checked = parts_light(__func__, scene, desc, &light);
    if (checked != AG_OK) return checked;
    return parts_added(scene, scene_add_placed_light(scene->scene, &light), index);
}

void ag_area_light_desc_default(struct ag_area_light_desc *desc)
{
    if (!desc) return;
    *desc = (struct ag_area_light_desc){
        .direction = { 0, -1, 0 }, .width = 1, .height = 1, .radiance = { 1, 1, 1 }
    };
}

// Index of the instance; -1 if out of memory. The quad is in the xy plane of its node and faces -z,
// the viewing direction of nodes.
static int add_emissive_quad(struct scene *scene, const struct ag_area_light_desc *desc)
{
    static const char *const NAME = "area light";
    float x = 0.5f * desc->width, y = 0.5f * desc->height;
    vec3s corners[4] = { { { -x, -y, 0 } }, { { -x, y, 0 } }, { { x, y, 0 } }, { { x, -y, 0 } } };
    uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    struct material material = material_default();
    material.name = NAME;
    material.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    material.emissive = api_vec3(desc->radiance);
    struct mesh mesh = { .name = NAME,
                         .vertex_count = 4,
                         .index_count = 6,
                         .positions = corners,
                         .indices = indices,
                         .material = scene_add_material(scene, &material) };
    if (mesh.material < 0) return -1;
    struct instance instance = { .skin = -1, .mesh = scene_add_mesh(scene, &mesh) };
    if (instance.mesh < 0) return -1;
    instance.node =
        scene_add_node_looking(scene, NAME, api_vec3(desc->position), api_vec3(desc->direction));
    return instance.node < 0 ? -1 : scene_add_instance(scene, &instance);
}

enum ag_result ag_scene_add_area_light(struct ag_scene *scene,
                                       const struct ag_area_light_desc *desc, int *instance)
{
    REQUIRE_ADDING(scene, desc, instance);
    struct ag_context *context = scene->context;
    REQUIRE_NO_BAKE(scene);
    AG_REQUIRE_KNOWN(__func__, context, desc);
    AG_REQUIRE(context, limits_position(api_vec3(desc->position)),
               "position is not within %g m of the origin", (double)SCENE_MAX_DISTANCE_M);
    AG_REQUIRE(context, glms_vec3_norm(vec3_unit(api_vec3(desc->direction))) > 0.0f,
               "direction is zero or not finite");
    AG_REQUIRE(context,
               desc->width > 0.0f && desc->height > 0.0f && isfinite(desc->width * desc->height),
               "width %g and height %g are not above 0", (double)desc->width, (double)desc->height);
    AG_REQUIRE(context, limits_light(api_vec3(desc->radiance)),
               "radiance is not within 0 to %g cd/m²", (double)SCENE_MAX_RADIANCE);
    return parts_added(scene, add_emissive_quad(scene->scene, desc), instance);
}
