// Ray sets of the gather operators.
//
// Light sources are diffuse surfaces of radiosity B (lm/m²), whose radiance is B / π. Irradiance is
// π/N Σ B/π over N cosine-distributed rays. SH coefficients of radiance use uniform rays, since a
// cosine density would divide by cosθ near the horizon; the clamped cosine then turns them into
// irradiance.
#include "rays.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "core/sh.h"

static void weigh_sh(vec3s direction, float scale, float out[MRT_PROBE_COEFFICIENTS])
{
    float y[MRT_PROBE_COEFFICIENTS];
    sh_eval(3, direction, y);
    for (int i = 0; i < MRT_PROBE_COEFFICIENTS; i++) y[i] *= scale;
    sh_irradiance(3, y, out);
}

// Printed one-based: b6, b7, b8 are yz, 3z²−1, xz.
void mrt_ohlsh_from_sh9(const float sh[MRT_PROBE_COEFFICIENTS], float out[MRT_VECTOR_COEFFICIENTS])
{
    static const float C1 = 1.67705098f, C2 = 0.83852549f, C3 = 1.93649167f; // 3√5/4 3√5/8 √15/2
    out[0] = sh[0] - C1 * sh[6];
    out[1] = sh[1] + C2 * sh[5];
    out[2] = sh[2] + C3 * sh[6];
    out[3] = sh[3] + C2 * sh[7];
}

static void set_ray(struct mrt_rays *rays, enum mrt_measure measure, int i)
{
    vec2s u = sobol_2d((uint32_t)i, 1);
    float *weight = rays->weight + (size_t)i * (size_t)rays->values, count = (float)rays->count;
    float sh[MRT_PROBE_COEFFICIENTS];
    if (measure == MRT_IRRADIANCE) {
        rays->direction[i] = sample_hemisphere_cosine(u);
        weight[0] = 1.0f / count;
    } else if (measure == MRT_VECTOR) {
        rays->direction[i] = sample_hemisphere_uniform(u);
        weigh_sh(rays->direction[i], 2.0f / count, sh); // 2π/N · 1/π
        mrt_ohlsh_from_sh9(sh, weight);
    } else {
        rays->direction[i] = sample_sphere(u);
        weigh_sh(rays->direction[i], 4.0f / count, weight); // 4π/N · 1/π
    }
}

bool mrt_rays_init(struct host *host, enum mrt_measure measure, int count, struct mrt_rays *rays)
{
    static const int values[] = { 1, MRT_VECTOR_COEFFICIENTS, MRT_PROBE_COEFFICIENTS };
    *rays = (struct mrt_rays){ .count = count, .values = values[measure] };
    rays->direction = host_alloc(host, (size_t)count, sizeof *rays->direction);
    rays->weight = host_alloc(host, (size_t)count * (size_t)rays->values, sizeof *rays->weight);
    if (!rays->direction || !rays->weight) {
        mrt_rays_finish(host, rays);
        return false;
    }
    for (int i = 0; i < count; i++) set_ray(rays, measure, i);
    return true;
}

void mrt_rays_finish(struct host *host, struct mrt_rays *rays)
{
    host_free(host, rays->direction);
    host_free(host, rays->weight);
    *rays = (struct mrt_rays){ 0 };
}
