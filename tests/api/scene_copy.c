#include "api/scene_copy.h"

#include "framework/test.h"

#include "api/objects.h"

static void ok(const struct ag_scene *scene, enum ag_result result)
{
    if (result != AG_OK) fail_msg("%s", ag_context_last_error(scene->context));
}

static void copy_images(const struct scene *from, struct ag_scene *to)
{
    for (int i = 0; i < from->image_count; i++) {
        const struct scene_image *image = &from->images[i];
        const struct ag_scene_image_desc desc = { .name = image->name,
                                                  .pixels = image->rgba,
                                                  .width = image->width,
                                                  .height = image->height,
                                                  .channels = 4 };
        ok(to, ag_scene_add_image(to, &desc, NULL));
    }
}

static void copy_materials(struct ag_scene *from, struct ag_scene *to)
{
    for (int i = 0; i < from->scene->material_count; i++) {
        struct ag_material_info info;
        struct ag_material_maps maps;
        ok(from, ag_scene_get_material(from, i, &info));
        ok(from, ag_scene_get_material_maps(from, i, &maps));
        info.material.maps = &maps;
        ok(to, ag_scene_add_material(to, &info.material, NULL));
    }
}

static void copy_meshes(const struct scene *from, struct ag_scene *to)
{
    for (int i = 0; i < from->mesh_count; i++) {
        const struct mesh *mesh = &from->meshes[i];
        assert_true(!mesh->joints && mesh->morph_count == 0);
        const struct ag_mesh_desc desc = {
            .positions = &mesh->positions->x,
            .normals = &mesh->normals->x,
            .uv = { (const float *)mesh->uv[0], (const float *)mesh->uv[1] },
            .tangents = (const float *)mesh->tangents,
            .colors = (const float *)mesh->colors,
            .vertex_count = mesh->vertex_count,
            .indices = mesh->indices,
            .index_count = mesh->index_count,
            .material = mesh->material,
        };
        ok(to, ag_scene_add_mesh(to, &desc, NULL));
    }
}

static void copy_instances(struct ag_scene *from, struct ag_scene *to)
{
    for (int i = 0; i < from->scene->instance_count; i++) {
        struct ag_instance_info info;
        int added = -1;
        ok(from, ag_scene_get_instance(from, i, -1, 0.0, &info));
        ok(to, ag_scene_add_instance(to, info.mesh, info.world_from_mesh, &added));
        ok(to, ag_scene_set_instance_mobility(to, added, info.mobility));
    }
}

struct ag_scene *scene_copy_by_calls(struct ag_scene *from)
{
    struct ag_scene *to = NULL;
    ok(from, ag_scene_create(from->context, &to));
    copy_images(from->scene, to);
    copy_materials(from, to);
    copy_meshes(from->scene, to);
    copy_instances(from, to);
    for (int i = 0; i < from->scene->light_count; i++) {
        struct ag_light_info info;
        ok(from, ag_scene_get_light(from, i, -1, 0.0, &info));
        ok(to, ag_scene_add_light(to, &info.light, NULL));
    }
    const vec3s sky = from->scene->environment.sky;
    ok(to, ag_scene_set_sky(to, sky.raw));
    return to;
}
