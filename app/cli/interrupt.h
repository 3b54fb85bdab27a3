// Signals that end the program, and files that must not be left half written.
#pragma once

#include <stdbool.h>

// At the start of main, before there is another thread: SIGINT, SIGTERM and SIGHUP end the program
// as ever, but not between the two calls below. Those that the program was started to ignore it
// ignores.
void interrupt_begin(void);

// Work that ends well when it is interrupted: after interrupt_catch the first SIGINT is only
// remembered, the next one ends the program.
void interrupt_catch(void);
bool interrupt_caught(void);
// From here on the first one ends the program again. True: one had come.
bool interrupt_let_go(void);

// Around all that writes a file.
void interrupt_hold(void);
void interrupt_release(void);

// What a signal that ends the program calls before, on another thread, between files; NULL:
// nothing.
void interrupt_clean_with(void (*clean)(void *user), void *user);
