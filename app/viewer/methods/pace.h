// Durations of the window's frames: how soon the interface answers.
#pragma once

enum { PACE_FRAMES = 4096 };

struct pace {
    int count; // since the last pace_clear; later ones are left out
    float ms[PACE_FRAMES];
};

struct pace_summary {
    int frames;
    float mean_ms, p95_ms, most_ms; // p95: 95 of 100 are shorter
};

void pace_clear(struct pace *pace);
void pace_add(struct pace *pace, float ms);
void pace_get(const struct pace *pace, struct pace_summary *out);
