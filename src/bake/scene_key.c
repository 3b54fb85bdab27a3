// Hashes of the geometry and the materials of a pose.
#include "bake/scene_key.h"

static struct hash128 add_array(struct hash128 key, const void *data, size_t count, size_t size)
{
    return hash128_add(key, data, data ? count * size : 0);
}

// Deformed vertices are in world space, rigid ones are placed by a matrix.
struct hash128 scene_key_add_shape(struct hash128 key, const struct scene_pose *pose, int instance)
{
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    const struct deformed_mesh *deformed = &pose->deformed[instance];
    const size_t count = mesh->vertex_count;
    const mat4s world_from_mesh = pose_world_from_instance(pose, instance);
    key = hash128_add(key, world_from_mesh.raw, sizeof world_from_mesh.raw);
    key = add_array(key, mesh->indices, mesh->index_count, sizeof *mesh->indices);
    key = add_array(key, deformed->positions ? deformed->positions : mesh->positions, count,
                    sizeof *mesh->positions);
    return add_array(key, deformed->normals ? deformed->normals : mesh->normals, count,
                     sizeof *mesh->normals);
}

static struct hash128 add_geometry(struct hash128 key, const struct scene_pose *pose, int instance)
{
    const int *material = &scene_mesh_of(pose->scene, instance)->material;
    return hash128_add(scene_key_add_shape(key, pose, instance), material, sizeof *material);
}

static struct hash128 add_map(struct hash128 key, const struct scene *scene,
                              const struct texture_use *use)
{
    const int words[] = { use->image >= 0, use->uv_set, (int)use->wrap_u, (int)use->wrap_v,
                          use->nearest };
    const float floats[] = { use->uv_offset[0], use->uv_offset[1], use->uv_scale[0],
                             use->uv_scale[1], use->uv_rotation_rad };
    if (use->image < 0) return hash128_add(key, words, sizeof words[0]);
    const struct scene_image *image = &scene->images[use->image];
    key = hash128_add(hash128_add(key, words, sizeof words), floats, sizeof floats);
    key = hash128_add(key, &image->width, sizeof image->width);
    if (image->linear) key = hash128_add_text(key, "linear");
    return add_array(key, image->rgba, (size_t)image->width * (size_t)image->height, 4);
}

struct hash128 scene_key_add_material(struct hash128 key, const struct scene *scene, int material)
{
    const struct material *m = &scene->materials[material];
    const float values[] = { m->base_color.x, m->base_color.y,     m->base_color.z,
                             m->base_color.w, m->metallic,         m->roughness,
                             m->ior,          m->specular,         m->specular_color.x,
                             m->emissive.x,   m->specular_color.y, m->specular_color.z,
                             m->emissive.y,   m->emissive.z,       m->normal_scale,
                             m->alpha_cutoff };
    const int flags[] = { (int)m->alpha_mode, m->double_sided, m->unlit };
    key = hash128_add(hash128_add(key, values, sizeof values), flags, sizeof flags);
    key = add_map(add_map(key, scene, &m->base_color_map), scene, &m->metallic_roughness_map);
    key = add_map(add_map(key, scene, &m->normal_map), scene, &m->emissive_map);
    return add_map(add_map(key, scene, &m->specular_map), scene, &m->specular_color_map);
}

struct hash128 scene_key_add_attributes(struct hash128 key, const struct scene *scene, int instance)
{
    const struct mesh *mesh = scene_mesh_of(scene, instance);
    const size_t count = mesh->vertex_count;
    for (int i = 0; i < 2; i++) key = add_array(key, mesh->uv[i], count, sizeof *mesh->uv[i]);
    key = add_array(key, mesh->colors, count, sizeof *mesh->colors);
    return add_array(key, mesh->tangents, count, sizeof *mesh->tangents);
}

struct hash128 scene_key_add_light(struct hash128 key, const struct world_light *light)
{
    const float values[] = { light->position.x,  light->position.y,  light->position.z,
                             light->direction.x, light->direction.y, light->direction.z,
                             light->intensity.x, light->intensity.y, light->intensity.z,
                             light->cos_inner,   light->cos_outer,   light->range_m };
    const int type = (int)light->type;
    return hash128_add(hash128_add(key, &type, sizeof type), values, sizeof values);
}

static struct hash128 add_surface(struct hash128 key, const struct scene *scene, int instance)
{
    return scene_key_add_material(scene_key_add_attributes(key, scene, instance), scene,
                                  scene_mesh_of(scene, instance)->material);
}

struct hash128 scene_key(const struct scene_pose *pose, unsigned parts)
{
    struct hash128 key =
        hash128_add(hash128_add_text((struct hash128){ 0 }, "scene"), &parts, sizeof parts);
    for (int i = 0; i < pose->scene->instance_count; i++) {
        if (pose->scene->instances[i].mesh < 0) continue; // removed
        if (parts & SCENE_KEY_GEOMETRY) key = add_geometry(key, pose, i);
        if (parts & SCENE_KEY_MATERIALS) key = add_surface(key, pose->scene, i);
    }
    return key;
}

struct hash128 scene_key_lit(const struct scene_pose *pose)
{
    struct hash128 key = scene_key(pose, SCENE_KEY_GEOMETRY | SCENE_KEY_MATERIALS);
    const uint64_t environment = environment_key(&pose->scene->environment);
    key = hash128_add(key, &environment, sizeof environment);
    for (int i = 0; i < pose_light_count(pose); i++) {
        if (i < pose->scene->light_count && pose->scene->lights[i].off) continue;
        const struct world_light light = pose_light(pose, i);
        key = scene_key_add_light(key, &light);
    }
    return key;
}
