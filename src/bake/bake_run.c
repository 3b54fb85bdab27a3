// A run from the outside: the memory it may take, the checkpoint it resumes, the tasks.
#include "bake/bake_state.h"

#include <math.h>
#include <stdio.h>

// Texels, and with them the memory that grows with the density, are as its square; a part of it is
// kept free for texels that small parts of the surface have at any density.
static const double SHARE = 0.9;

static float fitting_density(const struct bake *bake, uint64_t needed, uint64_t limit)
{
    const uint64_t fixed = bake->plan.job.bytes;
    if (limit <= fixed || needed <= fixed) return 0.0f;
    const double ratio = (double)(limit - fixed) / (double)(needed - fixed);
    return (float)(SHARE * sqrt(ratio) * (double)bake->plan.light_map.texels_per_m);
}

static void print_advice(const struct bake *bake, uint64_t needed, uint64_t limit,
                         char out[BAKE_TEXT])
{
    const float density = fitting_density(bake, needed, limit);
    if (density > 0.0f)
        snprintf(out, BAKE_TEXT, "density=%.3g fits", (double)density);
    else
        snprintf(out, BAKE_TEXT, "choose smaller options or fewer threads");
}

static bool check_memory(const struct bake *bake, const struct bake_run_options *options)
{
    static const double MIB = 1024.0 * 1024.0;
    const uint64_t needed = estimate_peak_memory(bake, options->threads);
    if (options->max_memory_bytes == 0 || needed <= options->max_memory_bytes) return true;
    char advice[BAKE_TEXT];
    print_advice(bake, needed, options->max_memory_bytes, advice);
    return host_fail(bake->host, FAIL_MEMORY,
                     "cannot bake %s: it needs about %.0f MiB, more than the limit of %.0f MiB; %s",
                     bake->identity.technique, (double)needed / MIB,
                     (double)options->max_memory_bytes / MIB, advice);
}

bool bake_run(struct bake *bake, const struct bake_run_options *options)
{
    if (bake_is_complete(bake)) return true;
    if (!check_memory(bake, options) || !bake_resume(bake, options->checkpoint)) return false;
    return bake_is_complete(bake) || run_bake(bake, options, false);
}
