#include "techniques/lpv/mesh_fixture.h"

#include "core/rng.h"

#include <stdlib.h>

void mesh_fixture_init(struct mesh_fixture *meshes, struct rsm_fixture *rsm)
{
    *meshes = (struct mesh_fixture){ .rsm = rsm, .scene = scene_create(test_host(), "meshes") };
    assert_non_null(meshes->scene);
}

void mesh_fixture_finish(struct mesh_fixture *meshes)
{
    scene_gpu_finish(&meshes->scene_gpu);
    pose_finish(&meshes->pose);
    scene_destroy(meshes->scene);
}

int mesh_fixture_add(struct mesh_fixture *meshes, const vec3s *positions, uint32_t vertex_count,
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
        meshes->scene, &(struct mesh){ .name = "prop",
                                       .vertex_count = vertex_count,
                                       .index_count = indices ? index_count : vertex_count,
                                       .positions = (vec3s *)positions,
                                       .normals = normals,
                                       .indices = indices ? (uint32_t *)indices : in_a_row });
    const int node = scene_add_node(meshes->scene, &still);
    assert_true(mesh >= 0 && node >= 0);
    free(normals);
    free(in_a_row);
    return scene_add_instance(meshes->scene,
                              &(struct instance){ .node = node, .mesh = mesh, .skin = -1 });
}

int mesh_fixture_add_wall(struct mesh_fixture *meshes, vec3s corner, vec3s across, vec3s down)
{
    const vec3s beside = glms_vec3_add(corner, across), under = glms_vec3_add(corner, down);
    const vec3s corners[4] = { corner, beside, glms_vec3_add(beside, down), under };
    const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    return mesh_fixture_add(meshes, corners, 4, indices, 6);
}

int mesh_fixture_add_soup(struct mesh_fixture *meshes, uint32_t seed)
{
    enum { TRIANGLES = 90 };
    struct rng rng = rng_for(seed, 0, 0);
    const struct box3 bounds = meshes->rsm->view.bounds;
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
    return mesh_fixture_add(meshes, positions, 3 * TRIANGLES, NULL, 0);
}

void mesh_fixture_place(struct mesh_fixture *meshes)
{
    assert_true(pose_init(&meshes->pose, meshes->scene, -1, 0));
    assert_true(scene_gpu_init(&meshes->scene_gpu, test_host(), meshes->rsm->gpu, meshes->scene));
    meshes->rsm->view.scene = &meshes->scene_gpu;
}

void mesh_fixture_move(struct mesh_fixture *meshes, int instance, float by)
{
    meshes->pose.world_from_node[meshes->scene->instances[instance].node].raw[3][0] += by;
}

void mesh_fixture_render(struct mesh_fixture *meshes, struct lpv *lpv)
{
    struct rsm_fixture *rsm = meshes->rsm;
    struct gpu_cmd *cmd = gpu_frame_begin(rsm->gpu);
    assert_non_null(cmd);
    scene_gpu_update(&meshes->scene_gpu, cmd, &meshes->pose, false);
    rsm->view.geometry_moved = meshes->scene_gpu.moved;
    technique_lpv.update(lpv, cmd, &rsm->view);
    technique_lpv.record(lpv, cmd, &rsm->view);
    CHECK(gpu_frame_end(rsm->gpu, cmd));
    CHECK(gpu_wait(rsm->gpu));
    rsm->view.index++;
}
