#include "cli/view/view_random.h"

#include "cli/view/cheap_bakes.h"

#include <afterglow/afterglow.h>

#include <stdbool.h>
#include <string.h>

enum { SPEC_SIZE = 4096, MOST_OPTIONS = 4 };

struct writer {
    const struct view_random *desc;
    FILE *out;
    uint64_t state;
    int width, height; // of the window
};

static uint32_t draw(struct writer *w, uint32_t below)
{
    w->state = w->state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(w->state >> 33) % below;
}

static double between(struct writer *w, double least, double most)
{
    return least + (most - least) * (double)draw(w, 1 << 20) / (1 << 20);
}

#define CHOOSE(w, list) (list)[draw(w, sizeof(list) / sizeof *(list))]

// ---- methods

// Options that take much time at their ends, and the greatest value here.
static const struct {
    const char *name;
    double most;
} costly[] = {
    { "dim", 24 },     { "resolution", 32 }, { "steps", 12 },       { "rays", 64 },
    { "cascades", 2 }, { "cones", 16 },      { "delta_rays", 256 }, { "map_size", 64 },
    { "parts", 4 },    { "bounces", 16 },    { "samples", 16 },
};

static double most_of(const struct ag_option_info *option)
{
    for (size_t i = 0; i < sizeof costly / sizeof *costly; i++)
        if (strcmp(costly[i].name, option->name) == 0 && costly[i].most < option->max)
            return costly[i].most;
    return option->max;
}

static void draw_choice(struct writer *w, const struct ag_option_info *option, char *out,
                        size_t size)
{
    int bars = 0;
    const char *at = option->unit;
    for (const char *c = at; *c; c++) bars += *c == '|';
    for (uint32_t skip = draw(w, (uint32_t)bars + 1); skip > 0; skip--) at = strchr(at, '|') + 1;
    snprintf(out, size, "%.*s", (int)strcspn(at, "|"), at);
}

static void draw_value(struct writer *w, const struct ag_option_info *option, char *out,
                       size_t size)
{
    static const char *const wrong[] = { "-1", "1e30", "nan", "", "x", "99999999999" };
    if (draw(w, 25) == 0) {
        snprintf(out, size, "%s", CHOOSE(w, wrong));
    } else if (strcmp(option->type, "bool") == 0) {
        snprintf(out, size, "%s", draw(w, 2) ? "true" : "false");
    } else if (strcmp(option->type, "choice") == 0) {
        draw_choice(w, option, out, size);
    } else if (strcmp(option->type, "text") == 0) {
        snprintf(out, size, "missing.json");
    } else {
        const double most = most_of(option), value = draw(w, 4)   ? between(w, option->min, most)
                                                     : draw(w, 2) ? option->min
                                                                  : most;
        if (strcmp(option->type, "int") == 0)
            snprintf(out, size, "%d", (int)value);
        else
            snprintf(out, size, "%.6g", value);
    }
}

static void add_technique(struct writer *w, int technique, char spec[SPEC_SIZE])
{
    struct ag_technique_info info;
    struct ag_option_info option;
    ag_technique_get(technique, &info);
    const char *bake = cheap_bake(info.name);
    size_t used = strlen(spec);
    used += (size_t)snprintf(spec + used, SPEC_SIZE - used, "%s%s%s%s", used ? "+" : "", info.name,
                             bake ? ":" : "", bake ? bake : "");
    bool first = !bake;
    const uint32_t count = info.option_count > 0 ? draw(w, MOST_OPTIONS + 1) : 0;
    for (uint32_t i = 0; i < count; i++) {
        char value[64];
        if (!ag_technique_option_get(technique, (int)draw(w, (uint32_t)info.option_count),
                                     &option) ||
            strcmp(option.effect, "rebake") == 0)
            continue;
        draw_value(w, &option, value, sizeof value);
        used += (size_t)snprintf(spec + used, SPEC_SIZE - used, "%c%s=%s", first ? ':' : ',',
                                 option.name, value);
        first = false;
    }
}

static int draw_technique(struct writer *w, const char *role)
{
    struct ag_technique_info info;
    uint32_t count = 0;
    for (int i = 0; ag_technique_get(i, &info); i++) count += strcmp(info.role, role) == 0;
    uint32_t left = draw(w, count);
    for (int i = 0; ag_technique_get(i, &info); i++)
        if (strcmp(info.role, role) == 0 && left-- == 0) return i;
    return 0;
}

// A delta technique changes the light of a source with probes.
static void draw_gi(struct writer *w, char spec[SPEC_SIZE])
{
    const bool delta = draw(w, 6) == 0;
    snprintf(spec, SPEC_SIZE, "%s", delta ? "lpv:dim=8,cascades=1" : "");
    if (!delta || draw(w, 8) == 0) add_technique(w, draw_technique(w, "source"), spec);
    if (delta) add_technique(w, draw_technique(w, "delta"), spec);
    if (draw(w, 3) == 0) add_technique(w, draw_technique(w, "visibility"), spec);
    if (draw(w, 4) == 0) add_technique(w, draw_technique(w, "reflection"), spec);
}

static void write_gi(struct writer *w)
{
    char spec[SPEC_SIZE];
    draw_gi(w, spec);
    fprintf(w->out, "try gi %s\n%s %u\n", spec, draw(w, 2) ? "settle" : "wait", 1 + draw(w, 40));
}

static void write_split(struct writer *w)
{
    static const char *const parts[] = { "off", "reference", "ambient", "none+gtao", "x" };
    char spec[SPEC_SIZE];
    draw_gi(w, spec);
    fprintf(w->out, "try split %s\nwait %u\n", draw(w, 3) ? CHOOSE(w, parts) : spec, draw(w, 6));
    if (draw(w, 2)) fprintf(w->out, "side %s\n", draw(w, 2) ? "on" : "off");
}

// ---- mouse and keys

static void write_mouse(struct writer *w)
{
    const int x = (int)draw(w, (uint32_t)w->width + 20) - 10;
    const int y = (int)draw(w, (uint32_t)w->height + 20) - 10;
    fprintf(w->out, "mouse %d %d\n", x, y);
}

static void write_drag(struct writer *w)
{
    static const char *const buttons[] = { "left", "left", "left", "right", "middle" };
    const char *button = CHOOSE(w, buttons);
    write_mouse(w);
    fprintf(w->out, "wait 1\nbutton %s down\nwait 1\n", button);
    for (uint32_t i = draw(w, 4); i > 0; i--) {
        write_mouse(w);
        fprintf(w->out, "wait %u\n", draw(w, 3));
    }
    if (draw(w, 10)) fprintf(w->out, "button %s up\n", button);
}

static void write_click(struct writer *w)
{
    static const char *const labels[] = {
        "Undo",
        "Redo",
        "sun",
        "point",
        "spot",
        "on",
        "Sky",
        "Surface",
        "Passes",
        "Memory",
        "Save image",
        "Save session",
        "Load session",
        "Save as CSV",
        "Add this view",
        "x",
        "go",
        "Cancel bake",
        "for experts",
        "debug view",
        "source",
        "delta",
        "visibility",
        "reflection",
        "with",
        "side by side",
        "Copy as command",
        "show the difference",
        "show the blocks",
        "probes as balls",
        "texels on surfaces",
        "Painted light",
        "paint with the left button",
        "Clear paint",
        "base color",
        "roughness",
        "position (m)",
    };
    fprintf(w->out, "try click %s\nwait %u\n", CHOOSE(w, labels), draw(w, 3));
}

static void write_keys(struct writer *w)
{
    static const char *const names[] = { "w",    "a",   "s",    "d",     "q",         "e",
                                         "f",    "tab", "z",    "y",     "enter",     "space",
                                         "home", "f12", "down", "up",    "backspace", "escape",
                                         "left", "end", "v",    "delete" };
    const bool control = draw(w, 4) == 0;
    if (control) fprintf(w->out, "key control down\n");
    if (draw(w, 3) == 0)
        fprintf(w->out, "key %s %s\n", CHOOSE(w, names), draw(w, 2) ? "down" : "up");
    else
        fprintf(w->out, "press %s\n", CHOOSE(w, names));
    if (control) fprintf(w->out, "key control up\n");
    if (draw(w, 6) == 0) fprintf(w->out, "text %x.%d\n", draw(w, 4096), (int)draw(w, 99) - 50);
    if (draw(w, 4) == 0)
        fprintf(w->out, "scroll %d %d\n", (int)draw(w, 5) - 2, (int)draw(w, 9) - 4);
}

static void write_size(struct writer *w)
{
    static const int sizes[][2] = { { 1, 1 },     { 1400, 1 },  { 1, 700 },   { 2000, 90 },
                                    { 361, 240 }, { 320, 240 }, { 640, 480 }, { 370, 2 } };
    const uint32_t i = draw(w, 2 * sizeof sizes / sizeof *sizes);
    const bool listed = i < sizeof sizes / sizeof *sizes;
    w->width = listed ? sizes[i][0] : 300 + (int)draw(w, 600);
    w->height = listed ? sizes[i][1] : 100 + (int)draw(w, 500);
    fprintf(w->out, "size %dx%d\nwait %u\n", w->width, w->height, draw(w, 4));
}

// ---- the view

static void write_view(struct writer *w)
{
    static const char *const exposures[] = { "auto", "auto", "9", "-3", "1e30", "-1e30", "nan" };
    static const char *const layers[] = { "color",      "direct", "indirect",
                                          "irradiance", "albedo", "visibility",
                                          "normal",     "depth",  "x" };
    static const char *const looks[] = { "0,0,0 0,0,0",    "0,2,9 0,2,0",    "0,9,0 0,0,0",
                                         "1e30,0,0 0,0,0", "0,0,0 0,-5,0",   "1,2,3",
                                         "nan,0,0 1,1,1",  "2,1,4 -1e6,0,3", "0.1,1,0 0,1,0" };
    static const char *const scales[] = { "0.1", "0.1", "0.15", "0.3", "0.2", "5", "nan" };
    static const char *const cameras[] = { "given", "near", "far", "default", "x" };
    switch (draw(w, 5)) {
    case 0:
        fprintf(w->out, "exposure %s\n", CHOOSE(w, exposures));
        break;
    case 1:
        fprintf(w->out, "try layer %s\n", CHOOSE(w, layers));
        break;
    case 2:
        fprintf(w->out, "try look %s\n", CHOOSE(w, looks));
        break;
    case 3:
        fprintf(w->out, "try scale %s\n", CHOOSE(w, scales));
        break;
    default:
        fprintf(w->out, "try camera %s\n", CHOOSE(w, cameras));
        break;
    }
    fprintf(w->out, "wait %u\n", draw(w, 4));
}

static void write_scene(struct writer *w)
{
    static const char *const handles[] = { "x", "y", "z", "turn" };
    switch (draw(w, 4)) {
    case 0:
        fprintf(w->out, "try light %d %u\n", (int)draw(w, 4) - 1, draw(w, 2));
        break;
    case 1:
        fprintf(w->out, "tab Light\nchoose light %d\n", (int)draw(w, 4) - 1);
        break;
    default:
        fprintf(w->out, "tab Inspect\nchoose instance %d\n", (int)draw(w, 12) - 1);
        break;
    }
    fprintf(w->out, "wait 1\ntry drag %s %d %d\nwait %u\n", CHOOSE(w, handles),
            (int)draw(w, 300) - 150, (int)draw(w, 300) - 150, draw(w, 3));
}

static void write_paint(struct writer *w)
{
    fprintf(w->out,
            "try gi %s\nsettle 60\ntab Light\ntry click Painted light\nwait 2\n"
            "try click paint with the left button\nwait 2\n",
            draw(w, 2) ? "radiosity:texels=2048,rays=16,sources=8"
                       : "ort:texels=64,rays=16,offsets=50,local=1");
    for (int i = 0; i < 2; i++) write_drag(w);
}

static void write_path(struct writer *w)
{
    static const char *const lines[] = { "path add", "path add", "path every 0.05 20",
                                         "path every 1e9 1", "path record missing/flight" };
    if (draw(w, 3))
        fprintf(w->out, "try %s\n", CHOOSE(w, lines));
    else
        fprintf(w->out, "path every 0.02 20\ntry path record flight\n");
}

static void write_file(struct writer *w)
{
    static const char *const lines[] = {
        "save a.png",
        "save a.exr",
        "save missing/a.png",
        "screenshot b.png",
        "session write a.json",
        "session read a.json",
        "session read wrong.json",
        "drop a.json",
        "drop wrong.json",
        "drop missing.glb",
        "open missing.glb",
        "errors errors.json",
        "pace pace.json",
        "inspect pixel.json",
        "command command.sh",
        "memory memory.json",
        "undo",
        "redo",
        "undo",
    };
    fprintf(w->out, "try %s\nwait %u\n", CHOOSE(w, lines), draw(w, 3));
}

static void write_open(struct writer *w)
{
    fprintf(w->out, "open %s\nwait %u\n", draw(w, 2) ? w->desc->other_scene : w->desc->scene,
            1 + draw(w, 10));
}

static void write_random(struct writer *w)
{
    static const char *const tabs[] = { "View", "Light", "Compare", "Cost", "Inspect" };
    fprintf(w->out, "tab %s\nrandom %u %u\n", CHOOSE(w, tabs), draw(w, 1 << 20), draw(w, 30));
}

// ---- the script

static void write_command(struct writer *w)
{
    static void (*const commands[])(struct writer *) = {
        write_gi,   write_gi,    write_gi,    write_split, write_mouse, write_drag,
        write_drag, write_click, write_click, write_keys,  write_keys,  write_size,
        write_size, write_view,  write_view,  write_scene, write_scene, write_paint,
        write_path, write_file,  write_file,  write_file,  write_open,  write_random,
    };
    static const char *const tabs[] = { "View", "Light", "Method", "Compare", "Cost", "Inspect" };
    if (draw(w, 6) == 0) fprintf(w->out, "tab %s\n", CHOOSE(w, tabs));
    CHOOSE(w, commands)(w);
}

void view_random_write(const struct view_random *desc, FILE *out)
{
    struct writer w = { desc, out, desc->seed * 0x9e3779b97f4a7c15u + 1, 480, 320 };
    for (int i = 0; i < desc->lines; i++) write_command(&w);
    fprintf(out,
            "button left up\nbutton right up\nbutton middle up\nmouse -1 -1\nwait 2\n"
            "size 480x320\nwait 2\nside off\nsplit off\ngi %s\nopen %s\nwait 2\n"
            "gi %s\nsettle\n",
            desc->gi, desc->scene, desc->gi);
}
