// Ranks of a team as threads of the test, each with a host and a sample of its own. Messages are
// copied through memory.
#pragma once

#include "bake/bake_sample.h"

enum { TEAM_MOST = 5, TEAM_TEXT = 1024 };

// The events of a run, set before it.
struct team_plan {
    int ranks;
    struct bake_sample sample;     // of each rank
    const char *checkpoint, *path; // of rank 0; path NULL: not saved
    int threads;                   // of each rank; 0: 1
    uint64_t other_seed_of;        // this rank has another seed; 0: none
    int lost_rank, lost_after;     // the rank is lost after this number of results; rank 0: none
    int quitting_rank;             // is asked to stop after its first task; -1: none
    int failing_rank;              // its first task fails; -1: none
};
struct team_plan team_plan_default(int ranks);

struct team_result {
    bool ok[TEAM_MOST], complete;
    int runs[TEAM_MOST]; // tasks
    enum fail_kind failure[TEAM_MOST];
    char error[TEAM_MOST][TEAM_TEXT];   // the last
    char warning[TEAM_MOST][TEAM_TEXT]; // the last
};
void team_run(const struct team_plan *plan, struct team_result *out);
