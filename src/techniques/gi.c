// The life of a sum of techniques: create, frames, resize, debug views, destroy.
#include "techniques/gi.h"

#include "techniques/gi_spec.h"

#include <stdio.h>
#include <string.h>

enum { LIST_SIZE = 512 };

struct gi {
    struct host *host;
    struct gpu *gpu;
    struct gi_spec spec;
    uint32_t width, height;
    void *state[GI_MAX_TERMS];
    int debug_term;         // whose view is shown
    const char *debug_name; // NULL: none
    gpu_image debug_image;
};

static bool create_term(struct gi *gi, int i, const struct scene_pose *pose)
{
    const struct technique *technique = gi->spec.technique[i];
    const struct technique_create how = { .host = gi->host,
                                          .gpu = gi->gpu,
                                          .pose = pose,
                                          .options = gi->spec.options[i],
                                          .width = gi->width,
                                          .height = gi->height };
    if (technique->check && !technique->check(&how)) return false;
    gi->state[i] = host_alloc(gi->host, 1, technique->state_size);
    return gi->state[i] && technique->create(gi->state[i], &how);
}

struct gi *gi_create(struct host *host, struct gpu *gpu, const struct gi_spec *spec,
                     const struct scene_pose *pose, uint32_t width, uint32_t height)
{
    struct gi *gi = host_alloc(host, 1, sizeof *gi);
    if (!gi) return NULL;
    gi->host = host;
    gi->gpu = gpu;
    gi->width = width;
    gi->height = height;
    if (!gi_spec_copy(&gi->spec, spec)) goto fail;
    for (int i = 0; i < gi->spec.count; i++)
        if (!create_term(gi, i, pose)) goto fail;
    return gi;
fail:
    gi_destroy(gi);
    return NULL;
}

void gi_destroy(struct gi *gi)
{
    if (!gi) return;
    for (int i = 0; i < gi->spec.count; i++) {
        if (!gi->state[i]) continue;
        gi->spec.technique[i]->destroy(gi->state[i]);
        host_free(gi->host, gi->state[i]);
    }
    gpu_image_destroy(gi->gpu, &gi->debug_image);
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
        const struct technique *technique = gi->spec.technique[i];
        if (technique->resize && !technique->resize(gi->state[i], width, height)) return false;
    }
    return !gi->debug_name || make_debug_image(gi);
}

void gi_invalidate(struct gi *gi, uint32_t changes)
{
    for (int i = 0; i < gi->spec.count; i++)
        if (gi->spec.technique[i]->invalidate)
            gi->spec.technique[i]->invalidate(gi->state[i], changes);
}

bool gi_set_options(struct gi *gi, const struct gi_spec *spec)
{
    if (spec->count != gi->spec.count) return false;
    for (int i = 0; i < spec->count; i++) {
        const struct technique *technique = gi->spec.technique[i];
        if (spec->technique[i] != technique) return false;
        const int effect =
            option_difference(&technique->options, gi->spec.options[i], spec->options[i]);
        if (effect >= 0 && (effect > INVALIDATE || !technique->set_options)) return false;
    }
    for (int i = 0; i < spec->count; i++) {
        const struct technique *technique = gi->spec.technique[i];
        const int effect =
            option_difference(&technique->options, gi->spec.options[i], spec->options[i]);
        if (effect < 0) continue;
        memcpy(gi->spec.options[i], spec->options[i], technique->options.size);
        technique->set_options(gi->state[i], gi->spec.options[i]);
        if (effect == INVALIDATE && technique->invalidate)
            technique->invalidate(gi->state[i], CHANGED_OPTIONS);
    }
    return true;
}

static void gi_record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct gi *gi = user;
    for (int i = 0; i < gi->spec.count; i++) gi->spec.technique[i]->record(gi->state[i], cmd, view);
    if (!gi->debug_name) return;
    gi->spec.technique[gi->debug_term]->debug_view(gi->state[gi->debug_term], cmd, view,
                                                   gi->debug_name, gi->debug_image);
}

struct frame_indirect gi_hook(struct gi *gi)
{
    uint32_t needs = 0;
    for (int i = 0; i < gi->spec.count; i++) needs |= gi->spec.technique[i]->needs;
    return (struct frame_indirect){ .record = gi_record, .user = gi, .needs = needs };
}

// "view", or "technique.view" where two techniques have one of that name.
static bool is_named(const struct technique *technique, const char *view, const char *name)
{
    const size_t length = strlen(technique->name);
    if (strncmp(name, technique->name, length) == 0 && name[length] == '.') name += length + 1;
    return strcmp(view, name) == 0;
}

static bool find_debug_view(struct gi *gi, const char *name)
{
    for (int i = 0; i < gi->spec.count; i++) {
        const struct technique_debug_view *view = gi->spec.technique[i]->debug_views;
        for (; view && view->name; view++) {
            if (!is_named(gi->spec.technique[i], view->name, name)) continue;
            gi->debug_term = i;
            gi->debug_name = view->name;
            return true;
        }
    }
    return false;
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
    return host_fail(gi->host, FAIL_ARGUMENT, "unknown debug view %s: %s%s", name,
                     used ? "there are " : "there is none", list);
}

bool gi_set_debug_view(struct gi *gi, const char *name)
{
    if (!name) {
        gi->debug_name = NULL;
        gpu_image_destroy(gi->gpu, &gi->debug_image);
        return true;
    }
    const char *before = gi->debug_name;
    if (!find_debug_view(gi, name)) return fail_debug_view(gi, name);
    if (before || make_debug_image(gi)) return true;
    gi->debug_name = NULL;
    return false;
}

gpu_image gi_debug_image(const struct gi *gi)
{
    return gi->debug_image;
}
