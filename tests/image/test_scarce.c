// Out of memory at any allocation and out of disk space: the right kind of failure, no partial
// files, and no leaks (under the address sanitizer).
#include "test_images.h"

#include "image/exr.h"
#include "image/metrics.h"
#include "image/png_file.h"
#include "image/tonemap.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

// An allocator that fails after a number of allocations.
struct limited_memory {
    int left; // allocations that succeed
    int live; // blocks in use
};

static void *limited_reallocate(void *user, void *old, size_t bytes)
{
    struct limited_memory *memory = user;
    if (bytes == 0) {
        memory->live -= old != NULL;
        free(old);
        return NULL;
    }
    if (memory->left == 0) return NULL;
    memory->left--;
    void *block = realloc(old, bytes);
    memory->live += block && !old;
    return block;
}

typedef bool (*action)(struct host *host);

// With 0, 1, 2 … allocations the action fails with FAIL_MEMORY, until there are enough.
static void check_action(action act)
{
    struct limited_memory memory = { 0 };
    struct host host = { .reallocate = limited_reallocate, .user = &memory };
    for (int allowed = 0;; allowed++) {
        memory.left = allowed;
        host.failure = FAIL_NONE;
        bool done = act(&host);
        CHECK(memory.live == 0);
        if (done) {
            CHECK(allowed > 0);
            return;
        }
        CHECK(host.failure == FAIL_MEMORY);
        CHECK(allowed < 1000);
    }
}

static const char *exr_path, *png_path;
static struct image noise;

static void prepare(void)
{
    if (noise.pixels) return;
    exr_path = strdup(test_path("picture.exr"));
    png_path = strdup(test_path("picture.png"));
    noise_image(&noise, 9, 20, 3);
    CHECK(png_write(test_host(), png_path, &noise));
    CHECK(exr_write(test_host(), exr_path, &(struct exr_layer){ "color", &noise }, 1,
                    &(struct exr_attribute){ "scene", "@maze" }, 1));
}

static bool finish(bool good, struct image *image, struct host *host)
{
    CHECK(good == (image->pixels != NULL));
    image_finish(image, host);
    return good;
}

static bool do_read_exr(struct host *host)
{
    struct image image;
    return finish(exr_read(host, exr_path, NULL, &image), &image, host);
}

static bool do_read_png(struct host *host)
{
    struct image image;
    return finish(png_read(host, png_path, &image), &image, host);
}

static bool do_write_exr(struct host *host)
{
    return exr_write(host, exr_path, &(struct exr_layer){ "color", &noise }, 1,
                     &(struct exr_attribute){ "scene", "@maze" }, 1);
}

static bool do_write_png(struct host *host)
{
    return png_write(host, png_path, &noise);
}

static bool do_list_layers(struct host *host)
{
    char *names = exr_layer_names(host, exr_path);
    host_free(host, names);
    return names != NULL;
}

static bool do_get_attribute(struct host *host)
{
    char *value = exr_attribute_value(host, exr_path, "scene");
    host_free(host, value);
    return value != NULL;
}

static bool do_map_error(struct host *host)
{
    struct image map;
    return finish(metrics_error_map(host, &noise, &noise, NULL, METRICS_ABSOLUTE, 0.0f, &map), &map,
                  host);
}

// The pixel that is not finite makes metrics_compute copy the images.
static bool do_measure(struct host *host)
{
    struct image with_nan;
    struct metrics m;
    noise_image(&with_nan, 9, 20, 4);
    with_nan.pixels[4] = NAN;
    const struct metrics_options options = { .radiance = true, .ignore_not_finite = true };
    bool good = metrics_compute(host, &with_nan, &noise, &options, &m);
    image_finish(&with_nan, test_host());
    return good;
}

static bool do_tonemap(struct host *host)
{
    struct image display;
    return finish(image_tonemap(&display, host, &noise, 1.0f, TONEMAP_NEUTRAL), &display, host);
}

static bool do_pair(struct host *host)
{
    struct image pair;
    return finish(image_side_by_side(&pair, host, &noise, &noise, 1), &pair, host);
}

TEST(out_of_memory_at_any_allocation_is_a_clean_failure)
{
    static const action actions[] = { do_read_exr,    do_read_png,      do_write_exr, do_write_png,
                                      do_list_layers, do_get_attribute, do_map_error, do_measure,
                                      do_tonemap,     do_pair };
    prepare();
    for (size_t i = 0; i < sizeof actions / sizeof actions[0]; i++) check_action(actions[i]);
}

TEST(full_disk_is_a_failure_that_keeps_the_old_file)
{
    struct image large, back;
    struct rlimit before, small = { 4096, 4096 };
    prepare();
    noise_image(&large, 200, 200, 3);
    signal(SIGXFSZ, SIG_IGN);
    CHECK(getrlimit(RLIMIT_FSIZE, &before) == 0);
    small.rlim_max = before.rlim_max;
    CHECK(setrlimit(RLIMIT_FSIZE, &small) == 0);
    test_host()->failure = FAIL_NONE;
    bool png = png_write(test_host(), png_path, &large);
    enum fail_kind png_kind = test_host()->failure;
    test_host()->failure = FAIL_NONE;
    bool exr = exr_write(test_host(), exr_path, &(struct exr_layer){ "color", &large }, 1, NULL, 0);
    enum fail_kind exr_kind = test_host()->failure;
    CHECK(setrlimit(RLIMIT_FSIZE, &before) == 0);
    CHECK(!png && png_kind == FAIL_FILE);
    CHECK(!exr && exr_kind == FAIL_FILE);
    CHECK(strstr(test_last_message(), exr_path));
    CHECK(png_read(test_host(), png_path, &back) && back.width == 9);
    image_finish(&back, test_host());
    CHECK(exr_read(test_host(), exr_path, NULL, &back) && back.width == 9);
    image_finish(&back, test_host());
    image_finish(&large, test_host());
}
