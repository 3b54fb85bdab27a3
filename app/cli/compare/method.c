// Renders and times one method and reads its layers.
#include "compare.h"
#include "cli/bake/baking.h"
#include "cli/files/json.h"
#include "cli/statistics.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const usual_methods[] = { "none", "ambient", "lpv" };

// ---- checks of the command line

static void renderer_desc(const struct comparison *c, int index, struct ag_renderer_desc *desc)
{
    const struct arguments *a = c->arguments;
    ag_renderer_desc_default(desc);
    desc->width = a->width;
    desc->height = a->height;
    desc->gi = c->methods[index].gi;
    desc->frame_options = arguments_frame_options(a);
    desc->indirect_layer = true;
    desc->display_layer = false;
    desc->scene_size_m = session_scene_size_m(&c->session);
}

// "2-lpv-steps-8": unique, and safe in file systems and URLs.
static void name_files(struct method *method, int number)
{
    int used = snprintf(method->stem, STEM_SIZE, "%d", number);
    bool gap = true;
    for (const char *c = method->gi; *c && used < STEM_SIZE - 2; c++) {
        bool plain = isalnum((unsigned char)*c) != 0 || *c == '.';
        if (plain && gap) method->stem[used++] = '-';
        if (plain) method->stem[used++] = *c;
        gap = !plain;
    }
    method->stem[used] = 0;
}

static enum status estimate_memory(struct comparison *c, int method)
{
    struct ag_renderer_desc desc;
    uint64_t bytes;
    renderer_desc(c, method, &desc);
    enum ag_result result =
        ag_renderer_estimate_memory(c->session.context, &desc, c->arguments->light_count, &bytes);
    if (result != AG_OK) return fail_library(c->session.context, result);
    if (bytes > c->gpu_bytes) c->gpu_bytes = bytes;
    if (c->session.scene)
        detail("%s at %dx%d takes at most %.1f MB on the GPU, without the scene", desc.gi,
               desc.width, desc.height, (double)bytes * 1e-6);
    return DONE;
}

enum status methods_estimate(struct comparison *c)
{
    enum status status = DONE;
    for (int i = 0; i < c->method_count && status == DONE; i++) status = estimate_memory(c, i);
    return status;
}

enum status methods_plan(struct comparison *c)
{
    const struct arguments *a = c->arguments;
    const char *const *gis = a->method_count > 0 ? a->methods : usual_methods;
    c->method_count = a->method_count > 0 ? a->method_count : 3;
    for (int i = 0; i < c->method_count; i++) {
        c->methods[i].gi = gis[i];
        name_files(&c->methods[i], i + 1);
    }
    return methods_estimate(c); // fails early
}

// ---- frames

struct rendering {
    struct comparison *c;
    struct method *method;
    struct ag_renderer *renderer;
    struct bakes bakes;
    struct statistics statistics;
};

static void frame_desc(const struct comparison *c, struct ag_frame_desc *desc)
{
    ag_frame_desc_default(desc);
    desc->camera = c->camera;
    desc->time_s = c->arguments->time_s;
    desc->animation = c->session.animation;
    desc->auto_exposure = false; // images are exposed later
}

// The first frame includes one-time work, so it is not measured if there are others.
static enum status render_frame(struct rendering *r, int index)
{
    struct comparison *c = r->c;
    struct ag_frame_desc desc;
    frame_desc(c, &desc);
    desc.camera_cut = index == 0;
    enum ag_result result = ag_renderer_render(r->renderer, &desc);
    if (result != AG_OK) return fail_library(c->session.context, result);
    bool counts = index > 0 || c->arguments->frames == 1;
    if (counts && !statistics_add(&r->statistics, r->renderer))
        return fail("cannot measure %s: out of memory", r->method->gi);
    result = ag_renderer_wait(r->renderer);
    return result == AG_OK ? DONE : fail_library(c->session.context, result);
}

static enum status render_frames(struct rendering *r)
{
    char what[STEM_SIZE + 16];
    int frames = r->c->arguments->frames;
    enum status status = DONE;
    snprintf(what, sizeof what, "rendering %.*s", STEM_SIZE, r->method->gi);
    for (int i = 0; i < frames && status == DONE; i++) {
        progress(what, i, frames);
        status = render_frame(r, i);
    }
    progress_end();
    return status;
}

// ---- results

static enum status take_layers(struct rendering *r)
{
    struct method *m = r->method;
    enum ag_result result = ag_renderer_read(r->renderer, "color", &m->color);
    if (result == AG_OK) result = ag_renderer_read(r->renderer, "indirect", &m->indirect);
    if (result == AG_OK) result = ag_renderer_read(r->renderer, "irradiance", &m->irradiance);
    if (result == AG_OK && !r->c->depth)
        result = ag_renderer_read(r->renderer, "depth", &r->c->depth);
    if (result == AG_OK && !r->c->direct)
        result = ag_renderer_read(r->renderer, "direct", &r->c->direct);
    return result == AG_OK ? DONE : fail_library(r->c->session.context, result);
}

static enum status take_costs(struct rendering *r)
{
    struct method *m = r->method;
    m->spelled = strdup(ag_renderer_gi(r->renderer));
    m->options = statistics_options(r->renderer);
    m->passes = statistics_passes(&r->statistics);
    m->frame_ms = statistics_frame(&r->statistics);
    m->memory = statistics_memory(r->renderer);
    if (r->bakes.count > 0)
        m->bake = json_pack("{s:o, s:I, s:b}", "seconds", json_double(r->bakes.seconds), "bytes",
                            (json_int_t)r->bakes.bytes, "cached", r->bakes.loaded);
    bool ok = m->spelled && m->options && m->passes && m->frame_ms && m->memory;
    return ok ? DONE : fail("cannot measure %s: out of memory", m->gi);
}

static enum status create(struct rendering *r, int index)
{
    struct comparison *c = r->c;
    struct ag_renderer_desc desc;
    enum status status = bakes_prepare(&r->bakes, &c->session, c->methods[index].gi);
    if (status != DONE) return status;
    renderer_desc(c, index, &desc);
    desc.bakes = r->bakes.bakes;
    desc.bake_count = r->bakes.count;
    enum ag_result result = ag_renderer_create(c->device, c->session.scene, &desc, &r->renderer);
    if (result == AG_OK) return DONE;
    fail_library(c->session.context, result);
    return FAILED; // an unsupported scene or device is not wrong usage
}

enum status method_render(struct comparison *c, int index)
{
    struct rendering *r = calloc(1, sizeof *r);
    if (!r) return fail("cannot render %s: out of memory", c->methods[index].gi);
    r->c = c;
    r->method = &c->methods[index];
    enum status status = create(r, index);
    if (status == DONE) status = render_frames(r);
    if (status == DONE) status = take_layers(r);
    if (status == DONE) status = take_costs(r);
    statistics_finish(&r->statistics);
    ag_renderer_destroy(r->renderer);
    bakes_finish(&r->bakes);
    free(r);
    return status;
}

void methods_finish(struct comparison *c)
{
    ag_image_destroy(c->session.context, c->depth);
    ag_image_destroy(c->session.context, c->direct);
    ag_image_destroy(c->session.context, c->direct_error_image);
    for (int i = 0; i < c->method_count; i++) {
        struct method *m = &c->methods[i];
        ag_image_destroy(c->session.context, m->color);
        ag_image_destroy(c->session.context, m->indirect);
        ag_image_destroy(c->session.context, m->irradiance);
        free(m->spelled);
        json_decref(m->options);
        json_decref(m->passes);
        json_decref(m->frame_ms);
        json_decref(m->memory);
        json_decref(m->bake);
    }
}
