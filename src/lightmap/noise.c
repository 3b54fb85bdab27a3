#include "lightmap/noise.h"

#include <math.h>
#include <stdlib.h>

// The noise of a unit of four tiles is known within some 13 %: it has 28 degrees of freedom.
enum { ENOUGH_TEXELS = 32, ENOUGH_TILES = 4 };

// ---- units

static bool is_small(uint32_t texels, uint32_t tiles)
{
    return texels < ENOUGH_TEXELS || tiles < ENOUGH_TILES;
}

// Blocks that `count` texels from `first` on touch.
static uint32_t tiles_of(uint32_t first, uint32_t count)
{
    return (first + count - 1) / NOISE_TILE - first / NOISE_TILE + 1;
}

// Appends the side of a chart that begins at texel `first`. last_chart: of the last unit.
static void append(struct noise_units *units, const struct charts *charts, uint32_t chart,
                   uint32_t first, uint32_t *last_chart)
{
    const struct chart *next = &charts->charts[chart];
    const uint32_t count = next->texel_count, tiles = tiles_of(first, count);
    struct noise_unit *last = units->count > 0 ? &units->at[units->count - 1] : NULL;
    if (last && *last_chart != CHART_NONE && is_small(last->count, last->tiles) &&
        is_small(count, tiles) && charts->charts[*last_chart].instance == next->instance) {
        last->count += count;
        last->tiles += tiles;
    } else {
        units->at[units->count++] = (struct noise_unit){ first, count, tiles };
    }
    *last_chart = chart;
}

bool noise_units_init(struct noise_units *out, const struct charts *charts)
{
    *out = (struct noise_units){ 0 };
    out->at = host_alloc(charts->host, 2 * (size_t)charts->count + 1, sizeof *out->at);
    if (!out->at) return false;
    for (int back = 0; back < 2; back++) {
        uint32_t last = CHART_NONE;
        for (uint32_t c = 0; c < charts->count; c++) {
            const struct chart *chart = &charts->charts[c];
            const uint32_t first = back ? chart->first_back : chart->first_texel;
            if (chart->texel_count > 0 && first != CHART_NONE) append(out, charts, c, first, &last);
        }
    }
    return true;
}

void noise_units_finish(struct noise_units *units, struct host *host)
{
    if (units->at) host_free(host, units->at);
    *units = (struct noise_units){ 0 };
}

uint32_t noise_unit_of(const struct noise_units *units, uint32_t texel)
{
    uint32_t low = 0, high = units->count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (units->at[middle].first <= texel)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// ---- estimates

static double mean_of(const struct noise_sums *sums)
{
    double sum = 0.0;
    for (int g = 0; g < NOISE_GROUPS; g++) sum += (double)sums->group[g];
    return sum / (double)sums->paths;
}

double noise_variance(const struct noise_sums *sums)
{
    const double mean = mean_of(sums), paths = (double)sums->paths / NOISE_GROUPS;
    double squares = 0.0;
    for (int g = 0; g < NOISE_GROUPS; g++) {
        const double difference = (double)sums->group[g] / paths - mean;
        squares += difference * difference;
    }
    return squares / (NOISE_GROUPS * (NOISE_GROUPS - 1));
}

struct noise_state noise_of(const struct noise_unit *unit, const struct noise_sums *sums,
                            float least)
{
    struct noise_state state = { 0 };
    double variance = 0.0, light = 0.0;
    uint32_t count = 0;
    for (uint32_t i = unit->first; i < unit->first + unit->count; i++) {
        if (!(sums[i].paths > 0.0f)) continue;
        variance += noise_variance(&sums[i]);
        light += mean_of(&sums[i]);
        state.paths = sums[i].paths;
        count++;
    }
    if (count == 0 || !(variance > 0.0)) return state;
    state.noise = (float)(sqrt(variance / count) / fmax(light / count, (double)least));
    return state;
}

static int compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

float noise_typical(const struct noise_units *units, const struct noise_sums *sums, float least,
                    float *scratch)
{
    size_t count = 0;
    for (uint32_t u = 0; u < units->count; u++) {
        const struct noise_state state = noise_of(&units->at[u], sums, least);
        if (state.noise > 0.0f) scratch[count++] = state.noise * state.noise * state.paths;
    }
    if (count == 0) return 0.0f;
    qsort(scratch, count, sizeof *scratch, compare);
    return scratch[count / 2];
}

struct noise_state noise_with_prior(const struct noise_unit *unit, struct noise_state state,
                                    float typical)
{
    const float freedom = (float)((NOISE_GROUPS - 1) * unit->tiles);
    if (!(state.paths > 0.0f)) return state;
    const float variance = freedom * state.noise * state.noise + typical / state.paths;
    state.noise = sqrtf(variance / (freedom + 1.0f));
    return state;
}

float noise_mean_light(const struct noise_units *units, const struct noise_sums *sums)
{
    double light = 0.0;
    uint64_t count = 0;
    for (uint32_t u = 0; u < units->count; u++)
        for (uint32_t k = 0; k < units->at[u].count; k++) {
            const struct noise_sums *texel = &sums[units->at[u].first + k];
            if (!(texel->paths > 0.0f)) continue;
            light += mean_of(texel);
            count++;
        }
    return count > 0 ? (float)(light / (double)count) : 0.0f;
}

uint32_t noise_paths_for(struct noise_state state, float bound, uint32_t most)
{
    const double ratio = (double)state.noise / (double)bound;
    const double paths = (double)state.paths * fmax(ratio * ratio, 1.0);
    const double groups = fmin(ceil(paths / NOISE_GROUPS), floor((double)most / NOISE_GROUPS));
    return (uint32_t)fmax(groups * NOISE_GROUPS, (double)state.paths);
}
