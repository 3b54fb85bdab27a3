// Resuming from a checkpoint.
#include "bake/bake_state.h"
#include "bake/relay_host.h"

#include <string.h>
#include <unistd.h>

// A checkpoint that cannot be used costs time; it is not an error.
static void read_checkpoint(struct bake *bake)
{
    struct relay_host quiet;
    if (access(bake->checkpoint, F_OK) != 0) return;
    relay_host_init(&quiet, bake->host, NULL);
    if (!partial_read(&quiet.host, bake, bake->checkpoint))
        host_log(bake->host, LOG_WARNING, "the checkpoint is ignored: %s", quiet.error);
}

bool bake_resume(struct bake *bake, const char *path)
{
    if (!path || (bake->checkpoint && strcmp(bake->checkpoint, path) == 0)) return true;
    host_free(bake->host, bake->checkpoint);
    bake->checkpoint = host_strdup(bake->host, path);
    if (!bake->checkpoint) return false;
    read_checkpoint(bake);
    return true;
}
