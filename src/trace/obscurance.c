// Volumetric obscurance and ambient occlusion at a point by ray tracing.
//
// Volumetric obscurance (Loos 2015, sec. 6.3) is V = ∫ρ(x) O(x) dx over ∫ρ(x) dx, with ρ constant
// in a sphere of radius R, and O 0 inside matter, 1 elsewhere. Along a direction ω from the centre,
// the segment from a to b has the share (b³ − a³)/R³ of the cone's volume, so that
//     V = 1/Ω ∫ Σ (b³ − a³)/R³ dω over the empty segments of each ray,
// with Ω = 4π for the sphere, or 2π for its hemisphere above the shading normal. On a plane half of
// the sphere is empty, and all of the hemisphere. Matter begins at front faces and ends at back
// faces. Behind a double-sided surface the rest of the sphere counts as matter, as in a depth
// buffer.
//
// Ambient visibility is 1/π ∫ cos θ dω over the unoccluded directions of the hemisphere, up to R.
// With a decay γ (1/m) an occluder at the distance r has the opacity 1/(1 + γ r) (Hong 2015,
// sec. 2.5.3.3.8): occluded directions add 1/π ∫ cos θ (1 − 1/(1 + γ r)) dω.
#include "trace/obscurance.h"

#include "core/rng.h"
#include "core/sampling.h"

enum { MAX_CROSSINGS = 64 };

static float cube(float x)
{
    return x * x * x;
}

static vec3s around(vec3s n, vec3s local)
{
    vec3s t, b;
    basis_of(n, &t, &b);
    return glms_vec3_muladds(t, local.x,
                             glms_vec3_muladds(b, local.y, glms_vec3_scale(n, local.z)));
}

// A surface crossed by a ray: the origin of the next ray, and whether matter ends there.
struct crossing {
    float distance_m;
    vec3s beyond;
    bool ends_matter;
};

static bool cross(const struct trace_scene *scene, vec3s from, vec3s direction, float far_m,
                  struct crossing *out)
{
    const struct ray ray = { from, direction, 0.0f, far_m };
    struct ray_hit hit;
    if (!embree_closest(scene->embree, &ray, NULL, false, &hit)) return false;
    const struct trace_mesh *mesh = &scene->meshes[hit.geometry];
    const struct trace_facet *facet = &mesh->facets[hit.triangle];
    const bool back = glms_vec3_dot(facet->normal, direction) > 0.0f;
    uint32_t corner[3];
    trace_corners(mesh, hit.triangle, corner);
    *out = (struct crossing){
        .distance_m = hit.distance,
        .beyond = glms_vec3_muladds(facet->normal, back ? facet->reach : -facet->reach,
                                    trace_point(mesh, corner, hit.u, hit.v)),
        .ends_matter = back && !mesh->material->double_sided,
    };
    return true;
}

struct ray_visibility {
    float empty;    // share of the cone's volume
    float occluded; // opacity towards the sky
};

// Empty segments along a direction. Below the surface the ray starts in matter.
static struct ray_visibility trace_visibility(const struct obscurance_settings *settings,
                                              const struct surface *s, vec3s direction)
{
    bool open = glms_vec3_dot(direction, s->geometric) > 0.0f;
    vec3s from = surface_leave(s, direction);
    struct ray_visibility out = { 0.0f, open ? 0.0f : 1.0f };
    float begin = 0.0f; // in radii
    for (int i = 0; i < MAX_CROSSINGS && begin < 1.0f; i++) {
        struct crossing at;
        const float left_m = (1.0f - begin) * settings->radius_m;
        const bool hit = cross(settings->scene, from, direction, left_m, &at);
        const float end = hit ? begin + at.distance_m / settings->radius_m : 1.0f;
        if (open) out.empty += cube(end) - cube(begin);
        if (!hit) break;
        if (out.occluded == 0.0f)
            out.occluded = 1.0f / (1.0f + settings->decay_per_m * end * settings->radius_m);
        open = at.ends_matter;
        begin = end;
        from = at.beyond;
    }
    return out;
}

void obscurance_add(const struct obscurance_settings *settings, const struct surface *surface,
                    uint32_t pixel, int samples, struct obscurance_sums *sums)
{
    const uint32_t scramble = pcg_hash(pixel ^ settings->seed);
    for (; sums->samples < samples; sums->samples++) {
        const vec2s u = sobol_2d((uint32_t)sums->samples, scramble);
        const vec3s local = sample_hemisphere_uniform(u);
        const struct ray_visibility above =
            trace_visibility(settings, surface, around(surface->normal, local));
        // cos θ/π over the density 1/(2π)
        sums->ambient += 2.0 * (double)local.z * (double)(1.0f - above.occluded);
        sums->volume += (double)above.empty;
        if (!settings->sphere) continue;
        const vec3s down = glms_vec3_negate(around(surface->normal, local));
        sums->volume -= 0.5 * (double)above.empty;
        sums->volume += 0.5 * (double)trace_visibility(settings, surface, down).empty;
    }
}
