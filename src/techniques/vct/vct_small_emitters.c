// A lamp's light on a point is the mean over points spread evenly over its area: see
// cones/small_emitters.glsl.
#include "techniques/vct/vct_small_emitters.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "frame/scene_gpu.h"

#include <math.h>
#include <string.h>

// What is larger than this part of the scene is no lamp: cones see it well enough, and from nearby
// better than points do.
static const float LARGEST = 0.25f;
enum { MOST_TRIANGLES = 20000 }; // to be walked in each frame in which it moves

// The triangles of a draw in world space.
struct lamp_mesh {
    const struct mesh *mesh;
    const vec3s *positions;
    mat4s world;
    float side; // 1, or −1 where the transform turns triangles over
};

static struct lamp_mesh mesh_of(const struct scene_pose *pose, const struct scene_draw *draw)
{
    struct lamp_mesh m = { .mesh = &pose->scene->meshes[draw->mesh],
                           .world = pose_world_from_instance(pose, draw->instance),
                           .side = draw->mirrored ? -1.0f : 1.0f };
    const vec3s *deformed = pose->deformed[draw->instance].positions;
    m.positions = deformed ? deformed : m.mesh->positions;
    if (deformed) m.world = glms_mat4_identity();
    return m;
}

// Corner, two edges; returns the area, m².
static float triangle_of(const struct lamp_mesh *m, uint32_t triangle, vec3s out[3])
{
    const uint32_t *index = &m->mesh->indices[3 * triangle];
    for (int i = 0; i < 3; i++) out[i] = mat4_point(m->world, m->positions[index[i]]);
    out[1] = glms_vec3_sub(out[1], out[0]);
    out[2] = glms_vec3_sub(out[2], out[0]);
    const float area = 0.5f * glms_vec3_norm(glms_vec3_cross(out[1], out[2]));
    return isfinite(area) ? area : 0.0f;
}

static double area_of(const struct lamp_mesh *m)
{
    double area = 0.0;
    vec3s t[3];
    for (uint32_t i = 0; i < m->mesh->index_count / 3; i++) area += (double)triangle_of(m, i, t);
    return area;
}

static bool may_be_lamp(const struct frame_view *view, const struct scene_draw *draw)
{
    const vec3s e = view->pose->scene->materials[draw->material].emissive;
    if (!(fmaxf(e.x, fmaxf(e.y, e.z)) > 0.0f)) return false;
    if (draw->variant & ~(uint32_t)VARIANT_NORMAL_MAP)
        return false; // what it emits is not the same all over
    if (view->pose->scene->meshes[draw->mesh].index_count / 3 > MOST_TRIANGLES) return false;
    return glms_vec3_norm(box3_size(draw->bounds)) <=
           LARGEST * glms_vec3_norm(box3_size(view->bounds));
}

// Watts would do as well: what tells which of many lamps are left to the cones.
static double flux_of(const struct frame_view *view, const struct scene_draw *draw)
{
    const struct lamp_mesh m = mesh_of(view->pose, draw);
    const vec3s e = view->pose->scene->materials[draw->material].emissive;
    return area_of(&m) * ((double)e.x + (double)e.y + (double)e.z);
}

// Puts a draw among the strongest, in falling order.
static void enter(struct vct_lamps *lamps, double flux[VCT_LAMPS_MAX], int draw, double its)
{
    if (!(its > 0.0)) return;
    int at = lamps->count;
    while (at > 0 && flux[at - 1] < its) at--;
    if (at == VCT_LAMPS_MAX) return;
    if (lamps->count < VCT_LAMPS_MAX) lamps->count++;
    for (int i = lamps->count - 1; i > at; i--) {
        flux[i] = flux[i - 1];
        lamps->draws[i] = lamps->draws[i - 1];
    }
    flux[at] = its;
    lamps->draws[at] = draw;
}

static void choose(struct vct_lamps *lamps, const struct frame_view *view)
{
    double flux[VCT_LAMPS_MAX];
    lamps->count = 0;
    for (int i = 0; i < view->scene->draw_count; i++) {
        const struct scene_draw *draw = &view->scene->draws[i];
        if (may_be_lamp(view, draw)) enter(lamps, flux, i, flux_of(view, draw));
    }
    lamps->chosen = true;
}

// Points spread evenly: each has as much of the area before it as the one before, and lies in its
// triangle where a sequence of even numbers says.
static void place_points(struct vct_lamp *lamp, const struct lamp_mesh *m, double area,
                         uint32_t turn)
{
    double before = 0.0;
    int placed = 0;
    for (uint32_t i = 0; i < m->mesh->index_count / 3 && placed < VCT_LAMP_POINTS; i++) {
        vec3s t[3];
        before += (double)triangle_of(m, i, t);
        const bool last = i + 1 == m->mesh->index_count / 3;
        const vec3s normal = glms_vec3_scale(glms_vec3_cross(t[1], t[2]), m->side);
        const float length = glms_vec3_norm(normal);
        while (placed < VCT_LAMP_POINTS &&
               (last || (placed + 0.5) / VCT_LAMP_POINTS * area < before)) {
            const vec2s at =
                sample_triangle(r2_sequence((uint32_t)placed + VCT_LAMP_POINTS * turn));
            lamp->positions[placed] = glms_vec3_add(
                t[0], glms_vec3_add(glms_vec3_scale(t[1], at.x), glms_vec3_scale(t[2], at.y)));
            lamp->normals[placed] =
                length > 0.0f ? glms_vec3_scale(normal, 1.0f / length) : vec3_of(0, 0, 0);
            placed++;
        }
    }
}

static void place(struct vct_lamp *lamp, const struct frame_view *view,
                  const struct scene_draw *draw, uint32_t turn)
{
    const struct material *material = &view->pose->scene->materials[draw->material];
    const struct lamp_mesh m = mesh_of(view->pose, draw);
    const double area = area_of(&m);
    lamp->radiance = glms_vec3_scale(material->emissive, view->constants->radiance_scale);
    lamp->area_m2 = (float)(area / VCT_LAMP_POINTS);
    lamp->both_sides = material->double_sided;
    place_points(lamp, &m, area, turn);
}

void vct_lamps_update(struct vct_lamps *lamps, const struct frame_view *view, uint32_t turn)
{
    if (!lamps->chosen) choose(lamps, view);
    for (int i = 0; i < lamps->count; i++)
        place(&lamps->list[i], view, &view->scene->draws[lamps->draws[i]], turn);
}

bool vct_lamps_have(const struct vct_lamps *lamps, int draw)
{
    for (int i = 0; i < lamps->count; i++)
        if (lamps->draws[i] == draw) return true;
    return false;
}

struct gpu_binding vct_lamps_binding(const struct vct_lamps *lamps, struct gpu_cmd *cmd)
{
    const size_t count = lamps->count > 0 ? (size_t)lamps->count : 1; // a block is never empty
    return gpu_transient(cmd, "vct_lamps", lamps->list, count * sizeof *lamps->list);
}
