#include "techniques/radiosity/probes/grid.h"

#include <math.h>

enum { MOST_PROBES = 1 << 18, MOST_ALONG_AXIS = 128 };

static struct box3 bounds_of(const struct charts *charts)
{
    struct box3 box = box3_empty();
    for (uint32_t t = 0; t < charts->triangle_count; t++)
        for (int c = 0; c < 3; c++) box = box3_add_point(box, charts->triangles[t].corner[c]);
    return box;
}

static bool is_within(vec3s size, float spacing, double most)
{
    double product = 1.0;
    for (int a = 0; a < 3; a++) {
        // Not as integers: a small spacing has more cells than they count.
        const double cells = ceil(fmax((double)size.raw[a] / (double)spacing - 1e-3, 1.0));
        if (cells > MOST_ALONG_AXIS) return false;
        product *= cells;
    }
    return product <= most;
}

// The smallest spacing from `least` upwards that has no more probes.
static float spacing_of(vec3s size, float least, double most)
{
    const float longest = glms_vec3_max(size);
    float spacing = fmaxf(least, longest / (2.0f * MOST_ALONG_AXIS));
    while (!is_within(size, spacing, most)) spacing *= 1.02f;
    return spacing;
}

struct frame_probes radiosity_probe_grid(const struct radiosity_map *map,
                                         const struct radiosity_options *options)
{
    const struct box3 box = bounds_of(&map->charts);
    const vec3s size = box3_size(box);
    if (box3_is_empty(box) || !(glms_vec3_max(size) > 0.0f)) return probe_grid_of_one();
    return probe_grid_over(
        box,
        options->probe_spacing > 0.0f
            ? spacing_of(size, options->probe_spacing, MOST_PROBES)
            : spacing_of(size, 0.0f, fmin((double)radiosity_probes_most(options), MOST_PROBES)));
}
