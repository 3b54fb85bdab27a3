// Shadows: position against rays, stability under camera motion, no self-shadowing.
#include "frame/frame_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const vec3s UP = { { 0, 1, 0 } };
static const vec3s GREY = { { 0.5f, 0.5f, 0.5f } };
static const vec3s LUX = { { 1000, 1000, 1000 } };

// A floor and a 1 m quad, 1 m above the origin, viewed obliquely.
static void begin(struct frame_fixture *s, struct gpu *gpu, uint32_t size)
{
    fixture_init(s, gpu);
    int matte = fixture_matte(s, GREY);
    fixture_floor(s, 10, matte);
    fixture_quad(s, vec3_of(-0.5f, 1, 0.5f), vec3_of(0.5f, 1, 0.5f), vec3_of(0.5f, 1, -0.5f),
                 vec3_of(-0.5f, 1, -0.5f), matte);
    fixture_look(s, vec3_of(0, 3, 4), vec3_of(0, 0, 0));
    s->width = s->height = size;
    s->options.shadow_size = 512;
}

// Counts floor pixels whose shadow differs from the ray's, except within `margin_m` of an edge.
static int count_wrong(struct frame_fixture *s, vec3s (*towards_light)(vec3s p), float margin_m,
                       int *checked)
{
    float *direct = fixture_read(s, READ_DIRECT), *position = fixture_read(s, READ_POSITION);
    int wrong = 0;
    *checked = 0;
    for (size_t i = 0; i < (size_t)s->width * s->height; i++) {
        vec3s p = vec3_of(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
        if (fabsf(p.y) > 1e-3f || (p.x == 0 && p.z == 0)) continue;
        vec3s to = towards_light(p);
        vec3s at = glms_vec3_muladds(to, (1 - p.y) / to.y, p); // on the quad's plane
        float out = fmaxf(fabsf(at.x), fabsf(at.z)) - 0.5f;
        if (fabsf(out) < margin_m) continue;
        (*checked)++;
        wrong += (out > 0) != (direct[3 * i] > 0.01f);
    }
    free(direct);
    free(position);
    return wrong;
}

static vec3s towards_sun(vec3s p)
{
    (void)p;
    return vec3_of(0.4f, 1, 0.1f);
}

static vec3s towards_point(vec3s p)
{
    return glms_vec3_sub(vec3_of(0.3f, 2.5f, 0.2f), p);
}

TEST_GPU(sun_shadow_matches_rays)
{
    for (int cascades = 1; cascades <= 4; cascades++) {
        struct frame_fixture s;
        begin(&s, gpu, 64);
        s.options.cascades = cascades;
        fixture_add_sun(&s, glms_vec3_negate(towards_sun(UP)), LUX);
        fixture_open(&s);
        fixture_render(&s);
        int checked, wrong = count_wrong(&s, towards_sun, 0.35f, &checked);
        CHECK(checked > 1000 && wrong == 0);
        fixture_finish(&s);
    }
}

TEST_GPU(point_shadow_matches_rays)
{
    struct frame_fixture s;
    begin(&s, gpu, 64);
    fixture_add_point(&s, vec3_of(0.3f, 2.5f, 0.2f), LUX);
    fixture_open(&s);
    fixture_render(&s);
    int checked, wrong = count_wrong(&s, towards_point, 0.2f, &checked);
    CHECK(checked > 1000 && wrong == 0);
    fixture_finish(&s);
}

TEST_GPU(spot_shadow_matches_rays)
{
    struct frame_fixture s;
    begin(&s, gpu, 64);
    fixture_look(&s, vec3_of(1.5f, 2, 0), vec3_of(0, 0, 0));
    fixture_add_spot(&s, vec3_of(0.3f, 2.5f, 0.2f), vec3_of(0, -1, 0), 1.25f, 1.3f,
                     vec3_of(10000, 10000, 10000));
    fixture_open(&s);
    fixture_render(&s);
    int checked, wrong = count_wrong(&s, towards_point, 0.2f, &checked);
    CHECK(checked > 1000 && wrong == 0);
    fixture_finish(&s);
}

TEST_GPU(masked_casters_are_transparent_where_cut)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    uint8_t rgba[16] = {
        255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 0, 255, 255, 255, 255
    };
    int image = scene_add_image(
        s.scene, &(struct scene_image){
                     .name = "checker", .width = 2, .height = 2, .rgba = rgba, .has_alpha = true });
    struct material m = material_default();
    m.base_color_map.image = image;
    m.base_color_map.nearest = true;
    m.alpha_mode = ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    int checker = fixture_material(&s, &m);
    fixture_floor(&s, 3, fixture_matte(&s, GREY));
    fixture_quad(&s, vec3_of(-1, 2, 1), vec3_of(1, 2, 1), vec3_of(1, 2, -1), vec3_of(-1, 2, -1),
                 checker);
    fixture_add_sun(&s, vec3_of(0, -1, 0), LUX);
    fixture_look(&s, vec3_of(0, 1.5f, 0.01f), vec3_of(0, 0, 0));
    fixture_open(&s);
    fixture_render(&s);
    // Texels: opaque at top left (−x, −z) and bottom right; the camera's up is −z.
    CHECK(fixture_pixel(&s, READ_DIRECT, 8, 8).x == 0);
    CHECK(fixture_pixel(&s, READ_DIRECT, 24, 24).x == 0);
    CHECK(fixture_pixel(&s, READ_DIRECT, 24, 8).x > 100);
    CHECK(fixture_pixel(&s, READ_DIRECT, 8, 24).x > 100);
    fixture_finish(&s);
}

TEST_GPU(casters_far_outside_a_cascade_cast_shadows)
{
    struct frame_fixture s;
    begin(&s, gpu, 32);
    // A roof far above the near cascades.
    fixture_quad(&s, vec3_of(-9, 60, 9), vec3_of(9, 60, 9), vec3_of(9, 60, -9), vec3_of(-9, 60, -9),
                 0);
    fixture_add_sun(&s, vec3_of(0, -1, 0), LUX);
    fixture_open(&s);
    fixture_render(&s);
    float *direct = fixture_read(&s, READ_DIRECT), *position = fixture_read(&s, READ_POSITION);
    for (size_t i = 0; i < 32 * 32; i++)
        if (fabsf(position[3 * i]) < 8 && fabsf(position[3 * i + 2]) < 8) CHECK(direct[3 * i] == 0);
    free(direct);
    free(position);
    fixture_finish(&s);
}

// A floor in the sun has no shadow: direct light equals the closed form.
TEST_GPU(plane_does_not_shadow_itself_at_any_angle)
{
    for (int i = 1; i < 9; i++) {
        struct frame_fixture s;
        fixture_init(&s, gpu);
        fixture_floor(&s, 10, fixture_matte(&s, GREY));
        float angle = 1.5f * (float)i / 9;
        fixture_add_sun(&s, vec3_of(-sinf(angle), -cosf(angle), 0.1f), LUX);
        fixture_look(&s, vec3_of(0, 1, 2), vec3_of(0, 0, 0));
        fixture_open(&s);
        fixture_render(&s);
        float *shadowed = fixture_read(&s, READ_DIRECT);
        float lambert = 1000 * s.lights[0].direction.y * -0.5f / 3.14159f;
        for (size_t p = 16 * 32; p < 32 * 32; p++) CHECK(shadowed[3 * p] > 0.97f * lambert);
        free(shadowed);
        fixture_finish(&s);
    }
}

// at_edges: minimum fraction of the unshadowed light along edges.
static void check_closed_box(struct gpu *gpu, int radius, float at_edges)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    s.options.shadow_filter = radius;
    s.options.shadow_size = 512; // 256 for points
    fixture_box(&s, vec3_of(-2, 0, -3), vec3_of(2, 3, 3), true, fixture_matte(&s, GREY));
    vec3s light = vec3_of(0.5f, 1.9f, -0.3f);
    fixture_add_point(&s, light, LUX);
    fixture_look(&s, vec3_of(1.8f, 0.3f, 2.8f), vec3_of(-1, 1.8f, -2));
    s.width = s.height = 64;
    fixture_open(&s);
    fixture_render(&s);
    float *direct = fixture_read(&s, READ_DIRECT), *position = fixture_read(&s, READ_POSITION);
    float *normal = fixture_read(&s, READ_NORMAL);
    for (size_t i = 0; i < 64 * 64; i++) {
        vec3s to = glms_vec3_sub(
            light, vec3_of(position[3 * i], position[3 * i + 1], position[3 * i + 2]));
        vec3s n = vec3_of(normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]);
        float r2 = glms_vec3_norm2(to), cosine = glms_vec3_dot(n, to) / sqrtf(r2);
        // Along edges the filter also covers the other wall, which is nearer to the light.
        int walls = (fabsf(position[3 * i]) > 1.88f) + (fabsf(position[3 * i + 1] - 1.5f) > 1.38f) +
                    (fabsf(position[3 * i + 2]) > 2.88f);
        float least = walls > 1 ? at_edges : 0.97f;
        CHECK(direct[3 * i] > least * 1000 / r2 * cosine * 0.5f / 3.14159f);
    }
    free(direct);
    free(position);
    free(normal);
    fixture_finish(&s);
}

// Along edges half of the filter covers the other wall; rasterisation adds half a texel, a sixth of
// a filter of three texels, a tenth of one of five.
TEST_GPU(point_light_in_a_closed_box_lights_every_pixel)
{
    check_closed_box(gpu, 0, 0.97f); // no filter, also along edges
    check_closed_box(gpu, 1, 1.0f / 3.0f);
    check_closed_box(gpu, 2, 0.4f);
}

// Direct light seen from above. Views that differ by a whole pixel or a quarter turn sample the
// same floor points, whose light must not depend on the camera.
static float *top_view(struct frame_fixture *s, float shift_x, float shift_z, float angle)
{
    s->input.camera = (struct world_camera){ .eye = vec3_of(shift_x, 4, shift_z),
                                             .forward = vec3_of(0, -1, 0),
                                             .up = vec3_of(sinf(angle), 0, -cosf(angle)),
                                             .vertical_fov_rad = 0.9f,
                                             .near_m = 0.05f };
    fixture_render(s);
    return fixture_read(s, READ_DIRECT);
}

TEST_GPU(sun_shadow_edge_is_stable_while_the_camera_moves)
{
    struct frame_fixture s;
    begin(&s, gpu, 64);
    fixture_floor(&s, 100, 0); // larger than the first cascade
    s.options.cascades = 3;
    fixture_add_sun(&s, vec3_of(-0.9f, -1, -0.3f), LUX);
    fixture_open(&s);
    // Pixels on the floor are 8 tan(0.45) / 64 m wide: shift by exactly one.
    float pixel = 8 * tanf(0.45f) / 64;
    float *a = top_view(&s, 0, 0, 0), *b = top_view(&s, pixel, 0, 0);
    int edges = 0;
    for (uint32_t y = 0; y < 64; y++) {
        for (uint32_t x = 1; x < 64; x++) {
            float was = a[3 * (y * 64 + x)], is = b[3 * (y * 64 + x - 1)];
            edges += was > 10 && was < 210;
            CHECK_NEAR(is, was, 12.0); // of 230 lx/sr: only the GGX highlight moves
        }
    }
    CHECK(edges > 10);
    free(a);
    free(b);
    fixture_finish(&s);
}

TEST_GPU(sun_shadow_edge_is_stable_while_the_camera_rotates)
{
    struct frame_fixture s;
    begin(&s, gpu, 64);
    fixture_floor(&s, 100, 0);
    fixture_add_sun(&s, vec3_of(-0.9f, -1, -0.3f), LUX);
    fixture_open(&s);
    // A quarter turn maps pixel centres onto pixel centres: up turns from −z to +x.
    float *a = top_view(&s, 0, 0, 0), *b = top_view(&s, 0, 0, 1.57079633f);
    for (uint32_t y = 0; y < 64; y++) {
        for (uint32_t x = 0; x < 64; x++) {
            // Screen right of b is +z, its up is +x.
            float was = a[3 * (y * 64 + x)], is = b[3 * ((63 - x) * 64 + y)];
            CHECK_NEAR(is, was, 2.0);
        }
    }
    free(a);
    free(b);
    fixture_finish(&s);
}

// ---- Sharp edges (shadow_filter 0) --------------------------------------------------------------

// Pixels of a layer of light that are lit although they should not be, and the reverse.
struct wrong_pixels {
    int lit, dark, checked;
};

// A floor, a box on it and a sun at this azimuth, viewed obliquely. The shadow of the box on the
// floor against the box's slabs (Kay & Kajiya 1986), except within margin_m of its edge.
static bool box_occludes(vec3s p, vec3s to_sun, vec3s half)
{
    float enter = 0, leave = 1e9f;
    for (int k = 0; k < 3; k++) {
        float low = (k == 1 ? 0 : -half.raw[k]) - p.raw[k], high = half.raw[k] - p.raw[k];
        float a = low / to_sun.raw[k], b = high / to_sun.raw[k];
        enter = fmaxf(enter, fminf(a, b));
        leave = fminf(leave, fmaxf(a, b));
    }
    return enter < leave;
}

static struct wrong_pixels box_on_floor(struct gpu *gpu, vec3s to_sun, float margin_m)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    const vec3s half = vec3_of(0.5f, 0.4f, 0.3f);
    int matte = fixture_matte(&s, GREY);
    fixture_floor(&s, 4, matte);
    fixture_box(&s, vec3_of(-0.5f, 0, -0.3f), half, false, matte);
    s.width = s.height = 128;
    s.options.shadow_size = 512; // texels of 16 mm, and pixels
    fixture_add_sun(&s, glms_vec3_negate(to_sun), LUX);
    fixture_look(&s, vec3_of(0.7f, 2, 1.7f), vec3_of(0, 0, 0));
    fixture_open(&s);
    fixture_render(&s);
    float *direct = fixture_read(&s, READ_DIRECT), *position = fixture_read(&s, READ_POSITION);
    struct wrong_pixels w = { 0 };
    for (size_t i = 0; i < (size_t)s.width * s.height; i++) {
        vec3s p = vec3_of(position[3 * i], 0, position[3 * i + 2]);
        if (fabsf(position[3 * i + 1]) > 1e-3f || (p.x == 0 && p.z == 0)) continue;
        vec3s grow = vec3_of(margin_m, margin_m, margin_m);
        bool wide = box_occludes(p, to_sun, glms_vec3_add(half, grow));
        bool narrow = box_occludes(p, to_sun, glms_vec3_sub(half, grow));
        if (wide != narrow) continue;
        w.checked++;
        w.lit += wide && direct[3 * i] > 1;
        w.dark += !wide && direct[3 * i] < 1;
    }
    free(direct);
    free(position);
    fixture_finish(&s);
    return w;
}

// Half a texel is the largest error of an edge; contact of box and floor has no gap of light and no
// dark line.
TEST_GPU(shadow_of_a_box_on_a_floor_is_exact_to_half_a_texel)
{
    struct wrong_pixels sum = { 0 };
    for (int i = 0; i < 8; i++) {
        float azimuth = 0.3f + 0.785f * (float)i;
        struct wrong_pixels w =
            box_on_floor(gpu, vec3_of(cosf(azimuth), 0.9f, sinf(azimuth)), 0.01f);
        sum.lit += w.lit;
        sum.dark += w.dark;
        sum.checked += w.checked;
    }
    printf("box on a floor: %d of %d pixels lit in the shadow, %d dark in the sun\n", sum.lit,
           sum.checked, sum.dark);
    CHECK(sum.checked > 50000 && sum.lit + sum.dark <= sum.checked / 10000);
}

// A closed room of single sheets in the sun stays dark, also along seams of walls and ceiling.
TEST_GPU(closed_room_has_no_light_along_its_seams)
{
    int lit = 0;
    for (int i = 0; i < 8; i++) {
        struct frame_fixture s;
        fixture_init(&s, gpu);
        fixture_box(&s, vec3_of(-2, 0, -3), vec3_of(2, 3, 3), true, fixture_matte(&s, GREY));
        fixture_floor(&s, 8, 0);
        float azimuth = 0.2f + 0.785f * (float)i;
        fixture_add_sun(&s, vec3_of(cosf(azimuth), -1, sinf(azimuth)), LUX);
        fixture_look(&s, vec3_of(1.8f, 0.3f, 2.8f), vec3_of(-1, 2.4f, -2));
        s.width = s.height = 128;
        s.options.shadow_size = 1024;
        fixture_open(&s);
        fixture_render(&s);
        float *direct = fixture_read(&s, READ_DIRECT);
        for (size_t p = 0; p < 128 * 128; p++) lit += direct[3 * p] > 1;
        free(direct);
        fixture_finish(&s);
    }
    printf("closed room: %d of %d pixels lit\n", lit, 8 * 128 * 128);
    // The tolerance of the test, a sixteenth of a texel, along 300 pixels of seams per view.
    CHECK(lit <= 8 * 300 / 16 / 8);
}

// Lit planes at all angles to sun and camera: no dark pixel.
TEST_GPU(slanted_planes_have_no_acne)
{
    int dark = 0, checked = 0;
    for (int i = 0; i < 24; i++) {
        struct frame_fixture s;
        fixture_init(&s, gpu);
        float tilt = 0.06f * (float)i;
        vec3s u = vec3_of(cosf(tilt), sinf(tilt), 0), v = vec3_of(0, 0, -1);
        u = glms_vec3_scale(u, 3);
        v = glms_vec3_scale(v, 3);
        vec3s low = glms_vec3_negate(glms_vec3_add(u, v));
        fixture_quad(&s, low, glms_vec3_sub(u, v), glms_vec3_add(u, v), glms_vec3_sub(v, u),
                     fixture_matte(&s, GREY));
        fixture_add_sun(&s, vec3_of(0.05f, -1, 0.02f * (float)i), LUX);
        vec3s normal = glms_vec3_normalize(glms_vec3_cross(u, v));
        fixture_look(&s, glms_vec3_muladds(normal, 2, vec3_of(0.2f, 0.3f, 0.5f)),
                     vec3_of(0.1f, 0, 0));
        s.width = s.height = 64;
        fixture_open(&s);
        fixture_render(&s);
        float *direct = fixture_read(&s, READ_DIRECT), *depth = fixture_read(&s, READ_DEPTH);
        for (size_t p = 0; p < 64 * 64; p++) {
            checked += depth[p] > 0;
            dark += depth[p] > 0 && direct[3 * p] == 0;
        }
        free(direct);
        free(depth);
        fixture_finish(&s);
    }
    printf("slanted planes: %d of %d pixels dark\n", dark, checked);
    CHECK(checked > 50000 && dark == 0);
}
