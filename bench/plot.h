// Line plots as SVG: axes with round numbers, units, a legend, colours that are told apart by
// everyone (Okabe & Ito 2008) and dashes that are told apart in print. A file depends on its data
// alone.
#pragma once

#include <stdbool.h>

// A line through count points; one whose x or y is not finite leaves a gap. Colours and dashes go
// by the series' place.
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

// False: the file cannot be written; errno says why.
bool plot_write(const char *path, const struct plot *plot);
// The first mark at or above `low` and the distance between marks, 1, 2 or 5 times a power of ten:
// at most `most` marks lie within low … high. low < high, both finite.
void plot_marks(double low, double high, int most, double *first, double *step);
