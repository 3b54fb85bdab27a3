// Probes as balls in the image: white diffuse spheres at the places of the published probes, lit by
// them, behind surfaces that are in front of them.
#pragma once

#include "viewer/window/interface.h"

enum { BALLS_MOST = 400 };

struct viewer;

// A ball's vertices: its middle, then rings from the inside, the last one transparent.
struct ball {
    int first, rings, segments;
};

struct probe_balls {
    bool shown;
    unsigned version; // viewer.version that they are complete for
    int count, in_view, dark;
    struct ball balls[BALLS_MOST]; // from the farthest
    struct ui_vertex *vertices;
};
// Places and shades the balls while the image changes. They are none if the method publishes no
// probes.
void probe_balls_update(struct viewer *v);
void probe_balls_close(struct viewer *v);
// The running method publishes probes.
bool probe_balls_published(const struct viewer *v);
