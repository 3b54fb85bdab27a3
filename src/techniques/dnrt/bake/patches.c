#include "techniques/dnrt/bake/patches.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "techniques/dnrt/bake/self.h"
#include "techniques/dnrt/dnrt_shared.h"

#include <math.h>

static const float STEP = 0.125f; // of a grid, at most, in radii of the bounding sphere
enum { MOST_STEPS = 32 };
// Points move this part of the way to the middle of their triangle: none is on the plane of a
// neighbour.
static const float INSET = 0.01f;

// ---- geometry

static uint32_t triangles_of(const struct dnrt_part *part, int mesh)
{
    return part->scene.meshes[mesh].index_count / 3;
}

static int mesh_of(const struct dnrt_part *part, uint32_t *triangle)
{
    int mesh = 0;
    for (; *triangle >= triangles_of(part, mesh); mesh++) *triangle -= triangles_of(part, mesh);
    return mesh;
}

void dnrt_patch_corners(const struct dnrt_part *part, uint32_t patch, vec3s corners[3])
{
    const int k = mesh_of(part, &patch);
    const struct mesh *mesh = &part->scene.meshes[k];
    for (int i = 0; i < 3; i++) {
        const vec3s p = mesh->positions[mesh->indices[3 * (size_t)patch + (size_t)i]];
        corners[i] = glms_vec3_sub(mat4_point(part->pose.world_from_node[k], p), part->centre);
    }
}

static uint32_t steps_of(const struct dnrt_part *part, uint32_t patch)
{
    vec3s corners[3];
    float longest = 0.0f;
    dnrt_patch_corners(part, patch, corners);
    for (int i = 0; i < 3; i++)
        longest = fmaxf(longest, glms_vec3_distance(corners[i], corners[(i + 1) % 3]));
    return (uint32_t)glm_clamp(ceilf(longest / (STEP * part->radius)), 1, MOST_STEPS);
}

static uint32_t points_of(uint32_t grid)
{
    const uint32_t n = grid & DNRT_PATCH_STEPS;
    return (n + 1) * (n + 2) / 2 * (grid & DNRT_PATCH_TWO_SIDES ? 2 : 1);
}

bool dnrt_patches_init(struct dnrt_patches *out, struct host *host, const struct dnrt_part *part)
{
    *out = (struct dnrt_patches){ .host = host };
    if (!(part->radius > 0.0f)) return true;
    for (int k = 0; k < part->scene.mesh_count; k++) out->count += triangles_of(part, k);
    out->at = host_alloc(host, out->count, sizeof *out->at);
    uint32_t patch = 0;
    for (int k = 0; out->at && k < part->scene.mesh_count; k++) {
        const int material = part->scene.meshes[k].material;
        const mat3s linear = glms_mat4_pick3(part->pose.world_from_node[k]);
        uint32_t bits = part->scene.materials[material].double_sided ? DNRT_PATCH_TWO_SIDES : 0;
        if (glms_mat3_det(linear) < 0.0f) bits |= DNRT_PATCH_MIRRORED;
        for (uint32_t i = 0; i < triangles_of(part, k); i++, patch++) {
            const uint32_t grid = steps_of(part, patch) | bits;
            out->at[patch] = (struct dnrt_patch){ out->points, grid };
            out->points += points_of(grid);
        }
    }
    return out->at != NULL;
}

void dnrt_patches_finish(struct dnrt_patches *patches)
{
    if (patches->host) host_free(patches->host, patches->at);
    *patches = (struct dnrt_patches){ 0 };
}

// ---- transfer

static uint32_t patch_of(const struct dnrt_patches *patches, uint32_t point)
{
    uint32_t low = 0, high = patches->count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (patches->at[middle].first <= point)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// Weights of the second and third corner.
static vec2s weights_of(uint32_t n, uint32_t point)
{
    uint32_t j = 0;
    for (; point > n - j; j++) point -= n - j + 1;
    const float middle = INSET / 3.0f, scale = (1.0f - INSET) / (float)n;
    return (vec2s){ { middle + scale * (float)point, middle + scale * (float)j } };
}

static void surface_of(const struct trace_scene *trace, const struct dnrt_patches *patches,
                       uint32_t point, struct surface *out)
{
    uint32_t triangle = patch_of(patches, point), mesh = 0, corner[3];
    const struct dnrt_patch *patch = &patches->at[triangle];
    const uint32_t n = patch->grid & DNRT_PATCH_STEPS, side = (n + 1) * (n + 2) / 2;
    const bool back = point - patch->first >= side;
    const vec2s at = weights_of(n, (point - patch->first) % side);
    for (; triangle >= trace->meshes[mesh].mesh->index_count / 3; mesh++)
        triangle -= trace->meshes[mesh].mesh->index_count / 3;
    const struct trace_mesh *of = &trace->meshes[mesh];
    trace_corners(of, triangle, corner);
    vec3s normal = glms_vec3_scale(of->vertices[corner[0]].normal, 1.0f - at.x - at.y);
    normal = glms_vec3_muladds(of->vertices[corner[1]].normal, at.x, normal);
    normal = glms_vec3_muladds(of->vertices[corner[2]].normal, at.y, normal);
    *out = (struct surface){ .position = trace_point(of, corner, at.x, at.y),
                             .geometric = of->facets[triangle].normal,
                             .normal = vec3_unit(normal),
                             .reach = of->facets[triangle].reach };
    if (!back) return;
    out->geometric = glms_vec3_negate(out->geometric);
    out->normal = glms_vec3_negate(out->normal);
}

void dnrt_self_at(const struct dnrt_sampling *how, const struct dnrt_patches *patches,
                  uint32_t point, uint32_t seed, vec4s out[DNRT_MAX_COEFFICIENTS])
{
    struct surface at;
    struct rng rng = rng_for(seed, 0, 0);
    surface_of(how->trace, patches, point, &at);
    for (int j = 0; j < DNRT_MAX_COEFFICIENTS; j++) out[j] = glms_vec4_zero();
    for (uint32_t i = 0; i < (uint32_t)how->rays; i++) {
        const vec3s direction = dnrt_cosine_direction(&at, sobol_2d(i, seed));
        const struct ray ray = { surface_leave(&at, direction), direction, 0.0f, INFINITY };
        struct ray_hit hit;
        struct surface other;
        vec3s reflected[DNRT_MAX_COEFFICIENTS];
        float occluded[DNRT_MAX_COEFFICIENTS];
        // Below the triangle, but above the interpolated normal's horizon, there is its own back.
        if (glms_vec3_dot(direction, at.geometric) <= 0.0f ||
            !embree_closest(how->trace->embree, &ray, NULL, false, &hit))
            continue;
        surface_at(how->trace, &ray, &hit, NULL, &other);
        dnrt_reflected(how->trace, how->bands, true, &other, &rng, reflected);
        dnrt_occluded(how->bands, direction, occluded);
        for (int j = 0; j < SH_COUNT(how->bands); j++) {
            const vec3s change = glms_vec3_subs(reflected[j], occluded[j]);
            out[j] = glms_vec4_add(out[j], vec4_of(change, occluded[j]));
        }
    }
    for (int j = 0; j < DNRT_MAX_COEFFICIENTS; j++)
        out[j] = glms_vec4_divs(out[j], (float)how->rays);
}
