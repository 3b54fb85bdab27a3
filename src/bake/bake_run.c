// A run from the outside: the memory it may take, the checkpoint it resumes, the tasks.
#include "bake/bake_state.h"

static bool check_memory(const struct bake *bake, const struct bake_run_options *options)
{
    static const double MIB = 1024.0 * 1024.0;
    const uint64_t needed = estimate_peak_memory(bake, options->threads);
    if (options->max_memory_bytes == 0 || needed <= options->max_memory_bytes) return true;
    return host_fail(bake->host, FAIL_MEMORY,
                     "cannot bake %s: it needs about %.0f MiB, more than the limit of %.0f MiB; "
                     "choose smaller options or fewer threads",
                     bake->identity.technique, (double)needed / MIB,
                     (double)options->max_memory_bytes / MIB);
}

bool bake_run(struct bake *bake, const struct bake_run_options *options)
{
    if (bake_is_complete(bake)) return true;
    if (!check_memory(bake, options) || !bake_resume(bake, options->checkpoint)) return false;
    return bake_is_complete(bake) || run_bake(bake, options, false);
}
