// Repeats the measurements of T. L. Martin, "Higher Order Light Propagation Volumes", 2012, chapter
// 5: table 5.1 (times, memory) and scanlines against a path-traced reference as in figures 5.4
// and 5.18, for all of its scenes, and images.
//
//     paper-lpv [--scenes DIR] [--out DIR] [--settings paper|default] [--only SCENE] [--frames N]
//     [--spp N] …
//
// Writes table.csv and, for each scene, NAME.csv, NAME.svg and NAME.png to the folder of --out.
#include "paper_lpv_measure.h"
#include "plot.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_SIZE = 1024 };

struct lpv_bench {
    struct bench bench;
    struct measure measure;
    const char *scenes, *out, *only;
    char table_path[PATH_SIZE];
};

// ---- output

static const char TABLE_HEADER[] =
    "scene,section,technique,options,width,height,frames,inject_ms,propagate_ms,apply_ms,other_ms,"
    "technique_ms,frame_ms,technique_bytes,scanline_error,scanline_relmse,image_relmse,"
    "paper_frame_ms,paper_bytes";

static void write_row(const struct bench *bench, const struct paper_scene *scene,
                      const struct measured *m)
{
    const struct technique_cost *cost = &m->cost;
    bool higher = strcmp(m->technique, "holpv") == 0;
    fprintf(bench->csv, "%s,%s,%s,\"%s\",%d,%d,%d,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%llu,%.4f,%.6f,",
            scene->name, scene->section, m->technique, m->gi, bench->width, bench->height,
            bench->frames, cost->inject_ms, cost->propagate_ms, cost->apply_ms, cost->other_ms,
            cost->technique_ms, cost->frame_ms, (unsigned long long)cost->bytes, m->error,
            m->relmse);
    if (m->image_relmse >= 0) fprintf(bench->csv, "%.6f", m->image_relmse);
    fputc(',', bench->csv);
    if (scene->lpv_ms > 0) fprintf(bench->csv, "%.1f", higher ? scene->holpv_ms : scene->lpv_ms);
    // Section 5.8: three light volumes, one geometry volume, the reflective shadow map.
    fprintf(bench->csv, ",%.0f\n", (higher ? 5.25 + 0.25 + 0.75 : 2.25 + 0.25 + 0.75) * 1048576);
}

static void print_row(const struct paper_scene *scene, const struct measured *m, bool first)
{
    const struct technique_cost *cost = &m->cost;
    printf("%-16s %-6s %9.2f %9.2f %9.2f %9.2f %9.2f %8.2f %7.2f %7.3f", first ? scene->name : "",
           m->technique, cost->inject_ms, cost->propagate_ms, cost->apply_ms, cost->technique_ms,
           cost->frame_ms, (double)cost->bytes / 1048576, m->error, m->relmse);
    if (m->image_relmse >= 0)
        printf(" %8.3f", m->image_relmse);
    else
        printf(" %8s", "-");
    double paper = strcmp(m->technique, "holpv") == 0 ? scene->holpv_ms : scene->lpv_ms;
    if (paper > 0)
        printf(" %8.1f\n", paper);
    else
        printf(" %8s\n", "-");
    fflush(stdout);
}

static bool write_scanline_csv(const char *path, const struct paper_scene *scene,
                               const struct scanline *line)
{
    FILE *file = fopen(path, "w");
    if (!file) return false;
    fprintf(file, "%s,reference_lux", paper_scene_scans_floor(scene) ? "metres" : "column");
    for (int t = 0; t < line->technique_count; t++)
        fprintf(file, ",%s_lux", line->techniques[t].technique);
    fputc('\n', file);
    for (int i = 0; i < line->count; i++) {
        fprintf(file, "%.6g,%.6g", line->x[i], line->reference[i]);
        for (int t = 0; t < line->technique_count; t++)
            fprintf(file, ",%.6g", line->techniques[t].lux[i]);
        fputc('\n', file);
    }
    bool wrote = !ferror(file);
    return (fclose(file) == 0) & wrote;
}

static bool write_scanline_plot(const char *path, const struct paper_scene *scene,
                                const struct scanline *line)
{
    struct plot_series series[1 + MEASURE_TECHNIQUES] = { { "path-traced reference", line->x,
                                                            line->reference, line->count } };
    char title[160], note[200];
    bool floor = paper_scene_scans_floor(scene);
    snprintf(title, sizeof title, "%s: irradiance %s", scene->title,
             floor ? "along the floor" : "on the middle row of the image");
    int used = snprintf(note, sizeof note,
                        "after Martin 2012, section %s; %s; mean absolute error over the mean:",
                        scene->section, scene->bounces ? "one bounce of sunlight" : "area light");
    for (int t = 0; t < line->technique_count; t++) {
        const struct measured *m = &line->techniques[t];
        series[1 + t] = (struct plot_series){ m->technique, line->x, m->lux, line->count };
        if (used > 0 && used < (int)sizeof note)
            used += snprintf(note + used, sizeof note - (size_t)used, " %s %.2f", m->technique,
                             m->error);
    }
    struct plot plot = { .title = title,
                         .note = note,
                         .x_label = floor ? "distance along the floor (m)" : "column (pixels)",
                         .y_label = "irradiance (lux)",
                         .series = series,
                         .series_count = 1 + line->technique_count };
    return plot_write(path, &plot);
}

static enum ag_result write_scene(const struct lpv_bench *b, const struct paper_scene *scene,
                                  const struct scanline *line, const struct ag_image *image)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s.csv", b->out, scene->name);
    bool ok = write_scanline_csv(path, scene, line);
    if (ok) {
        snprintf(path, sizeof path, "%s/%s.svg", b->out, scene->name);
        ok = write_scanline_plot(path, scene, line);
    }
    if (!ok) {
        fprintf(stderr, "paper-lpv: %s: %s\n", path, strerror(errno));
        return AG_ERROR_FILE;
    }
    if (!image) return AG_OK;
    snprintf(path, sizeof path, "%s/%s.png", b->out, scene->name);
    return ag_image_write_png(b->bench.context, path, image);
}

// ---- measurement

static const struct paper_scene *find_scene(const char *name)
{
    for (int i = 0; i < paper_scene_count; i++)
        if (strcmp(paper_scenes[i].name, name) == 0) return &paper_scenes[i];
    return NULL;
}

static bool is_missing(const struct lpv_bench *b, const struct paper_scene *scene)
{
    char path[PATH_SIZE];
    struct stat info;
    if (scene->spec[0] == '@') return false;
    snprintf(path, sizeof path, "%s/%s", b->scenes, scene->spec);
    return stat(path, &info) != 0;
}

static enum ag_result measure_scene(void *user, const char *name)
{
    struct lpv_bench *b = user;
    const struct paper_scene *scene = find_scene(name);
    struct ag_context *context = b->bench.context;
    struct ag_scene *loaded = NULL;
    struct ag_image *image = NULL;
    static struct scanline line;
    if (is_missing(b, scene)) {
        fprintf(stderr, "%s skipped: no %s/%s (--scenes)\n", name, b->scenes, scene->spec);
        return AG_OK;
    }
    enum ag_result result = paper_scene_open(scene, context, b->scenes, &loaded);
    if (result == AG_OK) result = measure_scanline(&b->measure, scene, loaded, &line);
    if (result == AG_OK) result = measure_costs(&b->measure, scene, loaded, &line);
    if (result == AG_OK && b->measure.image_spp > 0)
        result = measure_image(&b->measure, scene, loaded, &line, &image);
    if (result == AG_OK) result = write_scene(b, scene, &line, image);
    ag_image_destroy(context, image);
    ag_scene_destroy(loaded);
    for (int t = 0; t < line.technique_count && result == AG_OK; t++) {
        write_row(&b->bench, scene, &line.techniques[t]);
        print_row(scene, &line.techniques[t], t == 0);
    }
    return result;
}

static void print_header(void *user)
{
    const struct lpv_bench *b = user;
    printf(
        "%s; median ms of %d frames; error: mean |E - reference| over the reference's mean, and "
        "relmse, of the scanline; image: relmse of the image; paper: ms of a frame on a GTX 460\n",
        b->bench.info.name, b->bench.frames);
    printf("%-16s %-6s %9s %9s %9s %9s %9s %8s %7s %7s %8s %8s\n", "", "", "inject", "propagate",
           "apply", "technique", "frame", "MiB", "error", "relmse", "image", "paper");
}

// ---- command line

static bool parse_settings(const char *value, bool *paper_settings)
{
    *paper_settings = strcmp(value, "paper") == 0;
    return *paper_settings || strcmp(value, "default") == 0;
}

// Accepts the names of options before their renaming.
static const char *current_name(const char *name)
{
    static const char *const renamed[][2] = { { "--picture-spp", "--image-spp" },
                                              { "--picture-width", "--image-width" } };
    for (int i = 0; i < 2; i++) {
        if (strcmp(name, renamed[i][0]) != 0) continue;
        fprintf(stderr,
                "paper-lpv: %s is now %s; the old name will be removed in the next release\n", name,
                renamed[i][1]);
        return renamed[i][1];
    }
    return name;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct lpv_bench *b = user;
    name = current_name(name);
    struct measure *measure = &b->measure;
    if (strcmp(name, "--scenes") == 0)
        b->scenes = value;
    else if (strcmp(name, "--out") == 0)
        b->out = value;
    else if (strcmp(name, "--options") == 0)
        measure->options = value;
    else if (strcmp(name, "--only") == 0 && find_scene(value))
        b->only = value;
    else if (strcmp(name, "--settings") == 0)
        return parse_settings(value, &measure->paper_settings);
    else if (strcmp(name, "--spp") == 0)
        return parse_int(value, 1, 1000000, &measure->spp);
    else if (strcmp(name, "--image-spp") == 0)
        return parse_int(value, 0, 1000000, &measure->image_spp);
    else if (strcmp(name, "--image-width") == 0)
        return parse_int(value, 16, 4096, &measure->image_width);
    else
        return false;
    return true;
}

static bool set_defaults(void *user)
{
    struct lpv_bench *b = user;
    struct bench_scenes *scenes = &b->bench.scenes;
    const char *folder = getenv("AFTERGLOW_SCENES");
    if (!b->scenes) b->scenes = folder ? folder : "scenes";
    for (int i = 0; i < paper_scene_count; i++)
        if (!b->only || strcmp(b->only, paper_scenes[i].name) == 0)
            scenes->names[scenes->count++] = paper_scenes[i].name;
    mkdir(b->out, 0777); // csv_open reports an error
    snprintf(b->table_path, sizeof b->table_path, "%s/table.csv", b->out);
    b->bench.csv_path = b->table_path;
    return true;
}

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "paper-lpv",
        .usage = "[--scenes DIR] [--out DIR] [--settings paper|default]\n"
                 "    [--options KEY=VALUE,...] [--spp N] [--image-spp N] [--image-width N]\n"
                 "    [--only diagonal|hallway|bunny|planter|floor|cornell|planter-builtin|"
                 "floor-builtin]\n   ",
        .csv_header = TABLE_HEADER,
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .print_header = print_header,
        .measure_scene = measure_scene,
    };
    static struct lpv_bench b = {
        .bench = { .frames = 5 },
        .measure = { .bench = &b.bench,
                     .spp = 4096,
                     .image_spp = 64,
                     .image_width = 320,
                     .paper_settings = true },
        .out = "paper-lpv",
    };
    return bench_main(&program, &b.bench, &b, argc, argv);
}
