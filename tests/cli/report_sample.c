#include "cli/report_sample.h"

#include "image/png_file.h"

#include <stdio.h>

// A horizontal and a vertical ramp with a tint.
static void write_image(const char *folder, const char *name, int tint)
{
    struct image image = { 0 };
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_true(image_init(&image, test_host(), SAMPLE_WIDTH, SAMPLE_HEIGHT, 3));
    for (int y = 0; y < SAMPLE_HEIGHT; y++)
        for (int x = 0; x < SAMPLE_WIDTH; x++) {
            float *pixel = image_at(&image, x, y);
            pixel[0] = (float)x / SAMPLE_WIDTH;
            pixel[1] = (float)y / SAMPLE_HEIGHT;
            pixel[2] = (float)tint / SAMPLE_IMAGES;
        }
    assert_true(png_write(test_host(), path, &image));
    image_finish(&image, test_host());
}

static json_t *passes(double scale)
{
    return json_pack("[{s:s, s:{s:f, s:f}}, {s:s, s:{s:f, s:f}}, {s:s, s:{s:f, s:f}}]", "name",
                     "gbuffer", "gpu_ms", "median", 2.0, "p95", 2.5, "name", "lpv.propagate",
                     "gpu_ms", "median", 3.0 * scale, "p95", 4.0 * scale, "name", "composite",
                     "gpu_ms", "median", 1.0, "p95", 1.5);
}

static json_t *images(const char *folder, int method)
{
    static const char *const roles[] = { "picture", "error", "indirect", "indirect_error" };
    json_t *object = json_object();
    for (int i = 0; i < 4; i++) {
        char name[64];
        snprintf(name, sizeof name, "%d-%s.png", method, roles[i]);
        write_image(folder, name, 2 + 4 * method + i);
        json_object_set_new(object, roles[i], json_string(name));
    }
    return object;
}

// Later methods are closer to the reference and slower.
static json_t *method(const char *folder, int i, const char *gi, json_t *options)
{
    double error = 1.0 / (1 + i);
    json_t *object =
        json_pack("{s:s, s:o, s:f, s:f, s:f, s:f, s:f, s:{s:f, s:f, s:f}, s:{s:f, s:f}, s:o, "
                  "s:{s:i, s:i}, s:o}",
                  "gi", gi, "options", options, "relmse", 0.5 * error, "flip", 0.4 * error, "mae",
                  20.0 * error, "ssim", 1 - 0.6 * error, "energy", 1 - 0.5 * error, "indirect",
                  "relmse", 0.7 * error, "mae", 30.0 * error, "energy", 1 - 0.8 * error, "frame_ms",
                  "median", 3.0 + 3.0 * i, "p95", 4.0 + 4.0 * i, "passes", passes(i),
                  "memory_bytes", "frame", 1 << 20, "lpv", i << 20, "images", images(folder, i));
    assert_non_null(object);
    return object;
}

json_t *sample_report(const char *folder, const char *scene, const char *gi)
{
    write_image(folder, "reference.png", 0);
    write_image(folder, "reference-indirect.png", 1);
    json_t *methods = json_pack(
        "[o, o, o, o]", method(folder, 0, gi, json_object()),
        method(folder, 1, "ambient:strength=1", json_pack("{s:{s:f}}", "ambient", "strength", 1.0)),
        method(folder, 2, "lpv:dim=16,steps=8",
               json_pack("{s:{s:i, s:i}}", "lpv", "dim", 16, "steps", 8)),
        method(folder, 3, "lpv:dim=16,steps=64",
               json_pack("{s:{s:i, s:i}}", "lpv", "dim", 16, "steps", 64)));
    json_t *report =
        json_pack("{s:s, s:s, s:[ii], s:f, s:s, s:s, s:i, s:{s:i, s:n, s:f, s:f, s:I, s:b, s:{s:s, "
                  "s:s}}, s:o}",
                  "scene", scene, "camera", "main", "size", SAMPLE_WIDTH, SAMPLE_HEIGHT,
                  "exposure_ev", 6.75, "device", "a device", "driver", "its driver", "frames", 8,
                  "reference", "spp", 64, "bounces", "seconds", 12.5, "noise", 0.02, "rays",
                  (json_int_t)38316784, "cached", 0, "images", "picture", "reference.png",
                  "indirect", "reference-indirect.png", "methods", methods);
    assert_non_null(report);
    json_object_set_new(report, "command", json_string("afterglow compare @cornell"));
    json_object_set_new(report, "light", json_string("--light sun:0,-1,0:1,1,1"));
    json_object_set_new(report, "light_is_default", json_true());
    json_object_set_new(json_array_get(methods, 3), "changed",
                        json_pack("{s:{s:i}}", "lpv", "steps", 64));
    return report;
}
