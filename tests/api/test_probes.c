// Probe volumes through the public API: positions, coefficients, availability.
#include "api/renderer_fixture.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = FIXTURE_WIDTH, HEIGHT = FIXTURE_HEIGHT, PIXELS = WIDTH * HEIGHT };
static const float PI = 3.14159265f;

static struct ag_probes *render_probes(struct renderer_fixture *s)
{
    struct ag_probes *probes = NULL;
    assert_int_equal(ag_renderer_render(s->renderer, &s->frame), AG_OK);
    if (ag_renderer_read_probes(s->renderer, &probes) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    return probes;
}

static size_t probe_at(const struct ag_probes *probes, int x, int y, int z)
{
    return ((size_t)z * (size_t)probes->counts[1] + (size_t)y) * (size_t)probes->counts[0] +
           (size_t)x;
}

static double mean(const struct ag_image *image)
{
    double sum = 0.0;
    for (int i = 0; i < 3 * PIXELS; i++) sum += (double)image->pixels[i] / (3.0 * PIXELS);
    return sum;
}

// The largest irradiance of the six directions of the axes.
static double largest(const struct ag_probes *probes, const float position[3])
{
    double most = 0.0;
    for (int i = 0; i < 6; i++) {
        float normal[3] = { 0.0f }, lux[3];
        normal[i / 2] = i % 2 ? -1.0f : 1.0f;
        ag_probes_irradiance(probes, position, normal, lux);
        for (int c = 0; c < 3; c++) most = fmax(most, (double)lux[c]);
    }
    return most;
}

// Irradiance from probes equals that of a surface at the same point. Without an offset, the
// lookup of surfaces differs only by rounding of coefficients and results to half floats (11
// bits) and weights of filters (8 bits on some drivers). Terms cancel for normals away from the
// light: errors are relative to the irradiance of the other directions, too. Coefficients hold
// light that is linear in all bands.
TEST(probes_and_surfaces_have_equal_irradiance)
{
    const char *gi[] = {
        "lpv:probes=true,dim=16,offset=0,cascades=1,geometry=off,closure=linear",
        "holpv:probes=true,dim=16,offset=0,cascades=1,geometry=off,closure=linear"
    };
    for (int k = 0; k < 2; k++) {
        struct renderer_fixture s = fixture_open(gi[k], NULL);
        struct ag_probes *probes = render_probes(&s);
        struct ag_image *irradiance = fixture_read(&s, "irradiance"),
                        *normal = fixture_read(&s, "normal"),
                        *position = fixture_read(&s, "position"),
                        *depth = fixture_read(&s, "depth");
        const double typical = mean(irradiance), rounding = fixture_is_software(&s) ? 4e-3 : 8e-3;
        int seen = 0;
        CHECK(typical > 0.0);
        for (int i = 0; i < PIXELS; i++) {
            if (depth->pixels[i] <= 0.0f) continue;
            float lux[3];
            ag_probes_irradiance(probes, position->pixels + 3 * i, normal->pixels + 3 * i, lux);
            const double most = largest(probes, position->pixels + 3 * i);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR((double)lux[c], (double)irradiance->pixels[3 * i + c],
                           rounding * ((double)lux[c] + typical) + 1e-3 * most);
            seen++;
        }
        CHECK(seen > PIXELS / 3);
        ag_image_destroy(s.context, irradiance);
        ag_image_destroy(s.context, normal);
        ag_image_destroy(s.context, position);
        ag_image_destroy(s.context, depth);
        ag_probes_destroy(s.context, probes);
        fixture_close(&s);
    }
}

// The debug view shades surfaces with the lookup of the shaders, which must equal that of the
// CPU: 0.3 albedo/π E half a spacing in front of the surface. Balls cover a few other pixels.
TEST(shaders_sample_probes_as_the_cpu_does)
{
    struct renderer_fixture s = fixture_open("holpv:probes=true,dim=16", NULL);
    assert_int_equal(ag_renderer_set_debug_view(s.renderer, "probes"), AG_OK);
    struct ag_probes *probes = render_probes(&s);
    struct ag_image *view = fixture_read(&s, "debug"), *normal = fixture_read(&s, "normal"),
                    *position = fixture_read(&s, "position"), *albedo = fixture_read(&s, "albedo"),
                    *depth = fixture_read(&s, "depth");
    int seen = 0, equal = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float *n = normal->pixels + 3 * i, *p = position->pixels + 3 * i;
        float at[3], lux[3];
        if (depth->pixels[i] <= 0.0f) continue;
        for (int axis = 0; axis < 3; axis++) at[axis] = p[axis] + 0.5f * probes->spacing * n[axis];
        ag_probes_irradiance(probes, at, n, lux);
        const float expected = 0.3f * albedo->pixels[3 * i + 1] / PI * lux[1];
        seen++;
        equal += fabsf(view->pixels[3 * i + 1] - expected) <= 0.01f * expected;
    }
    print_message("%d of %d pixels equal\n", equal, seen);
    // Balls of radius 0.12 d, one in d³, cover 1 − exp(−π 0.12² L/d) of the pixels: 1/2 for a
    // free path past 16 of them.
    CHECK(seen > PIXELS / 3 && equal > seen / 2);
    CHECK(equal < seen); // there are balls
    ag_image_destroy(s.context, view);
    ag_image_destroy(s.context, normal);
    ag_image_destroy(s.context, position);
    ag_image_destroy(s.context, albedo);
    ag_image_destroy(s.context, depth);
    ag_probes_destroy(s.context, probes);
    fixture_close(&s);
}

TEST(probes_are_interpolated_inside_and_clamped_outside)
{
    struct renderer_fixture s = fixture_open("lpv:probes=true,dim=16", NULL);
    struct ag_probes *probes = render_probes(&s);
    struct ag_scene_info info;
    assert_int_equal(ag_scene_get_info(s.scene, 0, 0.0, &info), AG_OK);
    for (int axis = 0; axis < 3; axis++) { // cells around all of the scene, a probe in each
        const float half = 0.5f * probes->spacing, low = probes->first[axis] - half;
        CHECK(low <= info.bounds_min[axis] + 1e-4f);
        CHECK(low + probes->spacing * (float)probes->counts[axis] >= info.bounds_max[axis] - 1e-4f);
    }
    // E(up) at a probe, from its coefficients: Y00, y and the even ones of 3z² − 1 and x² − y².
    const int x = probes->counts[0] / 2, y = probes->counts[1] / 2, z = probes->counts[2] / 2;
    const float up[3] = { 0, 1, 0 };
    float position[3] = { probes->first[0] + probes->spacing * (float)x,
                          probes->first[1] + probes->spacing * (float)y,
                          probes->first[2] + probes->spacing * (float)z };
    float here[3], there[3], between[3];
    ag_probes_irradiance(probes, position, up, here);
    const float *c = probes->coefficients + 27 * probe_at(probes, x, y, z);
    for (int colour = 0; colour < 3; colour++) {
        const double expected =
            0.282094792 * (double)c[colour] + 0.488602512 * (double)c[3 + colour] -
            0.315391565 * (double)c[18 + colour] - 0.546274215 * (double)c[24 + colour];
        CHECK(expected > 0.0);
        CHECK_RELATIVE((double)here[colour], expected, 1e-5);
    }
    position[0] += probes->spacing;
    ag_probes_irradiance(probes, position, up, there);
    position[0] -= 0.25f * probes->spacing;
    ag_probes_irradiance(probes, position, up, between);
    CHECK_RELATIVE((double)between[1], 0.25 * (double)here[1] + 0.75 * (double)there[1], 1e-4);
    CHECK(here[1] != there[1]);
    // Outside the grid: the irradiance of its border, at any distance.
    position[0] = probes->first[0] + probes->spacing * (float)(probes->counts[0] - 1);
    ag_probes_irradiance(probes, position, up, here);
    position[0] = INFINITY;
    ag_probes_irradiance(probes, position, up, there);
    CHECK(here[1] == there[1]);
    position[0] = NAN;
    ag_probes_irradiance(probes, position, up, there);
    CHECK(isfinite(there[1]));
    ag_probes_destroy(s.context, probes);
    fixture_close(&s);
}

TEST(probes_are_dark_without_light)
{
    struct renderer_fixture s = fixture_open("lpv:probes=true,dim=16", NULL);
    assert_int_equal(ag_scene_remove_lights(s.scene), AG_OK);
    struct ag_probes *probes = render_probes(&s);
    const size_t count =
        (size_t)probes->counts[0] * (size_t)probes->counts[1] * (size_t)probes->counts[2];
    CHECK(count > 0);
    for (size_t i = 0; i < 27 * count; i++) CHECK(probes->coefficients[i] == 0.0f);
    ag_probes_destroy(s.context, probes);
    fixture_close(&s);
}

TEST(the_image_of_the_probes_is_accessible)
{
    struct renderer_fixture s = fixture_open("lpv:probes=true,dim=16", NULL);
    struct ag_probes *probes = render_probes(&s);
    struct ag_probes_handle handle;
    assert_int_equal(ag_renderer_probes_handle(s.renderer, &handle), AG_OK);
    CHECK(handle.vk_image != NULL);
    CHECK(handle.scale > 0.0f && handle.slab == 16);
    CHECK(handle.spacing == probes->spacing);
    CHECK(memcmp(handle.counts, probes->counts, sizeof handle.counts) == 0);
    CHECK(memcmp(handle.first, probes->first, sizeof handle.first) == 0);
    ag_probes_destroy(s.context, probes);
    fixture_close(&s);
}

TEST(without_probes_the_message_names_the_option)
{
    struct renderer_fixture s = fixture_open("lpv", NULL);
    struct ag_probes *probes = (struct ag_probes *)1;
    struct ag_probes_handle handle;
    assert_int_equal(ag_renderer_read_probes(s.renderer, &probes), AG_ERROR_ARGUMENT); // no frame
    assert_null(probes);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_read_probes(s.renderer, &probes), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "lpv:probes=true"));
    assert_int_equal(ag_renderer_read_probes(s.renderer, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_read_probes(NULL, &probes), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_probes_handle(s.renderer, &handle), AG_ERROR_ARGUMENT);
    assert_null(handle.vk_image);
    assert_int_equal(ag_renderer_set_debug_view(s.renderer, "probes"), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "lpv:probes=true"));
    fixture_close(&s);
    s = fixture_open("ambient", NULL);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_read_probes(s.renderer, &probes), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "ambient publishes no probes"));
    ag_probes_destroy(s.context, NULL);
    fixture_close(&s);
}
