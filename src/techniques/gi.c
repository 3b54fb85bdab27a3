// A GI stack: creation, frames, resizing, debug views, destruction.
#include "techniques/gi_state.h"

#include "techniques/gi_spec.h"
#include "techniques/registry.h"

#include <stdio.h>
#include <string.h>

enum { LIST_SIZE = 512 };

// Around the functions of a technique: objects and passes are named "technique.thing".
static const struct technique *enter(const struct gi *gi, int term)
{
    gpu_owner_push(gi->gpu, gi->spec.technique[term]->name);
    return gi->spec.technique[term];
}

static void leave(const struct gi *gi)
{
    gpu_owner_pop(gi->gpu);
}

static bool check_term(const struct gi *gi, const struct technique *technique,
                       const struct tensors *bake, const struct technique_create *how)
{
    if (technique->bake_version != 0 && !bake)
        return host_fail(gi->host, FAIL_ARGUMENT, "cannot create %s: it needs a bake",
                         technique->name);
    return !technique->check || technique->check(how);
}

// The common state gets the further views, too.
static bool add_views(const struct gi *gi, const struct technique *technique, const void *options,
                      void *state)
{
    for (int v = 1; v < FRAME_MAX_VIEWS; v++) {
        const struct gi_view *view = &gi->views[v];
        if (view->width > 0 &&
            !technique_resize(technique, gi->gpu, state, options, v, view->width, view->height))
            return false;
    }
    return true;
}

bool gi_create_state(const struct gi *gi, const struct technique *technique, const void *options,
                     const struct tensors *bake, const struct scene_pose *pose, int view,
                     void **state)
{
    const struct technique_create how = { .host = gi->host,
                                          .gpu = gi->gpu,
                                          .pose = pose,
                                          .options = options,
                                          .width = view ? gi->views[view].width : gi->width,
                                          .height = view ? gi->views[view].height : gi->height };
    *state = NULL;
    if (!check_term(gi, technique, bake, &how)) return false;
    if (!(*state = host_alloc(gi->host, 1, technique->state_size))) return false;
    gpu_owner_push(gi->gpu, technique->name);
    const bool ok = technique_create(technique, *state, &how) &&
                    (technique->bake_version == 0 || technique->load(*state, bake)) &&
                    (gi_is_per_view(technique) || add_views(gi, technique, options, *state));
    gpu_owner_pop(gi->gpu);
    return ok;
}

void gi_destroy_state(const struct gi *gi, const struct technique *technique, const void *options,
                      void *state)
{
    if (!state) return;
    technique_destroy(technique, gi->gpu, state, options);
    host_free(gi->host, state);
}

struct gi *gi_create_baked(struct host *host, struct gpu *gpu, const struct gi_spec *spec,
                           const struct gi_bakes *bakes, const struct scene_pose *pose,
                           uint32_t width, uint32_t height)
{
    struct gi *gi = host_alloc(host, 1, sizeof *gi);
    if (!gi) return NULL;
    gi->host = host;
    gi->gpu = gpu;
    gi->width = width;
    gi->height = height;
    if (!gi_spec_copy(&gi->spec, spec)) goto fail;
    gi_spec_fit_pose(&gi->spec, pose);
    for (int i = 0; i < gi->spec.count; i++)
        if (!gi_create_state(gi, gi->spec.technique[i], gi->spec.options[i], bakes->of_term[i],
                             pose, 0, &gi->state[i]))
            goto fail;
    return gi;
fail:
    gi_destroy(gi);
    return NULL;
}

void gi_destroy(struct gi *gi)
{
    if (!gi) return;
    for (int i = 0; i < gi->spec.count; i++) {
        gi_destroy_state(gi, gi->spec.technique[i], gi->spec.options[i], gi->state[i]);
        for (int v = 1; v < FRAME_MAX_VIEWS; v++)
            gi_destroy_state(gi, gi->spec.technique[i], gi->spec.options[i], gi->views[v].state[i]);
    }
    gpu_image_destroy(gi->gpu, &gi->debug_image);
    probe_view_destroy(&gi->probe_view, gi->gpu);
    gi_spec_finish(&gi->spec);
    host_free(gi->host, gi);
}

static bool make_debug_image(struct gi *gi)
{
    gpu_image_destroy(gi->gpu, &gi->debug_image);
    const struct gpu_image_desc desc = { .name = "gi.debug",
                                         .format = GPU_RGBA16F,
                                         .width = gi->width,
                                         .height = gi->height,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    return gpu_image_create(gi->gpu, &desc, &gi->debug_image);
}

bool gi_resize(struct gi *gi, uint32_t width, uint32_t height)
{
    gi->width = width;
    gi->height = height;
    for (int i = 0; i < gi->spec.count; i++) {
        const struct technique *technique = enter(gi, i);
        const bool ok = technique_resize(technique, gi->gpu, gi->state[i], gi->spec.options[i], 0,
                                         width, height);
        leave(gi);
        if (!ok) return false;
    }
    return !gi->debug_name || make_debug_image(gi);
}

static bool resize_term(struct gi *gi, int term, int v, const struct scene_pose *pose)
{
    const struct technique *technique = gi->spec.technique[term];
    const void *options = gi->spec.options[term];
    struct gi_view *view = &gi->views[v];
    if (!gi_is_per_view(technique))
        return technique_resize(technique, gi->gpu, gi->state[term], options, v, view->width,
                                view->height);
    if (view->state[term] && view->width > 0)
        return technique_resize(technique, gi->gpu, view->state[term], options, 0, view->width,
                                view->height);
    gi_destroy_state(gi, technique, options, view->state[term]);
    view->state[term] = NULL;
    return view->width == 0 ||
           gi_create_state(gi, technique, options, NULL, pose, v, &view->state[term]);
}

static void remove_view(struct gi *gi, int view, const struct scene_pose *pose)
{
    gi->views[view].width = gi->views[view].height = 0;
    for (int i = 0; i < gi->spec.count; i++) resize_term(gi, i, view, pose);
}

bool gi_resize_view(struct gi *gi, int view, const struct scene_pose *pose, uint32_t width,
                    uint32_t height)
{
    bool ok = true;
    gi->views[view].width = width;
    gi->views[view].height = height;
    for (int i = 0; ok && i < gi->spec.count; i++) {
        enter(gi, i);
        ok = resize_term(gi, i, view, pose);
        leave(gi);
    }
    if (!ok) remove_view(gi, view, pose);
    return ok;
}

// Once for each technique that cannot follow changed surfaces.
static void warn_of_change(struct gi *gi, int term)
{
    const struct technique *technique = gi->spec.technique[term];
    if (!gi->warned_fixed[term])
        host_log(gi->host, LOG_WARNING,
                 "%s: the scene's geometry%s changed, but indirect light keeps those at "
                 "the renderer's creation; lpv and vct follow them",
                 technique->name, technique->follow ? "" : " or materials");
    gi->warned_fixed[term] = true;
}

// Whether it keeps the geometry of the renderer's creation.
static bool is_fixed(const struct gi *gi, int term)
{
    const struct technique *technique = gi->spec.technique[term];
    const bool follows = technique->follow && !(technique->capabilities & KEEPS_GEOMETRY);
    return !(technique->capabilities & CAN_MOVE_GEOMETRY) && !follows;
}

bool gi_would_warn_of_movement(const struct gi *gi)
{
    for (int i = 0; i < gi->spec.count; i++)
        if (is_fixed(gi, i) && !gi->warned_fixed[i]) return true;
    return false;
}

void gi_warn_of_movement(struct gi *gi)
{
    for (int i = 0; i < gi->spec.count; i++) {
        if (!is_fixed(gi, i) || gi->warned_fixed[i]) continue;
        gi->warned_fixed[i] = true;
        host_log(gi->host, LOG_WARNING,
                 "%s: the animation moves surfaces, but indirect light keeps those of the first "
                 "pose; lpv and vct follow them",
                 gi->spec.technique[i]->name);
    }
}

void gi_invalidate(struct gi *gi, uint32_t changes)
{
    for (int i = 0; i < gi->spec.count; i++) {
        const struct technique *technique = gi->spec.technique[i];
        const uint32_t surfaces =
            CHANGED_GEOMETRY | CHANGED_MOVABLE | (technique->follow ? 0 : CHANGED_MATERIAL);
        if (changes & surfaces && is_fixed(gi, i)) warn_of_change(gi, i);
        if (!technique->invalidate) continue;
        technique->invalidate(gi->state[i], changes);
        for (int v = 1; v < FRAME_MAX_VIEWS; v++)
            if (gi->views[v].state[i]) technique->invalidate(gi->views[v].state[i], changes);
    }
}

void gi_follow(struct gi *gi, const struct scene_pose *pose, bool wait)
{
    for (int i = 0; i < gi->spec.count; i++) {
        const struct technique *technique = enter(gi, i);
        if (technique->follow) technique->follow(gi->state[i], pose, wait);
        leave(gi);
    }
}

bool gi_is_updating(const struct gi *gi)
{
    for (int i = 0; i < gi->spec.count; i++) {
        const struct technique *technique = gi->spec.technique[i];
        if (technique->is_updating && technique->is_updating(gi->state[i])) return true;
    }
    return false;
}

static bool probes_of(const struct gi *gi, int term, struct probe_volume *out)
{
    const struct technique *technique = gi->spec.technique[term];
    return technique->probes && technique->probes(gi->state[term], out);
}

static bool fail_probes(const struct gi *gi)
{
    for (int i = 0; i < gi->spec.count; i++) {
        const char *name = gi->spec.technique[i]->name;
        if (gi->spec.technique[i]->capabilities & PUBLISHES_PROBES)
            return host_fail(gi->host, FAIL_ARGUMENT, "%s publishes no probes: %s:probes=true does",
                             name, name);
    }
    return host_fail(gi->host, FAIL_ARGUMENT, "%s publishes no probes",
                     gi->spec.technique[0]->name);
}

bool gi_probes(const struct gi *gi, struct probe_volume *out)
{
    for (int i = 0; i < gi->spec.count; i++)
        if (probes_of(gi, i, out)) return true;
    return fail_probes(gi);
}

bool gi_light_map(const struct gi *gi, int *term, gpu_image *out)
{
    for (int i = 0; i < gi->spec.count; i++) {
        const struct technique *technique = gi->spec.technique[i];
        *term = i;
        if (!technique_has_light_map(technique, gi->spec.options[i])) continue;
        *out = technique->light_map(gi->state[i]);
        if (out->id) return true;
    }
    return host_fail(gi->host, FAIL_ARGUMENT, "light map: no technique of the stack has one");
}

static bool shows_probes(const struct technique *technique, const char *view)
{
    return (technique->capabilities & PUBLISHES_PROBES) && strcmp(view, PROBES_VIEW) == 0;
}

static void record_debug_view(struct gi *gi, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct probe_volume probes;
    const int term = gi->debug_term;
    const struct technique *technique = gi->spec.technique[term];
    if (!shows_probes(technique, gi->debug_name)) {
        enter(gi, term);
        technique->debug_view(gi->state[term], cmd, view, gi->debug_name, gi->debug_image);
        leave(gi);
    } else if (probes_of(gi, term, &probes)) {
        probe_view_record(&gi->probe_view, cmd, view, &probes, gi->debug_image);
    }
}

// A delta's source is the first term.
static void hand_probes(const struct gi *gi, int term)
{
    struct probe_volume probes;
    const struct technique *technique = gi->spec.technique[term];
    if (technique->set_probes && probes_of(gi, 0, &probes))
        technique->set_probes(gi->state[term], &probes);
}

static void gi_update(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct gi *gi = user;
    for (int i = 0; i < gi->spec.count; i++) {
        const struct technique *technique = enter(gi, i);
        hand_probes(gi, i);
        if (technique->update) technique->update(gi->state[i], cmd, view);
        leave(gi);
    }
}

static void record_term(struct gi *gi, int term, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct technique *technique = gi->spec.technique[term];
    void *own = gi->views[view->number].state[term];
    if (view->number == 0 || !gi_is_per_view(technique)) {
        technique->record(gi->state[term], cmd, view);
    } else if (own) {
        struct frame_view as_first = *view;
        as_first.number = 0;
        technique->record(own, cmd, &as_first);
    }
}

// Sources that write no specular layer leave that of a reflection black.
static void clear_specular(const struct gi *gi, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const int last = gi->spec.count - 1;
    uint32_t needs = 0;
    for (int i = 0; i < last; i++) needs |= gi_term_needs(&gi->spec, i);
    if (gi->spec.technique[last]->role != ROLE_REFLECTION || needs & FRAME_WRITES_SPECULAR) return;
    enter(gi, last);
    gpu_scope_begin(cmd, "clear");
    gpu_clear_image(cmd, view->layers[FRAME_SPECULAR], (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
    gpu_scope_end(cmd);
    leave(gi);
}

static void gi_record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct gi *gi = user;
    clear_specular(gi, cmd, view);
    for (int i = 0; i < gi->spec.count; i++) {
        enter(gi, i);
        record_term(gi, i, cmd, view);
        leave(gi);
    }
    if (gi->debug_name && view->number == 0) record_debug_view(gi, cmd, view);
}

struct frame_indirect gi_hook(struct gi *gi)
{
    return (struct frame_indirect){
        .update = gi_update, .record = gi_record, .user = gi, .needs = gi_spec_needs(&gi->spec)
    };
}

static const struct technique_debug_view *find_debug_view(const struct gi *gi, const char *name,
                                                          int *term)
{
    for (*term = 0; *term < gi->spec.count; ++*term) {
        const struct technique_debug_view *view =
            technique_find_view(gi->spec.technique[*term], name);
        if (view) return view;
    }
    return NULL;
}

static void warn_of_old_name(const struct gi *gi, int term, const struct technique_debug_view *view,
                             const char *name)
{
    const char *dot = strchr(name, '.');
    if (strcmp(view->name, dot ? dot + 1 : name) == 0) return;
    host_log(gi->host, LOG_WARNING,
             "%s: debug view %s is now %s; the old name will be removed in the next release",
             gi->spec.technique[term]->name, view->old_name, view->name);
}

static bool fail_no_debug_views(const struct gi *gi, const char *name)
{
    const char *owner = NULL;
    for (size_t i = 0; !owner && techniques[i]; i++)
        if (technique_find_view(techniques[i], name)) owner = techniques[i]->name;
    return host_fail(gi->host, FAIL_ARGUMENT,
                     "cannot show debug view %s: no technique of --gi has debug views%s%s", name,
                     owner ? "; try --gi " : "", owner ? owner : "");
}

static bool fail_debug_view(const struct gi *gi, const char *name)
{
    char list[LIST_SIZE] = "";
    size_t used = 0;
    for (int i = 0; i < gi->spec.count; i++) {
        const struct technique_debug_view *view = gi->spec.technique[i]->debug_views;
        for (; view && view->name && used < sizeof list - 1; view++) {
            const int written = snprintf(list + used, sizeof list - used, "%s%s.%s",
                                         used ? ", " : "", gi->spec.technique[i]->name, view->name);
            if (written > 0) used += (size_t)written;
        }
    }
    if (used)
        return host_fail(gi->host, FAIL_ARGUMENT, "unknown debug view %s: there are %s", name,
                         list);
    return fail_no_debug_views(gi, name);
}

// Creates the images and pipelines of the view.
static bool make_debug_view(struct gi *gi, const char *view, int term)
{
    struct probe_volume probes;
    if (shows_probes(gi->spec.technique[term], view)) {
        if (!probes_of(gi, term, &probes)) return fail_probes(gi);
        if (!gi->probe_view.pipeline.id && !probe_view_create(&gi->probe_view, gi->gpu))
            return false;
    }
    return gi->debug_name || make_debug_image(gi);
}

bool gi_set_debug_view(struct gi *gi, const char *name)
{
    int term = 0;
    if (!name) {
        gi->debug_name = NULL;
        gpu_image_destroy(gi->gpu, &gi->debug_image);
        return true;
    }
    const struct technique_debug_view *view = find_debug_view(gi, name, &term);
    if (!view) return fail_debug_view(gi, name);
    warn_of_old_name(gi, term, view, name);
    if (!make_debug_view(gi, view->name, term)) return false;
    gi->debug_name = view->name;
    gi->debug_term = term;
    return true;
}

gpu_image gi_debug_image(const struct gi *gi)
{
    return gi->debug_image;
}

bool gi_has_debug_view(const struct gi *gi)
{
    return gi->debug_name != NULL;
}
