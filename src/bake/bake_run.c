// A run from the outside: the memory it may take, the checkpoint it resumes, the tasks.
#include "bake/bake_state.h"
#include "bake/relay_host.h"

#include <unistd.h>

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

static bool remember_checkpoint(struct bake *bake, const char *path)
{
    host_free(bake->host, bake->checkpoint);
    bake->checkpoint = path ? host_strdup(bake->host, path) : NULL;
    return !path || bake->checkpoint;
}

// A checkpoint that cannot be used costs time, and is no error.
static void resume(struct bake *bake, const char *path)
{
    struct relay_host quiet;
    if (!path || access(path, F_OK) != 0) return;
    relay_host_init(&quiet, bake->host, NULL);
    if (!partial_read(&quiet.host, bake, path))
        host_log(bake->host, LOG_WARNING, "the checkpoint is ignored: %s", quiet.error);
}

bool bake_run(struct bake *bake, const struct bake_run_options *options)
{
    if (bake_is_complete(bake)) return true;
    if (!check_memory(bake, options) || !remember_checkpoint(bake, options->checkpoint))
        return false;
    resume(bake, options->checkpoint);
    return bake_is_complete(bake) || run_bake(bake, options, false);
}
