// A script's state, and its commands, for its own files.
#pragma once

#include "script.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { SCRIPT_LINE = 4096 };

struct script {
    FILE *file;
    const char *path;
    int line;
    char text[SCRIPT_LINE]; // the next line; "": to be read
    int waits;              // further frames
    bool settles;           // until the image is complete
    int settle_frames;      // at most; 0: no limit
    bool records;           // until a flight of its own is recorded
    int samples;            // until the reference has N; 0: none
    float click_x, click_y;
    int click;            // steps of a click that are left: down, up
    float drag_x, drag_y; // of the mouse in between
    uint64_t random;
    int random_left;
    char error[1024]; // "": none
};

// A line.
struct words {
    struct viewer *v;
    struct script *script;
    struct event_queue *queue;
    const char *name;
    char *rest; // of the line, after the name
};

struct script_command {
    const char *name;
    bool is_event;                      // others wait for the events of the lines before
    bool (*run)(const struct words *w); // false after a failure
};
bool script_blocks(const struct words *w);
bool script_light(const struct words *w);
bool script_environment(const struct words *w);
bool script_paint(const struct words *w);
extern const struct script_command script_input[], script_commands[]; // the last has no name

// Ends the script with a sentence; false.
bool script_wrong(struct script *script, const char *what, const char *text);
// `success`, or ends the script with the sentence of the status line.
bool script_done(const struct words *w, bool success);
bool script_is(const struct words *w, const char *name);
bool script_run_memory(const struct words *w);
// Appends a random event.
void script_push_random(struct script *script, struct viewer *v, struct event_queue *queue);
