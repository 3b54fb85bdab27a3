// The index of an export.
#include "techniques/ort/export.h"

#include "bake/report.h"
#include "core/files/file.h"

#include <stdio.h>
#include <string.h>

static void add_numbers(struct report *out, const char *name, const double *values, int count)
{
    report_begin_list(out, name);
    for (int i = 0; i < count; i++) report_number(out, NULL, values[i]);
    report_end(out);
}

static void add_colour(struct report *out, const char *name, const float *colour)
{
    add_numbers(out, name, (const double[]){ colour[0], colour[1], colour[2] }, 3);
}

static void add_sizes(const struct ort_export *e, struct report *out)
{
    report_begin_object(out, "plane");
    report_number(out, "width", e->map.width);
    report_number(out, "height", e->map.height);
    report_end(out);
    report_begin_object(out, "light_map");
    report_number(out, "width", e->map.charts.width);
    report_number(out, "height", e->map.charts.height);
    report_number(out, "sides", charts_sides(&e->map.charts));
    report_end(out);
}

static void add_files(const struct ort_export *e, struct report *out)
{
    char name[24];
    report_number(out, "bin_side", ORT_BIN_SIDE);
    report_begin_list(out, "files");
    for (uint32_t bin = 0; bin < e->bins.bin_count; bin++) {
        snprintf(name, sizeof name, ORT_EXPORT_BIN, bin);
        report_text_value(out, NULL, name);
    }
    report_end(out);
}

static void add_occupancy(const struct ort_export *e, struct report *out)
{
    const double texels = (double)e->bins.bin_count * ORT_BIN_SIDE * ORT_BIN_SIDE;
    report_begin_object(out, "occupancy");
    report_number(out, "pieces", texels > 0 ? (double)e->bins.packed / texels : 0);
    report_number(out, "weights", texels > 0 ? (double)e->bins.occupied / texels : 0);
    report_end(out);
}

static void add_energy(const struct ort_export *e, struct report *out)
{
    report_begin_object(out, "energy");
    report_text_value(out, "unit", "lm");
    add_colour(out, "offsets", e->energy);
    add_colour(out, "exact", e->energy + 3);
    report_end(out);
}

static void add_offsets(const struct ort_export *e, struct report *out)
{
    report_begin_list(out, "offsets");
    for (uint32_t k = 0; k < e->maps.count; k++) {
        const int32_t *at = e->maps.offset + 2 * (size_t)k;
        if (k % e->maps.offsets == 0) report_begin_list(out, NULL);
        add_numbers(out, NULL, (const double[]){ at[0], at[1] }, 2);
        if (k % e->maps.offsets == e->maps.offsets - 1) report_end(out);
    }
    report_end(out);
}

static void add_pieces(const struct ort_export *e, struct report *out)
{
    static const char *const FIELDS[] = { "map", "bin", "bin_x", "bin_y",
                                          "x",   "y",   "width", "height" };
    enum { COUNT = sizeof FIELDS / sizeof *FIELDS };
    report_begin_list(out, "piece");
    for (int i = 0; i < COUNT; i++) report_text_value(out, NULL, FIELDS[i]);
    report_end(out);
    report_begin_list(out, "pieces");
    for (uint32_t i = 0; i < e->bins.piece_count; i++) {
        const struct ort_piece *p = &e->bins.pieces[i];
        add_numbers(out, NULL,
                    (const double[COUNT]){ p->map, p->bin, p->bin_x, p->bin_y, p->x, p->y, p->width,
                                           p->height },
                    COUNT);
    }
    report_end(out);
}

static void add_all(const struct ort_export *e, struct report *out)
{
    static const char *const TRANSFER[] = {
        [ORT_RADIOSITY] = "radiosity", [ORT_SCATTERING] = "scattering", [ORT_BOTH] = "both"
    };
    report_text_value(out, "format", ORT_EXPORT_FORMAT);
    report_number(out, "version", ORT_EXPORT_VERSION);
    report_text_value(out, "transfer", TRANSFER[e->options->transfer]);
    report_number(out, "scale", (double)ORT_MAP_SCALE);
    add_sizes(e, out);
    add_files(e, out);
    add_occupancy(e, out);
    add_energy(e, out);
    add_offsets(e, out);
    add_pieces(e, out);
}

static bool write_text(struct host *host, const char *path, const char *text)
{
    struct file_writer writer;
    if (!file_begin(&writer, host, path)) return false;
    file_write(&writer, text, strlen(text));
    file_write(&writer, "\n", 1);
    return file_commit(&writer);
}

bool ort_export_index(const struct ort_export *from)
{
    struct report *report = report_create(from->host);
    if (!report) return false;
    add_all(from, report);
    const char *text = report_text(report);
    char *path = host_sprintf(from->host, "%s/%s", from->folder, ORT_EXPORT_INDEX);
    const bool ok =
        path &&
        (text || host_fail(from->host, FAIL_MEMORY, "cannot write %s: out of memory", path)) &&
        write_text(from->host, path, text);
    host_free(from->host, path);
    report_destroy(report);
    return ok;
}
