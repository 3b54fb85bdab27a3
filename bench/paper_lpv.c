// Repeats the measurements of T. L. Martin, "Higher Order Light Propagation Volumes", 2012, chapter
// 5: table 5.1 (times, memory) and scanlines against a path-traced reference as in figures 5.4
// and 5.18, for all of its scenes, and pictures.
//
//     paper-lpv [--scenes DIR] [--out DIR] [--settings paper|default] [--only SCENE] [--frames N]
//     [--spp N] …
//
// In DIR of --out come table.csv and, for each scene, NAME.csv, NAME.svg and NAME.png.
#include "paper_lpv_measure.h"
#include "plot.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_SIZE = 1024 };

struct program {
    struct measure measure;
    const char *scenes, *out, *only, *device;
    FILE *table;
};

// ---- what comes out

static const char TABLE_HEAD[] =
    "scene,section,technique,options,width,height,frames,inject_ms,propagate_ms,apply_ms,other_ms,"
    "technique_ms,frame_ms,technique_bytes,scanline_error,scanline_relmse,picture_relmse,paper_"
    "frame_ms,paper_bytes\n";

static void table_row(const struct program *program, const struct paper_scene *scene,
                      const struct measured *m)
{
    const struct technique_cost *cost = &m->cost;
    bool higher = strcmp(m->technique, "holpv") == 0;
    fprintf(program->table,
            "%s,%s,%s,\"%s\",%d,%d,%d,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%llu,%.4f,%.6f,", scene->name,
            scene->section, m->technique, m->gi, program->measure.width, program->measure.height,
            program->measure.frames, cost->inject_ms, cost->propagate_ms, cost->apply_ms,
            cost->other_ms, cost->technique_ms, cost->frame_ms, (unsigned long long)cost->bytes,
            m->error, m->relmse);
    if (m->picture_relmse >= 0) fprintf(program->table, "%.6f", m->picture_relmse);
    fputc(',', program->table);
    if (scene->lpv_ms > 0)
        fprintf(program->table, "%.1f", higher ? scene->holpv_ms : scene->lpv_ms);
    // Three volumes of light, one of geometry, and the reflective shadow map: section 5.8.
    fprintf(program->table, ",%.0f\n",
            (higher ? 5.25 + 0.25 + 0.75 : 2.25 + 0.25 + 0.75) * 1048576);
}

static void print_row(const struct paper_scene *scene, const struct measured *m, bool first)
{
    const struct technique_cost *cost = &m->cost;
    printf("%-16s %-6s %9.2f %9.2f %9.2f %9.2f %9.2f %8.2f %7.2f %7.3f", first ? scene->name : "",
           m->technique, cost->inject_ms, cost->propagate_ms, cost->apply_ms, cost->technique_ms,
           cost->frame_ms, (double)cost->bytes / 1048576, m->error, m->relmse);
    if (m->picture_relmse >= 0)
        printf(" %8.3f", m->picture_relmse);
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
             floor ? "along the floor" : "on the middle row of the picture");
    int used = snprintf(
        note, sizeof note,
        "after Martin 2012, section %s; %s; mean absolute error over the mean:", scene->section,
        scene->bounces ? "one bounce of sunlight" : "light of an area");
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

static enum ag_result write_scene(struct program *program, const struct paper_scene *scene,
                                  const struct scanline *line, const struct ag_image *picture)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s.csv", program->out, scene->name);
    bool ok = write_scanline_csv(path, scene, line);
    if (ok) {
        snprintf(path, sizeof path, "%s/%s.svg", program->out, scene->name);
        ok = write_scanline_plot(path, scene, line);
    }
    if (!ok) {
        fprintf(stderr, "paper-lpv: %s: %s\n", path, strerror(errno));
        return AG_ERROR_FILE;
    }
    if (!picture) return AG_OK;
    snprintf(path, sizeof path, "%s/%s.png", program->out, scene->name);
    return ag_image_write_png(program->measure.context, path, picture);
}

// ---- the run

static bool file_is_there(const char *folder, const char *name)
{
    char path[PATH_SIZE];
    struct stat about;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return stat(path, &about) == 0;
}

static enum ag_result measure_scene(struct program *program, const struct paper_scene *scene)
{
    struct measure *measure = &program->measure;
    struct ag_scene *loaded = NULL;
    struct ag_image *picture = NULL;
    static struct scanline line;
    enum ag_result result = paper_scene_open(scene, measure->context, program->scenes, &loaded);
    if (result == AG_OK) result = measure_scanline(measure, scene, loaded, &line);
    if (result == AG_OK) result = measure_costs(measure, scene, loaded, &line);
    if (result == AG_OK && measure->picture_spp > 0)
        result = measure_picture(measure, scene, loaded, &line, &picture);
    if (result == AG_OK) result = write_scene(program, scene, &line, picture);
    ag_image_destroy(measure->context, picture);
    ag_scene_destroy(loaded);
    for (int t = 0; t < line.technique_count && result == AG_OK; t++) {
        table_row(program, scene, &line.techniques[t]);
        print_row(scene, &line.techniques[t], t == 0);
    }
    return result;
}

static void print_head(const struct program *program)
{
    struct ag_device_info device;
    ag_device_get_info(program->measure.device, &device);
    printf("%s; median ms of %d frames; error: mean of |E - reference| over the reference's mean, "
           "relmse "
           "beside it, of the line and of the whole picture; paper: ms of a frame on a GTX 460\n",
           device.name, program->measure.frames);
    printf("%-16s %-6s %9s %9s %9s %9s %9s %8s %7s %7s %8s %8s\n", "", "", "inject", "propagate",
           "apply", "technique", "frame", "MiB", "error", "relmse", "picture", "paper");
}

static enum ag_result run(struct program *program)
{
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.device = program->device;
    enum ag_result result =
        ag_device_create(program->measure.context, &desc, &program->measure.device);
    if (result == AG_OK) print_head(program);
    for (int i = 0; i < paper_scene_count && result == AG_OK; i++) {
        const struct paper_scene *scene = &paper_scenes[i];
        if (program->only && strcmp(program->only, scene->name) != 0) continue;
        if (scene->spec[0] != '@' && !file_is_there(program->scenes, scene->spec)) {
            fprintf(stderr, "%s: left out, there is no %s/%s (--scenes)\n", scene->name,
                    program->scenes, scene->spec);
            continue;
        }
        result = measure_scene(program, scene);
    }
    return result;
}

// ---- the command line

static bool parse_int(const char *value, int low, int high, int *out)
{
    char rest;
    return sscanf(value, "%d%c", out, &rest) == 1 && *out >= low && *out <= high;
}

static bool is_scene(const char *name)
{
    for (int i = 0; i < paper_scene_count; i++)
        if (strcmp(paper_scenes[i].name, name) == 0) return true;
    return false;
}

static bool parse_option(struct program *program, const char *name, const char *value)
{
    struct measure *measure = &program->measure;
    if (strcmp(name, "--scenes") == 0)
        program->scenes = value;
    else if (strcmp(name, "--out") == 0)
        program->out = value;
    else if (strcmp(name, "--device") == 0)
        program->device = value;
    else if (strcmp(name, "--options") == 0)
        measure->options = value;
    else if (strcmp(name, "--only") == 0 && is_scene(value))
        program->only = value;
    else if (strcmp(name, "--settings") == 0 && strcmp(value, "paper") == 0)
        measure->paper_settings = true;
    else if (strcmp(name, "--settings") == 0 && strcmp(value, "default") == 0)
        measure->paper_settings = false;
    else if (strcmp(name, "--frames") == 0)
        return parse_int(value, 1, PASSES_MAX_FRAMES, &measure->frames);
    else if (strcmp(name, "--spp") == 0)
        return parse_int(value, 1, 1000000, &measure->spp);
    else if (strcmp(name, "--picture-spp") == 0)
        return parse_int(value, 0, 1000000, &measure->picture_spp);
    else if (strcmp(name, "--picture-width") == 0)
        return parse_int(value, 16, 4096, &measure->picture_width);
    else
        return false;
    return true;
}

static void usage(void)
{
    fputs("usage: paper-lpv [--scenes DIR] [--out DIR] [--settings paper|default] [--options "
          "KEY=VALUE,...]\n"
          "                 [--only SCENE] [--frames N] [--spp N] [--picture-spp N] "
          "[--picture-width N]\n"
          "                 [--device NAME]\nscenes:",
          stderr);
    for (int i = 0; i < paper_scene_count; i++) fprintf(stderr, " %s", paper_scenes[i].name);
    fputc('\n', stderr);
}

static bool open_table(struct program *program)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/table.csv", program->out);
    if (mkdir(program->out, 0777) != 0 && errno != EEXIST)
        snprintf(path, sizeof path, "%s", program->out);
    else if ((program->table = fopen(path, "w")))
        return fputs(TABLE_HEAD, program->table) >= 0;
    fprintf(stderr, "paper-lpv: %s: %s\n", path, strerror(errno));
    return false;
}

int main(int argc, char **argv)
{
    const char *scenes = getenv("AFTERGLOW_SCENES");
    struct program program = {
        .measure = { .frames = 5,
                     .spp = 4096,
                     .picture_spp = 64,
                     .picture_width = 320,
                     .paper_settings = true },
        .scenes = scenes ? scenes : "scenes",
        .out = "paper-lpv",
    };
    for (int i = 1; i < argc; i += 2) {
        if (i + 1 == argc || !parse_option(&program, argv[i], argv[i + 1])) {
            usage();
            return 2;
        }
    }
    if (!open_table(&program)) return 1;
    enum ag_result result = ag_context_create(NULL, &program.measure.context);
    if (result == AG_OK) result = run(&program);
    if (result != AG_OK)
        fprintf(stderr, "paper-lpv: %s (%s)\n", ag_context_last_error(program.measure.context),
                ag_result_string(result));
    ag_device_destroy(program.measure.device);
    ag_context_destroy(program.measure.context);
    bool wrote = !ferror(program.table);
    if (!((fclose(program.table) == 0) & wrote)) {
        fprintf(stderr, "paper-lpv: %s/table.csv: %s\n", program.out, strerror(errno));
        return 1;
    }
    return result == AG_OK ? 0 : 1;
}
