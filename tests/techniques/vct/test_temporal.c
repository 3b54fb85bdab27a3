// Temporal filter of cone tracing: a static camera, a pan, a moving object, and cuts. Figures are
// printed.
#include "techniques/vct/vct_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const vec3s CAMERA = { { 1, 6, 9 } }, TARGET = { { 8, 2, 3 } };

static size_t floats_of(const struct vct_fixture *fixture)
{
    return (size_t)fixture->frame_fixture.width * fixture->frame_fixture.height * 3;
}

static double mean(const float *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += (double)values[i];
    return sum / (double)count;
}

static double mean_difference(const float *a, const float *b, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += fabs((double)a[i] - (double)b[i]);
    return sum / (double)count;
}

// Channels of an image of the filter; to be freed.
static float *channels(const struct vct_fixture *fixture, gpu_image image, int count)
{
    const size_t floats =
        (size_t)fixture->frame_fixture.width * fixture->frame_fixture.height * (size_t)count;
    float *out = malloc(floats * sizeof *out);
    CHECK(gpu_image_download_float(fixture->frame_fixture.gpu, image, 0, 0, out, count, floats));
    return out;
}

// The unfiltered irradiance of the last frame.
static float *alone(const struct vct_fixture *fixture, size_t count)
{
    const size_t pixels = count / 3;
    const float scale = frame_radiance_scale(fixture->frame_fixture.frame);
    float *rgba = malloc(pixels * 4 * sizeof *rgba), *out = malloc(count * sizeof *out);
    CHECK(gpu_image_download_float(fixture->frame_fixture.gpu,
                                   vct_temporal_now(&fixture->vct->views[0].temporal), 0, 0, rgba,
                                   4, pixels * 4));
    for (size_t i = 0; i < count; i++) out[i] = rgba[i / 3 * 4 + i % 3] / scale;
    free(rgba);
    return out;
}

static gpu_image newest_history(const struct vct_fixture *fixture)
{
    const struct vct_temporal *temporal = &fixture->vct->views[0].temporal;
    return temporal->light[temporal->newest];
}

// ---- Static camera

// With a static camera history is the weighted mean of the unfiltered frames.
TEST_GPU(history_is_the_weighted_mean_of_the_frames)
{
    struct vct_fixture fixture;
    vct_fixture_room(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=32,temporal=true,frames=4");
    const size_t pixels = (size_t)fixture.frame_fixture.width * fixture.frame_fixture.height;
    double *mean_of_them = calloc(3 * pixels, sizeof *mean_of_them);
    for (int frame = 0; frame < 9; frame++) {
        fixture_render(&fixture.frame_fixture);
        float *now = channels(&fixture, vct_temporal_now(&fixture.vct->views[0].temporal), 3);
        float *got = channels(&fixture, newest_history(&fixture), 4);
        const double w = frame < 4 ? frame : 4; // at most `frames`
        for (size_t i = 0; i < 3 * pixels; i++) {
            mean_of_them[i] = (w * mean_of_them[i] + (double)now[i]) / (w + 1.0);
            const double value = (double)got[i / 3 * 4 + i % 3];
            CHECK_NEAR(value, mean_of_them[i], 1e-5 * mean_of_them[i] + 1e-6);
        }
        CHECK(got[3] == (frame < 4 ? (float)frame + 1.0f : 4.0f));
        free(now);
        free(got);
    }
    free(mean_of_them);
    vct_fixture_finish(&fixture);
}

// Each frame has other cones: the light differs by a tenth, and the mean over n frames changes by
// 1/n of that per frame, after 500 frames by less than a thousandth.
TEST_GPU(history_converges_with_a_static_camera)
{
    struct vct_fixture fixture;
    vct_fixture_room(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=32,temporal=true,frames=4");
    const size_t count = floats_of(&fixture);
    float *first = vct_fixture_irradiance_after(&fixture, 1),
          *second = vct_fixture_irradiance_after(&fixture, 1);
    float *before = vct_fixture_irradiance_after(&fixture, 497),
          *after = vct_fixture_irradiance_after(&fixture, 1);
    const double average = mean(after, count);
    double squares = 0.0, most = 0.0;
    size_t resting = 0;
    for (size_t i = 0; i < count; i++) {
        const double change = fabs((double)after[i] - (double)before[i]);
        squares += change * change;
        most = fmax(most, change / (double)after[i]);
        resting += change < 1e-3 * (double)after[i];
    }
    const double change = sqrt(squares / (double)count) / average;
    print_message(
        "from the first frame to the second: %.2e of the mean; from the 499th to the 500th: %.2e "
        "(root of the mean square), %.2e at most, %.2f %% of the values less than 1e-3\n",
        mean_difference(first, second, count) / average, change, most,
        100.0 * (double)resting / (double)count);
    CHECK(change < 1e-3);
    CHECK((double)resting > 0.95 * (double)count);
    CHECK(mean_difference(first, second, count) > 1e-2 * average); // without noise the test is void
    free(first), free(second), free(before), free(after);
    vct_fixture_finish(&fixture);
}

// ---- A pan

enum { PAN = 30, WARM = 8 };

static void pan_camera(struct frame_fixture *s, int frame)
{
    const float turn = 0.012f * (float)(frame - PAN / 2);
    const vec3s to = glms_vec3_sub(TARGET, CAMERA);
    const vec3s rotated =
        vec3_of(to.x * cosf(turn) - to.z * sinf(turn), to.y, to.x * sinf(turn) + to.z * cosf(turn));
    fixture_look(s, CAMERA, glms_vec3_add(CAMERA, rotated));
}

struct image {
    float *position, *normal, *irradiance;
};

static struct image image_of(struct frame_fixture *s)
{
    return (struct image){ fixture_read(s, READ_POSITION), fixture_read(s, READ_NORMAL),
                           fixture_read(s, READ_IRRADIANCE) };
}

static void image_free(struct image *p)
{
    free(p->position), free(p->normal), free(p->irradiance);
}

static vec3s vector(const float *of, size_t pixel)
{
    return vec3_of(of[3 * pixel], of[3 * pixel + 1], of[3 * pixel + 2]);
}

// Bilinear irradiance of the image at a point of the world. False unless all four pixels are within
// 0.1 m of its plane: creases and silhouettes mix surfaces.
static bool irradiance_at(const struct frame_fixture *s, vec3s p, vec3s n,
                          const struct image *image, double out[3])
{
    const struct world_camera *c = &s->input.camera;
    const int width = (int)s->width, height = (int)s->height;
    const float tan_y = tanf(0.5f * c->vertical_fov_rad),
                tan_x = tan_y * (float)width / (float)height;
    const vec3s to = glms_vec3_sub(p, c->eye);
    const float along = glms_vec3_dot(to, c->forward);
    if (along <= 0.0f) return false;
    const float x =
        (0.5f + 0.5f * glms_vec3_dot(to, glms_vec3_cross(c->forward, c->up)) / (along * tan_x)) *
            (float)width -
        0.5f;
    const float y =
        (0.5f - 0.5f * glms_vec3_dot(to, c->up) / (along * tan_y)) * (float)height - 0.5f;
    const int left = (int)floorf(x), top = (int)floorf(y);
    if (left < 0 || top < 0 || left + 1 >= width || top + 1 >= height) return false;
    memset(out, 0, 3 * sizeof *out);
    for (int i = 0; i < 4; i++) {
        const size_t at = (size_t)((top + (i >> 1)) * width + left + (i & 1));
        const vec3s off = glms_vec3_sub(vector(image->position, at), p);
        if (glms_vec3_dot(vector(image->normal, at), n) < 0.99f) return false;
        if (fabsf(glms_vec3_dot(off, n)) > 0.1f || glms_vec3_norm(off) > 0.2f * along) return false;
        const double fx = (double)(x - (float)left), fy = (double)(y - (float)top);
        const double share = (i & 1 ? fx : 1.0 - fx) * (i >> 1 ? fy : 1.0 - fy);
        for (int k = 0; k < 3; k++) out[k] += share * (double)image->irradiance[3 * at + (size_t)k];
    }
    return true;
}

// Root mean square change of irradiance from frame to frame at points of the room, over its mean,
// in a pan. All of it is error: irradiance does not depend on the camera.
static double flicker_in_pan(struct gpu *gpu, const char *options, float light_step)
{
    struct vct_fixture fixture;
    vct_fixture_room(&fixture, gpu);
    struct frame_fixture *s = &fixture.frame_fixture;
    s->width = s->height = 48;
    pan_camera(s, 0);
    vct_fixture_open(&fixture, options);
    for (int i = 0; i < WARM; i++) fixture_render(s);
    pan_camera(s, PAN / 2);
    fixture_render(s);
    struct image middle = image_of(s);
    pan_camera(s, 0);
    for (int i = 0; i < WARM; i++) fixture_render(s);
    const size_t pixels = (size_t)s->width * s->height;
    double *last = calloc(4 * pixels, sizeof *last), changes = 0.0, sum = 0.0;
    long count = 0;
    for (int frame = 0; frame < PAN; frame++) {
        pan_camera(s, frame);
        s->lights[0].position.x += frame % 2 ? light_step : -light_step;
        fixture_render(s);
        struct image image = image_of(s);
        for (size_t i = 0; i < pixels; i++) {
            double now[3];
            const vec3s p = vector(middle.position, i), n = vector(middle.normal, i);
            const bool seen = irradiance_at(s, p, n, &image, now);
            for (int k = 0; seen && k < 3; k++) {
                if (last[4 * i + 3] > 0.0) {
                    changes +=
                        (now[k] - last[4 * i + (size_t)k]) * (now[k] - last[4 * i + (size_t)k]);
                    sum += now[k];
                    count++;
                }
                last[4 * i + (size_t)k] = now[k];
            }
            last[4 * i + 3] = seen;
        }
        image_free(&image);
    }
    CHECK(count > PAN * (long)pixels);
    image_free(&middle);
    free(last);
    vct_fixture_finish(&fixture);
    return sqrt(changes / (double)count) / (sum / (double)count);
}

// Also while a light moves by an amount that does not show: then differences of frames are noise.
TEST_GPU(the_filter_reduces_flicker_in_a_pan)
{
    const double with = flicker_in_pan(gpu, "resolution=32,temporal=true", 0);
    const double restless = flicker_in_pan(gpu, "resolution=32,temporal=true", 1e-5f);
    const double without = flicker_in_pan(gpu, "resolution=32", 0);
    const double clamped = flicker_in_pan(gpu, "resolution=32,temporal=true,clamp=2", 0);
    print_message(
        "flicker in a pan: %.4f, with the filter %.4f, clamped %.4f, beside a moving light "
        "%.4f\n",
        without, with, clamped, restless);
    CHECK(with < without / 3.0);
    CHECK(restless < 0.6 * without);
}

// ---- Moving objects

// All pixels of the clamp's neighbourhood are on one plane.
static bool interior(const struct image *image, int width, int height, int x, int y)
{
    if (x < 2 || y < 2 || x >= width - 2 || y >= height - 2) return false;
    const size_t at = (size_t)(y * width + x);
    const vec3s p = vector(image->position, at), n = vector(image->normal, at);
    for (int i = 0; i < 25; i++) {
        const size_t other = (size_t)((y + i / 5 - 2) * width + x + i % 5 - 2);
        const vec3s off = glms_vec3_sub(vector(image->position, other), p);
        if (glms_vec3_dot(vector(image->normal, other), n) < 0.999f ||
            fabsf(glms_vec3_dot(off, n)) > 0.01f)
            return false;
    }
    return true;
}

// A clamp of almost no deviation replaces the history by the mean of 5 × 5 pixels of the frame.
TEST_GPU(the_clamp_limits_the_history_to_its_neighbours)
{
    struct vct_fixture fixture;
    vct_fixture_room(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=32,temporal=true,frames=4,clamp=0.001");
    struct frame_fixture *s = &fixture.frame_fixture;
    float *light = vct_fixture_irradiance_after(&fixture, 8),
          *now = alone(&fixture, floats_of(&fixture));
    struct image image = image_of(s);
    const int width = (int)s->width, height = (int)s->height;
    int tested = 0;
    for (int i = 0; i < width * height; i++) {
        if (!interior(&image, width, height, i % width, i / width)) continue;
        for (int c = 0; c < 3; c++) {
            double sum = 0.0;
            for (int k = 0; k < 25; k++)
                sum += (double)now[3 * (i + (k / 5 - 2) * width + k % 5 - 2) + c];
            const double expected = (4.0 * sum / 25.0 + (double)now[3 * i + c]) / 5.0;
            CHECK_NEAR((double)light[3 * i + c], expected, 2e-3 * expected);
        }
        tested++;
    }
    CHECK(tested > 50);
    image_free(&image);
    free(light), free(now);
    vct_fixture_finish(&fixture);
}

// The sides of the moving box keep their history; pixels that it uncovers have none.
TEST_GPU(history_follows_objects_and_resets_where_uncovered)
{
    struct vct_fixture fixture;
    const int box = vct_fixture_room(&fixture, gpu);
    fixture.frame_fixture.width = fixture.frame_fixture.height = 48;
    vct_fixture_open(&fixture, "resolution=32,temporal=true,frames=16");
    struct frame_fixture *s = &fixture.frame_fixture;
    const vec3s step = vec3_of(0.12f, 0, 0.03f);
    for (int i = 0; i < 12; i++) {
        fixture_render(s);
        vct_fixture_move_box(&fixture, box, step);
    }
    struct image before = image_of(s);
    fixture_render(s);
    struct image after = image_of(s);
    float *history = channels(&fixture, newest_history(&fixture), 4);
    int on_box = 0, followed = 0, uncovered = 0, begun = 0, still = 0, kept = 0;
    for (size_t i = 0; i < (size_t)s->width * s->height; i++) {
        const vec3s was = vector(before.position, i), is = vector(after.position, i);
        const float frames = history[4 * i + 3];
        // The box after 12 steps: x 5.44 … 6.94, y up to 3, z 2.36 … 3.86.
        const bool box_now =
            is.y > 0.3f && is.y < 3.1f && is.x > 5.4f && is.x < 7.0f && is.z > 2.3f && is.z < 3.9f;
        const bool same = glms_vec3_norm(glms_vec3_sub(was, is)) < 1e-3f;
        on_box += box_now;
        followed += box_now && frames > 2.0f;
        uncovered += !box_now && !same;
        begun += !box_now && !same && frames == 1.0f;
        still += !box_now && same;
        kept += !box_now && same && frames > 1.0f + fixture.vct->views[0].temporal.params.added;
    }
    print_message("%d of %d pixels on the box have followed it, %d of %d that it uncovered have "
                  "begun, %d of %d elsewhere go on\n",
                  followed, on_box, begun, uncovered, kept, still);
    CHECK(on_box > 50 && followed > 0.8 * on_box);
    CHECK(uncovered > 3 && begun > 0.8 * uncovered);
    CHECK(kept > 0.9 * still); // but not in the box's shadow
    image_free(&before), image_free(&after);
    free(history);
    vct_fixture_finish(&fixture);
}

// History is in physical units while the frame's unit changes. It follows a light that becomes 2¹⁰
// times as weak, and then equals that before up to this factor.
TEST_GPU(history_is_independent_of_the_exposure)
{
    struct vct_fixture fixture;
    vct_fixture_room(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=32,bounces=1,temporal=true");
    const size_t count = floats_of(&fixture);
    float *old = vct_fixture_irradiance_after(&fixture, 5);
    struct world_light *light = &fixture.frame_fixture.lights[0];
    const float scale = frame_radiance_scale(fixture.frame_fixture.frame);
    light->intensity = glms_vec3_scale(light->intensity, 1.0f / 1024.0f);
    float *weak = vct_fixture_irradiance_after(&fixture, 1);
    CHECK(frame_radiance_scale(fixture.frame_fixture.frame) > scale);
    // Half floats: 11 bits, for the history and for both frames of the difference.
    for (size_t i = 0; i < count; i++) CHECK_NEAR(1024.0f * weak[i], old[i], 3e-3f * old[i]);
    free(old), free(weak);
    vct_fixture_finish(&fixture);
}

// ---- Reset of history

static float *render_first_frame(struct gpu *gpu, const char *options, vec3s camera, vec3s target,
                                 uint32_t size)
{
    struct vct_fixture fixture;
    vct_fixture_room(&fixture, gpu);
    fixture.frame_fixture.width = fixture.frame_fixture.height = size;
    fixture_look(&fixture.frame_fixture, camera, target);
    vct_fixture_open(&fixture, options);
    float *e = vct_fixture_irradiance_after(&fixture, 1);
    vct_fixture_finish(&fixture);
    return e;
}

static const vec3s OTHER_CAMERA = { { 10, 3, 9 } }, OTHER_TARGET = { { 2, 1, 1 } };

TEST_GPU(a_camera_cut_resets_history)
{
    static const char *const off = "resolution=32", *const on = "resolution=32,temporal=true";
    float *fresh = render_first_frame(gpu, off, OTHER_CAMERA, OTHER_TARGET, 32);
    struct vct_fixture fixture;
    vct_fixture_room(&fixture, gpu);
    vct_fixture_open(&fixture, on);
    const size_t bytes = floats_of(&fixture) * sizeof *fresh;
    free(vct_fixture_irradiance_after(&fixture, 5));
    fixture_look(&fixture.frame_fixture, OTHER_CAMERA, OTHER_TARGET);
    fixture.frame_fixture.input.camera_cut = true;
    float *cut = vct_fixture_irradiance_after(&fixture, 1);
    assert_memory_equal(cut, fresh, bytes);
    free(cut);
    // Reset by options, by an invalidation and by another size.
    fixture.frame_fixture.input.camera_cut = false;
    free(vct_fixture_irradiance_after(&fixture, 3));
    struct vct_options options = fixture.vct->options;
    options.gain = 2.0f;
    technique_set_options(&technique_vct, fixture.vct, &options);
    float *gained = vct_fixture_irradiance_after(&fixture, 1);
    for (size_t i = 0; i < floats_of(&fixture); i++)
        CHECK_NEAR(gained[i], 2.0f * fresh[i], 1e-3f * gained[i]);
    free(gained);
    options.gain = 1.0f;
    technique_set_options(&technique_vct, fixture.vct, &options);
    free(vct_fixture_irradiance_after(&fixture, 3));
    technique_vct.invalidate(fixture.vct, CHANGED_CAMERA);
    cut = vct_fixture_irradiance_after(&fixture, 1);
    assert_memory_equal(cut, fresh, bytes);
    free(cut), free(fresh);
    fresh = render_first_frame(gpu, off, OTHER_CAMERA, OTHER_TARGET, 40);
    CHECK(technique_resize(&technique_vct, gpu, fixture.vct, &fixture.vct->options, 0, 40, 40));
    fixture_resize(&fixture.frame_fixture, 40, 40);
    cut = vct_fixture_irradiance_after(&fixture, 1);
    assert_memory_equal(cut, fresh, floats_of(&fixture) * sizeof *fresh);
    free(cut), free(fresh);
    vct_fixture_finish(&fixture);
}

// A jump without a cut: history is of the same surface or rejected. The error is not larger than
// that of the unfiltered frame.
TEST_GPU(a_camera_jump_has_no_ghosting)
{
    struct vct_fixture fixture;
    vct_fixture_room(&fixture, gpu);
    // At this resolution the bilinear history lookup is as exact as the unfiltered frame.
    fixture.frame_fixture.width = fixture.frame_fixture.height = 64;
    // With all bounces the light is so even that the unfiltered frame is as exact.
    vct_fixture_open(&fixture, "resolution=32,bounces=1,temporal=true");
    const size_t count = floats_of(&fixture);
    float *there = vct_fixture_irradiance_after(&fixture, 60);
    fixture_look(&fixture.frame_fixture, OTHER_CAMERA, OTHER_TARGET);
    float *jump = vct_fixture_irradiance_after(&fixture, 1), *fresh = alone(&fixture, count);
    float *settled = vct_fixture_irradiance_after(&fixture, 200);
    const double average = mean(settled, count),
                 begun = mean_difference(fresh, settled, count) / average;
    const double ghost = mean_difference(jump, settled, count) / average;
    print_message("error after a jump %.4f of the mean, unfiltered %.4f, of the old image %.4f\n",
                  ghost, begun, mean_difference(there, settled, count) / average);
    CHECK(ghost <= begun);
    free(fresh), free(there), free(jump), free(settled);
    vct_fixture_finish(&fixture);
}

// Without history the filter is the identity.
TEST_GPU(the_first_frame_is_unfiltered)
{
    float *off = render_first_frame(gpu, "resolution=32", CAMERA, TARGET, 32);
    float *on = render_first_frame(gpu, "resolution=32,temporal=true", CAMERA, TARGET, 32);
    assert_memory_equal(off, on, 32 * 32 * 3 * sizeof *off);
    free(off), free(on);
}
