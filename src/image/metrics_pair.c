// Selection of the pixels that count. A pixel that is not finite would spread through the filters
// of ssim and flip; where it does not count, both images get the same finite value.
#include "image/metrics_pair.h"

#include <math.h>

static bool check_pair(struct host *host, const struct image *a, const struct image *b,
                       const struct image *mask)
{
    if (a->width != b->width || a->height != b->height)
        return host_fail(host, FAIL_ARGUMENT, "cannot compare images: %dx%d against %dx%d",
                         a->width, a->height, b->width, b->height);
    if (a->channels < 3 || b->channels < 3)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot compare images: %d and %d channels, where each needs 3 or 4",
                         a->channels, b->channels);
    if (mask && (mask->width != a->width || mask->height != a->height))
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot compare images: the mask is %dx%d, the images %dx%d", mask->width,
                         mask->height, a->width, a->height);
    return true;
}

static bool in_mask(const struct image *mask, size_t i)
{
    if (!mask) return true;
    const float *values = mask->pixels + i * (size_t)mask->channels;
    for (int c = 0; c < mask->channels; c++)
        if (values[c] > 0.0f) return true;
    return false;
}

static bool is_finite(const struct image *image, size_t i)
{
    const float *values = image->pixels + i * (size_t)image->channels;
    bool finite = true;
    for (int c = 0; c < image->channels; c++) finite &= isfinite(values[c]) != 0;
    return finite;
}

// Counts of pixels that are not finite.
struct not_finite {
    size_t a, b;   // inside the mask
    size_t either; // in either image, inside or outside the mask
};

static void count(const struct image *a, const struct image *b,
                  const struct metrics_options *options, struct metrics_pair *out,
                  struct not_finite *not_finite)
{
    size_t pixels = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < pixels; i++) {
        bool inside = in_mask(options->mask, i);
        bool good_a = is_finite(a, i), good_b = is_finite(b, i), good = good_a && good_b;
        out->counts[i] = inside && good;
        out->counted += inside && good;
        out->ignored += inside && !good;
        not_finite->a += inside && !good_a;
        not_finite->b += inside && !good_b;
        not_finite->either += !good;
    }
}

static bool check_counts(struct host *host, const struct metrics_options *options,
                         const struct metrics_pair *pair, const struct not_finite *not_finite)
{
    size_t inside = pair->counted + pair->ignored;
    if (!options->ignore_not_finite && not_finite->a)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot compare images: %zu of %zu pixels of the image are not finite",
                         not_finite->a, inside);
    if (!options->ignore_not_finite && not_finite->b)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot compare images: %zu of %zu pixels of the reference are not finite",
                         not_finite->b, inside);
    if (pair->counted) return true;
    return host_fail(host, FAIL_ARGUMENT,
                     "cannot compare images: no pixel is left (%zu are outside the mask, %zu not "
                     "finite)",
                     (size_t)pair->a.width * (size_t)pair->a.height - inside, pair->ignored);
}

static bool copy_colour(struct host *host, const struct image *from, struct image *to)
{
    if (!image_init(to, host, from->width, from->height, 3)) return false;
    size_t pixels = (size_t)from->width * (size_t)from->height;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            to->pixels[3 * i + c] = from->pixels[i * (size_t)from->channels + c];
    return true;
}

// Replaces pixels that are not finite: by the reference's value, else the image's, else black.
static bool patch(struct host *host, const struct image *a, const struct image *b,
                  struct metrics_pair *out)
{
    out->copied = true;
    out->a = out->b = (struct image){ 0 };
    if (!copy_colour(host, a, &out->a) || !copy_colour(host, b, &out->b)) return false;
    size_t pixels = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < pixels; i++) {
        bool good_a = is_finite(a, i), good_b = is_finite(b, i);
        if (good_a && good_b) continue;
        for (size_t c = 0; c < 3; c++) {
            float *to_a = &out->a.pixels[3 * i + c], *to_b = &out->b.pixels[3 * i + c];
            *to_a = *to_b = good_b ? *to_b : good_a ? *to_a : 0.0f;
        }
    }
    return true;
}

bool metrics_pair_init(struct host *host, const struct image *a, const struct image *b,
                       const struct metrics_options *options, struct metrics_pair *out)
{
    struct not_finite not_finite = { 0 };
    *out = (struct metrics_pair){ .a = *a, .b = *b };
    if (!check_pair(host, a, b, options->mask)) return false;
    out->counts = host_alloc(host, (size_t)a->width * (size_t)a->height, 1);
    if (!out->counts) goto fail;
    count(a, b, options, out, &not_finite);
    if (!check_counts(host, options, out, &not_finite)) goto fail;
    if (not_finite.either && !patch(host, a, b, out)) goto fail;
    return true;
fail:
    metrics_pair_finish(out, host);
    return false;
}

void metrics_pair_finish(struct metrics_pair *pair, struct host *host)
{
    if (pair->copied) {
        image_finish(&pair->a, host);
        image_finish(&pair->b, host);
    }
    host_free(host, pair->counts);
    *pair = (struct metrics_pair){ 0 };
}
