// Table 1 of P. Sunshine-Hill and P. Faloutsos, "Photorealistic Lighting with Offset Radiance
// Transfer Mapping", 2006: bins, seconds of the bake and times of the passes for light maps of
// several sizes and numbers of offsets, with errors; and times against the number of lights.
//
//     paper-ort [--only table|lights] [--side N]… [--offsets N]… [--options …]
//     [--beside SPEC] [--out DIR] [--spp N] [--image-width N] [--threads N] [--frames N] [SCENE]
//
// Writes table-1.csv, lights.csv, error.svg and gathers.svg. The lights are counted as changed in
// each frame (keep_maps=false), so that each gathers.
#include "paper_ort/measure.h"

#include "csv.h"
#include "plot.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum {
    PATH_SIZE = 1024,
    MOST_SIDES = 3,
    MOST_OFFSETS = 8,
    LIGHT_COUNTS = 3,
    DEFAULT_OFFSETS = 200
};

static const char HEAD[] = "head-lee-perry-smith.glb", BUILT_IN[] = "@cornell";
// A frame uses 64 punctual lights at most.
static const int LIGHTS[LIGHT_COUNTS] = { 1, 10, 64 };

static const struct paper {
    int side, offsets, bins, seconds;
    double frames_per_s;
} PAPER[] = {
    { 256, 50, 3, 22, 30.08 },   { 256, 100, 6, 28, 15.04 },  { 256, 200, 10, 42, 8.59 },
    { 256, 400, 19, 57, 1.96 },  { 384, 100, 13, 36, 7.52 },  { 384, 200, 24, 107, 1.43 },
    { 512, 100, 22, 197, 1.72 }, { 512, 200, 43, 226, 1.01 },
};
enum { PAPER_ROWS = sizeof PAPER / sizeof *PAPER };

struct ort_bench {
    struct bench bench;
    const char *only, *options, *beside, *out;
    int spp, threads;
    int sides[MOST_SIDES], side_count;
    int offsets[MOST_OFFSETS], offset_count;
};

// By side and by number of offsets; of the default order and precision, and of bytes.
struct curves {
    double offsets[MOST_OFFSETS];
    double l2[MOST_SIDES][MOST_OFFSETS], beside_l2[MOST_OFFSETS];
    double gathers[2][MOST_SIDES][MOST_OFFSETS];
};

static double gathers_per_s(const struct ort_result *result)
{
    return 1e3 / result->stage_ms[STAGE_GATHER];
}

static const struct paper *find_paper(const struct ort_setting *setting)
{
    for (int i = 0; i < PAPER_ROWS; i++)
        if (PAPER[i].side == setting->map.side && PAPER[i].offsets == setting->offsets)
            return &PAPER[i];
    return NULL;
}

// ---- table 1

static void print_heading(const struct map_size *map)
{
    printf("\n%d²: texels=%d has a light map of %d x %d, %d texels on surfaces\n", map->side,
           map->texels_option, map->width, map->height, map->texels);
    printf("%7s %6s %4s %5s %6s %8s %8s", "offsets", "order", "", "bins", "paper", "bake, s",
           "cpu, s");
    for (int s = 0; s < ORT_STAGES; s++) printf(" %9s", ort_stages[s]);
    printf(" %9s %8s %8s %8s %8s %8s %8s\n", "gathers/s", "of read", "of copy", "l2", "relmse",
           "flip", "energy");
}

static void print_error(const struct ort_error *error)
{
    printf(" %8.4f %8.4f %8.4f %8.4f\n", error->l2, error->relmse, error->flip, error->energy);
}

static void print_row(const struct ort_setting *setting, int v)
{
    const struct ort_result *r = &setting->results[v];
    const double gather_ms = r->stage_ms[STAGE_GATHER];
    const struct paper *paper = find_paper(setting);
    char bins[16] = "-";
    if (paper) snprintf(bins, sizeof bins, "%d", paper->bins);
    printf("%7d %6s %4s %5d %6s %8.1f %8.1f", setting->offsets, ort_variants[v].order,
           ort_variants[v].precision, r->bins, bins, setting->bake_s, setting->processor_s);
    for (int s = 0; s < ORT_STAGES; s++) printf(" %9.3f", r->stage_ms[s]);
    printf(" %9.1f %8.2f %8.2f", gathers_per_s(r), gather_ms / r->copy.read_ms,
           gather_ms / r->copy.copy_ms);
    print_error(&r->error);
}

// Nothing for NaN.
static void write_number(FILE *file, double value, int decimals)
{
    if (isnan(value))
        fputc(',', file);
    else
        fprintf(file, "%.*f,", decimals, value);
}

static void write_row(FILE *file, const char *scene, const struct ort_setting *setting, int v)
{
    const struct ort_result *r = &setting->results[v];
    const struct map_size *map = &setting->map;
    const struct paper *paper = find_paper(setting);
    csv_text(file, scene);
    fprintf(file, "%d,%d,%d,%d,%d,%d,%s,%s,%d,%llu,%llu,", map->side, map->texels_option,
            map->width, map->height, map->texels, setting->offsets, ort_variants[v].order,
            ort_variants[v].precision, r->bins, (unsigned long long)r->map_bytes,
            (unsigned long long)r->bytes);
    write_number(file, setting->bake_s, 2);
    write_number(file, setting->processor_s, 2);
    for (int s = 0; s < ORT_STAGES; s++) write_number(file, r->stage_ms[s], 4);
    write_number(file, gathers_per_s(r), 2);
    write_number(file, r->copy.read_ms, 4);
    write_number(file, r->copy.copy_ms, 4);
    write_number(file, r->error.l2, 6);
    write_number(file, r->error.relmse, 6);
    write_number(file, r->error.flip, 6);
    write_number(file, r->error.energy, 5);
    if (paper)
        fprintf(file, "%d,%d,%.2f\n", paper->bins, paper->seconds, paper->frames_per_s);
    else
        fputs(",,\n", file);
}

static void add_to_curves(struct curves *curves, const struct ort_setting *setting, int side, int n)
{
    curves->offsets[n] = setting->offsets;
    curves->l2[side][n] = setting->results[0].error.l2;
    for (int p = 0; p < 2; p++) curves->gathers[p][side][n] = gathers_per_s(&setting->results[p]);
}

static enum ag_result measure_side(const struct ort_bench *b, const struct ort_view *view,
                                   const char *scene, FILE *file, int side, struct curves *curves)
{
    struct map_size map;
    enum ag_result result = map_size_find(view->scene, b->options, b->sides[side], &map);
    if (result == AG_OK) print_heading(&map);
    for (int n = 0; n < b->offset_count && result == AG_OK; n++) {
        struct ort_setting setting = { .map = map, .offsets = b->offsets[n] };
        result = ort_setting_measure(view, &setting);
        if (result != AG_OK) break;
        for (int v = 0; v < ORT_VARIANTS; v++) {
            print_row(&setting, v);
            write_row(file, scene, &setting, v);
        }
        fflush(stdout);
        fflush(file);
        add_to_curves(curves, &setting, side, n);
    }
    return result;
}

static bool draw(const struct ort_bench *b, const char *name, const struct plot *plot)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", b->out, name);
    if (plot_write(path, plot)) return true;
    fprintf(stderr, "paper-ort: %s: %s\n", path, strerror(errno));
    return false;
}

static bool draw_curves(const struct ort_bench *b, const char *scene, const struct curves *c)
{
    char note[BENCH_TEXT], names[2 * MOST_SIDES][32];
    const char *slash = strrchr(scene, '/');
    struct plot_series error[MOST_SIDES + 1], gathers[2 * MOST_SIDES];
    snprintf(note, sizeof note, "%.60s; after Sunshine-Hill & Faloutsos 2006, table 1; %.60s",
             slash ? slash + 1 : scene, b->bench.info.name);
    for (int s = 0; s < b->side_count; s++) {
        snprintf(names[s], sizeof *names, "%d²", b->sides[s]);
        snprintf(names[b->side_count + s], sizeof *names, "%d², byte", b->sides[s]);
        error[s] = (struct plot_series){ names[s], c->offsets, c->l2[s], b->offset_count };
        for (int p = 0; p < 2; p++)
            gathers[p * b->side_count + s] =
                (struct plot_series){ names[p * b->side_count + s], c->offsets, c->gathers[p][s],
                                      b->offset_count };
    }
    error[b->side_count] =
        (struct plot_series){ b->beside, c->offsets, c->beside_l2, b->offset_count };
    const struct plot errors = { .title = "Error of indirect irradiance by offsets",
                                 .note = note,
                                 .x_label = "number of offsets",
                                 .y_label = "relative L2 error",
                                 .series = error,
                                 .series_count = b->side_count + 1 };
    const struct plot rates = { .title = "Gathers per second by offsets",
                                .note = note,
                                .x_label = "number of offsets",
                                .y_label = "gathers per second",
                                .series = gathers,
                                .series_count = 2 * b->side_count };
    return (b->spp == 0 || draw(b, "error.svg", &errors)) && draw(b, "gathers.svg", &rates);
}

static FILE *open_table(const struct ort_bench *b, const char *name, const char *header,
                        char path[PATH_SIZE])
{
    FILE *file = NULL;
    snprintf(path, PATH_SIZE, "%s/%s", b->out, name);
    return csv_open(path, header, &file) ? file : NULL;
}

// The error of other techniques in the same image, which has normal maps and noise.
static enum ag_result measure_beside(const struct ort_bench *b, const struct ort_view *view,
                                     struct curves *curves)
{
    struct ort_error error;
    if (b->spp == 0) return AG_OK;
    const enum ag_result result = ort_error_of(view, b->beside, &error);
    if (result != AG_OK) return result;
    printf("\n%s: l2, relmse, flip, energy", b->beside);
    print_error(&error);
    for (int n = 0; n < b->offset_count; n++) curves->beside_l2[n] = error.l2;
    return AG_OK;
}

static enum ag_result measure_table(const struct ort_bench *b, const char *scene)
{
    static struct curves curves;
    char path[PATH_SIZE];
    struct ort_view view = { .bench = &b->bench, .options = b->options, .threads = b->threads };
    FILE *file = open_table(
        b, "table-1.csv",
        "scene,side,texels_option,width,height,texels,offsets,order,precision,bins,"
        "map_bytes,bytes,bake_s,processor_s,direct_ms,spread_ms,prefilter_ms,gather_ms,finish_ms,"
        "light_map_ms,gathers_per_s,read_ms,copy_ms,l2,relmse,flip,energy,paper_bins,"
        "paper_s,paper_frames_per_s",
        path);
    if (!file) return AG_ERROR_FILE;
    enum ag_result result = ort_view_open(&view, scene, b->spp);
    if (result == AG_OK) result = measure_beside(b, &view, &curves);
    for (int s = 0; s < b->side_count && result == AG_OK; s++)
        result = measure_side(b, &view, scene, file, s, &curves);
    ort_view_close(&view);
    if (!csv_close(file, path)) return AG_ERROR_FILE;
    if (result == AG_OK && b->offset_count > 1 && !draw_curves(b, scene, &curves))
        result = AG_ERROR_FILE;
    return result;
}

// ---- lights

static enum ag_result measure_counts(const struct ort_bench *b, const struct ort_view *view,
                                     const char *scene, FILE *file)
{
    struct ort_setting setting = { .offsets = DEFAULT_OFFSETS };
    enum ag_result result = map_size_find(view->scene, b->options, b->sides[0], &setting.map);
    if (result != AG_OK) return result;
    printf("\nlights, %d², %d offsets\n%6s", b->sides[0], DEFAULT_OFFSETS, "");
    for (int s = 0; s < ORT_STAGES; s++) printf(" %9s", ort_stages[s]);
    putchar('\n');
    for (int i = 0; i < LIGHT_COUNTS && result == AG_OK; i++) {
        double stage_ms[ORT_STAGES];
        result = ort_lights_measure(view, &setting, LIGHTS[i], stage_ms);
        if (result != AG_OK) break;
        csv_text(file, scene);
        fprintf(file, "%d,%d,%d", b->sides[0], DEFAULT_OFFSETS, LIGHTS[i]);
        printf("%6d", LIGHTS[i]);
        for (int s = 0; s < ORT_STAGES; s++) {
            fprintf(file, ",%.4f", stage_ms[s]);
            printf(" %9.3f", stage_ms[s]);
        }
        fputc('\n', file);
        putchar('\n');
        fflush(stdout);
    }
    return result;
}

static enum ag_result measure_lights(const struct ort_bench *b, const char *scene)
{
    char path[PATH_SIZE];
    struct ort_view view = { .bench = &b->bench, .options = b->options };
    FILE *file =
        open_table(b, "lights.csv",
                   "scene,side,offsets,lights,direct_ms,spread_ms,prefilter_ms,gather_ms,finish_ms,"
                   "light_map_ms",
                   path);
    if (!file) return AG_ERROR_FILE;
    enum ag_result result = ort_view_open(&view, scene, 0);
    if (result == AG_OK) result = measure_counts(b, &view, scene, file);
    ort_view_close(&view);
    if (!csv_close(file, path)) return AG_ERROR_FILE;
    return result;
}

// ---- command line

static enum ag_result measure_scene(void *user, const char *name)
{
    const struct ort_bench *b = user;
    enum ag_result result = AG_OK;
    if (!b->only || strcmp(b->only, "table") == 0) result = measure_table(b, name);
    if (result == AG_OK && (!b->only || strcmp(b->only, "lights") == 0))
        result = measure_lights(b, name);
    return result;
}

static void print_header(void *user)
{
    const struct ort_bench *b = user;
    printf("%s; ms, least of %d frames; %d threads read and copy; errors at %dx%d, %d samples\n",
           b->bench.info.name, b->bench.frames, b->threads, b->bench.width, b->bench.height,
           b->spp);
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct ort_bench *b = user;
    if (strcmp(name, "--spp") == 0) return parse_int(value, 0, 1000000, &b->spp);
    if (strcmp(name, "--threads") == 0) return parse_int(value, 1, 256, &b->threads);
    if (strcmp(name, "--image-width") == 0) return parse_int(value, 16, 8192, &b->bench.width);
    if (strcmp(name, "--side") == 0)
        return append_int(value, 16, 1024, b->sides, &b->side_count, MOST_SIDES);
    if (strcmp(name, "--offsets") == 0)
        return append_int(value, 50, 4096, b->offsets, &b->offset_count, MOST_OFFSETS);
    if (strcmp(name, "--only") == 0 &&
        (strcmp(value, "table") == 0 || strcmp(value, "lights") == 0))
        b->only = value;
    else if (strcmp(name, "--options") == 0)
        b->options = value;
    else if (strcmp(name, "--beside") == 0)
        b->beside = value;
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
    snprintf(path, sizeof path, "%s/%s", folder && folder[0] ? folder : "../shared/scenes", HEAD);
    return stat(path, &info) == 0 ? path : BUILT_IN;
}

static bool set_defaults(void *user)
{
    static const int sides[MOST_SIDES] = { 256, 384, 512 }, offsets[] = { 50, 100, 200, 400 };
    struct ort_bench *b = user;
    struct bench_scenes *scenes = &b->bench.scenes;
    if (scenes->count == 0) scenes->names[scenes->count++] = default_scene();
    if (b->side_count == 0)
        for (int i = 0; i < MOST_SIDES; i++) b->sides[b->side_count++] = sides[i];
    if (b->offset_count == 0)
        for (int i = 0; i < 4; i++) b->offsets[b->offset_count++] = offsets[i];
    b->bench.height = b->bench.width * 9 / 16;
    mkdir(b->out, 0777); // csv_open reports an error
    return scenes->count == 1;
}

static const char HELP[] =
    "\n"
    "Repeats table 1 of Sunshine-Hill & Faloutsos 2006 for one scene: the head of\n"
    "$AFTERGLOW_SCENES or ../shared/scenes, else @cornell.\n"
    "\n"
    "  --only table|lights  one part: table 1 with errors, or times against the number of lights\n"
    "  --side N             light map of about N x N texels, 3 times at most; 256, 384, 512\n"
    "  --offsets N          transfer maps, 8 times at most; 50, 100, 200, 400\n"
    "  --options KEY=VALUE  more options of ort, as rays=64: faster bakes, more noise\n"
    "  --beside SPEC        a GI spec whose error is printed too; radiosity\n"
    "  --spp N              samples of the reference, 0: times alone; 256\n"
    "  --image-width N      pixels of frames and reference, 16:9; 640\n"
    "  --threads N          of reading and copying; LP_NUM_THREADS, else all processors\n"
    "  --frames N           each time is the least of N frames; 20\n"
    "  --out DIR            folder of table-1.csv, lights.csv, error.svg, gathers.svg; paper-ort\n"
    "\n"
    "Bakes are kept in the cache of afterglow, about 1.3 GB for the head; their processor time is\n"
    "that of a run, not of a load. For times of an idle machine:\n"
    "\n"
    "  chrt -f 10 build/release/bench/paper-ort\n"
    "  build/release/bench/paper-ort --side 128 --offsets 50 --offsets 100 --spp 32 @cornell\n";

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "paper-ort",
        .usage = "[--only table|lights] [--side N]... [--offsets N]... [--options KEY=VALUE,...]\n"
                 "    [--beside SPEC] [--out DIR] [--spp N] [--image-width N] [--threads N]",
        .help = HELP,
        .options = BENCH_SCENES,
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .print_header = print_header,
        .measure_scene = measure_scene,
    };
    static struct ort_bench b = { .bench = { .width = 640, .frames = 20 },
                                  .beside = "radiosity",
                                  .out = "paper-ort",
                                  .spp = 256 };
    b.threads = copy_threads();
    return bench_main(&program, &b.bench, &b, argc, argv);
}
