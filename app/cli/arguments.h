// The parsed command line.
#pragma once

#include "cli/bake/team.h"
#include "cli/terminal/messages.h"
#include "environment.h"
#include "values.h"

#include <afterglow/image.h>
#include <afterglow/scene.h>

enum command_bit {
    RENDER = 1,
    INFO = 2,
    LIST = 4,
    DIFF = 8,
    REFERENCE = 16,
    COMPARE = 32,
    BAKE = 64,
    CACHE = 128,
    VIEW = 256
};
// In the order of ag_difference.
#define METRIC_NAMES "mae mse relmse ssim flip flip_hdr"
// In the order of ag_tonemap.
#define TONEMAP_NAMES "neutral agx linear"
// In the order of ag_metering.
#define METERING_NAMES "mean highlights"
// In the order of the bits of enum ag_lightmap_format.
#define LIGHTMAP_FORMAT_NAMES "exr ktx2 png"
enum { COMMAND_SIZE = 16384, FRAME_OPTIONS_SIZE = 2048 };
enum { MAX_LIGHTS = 64, MAX_POSITIONAL = 64, MAX_METHODS = 16, MAX_BAKE_FILES = 8 };

struct arguments {
    const char *positional[MAX_POSITIONAL]; // SCENE, A and B, or parts to merge
    int positional_count;
    bool help, json, quiet, verbose;
    char *const *words; // after the command
    int word_count;
    const struct team *team; // not of the command line: processes that run it together, or NULL
    // image
    const char *gi, *frame_options;
    bool has_gi, follow_links, has_scene_scale;
    float scene_scale; // metres per unit of the scene's file
    int width, height, frames;
    int frame_samples;  // jittered frames whose mean is written: --antialias of render; 1: none
    const char *output; // NULL: from the scene's name
    const char *aov, *debug_view, *stats, *device;
    uint64_t seed;
    bool has_exposure;
    float exposure_ev;
    const char *rule; // the value of --exposure where it is no number; NULL: none
    enum ag_metering metering;
    const char *curve; // the value of --tonemap; NULL: none
    enum ag_tonemap tonemap;
    char display_options[FRAME_OPTIONS_SIZE]; // see arguments_frame_options
    // time and camera
    const char *camera, *animation;
    bool has_eye, has_target, has_fov;
    float eye[3], target[3];
    double fov_deg, time_s, time_step_s;
    // light
    struct light_value lights[MAX_LIGHTS];
    const char *light_texts[MAX_LIGHTS]; // as given
    int light_count;
    bool no_scene_lights, has_sky;
    const char *environment; // as given; NULL: none
    struct environment_value environment_value;
    float sky[3];
    // reference
    int spp, bounces;
    double spp_noise; // of --spp auto:noise=PERCENT, 0…1; 0: none
    bool has_spp, direct_only, indirect_only, no_guiding, antialias, resume;
    float obscurance_radius_m, occlusion_decay_per_m;
    bool obscurance_sphere;
    // bakes
    const char *bake_files[MAX_BAKE_FILES]; // each a --bake
    int bake_file_count;
    bool no_bake, force, merge, report_full, all_objects, update;
    int threads;               // 0: all cores
    int shard, shard_count;    // count 0: everything
    long long max_memory_mib;  // 0: no limit
    const char *report;        // NULL: none
    const char *lightmap;      // a folder; NULL: none
    unsigned lightmap_formats; // enum ag_lightmap_format; 0: all
    int page;                  // side of pages of the light map, texels; 0: one page of any size
    const char *probes;        // a folder; NULL: none
    const char *exported;      // likewise
    bool denoise;
    bool clear;         // cache
    const char *blocks; // info: a file; NULL: none
    bool all;           // list
    // compare
    const char *methods[MAX_METHODS]; // each a --gi
    int method_count;
    const char *reference; // an EXR; NULL: traced
    bool no_cache;
    double max_flip, max_relmse, max_ms; // below 0: no bound
    // view
    const char *split, *script, *session, *screenshot; // NULL: none
    float scale;                                       // of the image; 0: chosen by the device
    // diff
    const char *layer, *map;
    enum ag_difference metric; // of the map
    char mask_layer[64];       // "": none
    double mask_threshold;
    bool ignore_nan;
};

struct command {
    const char *name;
    enum command_bit bit;
    int positional_count; // required ones
    int optional_count;   // and as many more
    const char *usage;    // "SCENE [options]"
    const char *summary;  // one line
    const char *text;     // description in --help
    const char *examples;
    enum status (*run)(const struct arguments *arguments);
};

// Parses the words after the command name; reports wrong usage on standard error.
enum status arguments_parse(const struct command *command, int count, char **words,
                            struct arguments *out);
// Options of the frame, with the tone curve: for a renderer. Valid as long as `arguments`.
const char *arguments_frame_options(const struct arguments *arguments);
// The command line, quoted for a POSIX shell and cut where it is longer.
void arguments_command(const char *command, const struct arguments *arguments, char *out,
                       size_t size);
