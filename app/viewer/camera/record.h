// A flight along the camera's path, recorded to numbered images.
#pragma once

#include <stdbool.h>

struct viewer;

struct record {
    bool runs, failed; // failed: an image could not be written
    char folder[512];  // of the images: 00000.png …
    int frames_each;   // frames rendered for an image, for what accumulates
    int image, left;   // the one in work; frames that it still needs
    double start_s;    // time of the animation at the first image
};

// Creates the folder. False, with a message: the path has no keys, or the folder cannot be made.
bool record_begin(struct viewer *v);
void record_end(struct viewer *v);
void record_place(struct viewer *v); // before a frame: its camera and time
void record_take(struct viewer *v);  // after a frame: writes an image that is complete
