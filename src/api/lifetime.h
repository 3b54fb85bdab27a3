// Lifetimes of objects that others use: a program destroys objects in any order. One that is still
// used stays until its last user goes.
#pragma once

#include <stdbool.h>

struct lifetime {
    int users;      // objects
    bool destroyed; // by the program
};

static inline void lifetime_use(struct lifetime *life)
{
    life->users++;
}

// A user has gone. True: nobody needs the object any more, the caller frees it.
static inline bool lifetime_release(struct lifetime *life)
{
    return --life->users == 0 && life->destroyed;
}

// For the public function that destroys the object; a second call has no effect. True: as above.
static inline bool lifetime_destroy(struct lifetime *life)
{
    const bool first = !life->destroyed;
    life->destroyed = true;
    return first && life->users == 0;
}
