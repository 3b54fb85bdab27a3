#include "techniques/props.h"

#include "core/rng.h"

#include <stdlib.h>

void props_init(struct props *props, struct stage *stage)
{
    *props = (struct props){ .stage = stage, .scene = scene_create(test_host(), "props") };
    assert_non_null(props->scene);
}

void props_finish(struct props *props)
{
    scene_gpu_finish(&props->scene_gpu);
    pose_finish(&props->pose);
    scene_destroy(props->scene);
}

int props_add(struct props *props, const vec3s *positions, uint32_t vertex_count,
              const uint32_t *indices, uint32_t index_count)
{
    vec3s *normals = calloc(vertex_count, sizeof *normals);
    uint32_t *in_a_row = calloc(vertex_count, sizeof *in_a_row);
    for (uint32_t i = 0; i < vertex_count; i++) {
        normals[i] = vec3_of(0, 1, 0);
        in_a_row[i] = i;
    }
    const struct node still = node_default();
    const int mesh = scene_add_mesh(
        props->scene, &(struct mesh){ .name = "prop",
                                      .vertex_count = vertex_count,
                                      .index_count = indices ? index_count : vertex_count,
                                      .positions = (vec3s *)positions,
                                      .normals = normals,
                                      .indices = indices ? (uint32_t *)indices : in_a_row });
    const int node = scene_add_node(props->scene, &still);
    assert_true(mesh >= 0 && node >= 0);
    free(normals);
    free(in_a_row);
    return scene_add_instance(props->scene,
                              &(struct instance){ .node = node, .mesh = mesh, .skin = -1 });
}

int props_add_wall(struct props *props, vec3s corner, vec3s across, vec3s down)
{
    const vec3s beside = glms_vec3_add(corner, across), under = glms_vec3_add(corner, down);
    const vec3s corners[4] = { corner, beside, glms_vec3_add(beside, down), under };
    const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    return props_add(props, corners, 4, indices, 6);
}

int props_add_soup(struct props *props, uint32_t seed)
{
    enum { TRIANGLES = 90 };
    struct rng rng = rng_for(seed, 0, 0);
    const struct box3 bounds = props->stage->view.bounds;
    const vec3s size = glms_vec3_sub(bounds.max, bounds.min);
    vec3s positions[3 * TRIANGLES];
    for (int i = 0; i < 3 * TRIANGLES; i++) {
        const float reach = i / 3 % 5 == 0 ? 4.5f : 0.4f;
        const vec3s random = vec3_of(rng_float(&rng), rng_float(&rng), rng_float(&rng));
        if (i % 3 == 0)
            positions[i] = glms_vec3_add(
                bounds.min,
                glms_vec3_mul(size, glms_vec3_scale(glms_vec3_subs(random, 0.05f), 1.1f)));
        else
            positions[i] = glms_vec3_add(positions[i - i % 3],
                                         glms_vec3_scale(glms_vec3_subs(random, 0.5f), reach));
    }
    return props_add(props, positions, 3 * TRIANGLES, NULL, 0);
}

void props_place(struct props *props)
{
    assert_true(pose_init(&props->pose, props->scene, -1, 0));
    assert_true(scene_gpu_init(&props->scene_gpu, test_host(), props->stage->gpu, props->scene));
    props->stage->view.scene = &props->scene_gpu;
}

void props_move(struct props *props, int instance, float by)
{
    props->pose.world_from_node[props->scene->instances[instance].node].raw[3][0] += by;
}

void props_render(struct props *props, struct lpv *lpv)
{
    struct stage *stage = props->stage;
    struct gpu_cmd *cmd = gpu_frame_begin(stage->gpu);
    assert_non_null(cmd);
    scene_gpu_update(&props->scene_gpu, cmd, &props->pose, false);
    technique_lpv.record(lpv, cmd, &stage->view);
    CHECK(gpu_frame_end(stage->gpu, cmd));
    CHECK(gpu_wait(stage->gpu));
    stage->view.index++;
}
