// Charts of about a wanted number of texels, or of a density.
#include "scene/charts/charts.h"

// Charts of a surface in many small parts touch several times as many texels as its area has. The
// atlas has room for the gutters of those.
enum { DENSITY_TRIES = 5, ATLAS_ROOM = 64, MOST_ATLAS = 1 << 28 };

// Changes the options so that the next charts may have fewer texels. False: no option can.
static bool want_fewer(struct charts_options *how, uint32_t texels, const struct charts *charts)
{
    // Each small part of a surface has a texel at any density: the others keep a quarter of them.
    const uint32_t least = texels / 4;
    if (charts->side_texel_count <= texels + texels / 8) return false;
    if (how->surface_texels > least) {
        const double surface = (double)how->surface_texels * texels / charts->side_texel_count;
        how->surface_texels = surface > least ? (uint32_t)surface : least;
        return true;
    }
    if (how->join == CHARTS_JOINED_ACROSS) return false;
    how->join = CHARTS_JOINED_ACROSS;
    return true;
}

// Limit of the surface's texels where the density is given.
enum { MOST_TEXELS = 1 << 22 };

static bool init_at_density(struct charts *out, struct host *host, const struct scene_pose *pose,
                            const struct charts_wish *wish)
{
    const struct charts_options how = { .texels_per_m = wish->density,
                                        .max_texels = MOST_ATLAS,
                                        .surface_texels = MOST_TEXELS,
                                        .join = CHARTS_JOINED,
                                        .coordinates = wish->coordinates };
    if (!charts_init(out, host, pose, &how)) return false;
    const float reached = out->texels_per_m;
    if (out->count == 0 || reached > 0.999f * wish->density) return true;
    return host_fail(host, FAIL_MEMORY,
                     "%s: density=%g needs more than %d texels for %s; density=%.3g fits",
                     wish->technique, (double)wish->density, MOST_TEXELS, pose->scene->name,
                     0.99 * (double)reached);
}

bool charts_init_wanted(struct charts *out, struct host *host, const struct scene_pose *pose,
                        const struct charts_wish *wish)
{
    const uint32_t texels = wish->texels;
    struct charts_options how = {
        .texels_per_m = wish->most_density > 0.0f ? wish->most_density : 1e6f,
        .max_texels = texels < MOST_ATLAS / ATLAS_ROOM ? texels * ATLAS_ROOM : MOST_ATLAS,
        .surface_texels = texels,
        .join = CHARTS_JOINED,
        .coordinates = wish->coordinates,
        .atlas_per_texel = ATLAS_ROOM,
        .most_texels = MOST_TEXELS,
        .most_charts = wish->most_charts
    };
    if (wish->density > 0.0f) return init_at_density(out, host, pose, wish);
    if (wish->begin && wish->begin->surface_texels > 0 && wish->begin->surface_texels <= texels) {
        how.surface_texels = wish->begin->surface_texels;
        if (wish->begin->across) how.join = CHARTS_JOINED_ACROSS;
    }
    for (int i = 0; i < DENSITY_TRIES; i++) {
        if (!charts_init(out, host, pose, &how)) return false;
        out->search =
            (struct charts_search){ how.surface_texels, how.join == CHARTS_JOINED_ACROSS };
        if (!want_fewer(&how, texels, out)) return true;
        if (i + 1 < DENSITY_TRIES) charts_finish(out);
    }
    return true;
}
