// Reflections in screen space against closed forms: a mirror, a furnace, rays without a hit.
#include "core/ggx_albedo.h"
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT };

static const float MARGIN_M = 0.25f; // some pixels at the panel's distance
static const float WALL_Z = -3, EMISSION = 1000, REFLECTANCE = 0.8f;
static const struct box3 panel = { { { -1.5f, 0.5f, -3 } }, { { 1.5f, 2, -3 } } };

static int metal(struct frame_fixture *s, float roughness)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(REFLECTANCE, REFLECTANCE, REFLECTANCE), 1);
    m.metallic = 1;
    m.roughness = roughness;
    return fixture_material(s, &m);
}

static void begin(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    s->width = WIDTH;
    s->height = HEIGHT;
}

static float *light(struct frame_fixture *s, const char *gi, int frames, enum frame_readback what)
{
    struct gi *stack = gi_fixture_light(s, gi);
    for (int i = 0; i < frames; i++) fixture_render(s);
    float *out = fixture_read(s, what);
    gi_destroy(stack);
    fixture_finish(s);
    return out;
}

// A metal floor before a black wall with an emissive panel.
static void open_floor(struct frame_fixture *s, struct gpu *gpu, float roughness, float emission)
{
    begin(s, gpu);
    const vec3s a = panel.min, c = panel.max;
    fixture_floor(s, 3, metal(s, roughness));
    fixture_quad(s, vec3_of(-3, 0, WALL_Z - 0.01f), vec3_of(3, 0, WALL_Z - 0.01f),
                 vec3_of(3, 3, WALL_Z - 0.01f), vec3_of(-3, 3, WALL_Z - 0.01f),
                 fixture_emissive(s, 0, 0));
    fixture_quad(s, a, vec3_of(c.x, a.y, a.z), c, vec3_of(a.x, c.y, a.z),
                 fixture_emissive(s, 0, emission));
    fixture_look(s, vec3_of(0, 1.4f, 2.8f), vec3_of(0, 0.6f, -3));
    fixture_open(s);
}

static float *floor_specular(struct gpu *gpu, const char *gi, float roughness, float emission,
                             int frames)
{
    struct frame_fixture s;
    open_floor(&s, gpu, roughness, emission);
    return light(&s, gi, frames, READ_SPECULAR);
}

// Directional albedo of the metal's lobe (brdf.glsl).
static double metal_albedo(float n_v, float roughness)
{
    const struct ggx_albedo t = ggx_albedo_at(n_v, fmaxf(roughness, GGX_MIN_ROUGHNESS));
    const float single = t.a + t.b;
    return (double)((REFLECTANCE * t.a + t.b) * (1 + REFLECTANCE * (1 - single) / single));
}

// Signed distance in m of the point that a pixel of the floor mirrors from the panel's border, > 0
// inside; NAN: the pixel is not of the floor.
static float inside_panel(const struct frame_fixture *s, int pixel, float *n_v)
{
    const uint32_t x = (uint32_t)(pixel % WIDTH), y = (uint32_t)(pixel / WIDTH);
    const vec3s eye = s->input.camera.eye;
    const vec3s p = fixture_ray_on_plane(s, x, y, vec3_of(0, 1, 0), 0);
    const vec3s to = glms_vec3_sub(p, eye);
    if (fixture_ray(s, (float)x + 0.5f, (float)y + 0.5f).y >= 0 || fabsf(p.x) > 2.9f ||
        fabsf(p.z) > 2.9f)
        return NAN;
    const float t = (WALL_Z - p.z) / to.z;
    const float hit_x = p.x + t * to.x, hit_y = -t * to.y;
    *n_v = -to.y / glms_vec3_norm(to);
    return fminf(fminf(hit_x - panel.min.x, panel.max.x - hit_x),
                 fminf(hit_y - panel.min.y, panel.max.y - hit_y));
}

TEST_GPU(a_mirror_reflects_the_radiance_of_a_panel)
{
    struct frame_fixture s;
    open_floor(&s, gpu, 0, EMISSION);
    const struct frame_fixture camera = s;
    float *specular = light(&s, "none+ssr:border=0", 1, READ_SPECULAR);
    int lit = 0, dark = 0;
    for (int i = 0; i < PIXELS; i++) {
        float n_v = 1;
        const float inside = inside_panel(&camera, i, &n_v);
        if (inside > MARGIN_M) {
            CHECK_RELATIVE((double)specular[3 * i], (double)EMISSION * metal_albedo(n_v, 0), 0.02);
            lit++;
        } else if (inside < -MARGIN_M) {
            CHECK(specular[3 * i] == 0.0f);
            dark++;
        }
    }
    print_message("%d pixels mirror the panel, %d do not\n", lit, dark);
    CHECK(lit > 200 && dark > 200);
    free(specular);
}

static double total(const float *values)
{
    double sum = 0;
    for (int i = 0; i < 3 * PIXELS; i++) sum += (double)values[i];
    return sum;
}

// Rough lobes blur the mirror image of the panel and keep its light: the sum changes by that which
// leaves the floor, and by Fresnel's factor.
TEST_GPU(a_rough_floor_reflects_as_much_as_a_mirror)
{
    float *mirror = floor_specular(gpu, "none+ssr:border=0", 0, EMISSION, 1);
    float *rough = floor_specular(gpu, "none+ssr:border=0,max_roughness=1", 0.2f, EMISSION, 1);
    print_message("rough over mirror: %.4f\n", total(rough) / total(mirror));
    CHECK_RELATIVE(total(rough), total(mirror), 0.1);
    free(mirror);
    free(rough);
}

// D V n·l of GGX (brdf.glsl), 1/sr.
static double lobe(vec3s n, vec3s v, vec3s l, double alpha)
{
    const vec3s h = glms_vec3_normalize(glms_vec3_add(v, l));
    const double n_l = (double)glms_vec3_dot(n, l), n_v = (double)glms_vec3_dot(n, v);
    const double n_h = (double)glms_vec3_dot(n, h), a2 = alpha * alpha;
    const double base = n_h * n_h * (a2 - 1) + 1;
    const double smith =
        n_l * sqrt(n_v * n_v * (1 - a2) + a2) + n_v * sqrt(n_l * n_l * (1 - a2) + a2);
    return a2 / (GLM_PI * base * base) * 0.5 / smith * n_l;
}

// Share of the lobe of a point of the floor that the panel fills, by a grid on the panel.
static double share_of_panel(vec3s p, vec3s eye, float roughness)
{
    enum { GRID = 200 };
    const vec3s up = vec3_of(0, 1, 0), v = glms_vec3_normalize(glms_vec3_sub(eye, p));
    const struct ggx_albedo t = ggx_albedo_at(v.y, roughness);
    const vec3s size = box3_size(panel);
    double sum = 0;
    for (int i = 0; i < GRID * GRID; i++) {
        const float x = ((float)(i % GRID) + 0.5f) / GRID, y = ((float)(i / GRID) + 0.5f) / GRID;
        const vec3s at = vec3_of(panel.min.x + x * size.x, panel.min.y + y * size.y, panel.min.z);
        const vec3s to = glms_vec3_sub(at, p);
        const double r = (double)glms_vec3_norm(to);
        sum += lobe(up, v, glms_vec3_normalize(to), (double)(roughness * roughness)) *
               -(double)to.z / (r * r * r);
    }
    return sum * (double)(size.x * size.y) / (GRID * GRID) / (double)(t.a + t.b);
}

TEST_GPU(a_rough_floor_reflects_the_panel_by_its_lobe)
{
    static const float roughnesses[] = { 0.15f, 0.3f };
    for (int r = 0; r < 2; r++) {
        struct frame_fixture s;
        const float roughness = roughnesses[r];
        open_floor(&s, gpu, roughness, EMISSION);
        const struct frame_fixture camera = s;
        float *specular =
            light(&s, "none+ssr:border=0,temporal=true,max_roughness=1", 16, READ_SPECULAR);
        double error = 0, sum = 0, found = 0;
        for (int y = HEIGHT / 2; y < HEIGHT; y += 3)
            for (int x = 8; x < WIDTH - 8; x += 5) {
                float n_v = 1;
                const int i = y * WIDTH + x;
                const vec3s p =
                    fixture_ray_on_plane(&camera, (uint32_t)x, (uint32_t)y, vec3_of(0, 1, 0), 0);
                if (isnan(inside_panel(&camera, i, &n_v))) continue;
                const double expected = (double)EMISSION * metal_albedo(n_v, roughness) *
                                        share_of_panel(p, camera.input.camera.eye, roughness);
                error += fabs((double)specular[3 * i] - expected);
                sum += expected;
                found += (double)specular[3 * i];
            }
        print_message("roughness %.2f: mean error %.4f, sum %.4f\n", (double)roughness, error / sum,
                      found / sum);
        CHECK(sum > 0 && error < 0.15 * sum);
        CHECK_RELATIVE(found, sum, 0.05);
        free(specular);
    }
}

TEST_GPU(half_the_light_gives_half_the_reflection)
{
    float *full = floor_specular(gpu, "none+ssr", 0.2f, EMISSION, 1);
    float *half = floor_specular(gpu, "none+ssr", 0.2f, 0.5f * EMISSION, 1);
    CHECK(total(full) > 0);
    for (int i = 0; i < 3 * PIXELS; i++) CHECK(half[i] == 0.5f * full[i]);
    free(full);
    free(half);
}

TEST_GPU(equal_frames_have_equal_reflections)
{
    float *first = floor_specular(gpu, "none+ssr", 0.2f, EMISSION, 1);
    float *again = floor_specular(gpu, "none+ssr", 0.2f, EMISSION, 1);
    float *later = floor_specular(gpu, "none+ssr", 0.2f, EMISSION, 3);
    assert_memory_equal(first, again, 3 * PIXELS * sizeof *first);
    assert_memory_equal(first, later, 3 * PIXELS * sizeof *first);
    free(first);
    free(again);
    free(later);
}

static double noise(const float *values, const float *mean)
{
    double total = 0;
    for (int i = 0; i < 3 * PIXELS; i++) total += pow((double)values[i] - (double)mean[i], 2);
    return sqrt(total);
}

TEST_GPU(frames_accumulate_to_less_noise)
{
    const char *gi = "none+ssr:temporal=true,reuse=1";
    float *mean = floor_specular(gpu, gi, 0.2f, EMISSION, 16);
    float *first = floor_specular(gpu, gi, 0.2f, EMISSION, 1);
    float *later = floor_specular(gpu, gi, 0.2f, EMISSION, 15);
    print_message("noise: %.0f in the first frame, %.0f later\n", noise(first, mean),
                  noise(later, mean));
    CHECK(noise(later, mean) < 0.3 * noise(first, mean));
    free(mean);
    free(first);
    free(later);
}

// Seen from above, the floor reflects nothing that is in the image.
static float *from_above(struct gpu *gpu, const char *gi, float roughness)
{
    struct frame_fixture s;
    begin(&s, gpu);
    fixture_box(&s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, metal(&s, roughness));
    fixture_add_point(&s, vec3_of(1, 2.5f, 1), vec3_of(100, 100, 100));
    fixture_look(&s, vec3_of(0, 2.9f, 0), vec3_of(0.001f, 0, 0));
    s.input.camera.vertical_fov_rad = 0.5f;
    fixture_open(&s);
    return light(&s, gi, 1, READ_SPECULAR);
}

TEST_GPU(rays_that_leave_the_image_keep_the_light_of_the_source)
{
    float *source = from_above(gpu, "vct:resolution=16,levels=2,specular=true", 0.2f);
    float *both = from_above(gpu, "vct:resolution=16,levels=2,specular=true+ssr", 0.2f);
    CHECK(total(source) > 0);
    assert_memory_equal(source, both, 3 * PIXELS * sizeof *source);
    free(source);
    free(both);
}

// A metal box in a black room of uniform emission: whatever a ray can hit has the same radiance.
static void open_furnace(struct frame_fixture *s, struct gpu *gpu, float roughness)
{
    fixture_init_furnace(s, gpu, 0, EMISSION);
    s->width = WIDTH;
    s->height = HEIGHT;
    fixture_box(s, vec3_of(-0.5f, 0, -1), vec3_of(0.7f, 1, 0.3f), false, metal(s, roughness));
    fixture_open(s);
}

static float *furnace(struct gpu *gpu, const char *gi, float roughness, enum frame_readback what)
{
    struct frame_fixture s;
    open_furnace(&s, gpu, roughness);
    return light(&s, gi, 1, what);
}

static double furnace_specular(const float *position, const float *normal, vec3s eye,
                               float roughness)
{
    const vec3s to = glms_vec3_sub(eye, vec3_of(position[0], position[1], position[2]));
    const vec3s n = vec3_of(normal[0], normal[1], normal[2]);
    return (double)EMISSION *
           metal_albedo(fabsf(glms_vec3_dot(n, to)) / glms_vec3_norm(to), roughness);
}

// Pixels have the light of the furnace, or lie between it and the light of the source, whose coarse
// cones have an error. Beside its lower edges the box is a pixel or two from the hits, and darker:
// their filter includes it.
TEST_GPU(a_furnace_stays_uniform)
{
    static const float roughnesses[] = { 0, 0.1f, 0.2f, 0.3f };
    static const char source_gi[] = "vct:resolution=16,storage=svo,specular=true";
    static const char both_gi[] = "vct:resolution=16,storage=svo,specular=true+ssr";
    struct frame_fixture camera;
    open_furnace(&camera, gpu, 0);
    const vec3s eye = camera.input.camera.eye;
    fixture_finish(&camera);
    float *position = furnace(gpu, "none", 0, READ_POSITION);
    float *normal = furnace(gpu, "none", 0, READ_NORMAL);
    for (int r = 0; r < 4; r++) {
        float *source = furnace(gpu, source_gi, roughnesses[r], READ_SPECULAR);
        float *both = furnace(gpu, both_gi, roughnesses[r], READ_SPECULAR);
        int changed = 0, exact = 0, others = 0;
        double sum = 0;
        for (int i = 0; i < 3 * PIXELS; i += 3) {
            if (both[i] == source[i]) continue;
            const double expected = furnace_specular(position + i, normal + i, eye, roughnesses[r]);
            const double error = fabs((double)both[i] / expected - 1);
            changed++;
            exact += error < 0.02;
            others += error > 0.05 && error > fabs((double)source[i] / expected - 1);
            sum += (double)both[i] / expected;
        }
        print_message("roughness %.1f: %d pixels change, %d are exact, %d worse; mean %.4f\n",
                      (double)roughnesses[r], changed, exact, others, sum / changed);
        CHECK(changed > 300 && exact > 0.8 * changed && others < 0.025 * changed);
        CHECK_NEAR(sum / changed, 1, 0.03);
        free(source);
        free(both);
    }
    free(position);
    free(normal);
}

// Sum of differences over the sum of b.
static double difference(const float *a, const float *b)
{
    double sum = 0;
    for (int i = 0; i < 3 * PIXELS; i++) sum += fabs((double)a[i] - (double)b[i]);
    return sum / total(b);
}

// The last of 16 frames, of a camera that moves sideways and back to the same place, or is there.
static float *seen(struct gpu *gpu, const char *gi, float roughness, float step_m)
{
    struct frame_fixture s;
    open_floor(&s, gpu, roughness, EMISSION);
    struct gi *stack = gi_fixture_light(&s, gi);
    for (int i = -15; i <= 0; i++) {
        const float x = 0.6f + step_m * (float)i, z = 2.8f + 0.5f * step_m * (float)i;
        fixture_look(&s, vec3_of(x, 1.4f, z), vec3_of(x, 0.6f, z - 5.8f));
        fixture_render(&s);
    }
    float *out = fixture_read(&s, READ_SPECULAR);
    gi_destroy(stack);
    fixture_finish(&s);
    return out;
}

// A mirror image moves otherwise than its surface: neither the panel's borders nor its light lag.
TEST_GPU(accumulated_reflections_follow_the_camera)
{
    static const float roughnesses[] = { 0, 0.2f };
    const char *gi = "none+ssr:temporal=true";
    for (int r = 0; r < 2; r++) {
        float *still = seen(gpu, gi, roughnesses[r], 0);
        float *moved = seen(gpu, gi, roughnesses[r], 0.04f);
        print_message("roughness %.1f: differs by %.4f, sums by %.4f\n", (double)roughnesses[r],
                      difference(moved, still), total(moved) / total(still) - 1);
        CHECK(difference(moved, still) < 0.08);
        CHECK_RELATIVE(total(moved), total(still), 0.03);
        free(still);
        free(moved);
    }
}

// The occluded light of a hit is reflected, not the source's.
TEST_GPU(hits_have_the_visibility_of_their_pixel)
{
    double sums[2];
    static const char *const specs[] = { "ambient+ssr", "ambient+ssao:radius=2+ssr" };
    for (int i = 0; i < 2; i++) {
        struct frame_fixture s;
        begin(&s, gpu);
        const int matte = fixture_matte(&s, vec3_of(0.7f, 0.7f, 0.7f));
        fixture_floor(&s, 3, metal(&s, 0));
        fixture_box(&s, vec3_of(-3, -0.1f, -3), vec3_of(3, 3, 3), true, matte);
        for (int k = 0; k < 4; k++)
            fixture_box(&s, vec3_of(-2 + (float)k, 0, -2.8f), vec3_of(-1.6f + (float)k, 2, -2.4f),
                        false, matte);
        fixture_look(&s, vec3_of(0, 1.4f, 2.8f), vec3_of(0, 0.6f, -3));
        s.input.environment.sky = vec3_of(100, 100, 100);
        fixture_open(&s);
        float *specular = light(&s, specs[i], 1, READ_SPECULAR);
        sums[i] = total(specular);
        free(specular);
    }
    print_message("with occlusion %.3f of the reflection without\n", sums[1] / sums[0]);
    CHECK(sums[0] > 0 && sums[1] < 0.9 * sums[0] && sums[1] > 0.2 * sums[0]);
}

// In an orthographic view all sight lines are parallel, and depths linear.
TEST_GPU(a_mirror_in_an_orthographic_view_reflects_the_panel)
{
    struct frame_fixture s;
    open_floor(&s, gpu, 0, EMISSION);
    const vec3s forward = glms_vec3_normalize(vec3_of(0, -0.3f, -1));
    const struct frame_camera camera = { .eye = vec3_of(0, 2.4f, 2.9f),
                                         .forward = forward,
                                         .up = glms_vec3_normalize(vec3_of(0, 1, -0.3f)),
                                         .left = -3,
                                         .right = 3,
                                         .bottom = -2,
                                         .top = 2,
                                         .near_m = 0.1f,
                                         .far_m = 20,
                                         .orthographic = true };
    s.input.projected = &camera;
    float *specular = light(&s, "none+ssr:border=0", 1, READ_SPECULAR);
    int lit = 0, dark = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float x = 2 * ((float)(i % WIDTH) + 0.5f) / WIDTH - 1;
        const float y = 2 * ((float)(i / WIDTH) + 0.5f) / HEIGHT - 1;
        const struct frame_sight sight = frame_camera_sight(&camera, x, y);
        const float to_floor = -sight.origin.y / forward.y;
        const vec3s p = glms_vec3_muladds(forward, to_floor, sight.origin);
        if (fabsf(p.x) > 2.9f || fabsf(p.z) > 2.9f) continue;
        const float t = (WALL_Z - p.z) / forward.z;
        const float hit_x = p.x + t * forward.x, hit_y = -t * forward.y;
        const float inside = fminf(fminf(hit_x - panel.min.x, panel.max.x - hit_x),
                                   fminf(hit_y - panel.min.y, panel.max.y - hit_y));
        if (inside > MARGIN_M) {
            CHECK_RELATIVE((double)specular[3 * i], (double)EMISSION * metal_albedo(-forward.y, 0),
                           0.02);
            lit++;
        } else if (inside < -MARGIN_M) {
            CHECK(specular[3 * i] == 0.0f);
            dark++;
        }
    }
    print_message("%d pixels mirror the panel, %d do not\n", lit, dark);
    CHECK(lit > 100 && dark > 100);
    free(specular);
}
