// Plots: ticks, and the SVG file.
#include "framework/test.h"

#include "bench/plot.h"

#include "core/files/file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

TEST(ticks_are_round_numbers_in_the_range)
{
    for (int i = 0; i < 200; i++) {
        double low = i % 3 == 0 ? 0 : 37.0 * sin(i), high = low + pow(10.0, 0.05 * i - 4);
        double first, step;
        plot_ticks(low, high, 8, &first, &step);
        CHECK(first >= low - 1e-6 * step && first < low + step);
        CHECK((high - low) / step <= 8 + 1e-6 && (high - low) / step > 8 / 2.5 - 1e-6);
        double mantissa = step / pow(10.0, floor(log10(step) + 1e-9));
        CHECK(fabs(mantissa - 1) < 1e-6 || fabs(mantissa - 2) < 1e-6 || fabs(mantissa - 5) < 1e-6);
        CHECK_NEAR(fmod(fabs(first) + 0.5 * step, step) / step, 0.5, 1e-3);
    }
}

static char written[65536];

static void write(const struct plot *plot)
{
    char path[300];
    snprintf(path, sizeof path, "%s", test_path("plot.svg"));
    CHECK(plot_write(path, plot));
    FILE *file = fopen(path, "r");
    CHECK(file);
    size_t count = fread(written, 1, sizeof written - 1, file);
    fclose(file);
    CHECK(count > 0 && count < sizeof written - 1);
    written[count] = 0;
}

static int count_of(const char *what)
{
    int count = 0;
    for (const char *at = written; (at = strstr(at, what)); at += strlen(what)) count++;
    return count;
}

TEST(names_are_escaped_and_curves_have_gaps_at_values_that_are_not_finite)
{
    const double x[] = { 0, 1, 2, 3, 4 }, y[] = { 0, 5, NAN, 5, 10 }, z[] = { 1, 1, 1, 1, 1 };
    const struct plot_series series[] = { { "a < b & c", x, y, 5 }, { "flat", x, z, 5 } };
    struct plot plot = { .title = "T<itle",
                         .x_label = "x (m)",
                         .y_label = "y (lux)",
                         .series = series,
                         .series_count = 2 };
    write(&plot);
    CHECK(strncmp(written, "<svg ", 5) == 0);
    CHECK(strstr(written, "T&lt;itle") && strstr(written, "a &lt; b &amp; c"));
    CHECK(strstr(written, "x (m)") && strstr(written, "y (lux)"));
    // The first curve has two strokes of two points each; its middle point is missing.
    const char *curve = strstr(written, "d=\"M84.0 382.0L");
    CHECK(curve);
    int strokes = 0;
    for (const char *c = curve + 3; *c != '"'; c++) strokes += *c == 'M';
    CHECK(strokes == 2);
    CHECK(!strstr(written, "nan") && !strstr(written, "inf"));
    CHECK(count_of("<text") == count_of("</text>"));
}

TEST(empty_and_single_point_plots_are_valid)
{
    const double none[] = { NAN }, one[] = { 3 };
    const struct plot_series nothing = { "nothing", none, none, 1 },
                             point = { "point", one, one, 1 };
    struct plot plot = {
        .title = "", .x_label = "", .y_label = "", .series = &nothing, .series_count = 1
    };
    write(&plot);
    CHECK(strstr(written, "</svg>") && !strstr(written, "nan"));
    plot.series = &point;
    write(&plot);
    CHECK(strstr(written, "</svg>") && !strstr(written, "nan") && !strstr(written, "inf"));
}

TEST(an_unwritable_file_is_an_error)
{
    struct plot plot = { .title = "", .x_label = "", .y_label = "" };
    CHECK(!plot_write("/no/such/folder/plot.svg", &plot));
}
