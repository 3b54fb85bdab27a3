// Signals that end the program, and files that must not be left half written.
#pragma once

// At the start of main, before there is another thread: SIGINT, SIGTERM and SIGHUP end the program as ever, but not
// between the two calls below. Those that the program was started to ignore it ignores.
void interrupt_begin(void);

// Around all that writes a file.
void interrupt_hold(void);
void interrupt_release(void);
