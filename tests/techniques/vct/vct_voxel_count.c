// CPU twin of voxelize/voxelize.glsl and voxelize/overlap.glsl.
#include "techniques/vct/vct_voxel_count.h"

#include "core/vec.h"
#include "scene/scene.h"

#include <math.h>

struct count {
    const struct vct_grid *grid;
    size_t dim;
    uint32_t *mask; // a bit for each voxel
    uint32_t touched, enough;
};

static bool edge_separates(vec3s edge, vec3s p, vec3s q)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const float at_p = edge.raw[j] * p.raw[k] - edge.raw[k] * p.raw[j];
        const float at_q = edge.raw[j] * q.raw[k] - edge.raw[k] * q.raw[j];
        const float reach = 0.5f * (fabsf(edge.raw[j]) + fabsf(edge.raw[k]));
        if (fminf(at_p, at_q) > reach || fmaxf(at_p, at_q) < -reach) return true;
    }
    return false;
}

// Corners relative to the voxel centre, in voxels.
static bool overlaps(const vec3s at[3], vec3s normal)
{
    float height = 0.0f, reach = 0.0f;
    for (int i = 0; i < 3; i++) {
        if (fminf(at[0].raw[i], fminf(at[1].raw[i], at[2].raw[i])) > 0.5f) return false;
        if (fmaxf(at[0].raw[i], fmaxf(at[1].raw[i], at[2].raw[i])) < -0.5f) return false;
        height += normal.raw[i] * at[0].raw[i];
        reach += 0.5f * fabsf(normal.raw[i]);
    }
    if (fabsf(height) > reach) return false;
    const vec3s ab = glms_vec3_sub(at[1], at[0]), bc = glms_vec3_sub(at[2], at[1]),
                ca = glms_vec3_sub(at[0], at[2]);
    return !edge_separates(ab, at[0], at[2]) && !edge_separates(bc, at[1], at[0]) &&
           !edge_separates(ca, at[2], at[1]);
}

static void mark_occupied(struct count *c, const int voxel[3])
{
    const size_t index = ((size_t)voxel[2] * c->dim + (size_t)voxel[1]) * c->dim + (size_t)voxel[0];
    const uint32_t bit = 1u << (index % 32);
    if (c->mask[index / 32] & bit) return;
    c->mask[index / 32] |= bit;
    c->touched++;
}

// Clamps a coordinate in voxels (rim = 0) or a voxel index (rim = 1) to the grid of the scene.
static float clamp_to_scene(const struct vct_grid *grid, int axis, float at, float rim)
{
    const float low = (float)-grid->first[axis], high = low + (float)grid->scene[axis] - rim;
    return fminf(fmaxf(at, low), high);
}

// Visits the columns along the dominant axis of the normal, a few voxels in each.
static void visit_columns(struct count *c, const vec3s at[3])
{
    const vec3s normal = glms_vec3_cross(glms_vec3_sub(at[1], at[0]), glms_vec3_sub(at[2], at[1]));
    const vec3s n = glms_vec3_abs(normal);
    const int axis = n.z >= n.x && n.z >= n.y ? 2 : n.x >= n.y ? 0 : 1;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    int first[3], last[3], voxel[3];
    if (!(n.raw[axis] > 0.0f)) return;
    for (int i = 0; i < 3; i++) {
        float low = floorf(fminf(at[0].raw[i], fminf(at[1].raw[i], at[2].raw[i])));
        float high =
            fmaxf(ceilf(fmaxf(at[0].raw[i], fmaxf(at[1].raw[i], at[2].raw[i]))) - 1.0f, low);
        if (!(fmaxf(fabsf(low), fabsf(high)) < 1e6f)) return;
        const float end = (float)c->grid->cells[i] - 1.0f;
        low = clamp_to_scene(c->grid, i, low, 1.0f);
        high = clamp_to_scene(c->grid, i, high, 1.0f);
        if (low > end || high < 0.0f) return;
        first[i] = (int)fmaxf(low, 0.0f);
        last[i] = (int)fminf(high, end);
    }
    const float slope_a = normal.raw[a] / normal.raw[axis],
                slope_b = normal.raw[b] / normal.raw[axis];
    const float reach = 0.5f * (fabsf(slope_a) + fabsf(slope_b)) + 0.01f;
    for (voxel[b] = first[b]; voxel[b] <= last[b]; voxel[b]++)
        for (voxel[a] = first[a]; voxel[a] <= last[a]; voxel[a]++) {
            const float height = at[0].raw[axis] -
                                 slope_a * ((float)voxel[a] + 0.5f - at[0].raw[a]) -
                                 slope_b * ((float)voxel[b] + 0.5f - at[0].raw[b]);
            const int end = (int)fminf(floorf(height + reach), (float)last[axis]);
            for (voxel[axis] = (int)fmaxf(floorf(height - reach), (float)first[axis]);
                 voxel[axis] <= end; voxel[axis]++) {
                vec3s from[3];
                for (int k = 0; k < 3; k++)
                    for (int i = 0; i < 3; i++)
                        from[k].raw[i] = at[k].raw[i] - ((float)voxel[i] + 0.5f);
                if (overlaps(from, normal)) mark_occupied(c, voxel);
            }
        }
}

// World to voxels. Snaps points within rounding of the scene's border to it.
static vec3s voxels_from_world(const struct vct_grid *grid, vec3s world)
{
    vec3s at = glms_vec3_scale(glms_vec3_sub(world, grid->origin_m), 1.0f / grid->cell_m);
    for (int i = 0; i < 3; i++) {
        const float inside = clamp_to_scene(grid, i, at.raw[i], 0.0f);
        if (fabsf(at.raw[i] - inside) < 0.01f) at.raw[i] = inside;
    }
    return at;
}

static void count_instance(struct count *c, const struct scene_pose *pose, int instance)
{
    const struct mesh *mesh = &pose->scene->meshes[pose->scene->instances[instance].mesh];
    const vec3s *deformed = pose->deformed[instance].positions;
    const vec3s *positions = deformed ? deformed : mesh->positions;
    const mat4s world = pose_world_from_instance(pose, instance);
    for (uint32_t i = 0; i + 2 < mesh->index_count && c->touched <= c->enough; i += 3) {
        vec3s at[3];
        for (uint32_t k = 0; k < 3; k++)
            at[k] = voxels_from_world(c->grid, mat4_point(world, positions[mesh->indices[i + k]]));
        visit_columns(c, at);
    }
}

bool vct_count_touched(struct host *host, const struct scene_pose *pose,
                       const struct vct_grid *grid, int32_t dim, uint32_t enough, uint32_t *count)
{
    struct count c = { .grid = grid, .dim = (size_t)dim, .enough = enough };
    c.mask = host_alloc(host, (c.dim * c.dim * c.dim + 31) / 32, sizeof *c.mask);
    if (!c.mask) return false;
    for (int i = 0; i < pose->scene->instance_count; i++) count_instance(&c, pose, i);
    host_free(host, c.mask);
    *count = c.touched;
    return true;
}
