// Signals that end the program, never during a write.
#pragma once

#include <stdbool.h>

// Call at the start of main, before any other thread exists. SIGINT, SIGUSR1, SIGTERM and SIGHUP
// then end the program, except between interrupt_hold and interrupt_release. Signals ignored by the
// parent stay ignored. term_is_recorded: SIGTERM is as SIGINT.
void interrupt_begin(bool term_is_recorded);

// For interruptible work: after interrupt_catch the first SIGINT or SIGUSR1, by which schedulers
// announce the end of a job, is only recorded; the next one ends the program.
void interrupt_catch(void);
bool interrupt_caught(void);
// Ends this mode. True: one was recorded.
bool interrupt_let_go(void);

// Enclose all writes of files.
void interrupt_hold(void);
void interrupt_release(void);

// Called on another thread before a signal ends the program; NULL: none.
void interrupt_clean_with(void (*clean)(void *user), void *user);
