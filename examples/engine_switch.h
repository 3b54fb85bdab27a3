// Another thread compiles what a GI spec needs, while the engine's frames go on.
#ifndef ENGINE_SWITCH_H
#define ENGINE_SWITCH_H

#include <afterglow/preparation.h>

#include <pthread.h>

struct engine_switch {
    struct ag_preparation *preparation;
    pthread_t thread;
    pthread_mutex_t mutex;
    bool done; // under the mutex
    enum ag_result result;
};
// After at least one frame.
enum ag_result engine_switch_begin(struct engine_switch *s, struct ag_renderer *renderer,
                                   const char *gi);
bool engine_switch_ready(struct engine_switch *s); // does not wait
// When it is ready: hands what was compiled to the device. The renderer then takes the GI spec
// without a compiler.
enum ag_result engine_switch_end(struct engine_switch *s);

#endif
