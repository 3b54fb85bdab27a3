// A host whose messages do not reach the program's log at once: for tasks on other threads, and for
// attempts whose failure is not an error. Memory comes from the program's host.
#pragma once

#include "core/host.h"

#include <pthread.h>

enum { RELAY_MESSAGE = 1024 };

struct relay_host {
    struct host host; // pass it on
    struct host *to;
    pthread_mutex_t *memory;   // guards the allocator of `to`; NULL: the calling thread's
    char error[RELAY_MESSAGE]; // the last error, "" if none
    // Gets other messages; NULL drops them.
    void (*message)(void *user, enum log_level level, const char *text);
    void *user;
};

// The struct must not move afterwards.
void relay_host_init(struct relay_host *relay, struct host *to, pthread_mutex_t *memory);
