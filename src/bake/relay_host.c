// Hosts for tasks and attempts.
#include "bake/relay_host.h"

#include <stdio.h>

static void relay_message(void *user, enum log_level level, const char *text)
{
    struct relay_host *relay = user;
    if (level == LOG_ERROR)
        snprintf(relay->error, sizeof relay->error, "%s", text);
    else if (relay->message)
        relay->message(relay->user, level, text);
}

static void *relay_memory(void *user, void *old, size_t bytes)
{
    struct relay_host *relay = user;
    if (relay->memory) pthread_mutex_lock(relay->memory);
    void *block = relay->to->reallocate(relay->to->user, old, bytes);
    if (relay->memory) pthread_mutex_unlock(relay->memory);
    return block;
}

void relay_host_init(struct relay_host *relay, struct host *to, pthread_mutex_t *memory)
{
    *relay = (struct relay_host){ .to = to, .memory = memory };
    relay->host = (struct host){ .log = relay_message,
                                 .reallocate = to->reallocate ? relay_memory : NULL,
                                 .user = relay,
                                 .log_up_to = to->log_up_to };
}
