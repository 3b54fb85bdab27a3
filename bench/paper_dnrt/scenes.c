#include "paper_dnrt/scenes.h"

#include <math.h>

enum { RINGS = 28, SEGMENTS = 28, VERTICES = (RINGS + 1) * (SEGMENTS + 1) };

static const float RADIUS = 0.7f;                      // m
static const float CENTRE[3] = { -2.6f, 0.75f, 0.2f }; // in the courtyard, above the floor
static const float EYE[3] = { 2.2f, 2.2f, 0.9f };
static const float SUN[3] = { 0.1f, -1.0f, 0.33f };

// About 1500 triangles.
static enum ag_result add_sphere(struct ag_scene *scene, int material, int *mesh)
{
    static float positions[3 * VERTICES], normals[3 * VERTICES];
    static uint32_t indices[6 * RINGS * SEGMENTS];
    uint32_t count = 0;
    for (int r = 0; r <= RINGS; r++)
        for (int s = 0; s <= SEGMENTS; s++) {
            const double polar = 3.14159265358979 * r / RINGS;
            const double turn = 2.0 * 3.14159265358979 * (s % SEGMENTS) / SEGMENTS;
            const double n[3] = { sin(polar) * sin(turn), cos(polar), sin(polar) * cos(turn) };
            for (int i = 0; i < 3; i++) {
                const int at = 3 * (r * (SEGMENTS + 1) + s) + i;
                normals[at] = (float)n[i];
                positions[at] = RADIUS * (float)n[i];
            }
        }
    for (uint32_t r = 0; r < RINGS; r++)
        for (uint32_t s = 0; s < SEGMENTS; s++) {
            const uint32_t a = r * (SEGMENTS + 1) + s, b = a + SEGMENTS + 1;
            const uint32_t quad[6] = { a, b, b + 1, a, b + 1, a + 1 };
            for (int i = 0; i < 6; i++) indices[count++] = quad[i];
        }
    const struct ag_mesh_desc desc = { .positions = positions,
                                       .normals = normals,
                                       .vertex_count = VERTICES,
                                       .indices = indices,
                                       .index_count = count,
                                       .material = material };
    return ag_scene_add_mesh(scene, &desc, mesh);
}

static enum ag_result add_object(struct ag_scene *scene)
{
    float place[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, CENTRE[0], CENTRE[1], CENTRE[2], 1 };
    struct ag_material_desc material;
    int index = -1, mesh = -1, instance = -1;
    ag_material_desc_default(&material);
    material.base_color[0] = 0.15f;
    material.base_color[1] = 0.35f;
    material.base_color[2] = 0.85f;
    enum ag_result result = ag_scene_add_material(scene, &material, &index);
    if (result == AG_OK) result = add_sphere(scene, index, &mesh);
    if (result == AG_OK) result = ag_scene_add_instance(scene, mesh, place, &instance);
    if (result == AG_OK)
        result = ag_scene_set_instance_mobility(scene, instance, AG_MOBILITY_MOVABLE);
    return result;
}

static enum ag_result add_sun(struct ag_scene *scene)
{
    struct ag_light_desc sun;
    ag_light_desc_default(&sun, AG_LIGHT_SUN);
    for (int i = 0; i < 3; i++) {
        sun.direction[i] = SUN[i];
        sun.intensity[i] = 100000.0f;
    }
    return ag_scene_add_light(scene, &sun, NULL);
}

enum ag_result dnrt_open_sponza(const struct bench *bench, const char *path,
                                struct ag_scene **scene, struct ag_frame_desc *frame)
{
    ag_frame_desc_default(frame);
    enum ag_result result = ag_scene_load(bench->context, path, scene);
    if (result == AG_OK) result = add_sun(*scene);
    if (result == AG_OK) result = add_object(*scene);
    if (result == AG_OK) result = ag_scene_look_at(*scene, EYE, CENTRE, 0.9f, &frame->camera);
    return result;
}
