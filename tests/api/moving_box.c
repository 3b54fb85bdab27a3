// The box, and a small dictionary.
#include "api/moving_box.h"

struct ag_bake *moving_box_bake(struct ag_context *context, struct ag_scene **scene)
{
    struct ag_bake *bake = NULL;
    if (ag_scene_load(context, MOVING_BOX_SCENE, scene) != AG_OK ||
        ag_bake_create(*scene, MOVING_BOX_WAIT, NULL, &bake) != AG_OK ||
        ag_bake_run(bake, NULL, NULL) != AG_OK)
        return NULL;
    return bake;
}

int moving_box_add(struct ag_scene *scene)
{
    static const float corners[24] = { -1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                       -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1 };
    static const uint32_t faces[36] = { 0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                        3, 6, 2, 3, 7, 6, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5 };
    const struct ag_mesh_desc desc = {
        .positions = corners, .vertex_count = 8, .indices = faces, .index_count = 36, .material = 0
    };
    int mesh, instance = -1;
    const float matrix[16] = { 0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0, -1, 1, 1.2f, 1 };
    if (ag_scene_add_mesh(scene, &desc, &mesh) != AG_OK ||
        ag_scene_add_instance(scene, mesh, matrix, &instance) != AG_OK)
        return -1;
    return instance;
}

enum ag_result moving_box_place(struct ag_scene *scene, int instance, float x)
{
    const float matrix[16] = { 0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0, x, 1, 1.2f, 1 };
    return ag_scene_set_instance_transform(scene, instance, matrix);
}
