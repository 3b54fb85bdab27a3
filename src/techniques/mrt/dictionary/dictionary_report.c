// Members of `afterglow bake --report`: energy of the modes of each shape (Loos 2015, table 3.2),
// the accuracy of its operators, and their cost.
#include "dictionary.h"

#include "techniques/mrt/dictionary/transfer.h"

#include <stdio.h>
#include <string.h>

enum { NAME = 64 };

struct dictionary_report {
    struct report *report;
    const struct bake *bake;
    const char *family; // "cube" or "tube"
    double *values;     // room for the singular values of a shape
};

static const struct tensor *find_of_shape(const struct dictionary_report *r, int shape,
                                          const char *what)
{
    char name[NAME];
    snprintf(name, sizeof name, "%s/%d/%s", r->family, shape, what);
    return tensors_find(bake_reported(r->bake), name);
}

// ---- singular values

struct spectrum {
    const char *name, *tensor;
};
static const struct spectrum SPECTRA[] = { { "F", "sigma_F" },
                                           { "Ld", "sigma_L" },
                                           { "M", "sigma_M" } };
enum { SPECTRUM_COUNT = sizeof SPECTRA / sizeof *SPECTRA };

static void add_modes_at(const struct dictionary_report *r, const char *name,
                         const struct tensor *sigma)
{
    static const struct {
        const char *percent;
        double share;
    } shares[] = { { "80", 0.80 }, { "90", 0.90 }, { "95", 0.95 } };
    const size_t count = (size_t)sigma->shape[0];
    for (size_t i = 0; i < count; i++) r->values[i] = (double)((const float *)sigma->data)[i];
    report_begin_object(r->report, name);
    for (int i = 0; i < 3; i++)
        report_number(r->report, shares[i].percent,
                      mrt_modes_for_energy(r->values, count, shares[i].share));
    report_end(r->report);
}

static void add_list(const struct dictionary_report *r, const char *name,
                     const struct tensor *values)
{
    report_begin_list(r->report, name);
    for (uint64_t i = 0; i < values->shape[0]; i++)
        report_number(r->report, NULL, (double)((const float *)values->data)[i]);
    report_end(r->report);
}

// Those of F are there after a run with --report-full.
static void add_spectra(const struct dictionary_report *r, int shape, const char *name,
                        void (*add)(const struct dictionary_report *, const char *,
                                    const struct tensor *))
{
    report_begin_object(r->report, name);
    for (int i = 0; i < SPECTRUM_COUNT; i++) {
        const struct tensor *sigma = find_of_shape(r, shape, SPECTRA[i].tensor);
        if (sigma) add(r, SPECTRA[i].name, sigma);
    }
    report_end(r->report);
}

static void add_checks(const struct dictionary_report *r, int shape)
{
    const float *checks = find_of_shape(r, shape, "checks")->data;
    report_number(r->report, "orthonormality", (double)checks[0]);
    report_number(r->report, "implicit_light_identity", (double)checks[1]);
}

// ---- costs

// Tensors of the file whose names begin so.
static void add_bytes(const struct dictionary_report *r, const char *prefix)
{
    const struct tensors *saved = bake_tensors(r->bake);
    const size_t length = strlen(prefix);
    report_begin_object(r->report, "bytes");
    for (size_t i = 0; i < saved->count; i++)
        if (strncmp(saved->at[i].name, prefix, length) == 0)
            report_number(r->report, saved->at[i].name + length, (double)saved->at[i].bytes);
    report_end(r->report);
}

// Stages whose names begin so.
static void add_seconds(const struct dictionary_report *r, const char *prefix)
{
    const size_t length = strlen(prefix);
    report_begin_object(r->report, "seconds");
    for (int i = 0; i < bake_stage_count(r->bake); i++) {
        const struct bake_stage_info stage = bake_stage_info(r->bake, i);
        if (strncmp(stage.name, prefix, length) == 0)
            report_number(r->report, stage.name + length, stage.seconds);
    }
    report_end(r->report);
}

// ---- shapes

static void add_open_faces(struct report *report, const struct mrt_shape *shape)
{
    static const char *const names[CUBE_FACES] = { "-x", "+x", "-y", "+y", "-z", "+z" };
    report_begin_list(report, "open_faces");
    for (int f = 0; f < CUBE_FACES; f++)
        if (mrt_shape_is_open(shape, f)) report_text_value(report, NULL, names[f]);
    report_end(report);
}

static void add_shape(const struct dictionary_report *r, const struct mrt_shape *shape, int i)
{
    char name[NAME], tensors[NAME], stages[NAME];
    snprintf(name, sizeof name, "%s/%d", r->family, i);
    snprintf(tensors, sizeof tensors, "%s/%d/", r->family, i);
    snprintf(stages, sizeof stages, "%s %d ", r->family, i);
    report_begin_object(r->report, NULL);
    report_text_value(r->report, "name", name);
    add_open_faces(r->report, shape);
    report_number(r->report, "texels", mrt_shape_texels(shape));
    add_spectra(r, i, "modes_at", add_modes_at);
    add_spectra(r, i, "sigma", add_list);
    add_checks(r, i);
    add_bytes(r, tensors);
    add_seconds(r, stages);
    report_end(r->report);
}

static void add_shapes(const struct dictionary_report *r,
                       const struct mrt_dictionary_options *options)
{
    const enum mrt_maze maze = mrt_dictionary_maze(options);
    report_begin_list(r->report, "shapes");
    for (int i = 0; i < mrt_dictionary_shapes(maze); i++) {
        const struct mrt_shape shape = mrt_dictionary_shape(maze, options->texels, i);
        add_shape(r, &shape, i);
    }
    report_end(r->report);
}

bool mrt_dictionary_report(struct report *report, struct bake *bake,
                           const struct mrt_dictionary_options *options)
{
    struct host *host = bake_plan_host(bake_plan_of(bake));
    const enum mrt_maze maze = mrt_dictionary_maze(options);
    const struct mrt_shape largest = mrt_dictionary_shape(maze, options->texels, 0); // no opening
    struct dictionary_report r = { report, bake, maze == MRT_TUNNEL ? "tube" : "cube", NULL };
    r.values = host_alloc(host, (size_t)mrt_shape_texels(&largest), sizeof *r.values);
    if (!r.values) return false;
    add_shapes(&r, options);
    report_begin_object(report, "interface");
    add_bytes(&r, "interface/");
    report_end(report);
    host_free(host, r.values);
    return true;
}
