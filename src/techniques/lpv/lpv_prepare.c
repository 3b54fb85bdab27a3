// Placement of the grids and the parameters of a frame.
#include "techniques/lpv/lpv_prepare.h"

#include "techniques/lpv/lpv_frame.h"

#include <math.h>

// Band 1 of a clamped cosine: without geometry no wall occludes the light behind its surface.
static const float LAMBERT_1 = 2.0f / 3.0f;

// See apply.comp.
static float mean_path_of(const struct lpv_options *options)
{
    return lpv_closure_of(options) == LPV_PRODUCT_CLOSURE
               ? 1.0f
               : (float)lpv_mean_path((enum lpv_scheme)options->neighbours);
}

static struct lpv_crossing crossing_of(const struct lpv_options *options)
{
    switch (lpv_closure_of(options)) {
    case LPV_BEAM_CLOSURE:
        return lpv_closed_crossing();
    case LPV_PRODUCT_CLOSURE:
        return lpv_product_crossing();
    default:
        return lpv_crossing_of((enum lpv_scheme)options->neighbours);
    }
}

// Flux of a cell that the sky's radiance L reaches from all directions: 4π I with
// L = I (w a) / a³ (apply.comp).
static vec3s sky_flux(const struct lpv_options *options, const struct lpv_grid *grid,
                      const struct frame_view *view)
{
    const float mean_path = mean_path_of(options);
    const float cell_m = grid->cell_m;
    if (!options->sky) return vec3_of(0, 0, 0);
    return glms_vec3_scale(view->constants->sky, 4.0f * GLM_PIf * cell_m * cell_m / mean_path);
}

// Coefficients of the intensity of such a cell. Light travels away from where it comes from:
// coefficients of odd bands change their sign.
static void set_sky(const struct lpv_options *options, struct lpv_cascade *cascade,
                    const struct frame_view *view, float grid_from_flux)
{
    const int count = options->bands == 3 ? 9 : 4;
    const float cell_m = cascade->grid.cell_m;
    const float intensity = grid_from_flux * cell_m * cell_m / mean_path_of(options);
    for (int i = 0; options->sky && i < count; i++)
        cascade->params.sky[i] = glms_vec3_scale(view->constants->environment_sh[i],
                                                 i >= 1 && i <= 3 ? -intensity : intensity);
}

static struct lpv_lights lights_of(const struct lpv_options *options, const struct frame_view *view)
{
    return (struct lpv_lights){
        .faces = view->rsm_faces,
        .face_count = view->rsm_face_count,
        .rsm_size = view->rsm_size,
        .emitters = view->emitters,
        .emitter_count = options->emitters ? view->emitter_count : 0,
        .bounces = options->bounces,
    };
}

// With the positive closure the option is that of light which has crossed 1/16 of the scene, so
// that the size of cells does not matter.
static double focus_of_step(const struct lpv_options *options, const struct lpv_grid *grid,
                            const struct frame_view *view)
{
    if (lpv_closure_of(options) == LPV_NO_CLOSURE) return (double)options->focus;
    const vec3s size = box3_size(view->bounds);
    const float longest = fmaxf(size.x, fmaxf(size.y, size.z));
    return pow((double)options->focus, (double)(16.0f * grid->cell_m / longest));
}

static struct lpv_params params_of(const struct lpv_options *options,
                                   const struct lpv_cascade *cascade, const struct frame_view *view,
                                   const struct lpv_scale *scale)
{
    const struct lpv_grid *grid = &cascade->grid;
    const struct lpv_cascade *coarser = cascade->coarser;
    const double focus = focus_of_step(options, grid, view);
    const enum lpv_scheme scheme = (enum lpv_scheme)options->neighbours;
    const struct lpv_step step =
        lpv_step_of(scheme, (enum lpv_lobe)options->lobe, focus, (double)options->filter);
    const struct lpv_crossing crossing = crossing_of(options);
    const struct lpv_lobe_weights lobe =
        lpv_closure_of(options) == LPV_PRODUCT_CLOSURE ? lpv_product_lobe(focus) : step.lobe;
    const float mean_path = mean_path_of(options);
    return (struct lpv_params){
        .origin_m = grid->origin_m,
        .cell_m = grid->cell_m,
        .cells_x = grid->cells[0],
        .cells_y = grid->cells[1],
        .cells_z = grid->cells[2],
        .dim = options->dim,
        .far_face = step.far_face,
        .side_face = step.side_face,
        .corner_face = step.corner_face,
        .lobe_along = (float)lobe.along,
        .lobe_square = (float)lobe.square,
        .lobe_product = (float)lobe.product,
        .fixed_from_flux = scale->fixed_from_flux,
        .grid_from_fixed = scale->grid_from_flux / scale->fixed_from_flux,
        .irradiance_scale =
            options->gain * mean_path / (grid->cell_m * grid->cell_m * scale->grid_from_flux),
        .mean_path = mean_path,
        .offset_m = options->offset * grid->cell_m,
        .bounce_offset = options->offset * (coarser ? coarser->grid.cell_m / grid->cell_m : 1.0f),
        .window_1 = options->window * (float)crossing.band_1,
        .window_2 = options->window * (float)crossing.band_2,
        .staircase = scheme == LPV_SIX && lpv_closure_of(options) == LPV_NO_CLOSURE &&
                             options->geometry != LPV_GEOMETRY_OFF
                         ? 1.0f
                         : 0.0f,
        .injected_1 =
            options->geometry == LPV_GEOMETRY_OFF ? LAMBERT_1 : (float)crossing.injected_1,
        .occlusion = options->occlusion,
        .damping = options->damping,
        .rsm_size = view->rsm_size,
        .width = view->width,
        .height = view->height,
        .emitter_count = (uint32_t)lights_of(options, view).emitter_count,
        .boundary = coarser ? grid->open : 0,
    };
}

bool lpv_prepare(const struct lpv_options *options, struct lpv_cascade *finest,
                 const struct frame_view *view)
{
    struct lpv_lights lights = lights_of(options, view);
    struct lpv_scale scale;
    if (!lpv_cascades_place(options, finest, view)) return false;
    const struct lpv_cascade *coarsest = finest;
    while (coarsest->coarser) coarsest = coarsest->coarser;
    lights.sky_flux = sky_flux(options, &coarsest->grid, view);
    if (!lpv_scale_of(&lights, &scale)) return false;
    for (struct lpv_cascade *c = finest; c; c = c->coarser) {
        c->params = params_of(options, c, view, &scale);
        set_sky(options, c, view, scale.grid_from_flux);
    }
    return true;
}
