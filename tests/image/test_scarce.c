// Memory that runs out at any allocation, and a disk that is full: a failure with its kind, nothing
// half done left behind, and no leak (under the address sanitizer).
#include "pictures.h"

#include "image/exr.h"
#include "image/metrics.h"
#include "image/png_file.h"
#include "image/tonemap.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

// A host that grants so many allocations and no more.
struct purse {
    int left;
    int held; // blocks in use
};

static void *spend(void *user, void *old, size_t bytes)
{
    struct purse *purse = user;
    if (bytes == 0) {
        purse->held -= old != NULL;
        free(old);
        return NULL;
    }
    if (purse->left == 0) return NULL;
    purse->left--;
    void *block = realloc(old, bytes);
    purse->held += block && !old;
    return block;
}

typedef bool (*action)(struct host *host);

// With 0, 1, 2 … allocations granted the action fails for want of memory, until they are enough.
static void check_action(action act)
{
    struct purse purse = { 0 };
    struct host host = { .reallocate = spend, .user = &purse };
    for (int granted = 0;; granted++) {
        purse.left = granted;
        host.failure = FAIL_NONE;
        bool done = act(&host);
        CHECK(purse.held == 0);
        if (done) {
            CHECK(granted > 0);
            return;
        }
        CHECK(host.failure == FAIL_MEMORY);
        CHECK(granted < 1000);
    }
}

static const char *exr_path, *png_path;
static struct image picture;

static void prepare(void)
{
    if (picture.pixels) return;
    exr_path = strdup(test_path("picture.exr"));
    png_path = strdup(test_path("picture.png"));
    noise_picture(&picture, 9, 20, 3);
    CHECK(png_write(test_host(), png_path, &picture));
    CHECK(exr_write(test_host(), exr_path, &(struct exr_layer){ "color", &picture }, 1,
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
    return exr_write(host, exr_path, &(struct exr_layer){ "color", &picture }, 1,
                     &(struct exr_attribute){ "scene", "@maze" }, 1);
}

static bool do_write_png(struct host *host)
{
    return png_write(host, png_path, &picture);
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
    return finish(metrics_error_map(host, &picture, &picture, NULL, METRICS_ABSOLUTE, 0.0f, &map),
                  &map, host);
}

// With a copy, for the pixel that is not finite.
static bool do_measure(struct host *host)
{
    struct image holed;
    struct metrics m;
    noise_picture(&holed, 9, 20, 4);
    holed.pixels[4] = NAN;
    const struct metrics_options options = { .radiance = true, .ignore_not_finite = true };
    bool good = metrics_compute(host, &holed, &picture, &options, &m);
    image_finish(&holed, test_host());
    return good;
}

static bool do_tonemap(struct host *host)
{
    struct image shown;
    return finish(image_tonemap(&shown, host, &picture, 1.0f), &shown, host);
}

static bool do_pair(struct host *host)
{
    struct image pair;
    return finish(image_side_by_side(&pair, host, &picture, &picture, 1), &pair, host);
}

TEST(memory_that_runs_out_anywhere_is_a_clean_failure)
{
    static const action actions[] = { do_read_exr,    do_read_png,      do_write_exr, do_write_png,
                                      do_list_layers, do_get_attribute, do_map_error, do_measure,
                                      do_tonemap,     do_pair };
    prepare();
    for (size_t i = 0; i < sizeof actions / sizeof actions[0]; i++) check_action(actions[i]);
}

TEST(a_full_disk_is_a_failure_that_leaves_the_old_file)
{
    struct image large, back;
    struct rlimit before, tight = { 4096, 4096 };
    prepare();
    noise_picture(&large, 200, 200, 3);
    signal(SIGXFSZ, SIG_IGN);
    CHECK(getrlimit(RLIMIT_FSIZE, &before) == 0);
    tight.rlim_max = before.rlim_max;
    CHECK(setrlimit(RLIMIT_FSIZE, &tight) == 0);
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
