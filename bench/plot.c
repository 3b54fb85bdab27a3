// One SVG per plot, written line by line. Coordinates are pixels at 96 dpi.
#include "plot.h"

#include <math.h>
#include <stdio.h>

enum { WIDTH = 760, HEIGHT = 440, LEFT = 84, RIGHT = 24, TOP = 84, BOTTOM = 58 };

static const char *const COLOURS[PLOT_MAX_SERIES] = { "#000000", "#d55e00", "#0072b2", "#009e73",
                                                      "#cc79a7", "#e69f00", "#56b4e9" };
static const char *const DASHES[PLOT_MAX_SERIES] = { "",    "7 3", "2 2.5", "10 3 2 3",
                                                     "5 5", "1 4", "12 4" };

struct range {
    double low, high;
};

// ---- numbers

void plot_ticks(double low, double high, int max_count, double *first, double *step)
{
    double least = (high - low) / max_count;
    double decade = pow(10.0, floor(log10(least)));
    static const double factors[] = { 1, 2, 5, 10 };
    int i = 0;
    while (i < 3 && factors[i] * decade < least) i++;
    *step = factors[i] * decade;
    *first = ceil(low / *step - 1e-9) * *step;
}

// As few decimals as the distance of the ticks needs.
static int decimals(double step)
{
    int digits = (int)-floor(log10(step) + 1e-9);
    return digits > 0 ? digits : 0;
}

static void print_number(FILE *file, double value, double step)
{
    if (fabs(value) < 1e-9 * step) value = 0; // no -0
    if (fabs(value) >= 1e6 || (step < 1e-4 && value != 0.0))
        fprintf(file, "%.3g", value);
    else
        fprintf(file, "%.*f", decimals(step), value);
}

static struct range range_of(const struct plot *plot, bool of_y)
{
    struct range range = { INFINITY, -INFINITY };
    for (int s = 0; s < plot->series_count; s++) {
        const struct plot_series *series = &plot->series[s];
        for (int i = 0; i < series->count; i++) {
            if (!isfinite(series->x[i]) || !isfinite(series->y[i])) continue;
            double value = of_y ? series->y[i] : series->x[i];
            range.low = fmin(range.low, value);
            range.high = fmax(range.high, value);
        }
    }
    if (!(range.low <= range.high)) return (struct range){ 0, 1 };
    return range;
}

// Never empty; starts at 0 for positive values; with a margin.
static struct range y_range(const struct plot *plot)
{
    struct range range = range_of(plot, true);
    if (range.low > 0.0) range.low = 0.0;
    double margin = 0.06 * (range.high - range.low);
    range.high += margin;
    if (range.low < 0.0) range.low -= margin;
    if (!(range.high > range.low)) range.high = range.low + 1.0;
    return range;
}

// Never empty; extended to 0 where it starts close to 0.
static struct range x_range(const struct plot *plot)
{
    struct range range = range_of(plot, false);
    if (range.low > 0.0 && range.low < 0.05 * range.high) range.low = 0.0;
    if (!(range.high > range.low)) range.high = range.low + 1.0;
    return range;
}

static double at_x(struct range range, double x)
{
    return LEFT + (WIDTH - LEFT - RIGHT) * (x - range.low) / (range.high - range.low);
}

static double at_y(struct range range, double y)
{
    return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (y - range.low) / (range.high - range.low);
}

// ---- drawing

static void text(FILE *file, const char *attributes, double x, double y, const char *string)
{
    fprintf(file, "<text x=\"%.1f\" y=\"%.1f\"%s>", x, y, attributes);
    for (; *string; string++) {
        if (*string == '<')
            fputs("&lt;", file);
        else if (*string == '>')
            fputs("&gt;", file);
        else if (*string == '&')
            fputs("&amp;", file);
        else
            fputc(*string, file);
    }
    fputs("</text>\n", file);
}

static void header(FILE *file, const struct plot *plot)
{
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
            "viewBox=\"0 0 %d %d\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\" "
            "fill=\"#222\">\n<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n",
            WIDTH, HEIGHT, WIDTH, HEIGHT, WIDTH, HEIGHT);
    text(file, " font-size=\"17\" font-weight=\"bold\"", LEFT, 26, plot->title);
    if (plot->note) text(file, " font-size=\"12\" fill=\"#666\"", LEFT, 44, plot->note);
}

static void x_axis(FILE *file, const struct plot *plot, struct range range)
{
    double first, step;
    plot_ticks(range.low, range.high, 9, &first, &step);
    double bottom = HEIGHT - BOTTOM;
    for (int i = 0; first + i * step <= range.high + 1e-9 * step; i++) {
        double value = first + i * step, x = at_x(range, value);
        fprintf(file,
                "<path d=\"M%.1f %d V%.1f\" stroke=\"#e4e4e4\"/>"
                "<path d=\"M%.1f %.1f v5\" stroke=\"#444\"/>"
                "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">",
                x, TOP, bottom, x, bottom, x, bottom + 20);
        print_number(file, value, step);
        fputs("</text>\n", file);
    }
    text(file, " text-anchor=\"middle\"", 0.5 * (LEFT + WIDTH - RIGHT), HEIGHT - 14, plot->x_label);
}

static void y_axis(FILE *file, const struct plot *plot, struct range range)
{
    double first, step;
    plot_ticks(range.low, range.high, 7, &first, &step);
    for (int i = 0; first + i * step <= range.high + 1e-9 * step; i++) {
        double value = first + i * step, y = at_y(range, value);
        fprintf(file,
                "<path d=\"M%d %.1f H%d\" stroke=\"#e4e4e4\"/>"
                "<path d=\"M%d %.1f h-5\" stroke=\"#444\"/>"
                "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">",
                LEFT, y, WIDTH - RIGHT, LEFT, y, LEFT - 9, y + 4.5);
        print_number(file, value, step);
        fputs("</text>\n", file);
    }
    double middle = 0.5 * (TOP + HEIGHT - BOTTOM);
    char rotated[80];
    snprintf(rotated, sizeof rotated, " text-anchor=\"middle\" transform=\"rotate(-90 20 %.1f)\"",
             middle);
    text(file, rotated, 20, middle, plot->y_label);
}

static void stroke(FILE *file, int series)
{
    fprintf(file, " fill=\"none\" stroke=\"%s\" stroke-width=\"2\" stroke-linejoin=\"round\"",
            COLOURS[series]);
    if (DASHES[series][0]) fprintf(file, " stroke-dasharray=\"%s\"", DASHES[series]);
}

static void curve(FILE *file, const struct plot_series *series, int index, struct range x_axis_of,
                  struct range y_axis_of)
{
    bool drawing = false;
    fputs("<path", file);
    stroke(file, index);
    fputs(" d=\"", file);
    for (int i = 0; i < series->count; i++) {
        bool finite = isfinite(series->x[i]) && isfinite(series->y[i]);
        if (finite)
            fprintf(file, "%c%.1f %.1f", drawing ? 'L' : 'M', at_x(x_axis_of, series->x[i]),
                    at_y(y_axis_of, series->y[i]));
        drawing = finite;
    }
    fputs("\"/>\n", file);
}

// One line between the title and the plot, at about seven pixels per letter.
static void legend(FILE *file, const struct plot *plot)
{
    double x = LEFT, y = TOP - 18;
    for (int s = 0; s < plot->series_count; s++) {
        const char *name = plot->series[s].name;
        int letters = 0;
        for (const char *c = name; *c; c++) letters += (*c & 0xC0) != 0x80; // UTF-8
        fprintf(file, "<path d=\"M%.1f %.1f h30\"", x, y);
        stroke(file, s);
        fputs("/>\n", file);
        text(file, "", x + 37, y + 4.5, name);
        x += 37 + 7.2 * letters + 22;
    }
}

bool plot_write(const char *path, const struct plot *plot)
{
    FILE *file = fopen(path, "w");
    if (!file) return false;
    struct range x = x_range(plot), y = y_range(plot);
    header(file, plot);
    x_axis(file, plot, x);
    y_axis(file, plot, y);
    fprintf(file, "<path d=\"M%d %d V%d H%d\" fill=\"none\" stroke=\"#444\"/>\n", LEFT, TOP,
            HEIGHT - BOTTOM, WIDTH - RIGHT);
    // The first series, usually the reference, is drawn last, on top.
    for (int s = plot->series_count - 1; s >= 0; s--) curve(file, &plot->series[s], s, x, y);
    legend(file, plot);
    fputs("</svg>\n", file);
    bool wrote = !ferror(file);
    return (fclose(file) == 0) & wrote;
}
