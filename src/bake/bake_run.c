// A run from the outside: the memory it may take, the checkpoint it resumes, the tasks.
#include "bake/bake_state.h"
#include "bake/follow.h"
#include "bake/lead.h"

#include "core/c_locale.h"

#include <stdio.h>

static void print_advice(const struct bake *bake, uint64_t needed,
                         const struct bake_run_options *options, char out[BAKE_TEXT])
{
    const double density =
        advised_density(bake, needed, options->max_memory_bytes, options->threads);
    if (density > 0.0)
        c_locale_print(out, BAKE_TEXT, "density=%.3g fits", density);
    else
        snprintf(out, BAKE_TEXT, "choose smaller options or fewer threads");
}

static bool check_memory(const struct bake *bake, const struct bake_run_options *options)
{
    static const double MIB = 1024.0 * 1024.0;
    const uint64_t needed = estimate_peak_memory(bake, options->threads);
    if (options->max_memory_bytes == 0 || needed <= options->max_memory_bytes) return true;
    char advice[BAKE_TEXT];
    print_advice(bake, needed, options, advice);
    return host_fail(bake->host, FAIL_MEMORY,
                     "cannot bake %s: it needs about %.0f MiB, more than the limit of %.0f MiB; %s",
                     bake->identity.technique, (double)needed / MIB,
                     (double)options->max_memory_bytes / MIB, advice);
}

// A merged part that was forgotten would be run again by each shard.
static bool check_shard(const struct bake *bake, const struct bake_run_options *options)
{
    const struct merged *merged = &bake->merged;
    const char *technique = bake->identity.technique;
    if (options->shard_count <= 0 || !merged->some) return true;
    if (merged->missing > 0)
        return host_fail(bake->host, FAIL_ARGUMENT,
                         "cannot bake part %d of %d of %s: %zu of %zu tasks are in none of the "
                         "merged files; merge all parts",
                         options->shard, options->shard_count, technique, merged->missing,
                         merged->expected);
    if (split_wave(bake) < bake->plan.waves) return true;
    return host_fail(bake->host, FAIL_ARGUMENT,
                     "cannot bake part %d of %d of %s: the work that is left is not worth "
                     "splitting; finish it without a shard",
                     options->shard, options->shard_count, technique);
}

static bool run_led(struct bake *bake, const struct bake_run_options *options)
{
    struct lead *lead = lead_create(bake, options);
    if (!lead) return false;
    const bool ok = bake_is_complete(bake) ? lead_dismiss(lead) : run_bake_led(bake, options, lead);
    lead_destroy(lead);
    return ok;
}

static bool check_team(const struct bake *bake, const struct bake_run_options *options)
{
    return !options->team || options->shard_count <= 0 ||
           host_fail(bake->host, FAIL_ARGUMENT,
                     "cannot bake part %d of %d of %s with other ranks: choose one way to split it",
                     options->shard, options->shard_count, bake->identity.technique);
}

// Before any task runs.
static bool begin(struct bake *bake, const struct bake_run_options *options)
{
    const struct merged *merged = &bake->merged;
    if (bake_is_complete(bake)) return true;
    if (merged->missing > 0)
        host_log(bake->host, LOG_WARNING,
                 "a part is missing: %zu of %zu tasks are in none of the merged files and run now",
                 merged->missing, merged->expected);
    return check_memory(bake, options) && bake_resume(bake, options->checkpoint);
}

bool bake_run(struct bake *bake, const struct bake_run_options *options)
{
    const struct bake_team *team = options->team;
    if (!check_team(bake, options) || !check_shard(bake, options)) return false;
    if (team && team->rank > 0) return follow_run(bake, options);
    if (!begin(bake, options)) return false;
    if (team) return run_led(bake, options);
    return bake_is_complete(bake) || run_bake(bake, options, false);
}
