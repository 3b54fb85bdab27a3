// A journal: the results of tasks in the order in which they ended, each written to the file at
// once. It holds what came after the checkpoint beside it. A program that is killed loses running
// tasks alone.
#pragma once

#include "bake/bake_state.h"

struct journal {
    int file; // descriptor; -1: none is written
    char *path;
    pthread_mutex_t mutex;
    int why; // errno of the first failed write, after which nothing more is written
};

// The path of the journal of a checkpoint, owned by the caller. NULL: out of memory.
char *journal_path(struct host *host, const char *checkpoint);
// An empty one in place of any other; checkpoint NULL: none is written. Finish it in any case.
bool journal_begin(struct journal *journal, struct bake *bake, const char *checkpoint);
void journal_finish(struct journal *journal, struct host *host);
// A finished task.
struct journal_entry {
    const struct planned_stage *stage;
    size_t index;
    double seconds, run_s; // of the task; of all runs until its end
};
// Appends it; its blocks are out[0…]. Any thread. False: see `why`.
bool journal_add(struct journal *journal, const struct bake *bake,
                 const struct journal_entry *entry, void *const *out);
// Takes the finished tasks of the journal of a checkpoint, an untrusted file, up to the first
// record that is damaged or incomplete. False: out of memory, or it is of another bake.
bool journal_read(struct host *host, struct bake *bake, const char *checkpoint);
