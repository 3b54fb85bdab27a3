// Compression and cost of precomputed radiance transfer, after figure 28 of S. Hong 2015 (P.-P.
// Sloan, J. Hall, J. Hart and J. Snyder, "Clustered Principal Components for Precomputed Radiance
// Transfer", 2003): error against bytes of vq, pca and cpca for transfer vectors and for transfer
// matrices; and times of the passes against the number of texels, in light that turns.
//
//     paper-prt [--only vectors|matrices|passes] [--vectors N]… [--clusters N] [--texels N]
//     [--points N]… [--options …] [--threads N] [--out DIR] [--size WxH] [--frames N] [SCENE]
//
// Writes error.csv, error-vectors.svg, error-matrices.svg, passes.csv and passes.svg.
#include "paper_prt/compression.h"
#include "paper_prt/times.h"

#include "csv.h"
#include "plot.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_SIZE = 1024, MOST_SIZES = 8 };

static const char BUNNY[] = "bunny.glb", BUILT_IN[] = "@cornell:ceiling=false";

struct prt_bench {
    struct bench bench;
    const char *only, *options, *out;
    int texels, clusters; // 0 clusters: by prt_clusters_for
    int vectors[MOST_SIZES], vector_count;
    int points[MOST_SIZES], point_count;
};

static bool is_wanted(const struct prt_bench *b, const char *part)
{
    return !b->only || strcmp(b->only, part) == 0;
}

// ---- files

static FILE *open_table(const struct prt_bench *b, const char *name, const char *header,
                        char path[PATH_SIZE])
{
    FILE *file = NULL;
    snprintf(path, PATH_SIZE, "%s/%s", b->out, name);
    return csv_open(path, header, &file) ? file : NULL;
}

static enum ag_result draw(const struct prt_bench *b, const char *name, const struct plot *plot)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", b->out, name);
    if (plot_write(path, plot)) return AG_OK;
    fprintf(stderr, "paper-prt: %s: %s\n", path, strerror(errno));
    return AG_ERROR_FILE;
}

static const char *short_name(const char *scene)
{
    const char *slash = strrchr(scene, '/');
    return slash ? slash + 1 : scene;
}

// ---- error against bytes

// By method and number of vectors of cpca.
struct error_curves {
    double kilobytes[PRT_METHODS][MOST_SIZES], log_error[PRT_METHODS][MOST_SIZES];
};

static void print_error_heading(const struct prt_compression *c, const struct prt_compressed *first)
{
    printf("\n%s: %.0f texels of %d numbers, %.0f kB\n", c->subject->name, first->texels,
           c->subject->numbers, 1e-3 * first->whole_bytes);
    printf("%-6s %8s %8s %9s %9s %10s %8s %8s %8s\n", "method", "clusters", "vectors", "kB",
           "of whole", "error", "flip", "surface", "bake, s");
}

static void print_error_row(const struct prt_compressed *r)
{
    printf("%-6s %8d %8d %9.1f %9.4f %10.3g %8.5f %8.5f %8.2f\n", prt_methods[r->setting.method],
           r->setting.clusters, r->setting.vectors, 1e-3 * r->bytes, r->bytes / r->whole_bytes,
           r->error, r->flip.all, r->flip.surface, r->seconds);
    fflush(stdout);
}

static void write_error_row(FILE *file, const char *scene, const struct prt_compression *c,
                            const struct prt_compressed *r)
{
    csv_text(file, scene);
    fprintf(file, "%s,%.0f,%d,%s,%d,%d,%.0f,%.0f,%.9g,%.6f,%.6f,", c->subject->name, r->texels,
            c->subject->numbers, prt_methods[r->setting.method], r->setting.clusters,
            r->setting.vectors, r->bytes, r->whole_bytes, r->error, r->flip.all, r->flip.surface);
    if (isnan(r->seconds))
        fputc('\n', file);
    else
        fprintf(file, "%.3f\n", r->seconds);
    fflush(file);
}

// cpca with a number of vectors, then the others at about as many bytes.
static enum ag_result measure_methods(const struct prt_bench *b, const struct prt_compression *c,
                                      int vectors, struct prt_compressed out[PRT_METHODS])
{
    const struct prt_setting cpca = { .method = PRT_CPCA,
                                      .clusters = b->clusters ? b->clusters : prt_clusters_for(c),
                                      .vectors = vectors };
    enum ag_result result = prt_compression_measure(c, &cpca, &out[PRT_CPCA]);
    for (int m = 0; m < PRT_CPCA && result == AG_OK; m++) {
        const struct prt_setting setting =
            prt_setting_of_bytes(c, (enum prt_method)m, &out[PRT_CPCA]);
        result = prt_compression_measure(c, &setting, &out[m]);
    }
    return result;
}

static enum ag_result measure_sizes(const struct prt_bench *b, const struct prt_compression *c,
                                    const char *scene, FILE *file, struct error_curves *curves)
{
    enum ag_result result = AG_OK;
    for (int n = 0; n < b->vector_count && result == AG_OK; n++) {
        struct prt_compressed rows[PRT_METHODS];
        result = measure_methods(b, c, b->vectors[n], rows);
        if (result == AG_OK && n == 0) print_error_heading(c, &rows[0]);
        for (int m = 0; m < PRT_METHODS && result == AG_OK; m++) {
            print_error_row(&rows[m]);
            write_error_row(file, scene, c, &rows[m]);
            curves->kilobytes[m][n] = 1e-3 * rows[m].bytes;
            curves->log_error[m][n] = log10(rows[m].error);
        }
    }
    return result;
}

static enum ag_result draw_errors(const struct prt_bench *b, const struct prt_compression *c,
                                  const char *scene, const struct error_curves *curves)
{
    char note[BENCH_TEXT], title[BENCH_TEXT], file[BENCH_TEXT];
    struct plot_series series[PRT_METHODS];
    snprintf(title, sizeof title, "Error of compressed transfer %s", c->subject->name);
    snprintf(note, sizeof note, "%.60s; after Sloan et al. 2003 (Hong 2015, figure 28)",
             short_name(scene));
    snprintf(file, sizeof file, "error-%s.svg", c->subject->name);
    for (int m = 0; m < PRT_METHODS; m++)
        series[m] = (struct plot_series){ prt_methods[m], curves->kilobytes[m],
                                          curves->log_error[m], b->vector_count };
    const struct plot plot = { .title = title,
                               .note = note,
                               .x_label = "kB",
                               .y_label = "log10 of squared error over variance",
                               .series = series,
                               .series_count = PRT_METHODS };
    return draw(b, file, &plot);
}

static enum ag_result measure_subject(const struct prt_bench *b, const char *scene, FILE *file,
                                      const struct prt_subject *subject)
{
    struct error_curves curves;
    struct prt_compression c = { .view = { .bench = &b->bench },
                                 .subject = subject,
                                 .options = b->options,
                                 .texels = b->texels };
    enum ag_result result = prt_compression_open(&c, scene);
    if (result == AG_OK) result = measure_sizes(b, &c, scene, file, &curves);
    if (result == AG_OK) result = draw_errors(b, &c, scene, &curves);
    prt_compression_close(&c);
    return result;
}

static enum ag_result measure_errors(const struct prt_bench *b, const char *scene)
{
    char path[PATH_SIZE];
    enum ag_result result = AG_OK;
    FILE *file = open_table(b, "error.csv",
                            "scene,of,texels,numbers,method,clusters,vectors,bytes,"
                            "uncompressed_bytes,squared_error,flip,surface_flip,compression_s",
                            path);
    if (!file) return AG_ERROR_FILE;
    for (int s = 0; s < PRT_SUBJECTS && result == AG_OK; s++)
        if (is_wanted(b, prt_subjects[s].name))
            result = measure_subject(b, scene, file, &prt_subjects[s]);
    if (!csv_close(file, path)) return AG_ERROR_FILE;
    return result;
}

// ---- times against texels

static void print_times_heading(const struct prt_bench *b)
{
    printf("\nms, medians of %d frames, %d x %d, light that turns\n%-8s %-14s", b->bench.frames,
           b->bench.width, b->bench.height, "texels", "");
    for (int p = 0; p < PRT_PASSES; p++) printf(" %9s", prt_passes[p]);
    printf(" %9s\n", "MB");
}

static void print_times(const struct prt_times *t)
{
    for (int v = 0; v < PRT_VARIANTS; v++) {
        printf("%-8.0f %-14s", t->points, prt_variants[v].name);
        for (int p = 0; p < PRT_PASSES; p++) printf(" %9.3f", t->pass_ms[v][p]);
        printf(" %9.2f\n", 1e-6 * (double)t->bytes[v]);
    }
    fflush(stdout);
}

static void write_times(FILE *file, const char *scene, const struct prt_times *t)
{
    for (int v = 0; v < PRT_VARIANTS; v++) {
        csv_text(file, scene);
        fprintf(file, "%d,%.0f,%s,%s", t->texels, t->points,
                prt_variants[v].glossy ? "true" : "false", prt_variants[v].compression);
        for (int p = 0; p < PRT_PASSES; p++) fprintf(file, ",%.4f", t->pass_ms[v][p]);
        fprintf(file, ",%llu\n", (unsigned long long)t->bytes[v]);
    }
    fflush(file);
}

// Passes whose time depends on the number of texels.
static const struct time_curve {
    const char *name;
    int variant;
    enum prt_pass pass;
} TIME_CURVES[] = { { "light", 2, PASS_LIGHT },
                    { "light, cpca", 3, PASS_LIGHT },
                    { "reflect", 2, PASS_REFLECT },
                    { "reflect, cpca", 3, PASS_REFLECT },
                    { "light_map", 2, PASS_LIGHT_MAP } };
enum { TIME_CURVE_COUNT = sizeof TIME_CURVES / sizeof *TIME_CURVES };

static enum ag_result draw_times(const struct prt_bench *b, const char *scene,
                                 const struct prt_times times[MOST_SIZES])
{
    char note[BENCH_TEXT];
    double points[MOST_SIZES], ms[TIME_CURVE_COUNT][MOST_SIZES];
    struct plot_series series[TIME_CURVE_COUNT];
    for (int i = 0; i < b->point_count; i++) {
        points[i] = 1e-3 * times[i].points;
        for (int k = 0; k < TIME_CURVE_COUNT; k++)
            ms[k][i] = times[i].pass_ms[TIME_CURVES[k].variant][TIME_CURVES[k].pass];
    }
    for (int k = 0; k < TIME_CURVE_COUNT; k++)
        series[k] = (struct plot_series){ TIME_CURVES[k].name, points, ms[k], b->point_count };
    snprintf(note, sizeof note, "%.60s; 25 coefficients, glossy; %.60s", short_name(scene),
             b->bench.info.name);
    return draw(b, "passes.svg",
                &(struct plot){ .title = "Passes of prt in light that turns",
                                .note = note,
                                .x_label = "texels, thousands",
                                .y_label = "ms",
                                .series = series,
                                .series_count = TIME_CURVE_COUNT });
}

static enum ag_result measure_points(const struct prt_bench *b, const char *scene, FILE *file)
{
    struct prt_times times[MOST_SIZES];
    struct prt_view view = { .bench = &b->bench };
    enum ag_result result = prt_view_open(&view, scene, true);
    print_times_heading(b);
    for (int i = 0; i < b->point_count && result == AG_OK; i++) {
        times[i] = (struct prt_times){ .texels = b->points[i] };
        result = prt_times_measure(&view, b->options, &times[i]);
        if (result != AG_OK) break;
        print_times(&times[i]);
        write_times(file, scene, &times[i]);
    }
    prt_view_close(&view);
    return result == AG_OK && b->point_count > 1 ? draw_times(b, scene, times) : result;
}

static enum ag_result measure_passes(const struct prt_bench *b, const char *scene)
{
    char path[PATH_SIZE];
    FILE *file = open_table(b, "passes.csv",
                            "scene,texels_option,texels,glossy,compression,rows_ms,light_ms,"
                            "light_map_ms,reflect_ms,apply_ms,bytes",
                            path);
    if (!file) return AG_ERROR_FILE;
    const enum ag_result result = measure_points(b, scene, file);
    if (!csv_close(file, path)) return AG_ERROR_FILE;
    return result;
}

// ---- command line

static enum ag_result measure_scene(void *user, const char *name)
{
    const struct prt_bench *b = user;
    enum ag_result result = AG_OK;
    if (is_wanted(b, "vectors") || is_wanted(b, "matrices")) result = measure_errors(b, name);
    if (result == AG_OK && is_wanted(b, "passes")) result = measure_passes(b, name);
    return result;
}

static void print_header(void *user)
{
    const struct prt_bench *b = user;
    printf("%s; %s\n", short_name(b->bench.scenes.names[0]), b->bench.info.name);
}

// The software driver reads it when the device is created.
static bool set_threads(const char *value)
{
    int threads;
    return parse_int(value, 1, 256, &threads) && setenv("LP_NUM_THREADS", value, 1) == 0;
}

static bool is_part(const char *name)
{
    return strcmp(name, "vectors") == 0 || strcmp(name, "matrices") == 0 ||
           strcmp(name, "passes") == 0;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct prt_bench *b = user;
    if (strcmp(name, "--threads") == 0) return set_threads(value);
    if (strcmp(name, "--texels") == 0) return parse_int(value, 64, 1048576, &b->texels);
    if (strcmp(name, "--clusters") == 0) return parse_int(value, 1, 4096, &b->clusters);
    if (strcmp(name, "--vectors") == 0)
        return append_int(value, 1, 32, b->vectors, &b->vector_count, MOST_SIZES);
    if (strcmp(name, "--points") == 0)
        return append_int(value, 64, 1048576, b->points, &b->point_count, MOST_SIZES);
    if (strcmp(name, "--only") == 0 && is_part(value))
        b->only = value;
    else if (strcmp(name, "--options") == 0)
        b->options = value;
    else if (strcmp(name, "--out") == 0)
        b->out = value;
    else
        return false;
    return true;
}

static const char *default_scene(void)
{
    static char path[PATH_SIZE];
    const char *folder = getenv("AFTERGLOW_SCENES");
    struct stat info;
    snprintf(path, sizeof path, "%s/%s", folder && folder[0] ? folder : "../shared/scenes", BUNNY);
    return stat(path, &info) == 0 ? path : BUILT_IN;
}

static bool set_defaults(void *user)
{
    static const int vectors[] = { 8, 12, 16, 20, 24 },
                     points[] = { 2048, 8192, 16384, 32768, 65536 };
    struct prt_bench *b = user;
    struct bench_scenes *scenes = &b->bench.scenes;
    if (scenes->count == 0) scenes->names[scenes->count++] = default_scene();
    if (b->vector_count == 0)
        for (int i = 0; i < 5; i++) b->vectors[b->vector_count++] = vectors[i];
    if (b->point_count == 0)
        for (int i = 0; i < 5; i++) b->points[b->point_count++] = points[i];
    mkdir(b->out, 0777); // csv_open reports an error
    return scenes->count == 1;
}

static const char HELP[] =
    "\n"
    "Error against bytes of vq, pca and cpca as in Sloan, Hall, Hart & Snyder 2003, and times of "
    "the\n"
    "passes of prt, for one scene: the bunny of $AFTERGLOW_SCENES or ../shared/scenes, else\n"
    "@cornell:ceiling=false.\n"
    "\n"
    "  --only PART          vectors or matrices: error against bytes; passes: times against "
    "texels\n"
    "  --vectors N          of cpca, 8 times at most; 8, 12, 16, 20, 24\n"
    "  --clusters N         of cpca; their bytes are a third of those of weights, of matrices as "
    "many\n"
    "  --texels N           of error; 16384\n"
    "  --points N           texels of passes, 8 times at most; 2048, 8192, 16384, 32768, 65536\n"
    "  --options KEY=VALUE  more options of prt, as rays=64: faster bakes, more noise\n"
    "  --threads N          of the software driver\n"
    "  --size WxH           pixels; 640x360\n"
    "  --frames N           each time is the median of N frames; 60\n"
    "  --out DIR            folder of CSV files and plots; paper-prt\n"
    "\n"
    "Bakes are kept in the cache of afterglow. For times of an idle machine:\n"
    "\n"
    "  chrt -f 10 build/release/bench/paper-prt\n"
    "  build/release/bench/paper-prt --texels 2048 --vectors 8 --points 2048 "
    "@cornell:ceiling=false\n";

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "paper-prt",
        .usage = "[--only vectors|matrices|passes] [--vectors N]... [--clusters N] [--texels N]\n"
                 "    [--points N]... [--options KEY=VALUE,...] [--threads N] [--out DIR]",
        .help = HELP,
        .options = BENCH_SCENES | BENCH_SIZE,
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .print_header = print_header,
        .measure_scene = measure_scene,
    };
    static struct prt_bench b = { .bench = { .width = 640, .height = 360, .frames = 60 },
                                  .out = "paper-prt",
                                  .texels = 16384 };
    return bench_main(&program, &b.bench, &b, argc, argv);
}
