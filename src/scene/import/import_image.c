#include "scene/import/import_image.h"

#include "scene/images/image_decode.h"
#include "core/parallel.h"

#include <stdlib.h>
#include <string.h>

// Images have a budget of their own: decoded pixels can be much larger than the file (a white 4096²
// PNG has 80 kB).
static const size_t IMAGE_ALLOWANCE_BYTES = (size_t)1 << 30;

struct job {
    const struct image_source *source;
    int same_as; // an earlier image of the same bytes, decoded once; -1: none
    int width, height;
    uint8_t *rgba;
    bool has_alpha;
    const char *problem; // NULL: decoded
    char why[DECODE_WHY_SIZE];
};

static void decode(void *user, size_t i)
{
    struct job *job = (struct job *)user + i;
    if (job->problem || job->same_as >= 0) return;
    job->problem = image_decode(job->source->data, job->source->size, job->width, job->height,
                                job->rgba, job->why);
    size_t pixels = (size_t)job->width * (size_t)job->height;
    for (size_t p = 0; p < pixels && !job->has_alpha; p++)
        job->has_alpha = job->rgba[4 * p + 3] < 255;
}

static const char *find_size(struct job *job)
{
    const struct image_source *source = job->source;
    if (!source->data) return "";
    enum image_kind kind = image_kind_of(source->data, source->size);
    if (source->jpeg_and_png_only && kind != IMAGE_JPEG && kind != IMAGE_PNG) {
        return "neither JPEG nor PNG";
    }
    if (kind == IMAGE_UNKNOWN && !source->is_tga) return "neither JPEG, PNG, BMP nor TGA";
    return image_decode_size(source->data, source->size, &job->width, &job->height, job->why);
}

static int by_bytes(const void *a, const void *b)
{
    const struct job *first = *(struct job *const *)a, *second = *(struct job *const *)b;
    const struct image_source *x = first->source, *y = second->source;
    if (x->data != y->data) return (uintptr_t)x->data < (uintptr_t)y->data ? -1 : 1;
    if (x->size != y->size) return x->size < y->size ? -1 : 1;
    return first < second ? -1 : 1;
}

// Finds images of the same bytes: sources of one file or buffer view share them.
static bool find_same(struct host *host, struct job *jobs, int count)
{
    struct job **sorted = host_alloc(host, (size_t)count, sizeof(struct job *));
    if (!sorted) return false;
    for (int i = 0; i < count; i++) sorted[i] = &jobs[i];
    if (count > 1) qsort(sorted, (size_t)count, sizeof(struct job *), by_bytes);
    for (int i = 0; i < count; i++) {
        sorted[i]->same_as = -1;
        const struct job *last = i > 0 ? sorted[i - 1] : NULL;
        const struct image_source *source = sorted[i]->source;
        if (!last || !source->data || last->source->data != source->data ||
            last->source->size != source->size)
            continue;
        sorted[i]->same_as = last->same_as >= 0 ? last->same_as : (int)(last - jobs);
    }
    host_free(host, sorted);
    return true;
}

// Reads all sizes first, so that the total memory is known before any image is decoded.
static bool prepare(struct import *import, int count, struct job *jobs)
{
    size_t limit = import_limit(import, IMAGE_ALLOWANCE_BYTES), bytes = 0;
    for (int i = 0; i < count; i++) {
        if (jobs[i].same_as >= 0) continue;
        jobs[i].problem = find_size(&jobs[i]);
        if (!jobs[i].problem) bytes += (size_t)jobs[i].width * (size_t)jobs[i].height * 4;
        if (bytes > limit) {
            return host_fail(import->host, FAIL_MEMORY,
                             "%s: its images need more memory than its %zu bytes justify",
                             import->path, import->source_bytes);
        }
    }
    for (int i = 0; i < count; i++) {
        if (jobs[i].problem || jobs[i].same_as >= 0) continue;
        size_t pixels = (size_t)jobs[i].width * (size_t)jobs[i].height;
        jobs[i].rgba = arena_alloc(&import->scene->arena, pixels, 4);
        if (!jobs[i].rgba) return false;
    }
    return true;
}

bool import_images(struct import *import, const struct image_source *sources, int count,
                   int *scene_image)
{
    struct scene *scene = import->scene;
    struct job *jobs = host_alloc(import->host, (size_t)count, sizeof *jobs);
    struct scene_image *images = import_alloc(import, (size_t)count, sizeof *images);
    bool ok = jobs && images;
    for (int i = 0; ok && i < count; i++) jobs[i].source = &sources[i];
    ok = ok && find_same(import->host, jobs, count) && prepare(import, count, jobs);
    if (ok) parallel_for((size_t)count, 1, decode, jobs);
    for (int i = 0; ok && i < count; i++) {
        const struct job *job = &jobs[i];
        scene_image[i] = -1;
        if (job->same_as >= 0) {
            scene_image[i] = scene_image[job->same_as];
        } else if (!job->problem) {
            scene_image[i] = scene->image_count;
            images[scene->image_count++] = (struct scene_image){
                .name = sources[i].name,
                .width = job->width,
                .height = job->height,
                .rgba = job->rgba,
                .has_alpha = job->has_alpha,
            };
        } else if (job->problem[0]) {
            import_note(import, "image %s (%s)", import_printable(sources[i].name).s, job->problem);
        }
    }
    if (ok) scene->images = images;
    host_free(import->host, jobs);
    return ok;
}
