#include "scene/import/import_image.h"

#include "scene/image_decode.h"
#include "core/parallel.h"

#include <string.h>

// Images have a budget of their own: decoded pixels can be much larger than the file (a white 4096²
// PNG has 80 kB).
static const size_t IMAGE_ALLOWANCE_BYTES = (size_t)1 << 30;
static const size_t IMAGE_BYTES_PER_SOURCE_BYTE = 64;

struct job {
    const struct image_source *source;
    int width, height;
    uint8_t *rgba;
    bool has_alpha;
    const char *problem; // NULL: decoded
};

static void decode(void *user, size_t i)
{
    struct job *job = (struct job *)user + i;
    if (job->problem) return;
    job->problem =
        image_decode(job->source->data, job->source->size, job->width, job->height, job->rgba);
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
    return image_decode_size(source->data, source->size, &job->width, &job->height);
}

// Reads all sizes first, so that the total memory is known before any image is decoded.
static bool prepare(struct import *import, const struct image_source *sources, int count,
                    struct job *jobs)
{
    size_t limit, bytes = 0;
    if (!size_mul(import->source_bytes, IMAGE_BYTES_PER_SOURCE_BYTE, &limit) ||
        !size_add(limit, IMAGE_ALLOWANCE_BYTES, &limit)) {
        limit = SIZE_MAX;
    }
    for (int i = 0; i < count; i++) {
        jobs[i].source = &sources[i];
        jobs[i].problem = find_size(&jobs[i]);
        if (!jobs[i].problem) bytes += (size_t)jobs[i].width * (size_t)jobs[i].height * 4;
        if (bytes > limit) {
            return host_fail(import->host, FAIL_MEMORY,
                             "%s: its images need more memory than its %zu bytes justify",
                             import->path, import->source_bytes);
        }
    }
    for (int i = 0; i < count; i++) {
        if (jobs[i].problem) continue;
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
    bool ok = jobs && images && prepare(import, sources, count, jobs);
    if (ok) parallel_for((size_t)count, 1, decode, jobs);
    for (int i = 0; ok && i < count; i++) {
        const struct job *job = &jobs[i];
        scene_image[i] = -1;
        if (!job->problem) {
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
