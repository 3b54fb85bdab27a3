// Modular radiance transfer (Loos 2015, chapters 3 and 4): the scene is a level of blocks, shapes
// of a precomputed dictionary. Each frame computes direct light at the texels of the blocks' walls,
// carries it in reduced bases within each block (b) and through openings into others (r),
// reconstructs indirect light in a light map, and looks that up at each pixel. Bounces are diffuse;
// lights may move.
#include "techniques/mrt/mrt.h"

#include "techniques/common/light_map/columns.h"
#include "techniques/mrt/mrt_state.h"

#include <stddef.h>
#include <string.h>

#define OPTION(...)       OPTION_ROW(struct mrt_options, __VA_ARGS__)
#define MRT_HAS_REMAINDER true
static const struct option_row option_rows[] = {
#include "techniques/mrt/mrt_options.def"
};
#undef MRT_HAS_REMAINDER
#undef OPTION

#define OPTION(...) OPTION_ROW(struct mrt_options, __VA_ARGS__)
#define MRT_GPU_ONLY
#define MRT_HAS_REMAINDER false
static const struct option_row drt_option_rows[] = {
#include "techniques/mrt/mrt_options.def"
#include "techniques/mrt/drt_options.def"
};
#undef MRT_HAS_REMAINDER
#undef MRT_GPU_ONLY
#undef OPTION

static const struct technique_debug_view debug_views[] = {
    { "blocks", "the block map over the scene: a colour for each block, squares for texels", NULL },
    { "direct", "radiosity of the texels that indirect light comes from", NULL },
    { PROBES_VIEW, PROBES_VIEW_HELP, NULL },
    { NULL, NULL, NULL },
};

static const struct technique_preset presets[] = {
    { "low", "bounces=1,feedback=true,vector=false,texels=6,modes=12,response_modes=12" },
    { "medium", "" },
    { "high", "bounces=16,precision=float,modes=48,lightfield_modes=192" },
    { NULL, NULL },
};

static struct mrt_dictionary_options dictionary_options(const struct mrt_options *options)
{
    struct mrt_dictionary_options out;
#define OPTION(type, name, ...) out.name = options->name;
#include "techniques/mrt/dictionary/dictionary_options.def"
#undef OPTION
    return out;
}

static bool check(const char *name, const struct technique_create *how)
{
    const struct mrt_options *options = how->options;
    if (options->modes > 4 * options->prior_modes)
        return host_fail(how->host, FAIL_ARGUMENT, "gi %s: modes=%d exceeds the modes of the prior",
                         name, (int)options->modes);
    if (options->blocks.at[0] && options->map != MRT_MAP_SCENE)
        return host_fail(how->host, FAIL_ARGUMENT,
                         "gi %s: map and blocks=%s are two maps; leave out one of them", name,
                         options->blocks.at);
    return true;
}

static bool mrt_check(const struct technique_create *how)
{
    return check("mrt", how);
}

static bool drt_check(const struct technique_create *how)
{
    return check("drt", how);
}

static char *mrt_block_map(struct host *host, const struct scene_pose *pose, const void *options)
{
    const struct technique_create how = { .host = host, .options = options };
    return mrt_check(&how) ? mrt_map_json(host, options, false, pose) : NULL;
}

static char *drt_block_map(struct host *host, const struct scene_pose *pose, const void *options)
{
    const struct technique_create how = { .host = host, .options = options };
    return drt_check(&how) ? mrt_map_json(host, options, true, pose) : NULL;
}

static char *mrt_read_block_map(struct host *host, const char *json)
{
    struct mrt_block_map map;
    if (!mrt_block_map_parse(host, "block map", json, strlen(json), &map)) return NULL;
    char *copy = mrt_block_map_json(host, &map);
    mrt_block_map_finish(&map);
    return copy;
}

static bool mrt_bake(struct bake_plan *plan, const struct technique_bake *how)
{
    const struct mrt_dictionary_options options = dictionary_options(how->options);
    return mrt_dictionary_bake(plan, &options, how->full_report);
}

static bool mrt_bake_report(struct report *report, struct bake *bake,
                            const struct technique_bake *how)
{
    const struct mrt_dictionary_options options = dictionary_options(how->options);
    return mrt_dictionary_report(report, bake, &options);
}

static void objects(bool delta, int view, uint32_t width, uint32_t height, struct gpu_objects *out)
{
    const size_t base = offsetof(struct mrt, lists) + (size_t)view * sizeof(struct mrt_pixel_lists);
    const size_t bytes = width > 0 ? mrt_list_bytes(width, height) : 0;
#define LIST(thing)                                                                                \
    { GPU_BUFFER,      #thing,         offsetof(struct mrt_pixel_lists, thing),                    \
      .of_view = true, .bytes = bytes, .usage = GPU_BUFFER_INDIRECT }
    GPU_ADD(out, base, LIST(amid), LIST(several));
    if (delta) GPU_ADD(out, base, LIST(clutter));
}

static void mrt_objects(const void *options, int view, uint32_t width, uint32_t height,
                        struct gpu_objects *out)
{
    (void)options;
    objects(false, view, width, height, out);
}

static void drt_objects(const void *options, int view, uint32_t width, uint32_t height,
                        struct gpu_objects *out)
{
    (void)options;
    objects(true, view, width, height, out);
}

static bool mrt_create(void *state, const struct technique_create *how)
{
    struct mrt *mrt = state;
    mrt->host = how->host;
    mrt->gpu = how->gpu;
    if (how->pose) mrt->materials = how->pose->scene->revisions.materials;
    mrt->pose = how->pose;
    return !how->pose || mrt_make_map(mrt, how->pose);
}

static uint32_t mrt_more_needs(const void *options)
{
    return ((const struct mrt_options *)options)->specular ? FRAME_WRITES_SPECULAR : 0;
}

// Pixels find their clutter by their triangle.
static uint32_t drt_more_needs(const void *options)
{
    const struct mrt_options *o = options;
    const bool gathers = o->gather && o->reflection && o->vector;
    return mrt_more_needs(options) | (gathers ? FRAME_NEEDS_ID : 0);
}

static bool drt_create(void *state, const struct technique_create *how)
{
    struct mrt *mrt = state;
    mrt->delta = true;
    return mrt_create(state, how) && (!how->pose || mrt_update_init(mrt, how->pose));
}

static bool mrt_load(void *state, const struct tensors *bake)
{
    struct mrt *mrt = state;
    const struct mrt_dictionary_options options = dictionary_options(&mrt->options);
    const bool ok = mrt_dictionary_init(mrt->host, bake, &options, &mrt->dictionary) &&
                    (mrt_make_level(mrt) || mrt_update_pass_on(mrt));
    mrt->pose = NULL;
    return ok;
}

static void mrt_set_options(void *state, const void *options)
{
    (void)options;
    ((struct mrt *)state)->kept.known = false;
}

static void mrt_invalidate(void *state, uint32_t changes)
{
    struct mrt *mrt = state;
    if (changes & CHANGED_OPTIONS) mrt->lit = false;
    if (changes & ~(uint32_t)CHANGED_CAMERA) mrt->kept.known = false;
}

// The light map shows the light of a frame since which nothing has changed. Feedback converges over
// frames.
static bool is_complete(const struct mrt *mrt)
{
    const struct mrt_host_solver *cpu = &mrt->host_solver;
    if (mrt->options.feedback) return false;
    return mrt->options.solver == MRT_SOLVER_GPU || (cpu->solved && cpu->newest >= mrt->kept.since);
}

// Whether this frame has the light of the one before.
static bool is_kept(struct mrt *mrt, const struct frame_view *view)
{
    kept_update(&mrt->kept, view, view->light_hash);
    const bool kept = view->keep && mrt->kept.same && is_complete(mrt);
    if (mrt->kept.follows || mrt->options.solver == MRT_SOLVER_GPU) return kept;
    mrt_host_solver_forget(&mrt->host_solver);
    mrt->lit = false;
    return kept;
}

// The weight of the last frame's irradiance in this frame's first bounce.
static float first_feedback(const struct mrt *mrt, const struct frame_view *view)
{
    if (!mrt->options.feedback || !mrt->lit) return 0.0f;
    return view->constants->previous_scale_ratio;
}

// Feedback gathers all bounces over some frames.
static float rest_of(const struct mrt *mrt)
{
    return mrt->options.remainder && !mrt->options.feedback ? mrt->runtime.rest : 1.0f;
}

// Feedback begins with more bounces while no light has accumulated: in the first frame, and with
// new operators.
static int bounces_of(const struct mrt *mrt, bool has_light)
{
    enum { FIRST = 16 };
    return mrt->options.bounces + (mrt->options.feedback && !has_light ? FIRST : 0);
}

static bool record_host_solution(struct mrt *mrt, struct gpu_cmd *cmd,
                                 const struct frame_view *view)
{
    return mrt_host_solver_record(&mrt->host_solver, cmd,
                                  &(struct mrt_host_frame){
                                      .index = view->index,
                                      .direct = mrt_buffer(&mrt->runtime, "mrt_direct"),
                                      .irradiance = mrt_buffer(&mrt->runtime, "mrt_irradiance"),
                                      .radiosity = mrt_buffer(&mrt->runtime, "mrt_radiosity"),
                                      .bounces = bounces_of(mrt, mrt->host_solver.solved),
                                      .feedback = mrt->options.feedback,
                                      .rest = rest_of(mrt),
                                      .radiance_scale = view->constants->radiance_scale,
                                  });
}

static void record_bounces(struct mrt *mrt, struct gpu_cmd *cmd, const struct frame_view *view)
{
    mrt_record_bounces(&mrt->runtime, cmd,
                       &(struct mrt_bounces){
                           .count = bounces_of(mrt, mrt->lit),
                           .feedback = first_feedback(mrt, view),
                           .rest = rest_of(mrt),
                       });
}

// Until the CPU's first result arrives the GPU solves.
static void record_solution(struct mrt *mrt, struct gpu_cmd *cmd, const struct frame_view *view)
{
    if (mrt->options.solver == MRT_SOLVER_CPU && record_host_solution(mrt, cmd, view))
        mrt_record_coefficients(&mrt->runtime, cmd);
    else
        record_bounces(mrt, cmd, view);
}

static void mrt_follow(void *state, const struct scene_pose *pose, bool wait)
{
    struct mrt *mrt = state;
    if (mrt_update_follow_materials(mrt, pose, wait)) return;
    if (!mrt->update.warned_failure)
        host_log(mrt->host, LOG_WARNING,
                 "mrt: materials changed, but indirect light keeps the former ones: out of memory");
    mrt->update.warned_failure = true;
}

static void drt_follow(void *state, const struct scene_pose *pose, bool wait)
{
    mrt_update_follow(state, pose, wait);
}

static bool mrt_is_updating(const void *state)
{
    return ((const struct mrt *)state)->update.state != MRT_IDLE;
}

static void mrt_update(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct mrt *mrt = state;
    if (mrt->map.count == 0) return;
    if (mrt_update_record(mrt, cmd)) mrt->lit = mrt->kept.known = false;
    if (!is_kept(mrt, view)) {
        mrt_record_direct(&mrt->runtime, cmd, view, mrt->options.emitters);
        // Light of the CPU is that of another frame.
        if (mrt->options.bright && mrt->options.solver == MRT_SOLVER_GPU)
            mrt_record_bright(&mrt->runtime, cmd);
        record_solution(mrt, cmd, view);
        mrt_record_light_map(&mrt->runtime, cmd);
        mrt_record_outdoors(&mrt->runtime, cmd, view);
        mrt_record_probes(&mrt->runtime, cmd, view, mrt->options.gain);
    }
    mrt->lit = true;
}

static void mrt_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct mrt *mrt = state;
    if (mrt->map.count == 0)
        light_map_clear_pixels(cmd, view);
    else
        mrt_record_apply(&mrt->runtime, cmd, view, &mrt->lists[view->number], mrt->options.gain);
}

static void mrt_debug_view(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                           const char *name, gpu_image out)
{
    struct mrt *mrt = state;
    if (mrt->map.count == 0)
        gpu_clear_image(cmd, out, (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
    else
        mrt_record_debug(&mrt->runtime, cmd, view,
                         strcmp(name, "blocks") == 0 ? MRT_VIEW_BLOCKS : MRT_VIEW_DIRECT, out);
}

static bool mrt_probes(void *state, struct probe_volume *out)
{
    const struct mrt *mrt = state;
    if (!mrt->options.probes) return false;
    *out = (struct probe_volume){ .image = mrt->runtime.probes.volume,
                                  .grid = mrt->runtime.probes.grid,
                                  .depth = mrt->probe_depth };
    return true;
}

static void mrt_destroy(void *state)
{
    struct mrt *mrt = state;
    if (!mrt->host) return;
    mrt_update_finish(mrt);
    mrt_host_solver_finish(&mrt->host_solver);
    mrt_runtime_finish(&mrt->runtime);
    mrt_level_finish(&mrt->level);
    mrt_dictionary_finish(mrt->host, &mrt->dictionary);
    mrt_parts_finish(&mrt->parts);
    mrt_published_finish(&mrt->published);
    gpu_image_destroy(mrt->gpu, &mrt->probe_depth);
    mrt_atlas_finish(&mrt->atlas);
    mrt_block_map_finish(&mrt->map);
}

static uint64_t estimate(const struct mrt_options *o, bool has_clutter)
{
    return mrt_runtime_bytes(&(struct mrt_runtime_size){
        .resolution = mrt_face_texels((enum mrt_maze)o->maze, o->texels),
        .tube = o->maze == MRT_TUNNEL,
        .has_clutter = has_clutter,
        .k_b = o->modes,
        .k_r = o->response_modes,
        .probes = o->block_probes,
        .options = mrt_runtime_options_of(o),
    });
}

// The scene may have no room.
static uint64_t mrt_memory_estimate(const void *options)
{
    const struct mrt_options *o = options;
    const bool may_be_open = o->map != MRT_MAP_SINGLE && !o->blocks.at[0];
    return estimate(o, false) + (may_be_open ? mrt_outdoors_bytes() : 0);
}

static uint64_t drt_memory_estimate(const void *options)
{
    return estimate(options, true);
}

// Capabilities of both; drt can also follow objects.
enum {
    MRT_CAN = CAN_MOVE_LIGHTS | NEEDS_BAKE | MAKES_SPECULAR | PUBLISHES_PROBES | GATHERS_EMISSION
};
#define MRT_TECHNIQUE(of_name, of_title, of_paper, rows)                                           \
    .name = of_name, .title = of_title, .paper = of_paper, .role = ROLE_SOURCE,                    \
    .needs = FRAME_WRITES_IRRADIANCE | FRAME_LIGHT_EVOLVES, .bake_version = 7,                     \
    .options = OPTION_TABLE(struct mrt_options, rows, NULL), .presets = presets,                   \
    .debug_views = debug_views, .state_size = sizeof(struct mrt), .resolve = mrt_resolve_maze,     \
    .read_block_map = mrt_read_block_map, .bake = mrt_bake, .bake_report = mrt_bake_report,        \
    .load = mrt_load, .set_options = mrt_set_options, .invalidate = mrt_invalidate,                \
    .is_updating = mrt_is_updating, .update = mrt_update, .record = mrt_record,                    \
    .debug_view = mrt_debug_view, .probes = mrt_probes, .destroy = mrt_destroy

const struct technique technique_mrt = {
    MRT_TECHNIQUE("mrt", "modular radiance transfer",
                  "Loos 2015, Modular Radiance Transfer, ch. 3 and 4", option_rows),
    .capabilities = MRT_CAN | KEEPS_GEOMETRY,
    .more_needs = mrt_more_needs,
    .check = mrt_check,
    .objects = mrt_objects,
    .block_map = mrt_block_map,
    .create = mrt_create,
    .follow = mrt_follow,
    .memory_estimate = mrt_memory_estimate,
};

const struct technique technique_drt = {
    MRT_TECHNIQUE("drt", "delta radiance transfer", "Loos 2015, Modular Radiance Transfer, ch. 5",
                  drt_option_rows),
    .capabilities = MRT_CAN | CAN_MOVE_GEOMETRY,
    .folder = "mrt",
    .bake_name = "mrt",
    .more_needs = drt_more_needs,
    .check = drt_check,
    .objects = drt_objects,
    .block_map = drt_block_map,
    .create = drt_create,
    .follow = drt_follow,
    .memory_estimate = drt_memory_estimate,
};
