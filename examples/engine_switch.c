#include "engine_switch.h"

#include <string.h>

static void *prepare(void *user)
{
    struct engine_switch *s = (struct engine_switch *)user;
    struct ag_context *context = NULL; // of this thread
    enum ag_result result = ag_context_create(NULL, &context);
    if (result == AG_OK) result = ag_preparation_run(s->preparation, context, NULL, NULL);
    ag_context_destroy(context);
    pthread_mutex_lock(&s->mutex);
    s->result = result;
    s->done = true;
    pthread_mutex_unlock(&s->mutex);
    return NULL;
}

enum ag_result engine_switch_begin(struct engine_switch *s, struct ag_renderer *renderer,
                                   const char *gi)
{
    memset(s, 0, sizeof *s);
    const enum ag_result result = ag_preparation_create(renderer, gi, &s->preparation);
    if (result != AG_OK) return result;
    pthread_mutex_init(&s->mutex, NULL);
    if (pthread_create(&s->thread, NULL, prepare, s) == 0) return AG_OK;
    pthread_mutex_destroy(&s->mutex);
    ag_preparation_destroy(s->preparation);
    return AG_ERROR_MEMORY;
}

bool engine_switch_ready(struct engine_switch *s)
{
    pthread_mutex_lock(&s->mutex);
    const bool done = s->done;
    pthread_mutex_unlock(&s->mutex);
    return done;
}

enum ag_result engine_switch_end(struct engine_switch *s)
{
    pthread_join(s->thread, NULL);
    pthread_mutex_destroy(&s->mutex);
    ag_preparation_destroy(s->preparation);
    return s->result;
}
