// Messages between the ranks of a team: a head and bytes. All are between rank 0 and another one.
#pragma once

#include "bake/bake.h"

enum message_kind {
    // To rank 0.
    MESSAGE_HELLO,  // takes part; count: threads; bytes: its identity
    MESSAGE_READY,  // is prepared
    MESSAGE_RESULT, // of a task, its seconds; bytes: its blocks, one after the other
    MESSAGE_WANT,   // the part of a tensor from the byte `count` on: of stage, output `task`
    MESSAGE_LOG,    // count: the level; bytes: text
    MESSAGE_FAIL,   // count: the kind of failure; bytes: text
    MESSAGE_QUIT,   // was asked to stop
    MESSAGE_BYE,    // has ended; count: its peak memory in bytes; seconds: of its tasks
    // From rank 0.
    MESSAGE_START, // prepare
    MESSAGE_TASK,  // run this task
    MESSAGE_PART,  // of a tensor, as in MESSAGE_WANT; size: of the tensor, 0: there is none
    MESSAGE_STOP,  // end; count: why (enum stop); bytes: text
};
enum stop { STOP_DONE, STOP_CANCELLED, STOP_REFUSED };

struct message {
    uint32_t kind, stage;
    uint64_t task, count, size;
    double seconds;
};
enum { MESSAGE_PART_BYTES = 4 << 20 }; // of a tensor at a time

// False: out of memory, or the other process has ended.
bool message_send(struct host *host, const struct bake_team *team, int to,
                  const struct message *message, const void *bytes, size_t size);
bool message_send_text(struct host *host, const struct bake_team *team, int to,
                       enum message_kind kind, uint64_t count, const char *text);
// False: it is shorter than a head.
bool message_parse(const void *data, size_t size, struct message *out, const char **bytes,
                   size_t *byte_count);
