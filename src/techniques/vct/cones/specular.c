#include "techniques/vct/cones/specular.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_state.h"

#include <math.h>

// Directional albedo of frame/brdf.glsl, ∫ D V F cos dω, split into a factor of F0 and a bias
// (Karis 2013). Half-vectors are importance sampled, tan² θ = α² u/(1 − u) for uniform u; the
// integrand is 4 V F (n·l) (v·h)/(n·h).
static void directional_albedo(double n_v, double roughness, float out[2])
{
    enum { STEPS = 32 };
    const double alpha = roughness * roughness, a2 = alpha * alpha;
    const double across = sqrt(1.0 - n_v * n_v);
    double with = 0.0, without = 0.0;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            // φ in 0…π: the integrand is symmetric.
            const double u = (i + 0.5) / STEPS, phi = GLM_PI * (k + 0.5) / STEPS;
            const double n_h = sqrt((1.0 - u) / (1.0 + (a2 - 1.0) * u));
            const double v_h = across * sqrt(1.0 - n_h * n_h) * cos(phi) + n_v * n_h;
            const double n_l = 2.0 * v_h * n_h - n_v;
            if (v_h <= 0.0 || n_l <= 0.0) continue;
            const double smith =
                n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
            const double part = 2.0 * n_l * v_h / (smith * n_h) / (STEPS * STEPS);
            const double fresnel = pow(1.0 - v_h, 5.0);
            with += part * (1.0 - fresnel);
            without += part * fresnel;
        }
    out[0] = (float)with;
    out[1] = (float)without;
}

void vct_fill_environment_brdf(struct vct_environment_brdf_table *out)
{
    // BRDF_MIN_ROUGHNESS; n·v has the same lower bound, since the terms divide by it.
    const double least = 0.045;
    for (int r = 0; r < VCT_BRDF_NODES; r++)
        for (int v = 0; v < VCT_BRDF_NODES; v++)
            directional_albedo(fmax((double)v / (VCT_BRDF_NODES - 1), least),
                               fmax((double)r / (VCT_BRDF_NODES - 1), least),
                               &out->pairs[2 * (r * VCT_BRDF_NODES + v)]);
}

void vct_record_specular(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct vct_options *options = &vct->options;
    const struct vct_specular_params params = {
        .tan_half = tanf(options->aperture * (GLM_PIf / 180.0f)),
        .step_size = options->step_size,
        .offset = options->offset,
        .gain = options->gain,
        .texel_m = 2.0f * vct->clips[vct->clip_count - 1].grid.cell_m,
        .last_mip = vct_volume_mips(options) - 1,
    };
    gpu_scope_begin(cmd, "specular");
    gpu_dispatch(
        cmd, vct->specular,
        GPU_BIND(vct_grid_binding(vct, &vct->clips[0], cmd), view->constants_binding,
                 vct_clipmap_binding(vct, cmd),
                 gpu_transient(cmd, "vct_specular", &params, sizeof params),
                 gpu_transient(cmd, "vct_environment_brdf", &vct->environment_brdf,
                               sizeof vct->environment_brdf),
                 { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                 { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                 { .name = "albedo", .image = view->layers[FRAME_ALBEDO] },
                 { .name = "material", .image = view->layers[FRAME_MATERIAL] },
                 { .name = "light", .image = vct->light, .sampler = vct->linear },
                 { .name = "specular", .image = view->layers[FRAME_SPECULAR] },
                 vct_svo_binding(vct, cmd), { .name = "vct_svo_nodes", .buffer = vct->svo.nodes }),
        NULL, 0, gpu_groups(view->width, VCT_LOCAL_2D), gpu_groups(view->height, VCT_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}
