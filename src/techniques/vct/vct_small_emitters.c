// A small emitter is represented by points spread evenly over its area: see
// cones/small_emitters.glsl.
#include "techniques/vct/vct_small_emitters.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "frame/scene_gpu.h"

#include <math.h>
#include <string.h>

// Largest extent, as a fraction of the scene's. Cones sample larger emitters well, and from nearby
// better than points do.
static const float LARGEST = 0.25f;
enum { MOST_TRIANGLES = 20000 }; // they are traversed in each frame

// The triangles of a draw in world space.
struct emitter_mesh {
    const struct mesh *mesh;
    const vec3s *positions;
    mat4s world;
    float side; // 1, or −1 where the transform turns triangles over
};

static struct emitter_mesh mesh_of(const struct scene_pose *pose, const struct scene_draw *draw)
{
    struct emitter_mesh m = { .mesh = &pose->scene->meshes[draw->mesh],
                              .world = pose_world_from_instance(pose, draw->instance),
                              .side = draw->mirrored ? -1.0f : 1.0f };
    const vec3s *deformed = pose->deformed[draw->instance].positions;
    m.positions = deformed ? deformed : m.mesh->positions;
    if (deformed) m.world = glms_mat4_identity();
    return m;
}

// Corner, two edges; returns the area, m².
static float triangle_of(const struct emitter_mesh *m, uint32_t triangle, vec3s out[3])
{
    const uint32_t *index = &m->mesh->indices[3 * triangle];
    for (int i = 0; i < 3; i++) out[i] = mat4_point(m->world, m->positions[index[i]]);
    out[1] = glms_vec3_sub(out[1], out[0]);
    out[2] = glms_vec3_sub(out[2], out[0]);
    const float area = 0.5f * glms_vec3_norm(glms_vec3_cross(out[1], out[2]));
    return isfinite(area) ? area : 0.0f;
}

static double area_of(const struct emitter_mesh *m)
{
    double area = 0.0;
    vec3s t[3];
    for (uint32_t i = 0; i < m->mesh->index_count / 3; i++) area += (double)triangle_of(m, i, t);
    return area;
}

static bool may_be_small_emitter(const struct frame_view *view, const struct scene_draw *draw)
{
    const vec3s e = view->pose->scene->materials[draw->material].emissive;
    if (!(fmaxf(e.x, fmaxf(e.y, e.z)) > 0.0f)) return false;
    if (draw->variant & ~(uint32_t)VARIANT_NORMAL_MAP)
        return false; // emission varies over the surface
    if (view->pose->scene->meshes[draw->mesh].index_count / 3 > MOST_TRIANGLES) return false;
    return glms_vec3_norm(box3_size(draw->bounds)) <=
           LARGEST * glms_vec3_norm(box3_size(view->bounds));
}

// Up to a factor. The strongest emitters are sampled, the others are left to the cones.
static double flux_of(const struct frame_view *view, const struct scene_draw *draw)
{
    const struct emitter_mesh m = mesh_of(view->pose, draw);
    const vec3s e = view->pose->scene->materials[draw->material].emissive;
    return area_of(&m) * ((double)e.x + (double)e.y + (double)e.z);
}

// Inserts a draw into the list, strongest first.
static void insert(struct vct_small_emitters *small_emitters, double flux[VCT_MAX_SMALL_EMITTERS],
                   int draw, double draw_flux)
{
    if (!(draw_flux > 0.0)) return;
    int at = small_emitters->count;
    while (at > 0 && flux[at - 1] < draw_flux) at--;
    if (at == VCT_MAX_SMALL_EMITTERS) return;
    if (small_emitters->count < VCT_MAX_SMALL_EMITTERS) small_emitters->count++;
    for (int i = small_emitters->count - 1; i > at; i--) {
        flux[i] = flux[i - 1];
        small_emitters->draws[i] = small_emitters->draws[i - 1];
    }
    flux[at] = draw_flux;
    small_emitters->draws[at] = draw;
}

static void choose(struct vct_small_emitters *small_emitters, const struct frame_view *view)
{
    double flux[VCT_MAX_SMALL_EMITTERS];
    small_emitters->count = 0;
    for (int i = 0; i < view->scene->draw_count; i++) {
        const struct scene_draw *draw = &view->scene->draws[i];
        if (may_be_small_emitter(view, draw)) insert(small_emitters, flux, i, flux_of(view, draw));
    }
    small_emitters->chosen = true;
}

// Points of equal area, stratified over the triangles in order; within a triangle they follow a
// low-discrepancy sequence.
static void place_points(struct vct_small_emitter *emitter, const struct emitter_mesh *m,
                         double area, uint32_t frame)
{
    double before = 0.0;
    int placed = 0;
    for (uint32_t i = 0; i < m->mesh->index_count / 3 && placed < VCT_EMITTER_POINTS; i++) {
        vec3s t[3];
        before += (double)triangle_of(m, i, t);
        const bool last = i + 1 == m->mesh->index_count / 3;
        const vec3s normal = glms_vec3_scale(glms_vec3_cross(t[1], t[2]), m->side);
        const float length = glms_vec3_norm(normal);
        while (placed < VCT_EMITTER_POINTS &&
               (last || (placed + 0.5) / VCT_EMITTER_POINTS * area < before)) {
            const vec2s at =
                sample_triangle(r2_sequence((uint32_t)placed + VCT_EMITTER_POINTS * frame));
            emitter->positions[placed] = glms_vec3_add(
                t[0], glms_vec3_add(glms_vec3_scale(t[1], at.x), glms_vec3_scale(t[2], at.y)));
            emitter->normals[placed] =
                length > 0.0f ? glms_vec3_scale(normal, 1.0f / length) : vec3_of(0, 0, 0);
            placed++;
        }
    }
}

static void sample_draw(struct vct_small_emitter *emitter, const struct frame_view *view,
                        const struct scene_draw *draw, uint32_t frame)
{
    const struct material *material = &view->pose->scene->materials[draw->material];
    const struct emitter_mesh m = mesh_of(view->pose, draw);
    const double area = area_of(&m);
    emitter->radiance = glms_vec3_scale(material->emissive, view->constants->radiance_scale);
    emitter->area_m2 = (float)(area / VCT_EMITTER_POINTS);
    emitter->both_sides = material->double_sided;
    place_points(emitter, &m, area, frame);
}

void vct_small_emitters_update(struct vct_small_emitters *small_emitters,
                               const struct frame_view *view, uint32_t frame)
{
    if (!small_emitters->chosen) choose(small_emitters, view);
    for (int i = 0; i < small_emitters->count; i++)
        sample_draw(&small_emitters->list[i], view, &view->scene->draws[small_emitters->draws[i]],
                    frame);
}

bool vct_small_emitters_have(const struct vct_small_emitters *small_emitters, int draw)
{
    for (int i = 0; i < small_emitters->count; i++)
        if (small_emitters->draws[i] == draw) return true;
    return false;
}
