#include "waiting.h"
#include "messages.h"

#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <time.h>

// Before a later frame there is a line of progress, with the remaining time.
enum { FIRST_S = 5, LATER_S = 20, EVERY_S = 10 };

static struct {
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t ended;
    bool running, stop; // running: the thread exists
    int frame, frames;
} state = { .mutex = PTHREAD_MUTEX_INITIALIZER, .ended = PTHREAD_COND_INITIALIZER };

static void *say(void *unused)
{
    struct timespec next;
    clock_gettime(CLOCK_REALTIME, &next);
    int passed_s = state.frame == 0 ? FIRST_S : LATER_S;
    next.tv_sec += passed_s;
    pthread_mutex_lock(&state.mutex);
    while (!state.stop) {
        if (pthread_cond_timedwait(&state.ended, &state.mutex, &next) == 0) continue;
        note("rendering frame %d of %d: %d s so far", state.frame + 1, state.frames, passed_s);
        next.tv_sec += EVERY_S;
        passed_s += EVERY_S;
    }
    pthread_mutex_unlock(&state.mutex);
    return unused;
}

// The thread takes no signals: they are for the one that writes files.
void waiting_begin(int frame, int frames)
{
    sigset_t all, kept;
    state.frame = frame;
    state.frames = frames;
    state.stop = false;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &kept);
    state.running = pthread_create(&state.thread, NULL, say, NULL) == 0;
    pthread_sigmask(SIG_SETMASK, &kept, NULL);
}

void waiting_end(void)
{
    if (!state.running) return;
    pthread_mutex_lock(&state.mutex);
    state.stop = true;
    pthread_cond_signal(&state.ended);
    pthread_mutex_unlock(&state.mutex);
    pthread_join(state.thread, NULL);
    state.running = false;
}
