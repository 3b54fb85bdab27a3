// The program without its main, which afterglow and afterglow-mpi share.
#pragma once

#include "cli/bake/team.h"
#include "cli/terminal/messages.h"

// Before anything else. term_interrupts: SIGTERM does as SIGINT, which keeps what is finished.
void program_begin(bool term_interrupts);
// team: the processes that run the command together; NULL: this one alone.
enum status program_run(int count, char **words, const struct team *team);
