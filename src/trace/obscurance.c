// Volumetric obscurance and ambient occlusion at a point, by rays.
//
// Volumetric obscurance (Loos 2015, sec. 6.3) is V = ∫ρ(x) O(x) dx over ∫ρ(x) dx, with ρ constant
// in a sphere of radius R and O zero where there is matter, one elsewhere. Along a direction ω from
// the middle, what lies from a to b has the share (b³ − a³)/R³ of a cone's volume, so that
//     V = 1/Ω ∫ Σ (b³ − a³)/R³ dω over the open stretches of each ray,
// with Ω = 4π for the sphere, or 2π for its hemisphere above the shading normal. Half of a sphere
// on a plane is open, and all of the hemisphere. Matter begins at fronts and ends at backs. A
// double-sided surface has no inside: what lies behind it, within the sphere, counts as matter,
// since that is what a depth buffer shows of it.
//
// Ambient occlusion is 1/π ∫ cos θ dω over the directions above the shading normal in which nothing
// is met up to R. With a decay γ (1/m) what is met at the distance r hides 1/(1 + γ r) of what is
// behind it (Hong 2015, sec. 2.5.3.3.8), so that it is 1/π ∫ cos θ (1 − 1/(1 + γ r)) dω over those
// in which something is met, besides.
#include "trace/obscurance.h"

#include "core/rng.h"
#include "core/sampling.h"

enum { MOST_CROSSINGS = 64 };

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

// What a direction meets: where it goes on behind that, and whether matter ends there.
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

struct stretch {
    float open;   // share of the cone's volume
    float hidden; // share of what lies beyond the radius
};

// What is open along a direction. What is open on one side of the surface is matter on the other.
static struct stretch open_along(const struct obscurance_rules *rules, const struct surface *s,
                                 vec3s direction)
{
    bool open = glms_vec3_dot(direction, s->geometric) > 0.0f;
    vec3s from = surface_leave(s, direction);
    struct stretch out = { 0.0f, open ? 0.0f : 1.0f };
    float begun = 0.0f; // in radii
    for (int i = 0; i < MOST_CROSSINGS && begun < 1.0f; i++) {
        struct crossing at;
        const float left_m = (1.0f - begun) * rules->radius_m;
        const bool met = cross(rules->scene, from, direction, left_m, &at);
        const float end = met ? begun + at.distance_m / rules->radius_m : 1.0f;
        if (open) out.open += cube(end) - cube(begun);
        if (!met) break;
        if (out.hidden == 0.0f)
            out.hidden = 1.0f / (1.0f + rules->decay_per_m * end * rules->radius_m);
        open = at.ends_matter;
        begun = end;
        from = at.beyond;
    }
    return out;
}

void obscurance_add(const struct obscurance_rules *rules, const struct surface *surface,
                    uint32_t pixel, int samples, struct obscurance_sums *sums)
{
    const uint32_t scramble = pcg_hash(pixel ^ rules->seed);
    for (; sums->samples < samples; sums->samples++) {
        const vec2s u = sobol_2d((uint32_t)sums->samples, scramble);
        const vec3s local = sample_hemisphere_uniform(u);
        const struct stretch above = open_along(rules, surface, around(surface->normal, local));
        // cos θ/π over the density 1/(2π)
        sums->ambient += 2.0 * (double)local.z * (double)(1.0f - above.hidden);
        sums->volume += (double)above.open;
        if (!rules->sphere) continue;
        const vec3s down = glms_vec3_negate(around(surface->normal, local));
        sums->volume -= 0.5 * (double)above.open;
        sums->volume += 0.5 * (double)open_along(rules, surface, down).open;
    }
}
