// Line plots as SVG: axes with round numbers and units, a legend, colours for colour-blind readers
// (Okabe & Ito 2008), and dashes for print. The same data give the same file.
#ifndef AG_BENCH_PLOT_H
#define AG_BENCH_PLOT_H

#include <stdbool.h>

// A line through `count` points. A point that is not finite leaves a gap. The index of a series
// selects its colour and dashes.
struct plot_series {
    const char *name;
    const double *x, *y;
    int count;
};

struct plot {
    const char *title;
    const char *note;              // below the title, smaller; may be NULL
    const char *x_label, *y_label; // with their units
    const struct plot_series *series;
    int series_count; // up to PLOT_MAX_SERIES
};

#define PLOT_MAX_SERIES 7

// False where the file cannot be written (errno has the reason).
bool plot_write(const char *path, const struct plot *plot);
// The first tick at or above `low`, and the distance of ticks: 1, 2 or 5 times a power of ten, with
// about max_count ticks in low … high. low < high, both finite.
void plot_ticks(double low, double high, int max_count, double *first, double *step);

#endif
