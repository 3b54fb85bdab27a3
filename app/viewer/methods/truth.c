#include "truth.h"

#include "yielding.h"

#include "viewer/window/window.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct truth {
    const struct viewer_desc *desc;
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    atomic_int request; // number of the newest view
    atomic_bool quit;
    // under the mutex
    struct truth_view view;
    struct edits edits;
    struct ag_image offered;   // pixels NULL: none
    bool paused;               // until the next restart
    bool unmeasured;           // it is newer than the errors
    struct ag_image images[2]; // radiance and FLIP, until they are taken
    struct truth_state state;
    // the thread's own
    struct ag_context *context;
    struct ag_scene *scene;
    struct ag_reference *reference;
    struct environments environments;
    struct edits applied;
    int running; // request that the reference is of
};

// ---- the thread

static bool wanted(void *user, double done)
{
    struct truth *t = user;
    (void)done;
    return !t->quit && t->request == t->running;
}

static void fail(struct truth *t)
{
    pthread_mutex_lock(&t->mutex);
    snprintf(t->state.error, sizeof t->state.error, "%s", ag_context_last_error(t->context));
    pthread_mutex_unlock(&t->mutex);
}

static bool begin(struct truth *t)
{
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    pthread_mutex_lock(&t->mutex);
    t->running = t->request;
    desc.width = t->view.width;
    desc.height = t->view.height;
    desc.camera = t->view.camera;
    desc.time_s = t->view.time_s;
    desc.animation = t->view.animation;
    t->applied = t->edits;
    t->state.error[0] = 0;
    pthread_mutex_unlock(&t->mutex);
    ag_reference_destroy(t->reference);
    t->reference = NULL;
    const bool done = edits_apply(&t->applied, t->scene) == AG_OK &&
                      (!t->applied.environment_touched ||
                       environments_set(&t->environments, &t->applied.environment) == AG_OK) &&
                      ag_reference_create(t->scene, &desc, &t->reference) == AG_OK;
    if (!done) fail(t);
    return done;
}

// The lock is held for moments only: the interface waits for it, and this thread yields.
static struct ag_image copy_of(const struct ag_image *image)
{
    const size_t bytes = (size_t)image->width * (size_t)image->height * (size_t)image->channels *
                         sizeof *image->pixels;
    struct ag_image copy = *image;
    copy.pixels = malloc(bytes);
    if (copy.pixels) memcpy(copy.pixels, image->pixels, bytes);
    return copy;
}

static void swap(struct ag_image *a, struct ag_image *b)
{
    const struct ag_image image = *a;
    *a = *b;
    *b = image;
}

// Takes the offered image, as far as it fits; its pixels are NULL if there is none.
static struct ag_image take_offered(struct truth *t, const struct ag_image *color, float *ev)
{
    struct ag_image image = { 0 };
    pthread_mutex_lock(&t->mutex);
    *ev = t->view.ev;
    if (t->offered.width == color->width && t->offered.height == color->height)
        swap(&image, &t->offered);
    t->unmeasured = false;
    pthread_mutex_unlock(&t->mutex);
    return image;
}

// For further samples, if there is no newer one.
static void give_back(struct truth *t, struct ag_image *image)
{
    pthread_mutex_lock(&t->mutex);
    if (t->request == t->running && !t->offered.pixels) swap(image, &t->offered);
    pthread_mutex_unlock(&t->mutex);
    free(image->pixels);
}

static void report(struct truth *t, const struct ag_metrics *metrics, const struct ag_image *map)
{
    static const double weights[3] = { 0.2126, 0.7152, 0.0722 };
    struct ag_image copy = copy_of(map);
    double a = 0, b = 0;
    for (int i = 0; i < 3; i++) {
        a += weights[i] * metrics->mean_a[i];
        b += weights[i] * metrics->mean_b[i];
    }
    pthread_mutex_lock(&t->mutex);
    if (t->request == t->running && !t->unmeasured) {
        swap(&copy, &t->images[1]);
        t->state.measured = true;
        t->state.flip = metrics->flip;
        t->state.relative_error = metrics->relmse;
        t->state.energy = b > 0 ? a / b : 0.0;
    }
    pthread_mutex_unlock(&t->mutex);
    free(copy.pixels);
}

// The errors of the offered image.
static void measure(struct truth *t, const struct ag_image *color)
{
    struct ag_image *map = NULL;
    struct ag_compare_desc desc;
    struct ag_metrics metrics;
    ag_compare_desc_default(&desc);
    struct ag_image image = take_offered(t, color, &desc.ev);
    if (!image.pixels) return;
    desc.radiance = true;
    desc.ignore_not_finite = true;
    if (ag_image_metrics(t->context, &image, color, &desc, &metrics) == AG_OK &&
        ag_image_error_map(t->context, &image, color, &desc, AG_DIFFERENCE_FLIP, 0, &map) == AG_OK)
        report(t, &metrics, map);
    ag_image_destroy(t->context, map);
    give_back(t, &image);
}

static void show(struct truth *t)
{
    struct ag_reference_info info;
    struct ag_image *color = NULL;
    if (ag_reference_get_info(t->reference, &info) != AG_OK ||
        ag_reference_read(t->reference, "color", &color) != AG_OK) {
        fail(t);
        return;
    }
    struct ag_image copy = copy_of(color);
    pthread_mutex_lock(&t->mutex);
    if (t->request == t->running) {
        swap(&copy, &t->images[0]);
        t->state.samples = info.samples;
    }
    pthread_mutex_unlock(&t->mutex);
    free(copy.pixels);
    measure(t, color);
    ag_image_destroy(t->context, color);
    window_wake();
}

static bool wait_for_work(struct truth *t)
{
    pthread_mutex_lock(&t->mutex);
    while (!t->quit &&
           (t->paused || (t->request == t->running && !(t->unmeasured && t->reference))))
        pthread_cond_wait(&t->changed, &t->mutex);
    pthread_mutex_unlock(&t->mutex);
    return !t->quit;
}

// Samples double from one image to the next, up to 16 at once.
static void trace(struct truth *t)
{
    int samples = 0;
    for (int more = 1; samples < TRUTH_SAMPLES && wanted(t, 0); more = more < 16 ? 2 * more : 16) {
        const enum ag_result result = ag_reference_render(t->reference, more, wanted, t);
        if (result == AG_ERROR_CANCELLED) return;
        if (result != AG_OK) {
            fail(t);
            return;
        }
        samples += more;
        show(t);
    }
}

static void *run(void *user)
{
    struct truth *t = user;
    char error[512] = "";
    thread_yields();
    struct environment_choice first;
    const bool loaded = t->desc->open_copy(t->desc->user, &t->context, &t->scene, error) &&
                        environments_begin(&t->environments, t->context, t->scene, &first) == AG_OK;
    pthread_mutex_lock(&t->mutex);
    snprintf(t->state.error, sizeof t->state.error, "%s", error);
    pthread_mutex_unlock(&t->mutex);
    while (loaded && wait_for_work(t)) {
        if (t->request == t->running)
            show(t); // it has all samples: another image is to be measured
        else if (begin(t))
            trace(t);
    }
    ag_reference_destroy(t->reference);
    environments_end(&t->environments);
    ag_scene_destroy(t->scene);
    ag_context_destroy(t->context);
    return NULL;
}

// ---- the viewer's thread

struct truth *truth_open(const struct viewer_desc *desc)
{
    struct truth *t = calloc(1, sizeof *t);
    if (!t) return NULL;
    t->desc = desc;
    pthread_mutex_init(&t->mutex, NULL);
    pthread_cond_init(&t->changed, NULL);
    if (pthread_create(&t->thread, NULL, run, t) == 0) return t;
    free(t);
    return NULL;
}

void truth_close(struct truth *t)
{
    if (!t) return;
    pthread_mutex_lock(&t->mutex);
    t->quit = true;
    pthread_cond_signal(&t->changed);
    pthread_mutex_unlock(&t->mutex);
    pthread_join(t->thread, NULL);
    free(t->offered.pixels);
    for (int i = 0; i < 2; i++) free(t->images[i].pixels);
    pthread_cond_destroy(&t->changed);
    pthread_mutex_destroy(&t->mutex);
    free(t);
}

static void forget(struct ag_image *image)
{
    free(image->pixels);
    *image = (struct ag_image){ 0 };
}

void truth_pause(struct truth *t)
{
    pthread_mutex_lock(&t->mutex);
    if (!t->paused) t->request++;
    t->paused = true;
    pthread_mutex_unlock(&t->mutex);
}

void truth_restart(struct truth *t, const struct truth_view *view)
{
    pthread_mutex_lock(&t->mutex);
    t->paused = false;
    t->view = *view;
    t->edits = *view->edits;
    t->view.edits = NULL;
    t->state.samples = 0;
    t->state.measured = false;
    forget(&t->offered);
    t->unmeasured = false;
    for (int i = 0; i < 2; i++) forget(&t->images[i]);
    t->request++;
    pthread_cond_signal(&t->changed);
    pthread_mutex_unlock(&t->mutex);
}

bool truth_offer(struct truth *t, const struct ag_image *color, float ev)
{
    struct ag_image copy = copy_of(color);
    pthread_mutex_lock(&t->mutex);
    const bool fits = color->width == t->view.width && color->height == t->view.height;
    if (fits) {
        t->view.ev = ev;
        swap(&copy, &t->offered);
        t->unmeasured = true;
        t->state.measured = false;
        pthread_cond_signal(&t->changed);
    }
    pthread_mutex_unlock(&t->mutex);
    free(copy.pixels);
    return fits;
}

void truth_get(struct truth *t, struct truth_state *out)
{
    pthread_mutex_lock(&t->mutex);
    *out = t->state;
    pthread_mutex_unlock(&t->mutex);
}

bool truth_take(struct truth *t, bool difference, struct ag_image *out)
{
    struct ag_image *slot = &t->images[difference ? 1 : 0];
    pthread_mutex_lock(&t->mutex);
    *out = *slot;
    *slot = (struct ag_image){ 0 };
    pthread_mutex_unlock(&t->mutex);
    return out->pixels != NULL;
}
