// Further bounces: reflecting surfaces by cell, and the light that they reflect.
#include "frame/frame_fixture.h"
#include "techniques/lpv/lpv_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDES = 6, SIDE_NUMBERS = LPV_FIXTURE_COLOURS + 1, NUMBERS = SIDES * SIDE_NUMBERS };

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    technique_lpv.update(user, cmd, view);
    technique_lpv.record(user, cmd, view);
}

static void use(struct frame_fixture *s, struct lpv *lpv)
{
    s->indirect =
        (struct frame_indirect){ .record = record, .user = lpv, .needs = technique_lpv.needs };
}

// Σ reflectance × area over all cells, and Σ area, in m²: [side][colour or area].
static void read_areas(struct lpv *lpv, double out[NUMBERS])
{
    const struct lpv_cascade *cascade = &lpv->cascades[0];
    const gpu_buffer areas =
        cascade->surfaces.at_rest ? cascade->surfaces.areas : lpv->injection.sums;
    const int32_t *cells = cascade->grid.cells;
    const size_t count = (size_t)cells[0] * (size_t)cells[1] * (size_t)cells[2];
    const double unit = (double)(cascade->grid.cell_m * cascade->grid.cell_m) / LPV_SURFACE_UNIT;
    uint32_t *words = malloc(count * NUMBERS * sizeof *words);
    CHECK(gpu_buffer_download(lpv->gpu, areas, 0, words, count * NUMBERS * sizeof *words));
    memset(out, 0, NUMBERS * sizeof *out);
    for (size_t i = 0; i < count * NUMBERS; i++) out[i % NUMBERS] += unit * words[i];
    free(words);
}

static void begin(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    fixture_look(s, vec3_of(0, 2, 5), vec3_of(0, 1, 0));
    fixture_add_sun(s, vec3_of(0.3f, -1, -0.2f), vec3_of(1, 1, 1));
}

// Lines sample the area, with an error of a border's length times half their spacing.
TEST_GPU(lpv_surfaces_have_the_area_and_colour_of_the_scene)
{
    struct frame_fixture s;
    begin(&s, gpu);
    const int matte = fixture_matte(&s, vec3_of(0.2f, 0.5f, 0.8f));
    fixture_floor(&s, 3, matte);                                            // +y
    fixture_box(&s, vec3_of(-1, 1, -1), vec3_of(1, 2, 1.5f), false, matte); // outwards
    struct node flip = node_default();
    flip.scale = vec3_of(1, -1, 1);
    flip.translation = vec3_of(0, 3, 0);
    fixture_instance(&s, 0, &flip); // the floor as a ceiling, −y
    // A slope of 4 × 5 m, n = (3/5, 4/5, 0).
    fixture_quad(&s, vec3_of(-2, 2, 2), vec3_of(2, -1, 2), vec3_of(2, -1, -2), vec3_of(-2, 2, -2),
                 matte);
    struct material metal = material_default();
    metal.metallic = 1;
    fixture_floor(&s, 2, fixture_material(&s, &metal)); // white: reflects all light
    fixture_open(&s);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=32,steps=2,bounces=1,cell_margin=1");
    use(&s, lpv);
    fixture_render(&s);
    double areas[NUMBERS];
    read_areas(lpv, areas);
    // Sides of a slope receive (1 + Σ |n_a|³)/2 of its flux, and as much of what they send leaves.
    const double share = (1 + 0.6 * 0.36 + 0.8 * 0.64) / 2, slope = 20 / (share * share);
    // +x −x +y −y +z −z
    const double expected[SIDES] = { 2.5 + slope * 0.36, 2.5, 36 + 5 + slope * 0.64, 36 + 5, 2, 2 };
    const double of_metal[SIDES] = { 0, 0, 16, 0, 0, 0 };
    const double albedo[LPV_FIXTURE_COLOURS] = { 0.2, 0.5, 0.8 };
    for (int side = 0; side < SIDES; side++)
        for (int c = 0; c < LPV_FIXTURE_COLOURS; c++)
            CHECK_RELATIVE(areas[SIDE_NUMBERS * side + c],
                           albedo[c] * expected[side] + of_metal[side], 0.06);
    lpv_fixture_destroy(lpv);
    fixture_finish(&s);
}

// An alpha mask and a double-sided material.
TEST_GPU(lpv_surfaces_respect_masks_and_sides)
{
    struct frame_fixture s;
    begin(&s, gpu);
    uint8_t pixels[2 * 4] = { 255, 255, 255, 255, 255, 255, 255, 0 }; // the right half is masked
    const int image = scene_add_image(
        s.scene, &(struct scene_image){
                     .name = "half", .width = 2, .height = 1, .rgba = pixels, .has_alpha = true });
    struct material m = material_default();
    m.metallic = 0;
    m.alpha_mode = ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    m.double_sided = true;
    m.base_color_map.image = image;
    m.base_color_map.nearest = true;
    fixture_floor(&s, 2, fixture_material(&s, &m));
    fixture_quad(&s, vec3_of(-2, 0, -2), vec3_of(2, 0, -2), vec3_of(2, 2, -2), vec3_of(-2, 2, -2),
                 fixture_matte(&s, vec3_of(1, 1, 1))); // +z, 8 m²
    fixture_open(&s);
    struct lpv *lpv = lpv_fixture_create(gpu, "lpv:dim=32,steps=2,bounces=1,cell_margin=1");
    use(&s, lpv);
    fixture_render(&s);
    double areas[NUMBERS];
    read_areas(lpv, areas);
    const double expected[SIDES] = { 0, 0, 8, 8, 8, 0 };
    for (int side = 0; side < SIDES; side++)
        CHECK_NEAR(areas[SIDE_NUMBERS * side], expected[side], 0.06 * 8);
    lpv_fixture_destroy(lpv);
    fixture_finish(&s);
}

// Sum of the irradiance of an image.
static double render_sum(struct frame_fixture *s)
{
    fixture_render(s);
    float *e = fixture_read(s, READ_IRRADIANCE);
    double sum = 0;
    for (uint32_t i = 0; i < 3 * s->width * s->height; i++) sum += (double)e[i];
    free(e);
    return sum;
}

// The box is turned about the vertical axis.
static double closed_box(struct gpu *gpu, const char *gi, float albedo, float turn_rad)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    fixture_look(&s, vec3_of(1.8f, 1.8f, 1.8f), vec3_of(-1, -1, -1));
    fixture_add_point(&s, vec3_of(0, 0, 0), vec3_of(100, 100, 100));
    fixture_box(&s, vec3_of(-2, -2, -2), vec3_of(2, 2, 2), true,
                fixture_matte(&s, vec3_of(albedo, albedo, albedo)));
    fixture_open(&s);
    for (int i = 0; i < s.scene->instance_count; i++)
        s.pose.world_from_node[s.scene->instances[i].node] =
            glms_rotate_make(turn_rad, vec3_of(0, 1, 0));
    struct lpv *lpv = lpv_fixture_create(gpu, gi);
    use(&s, lpv);
    const double sum = render_sum(&s);
    lpv_fixture_destroy(lpv);
    fixture_finish(&s);
    return sum;
}

// A point light in the centre of a closed box: the walls receive Φ ρ of its flux Φ by one bounce,
// Φ ρ / (1 − ρ) by all bounces.
static void bounces_are_near_the_geometric_series(struct gpu *gpu, const char *gi, float turn_rad,
                                                  double least)
{
    static const float albedos[] = { 0.3f, 0.6f };
    for (int i = 0; i < 2; i++) {
        char text[64];
        double mean[3];
        static const int bounces[3] = { 0, 1, 8 };
        for (int k = 0; k < 3; k++) {
            snprintf(text, sizeof text, "%s,bounces=%d", gi, bounces[k]);
            mean[k] = closed_box(gpu, text, albedos[i], turn_rad);
        }
        const double rho = (double)albedos[i], all = mean[2] / mean[0];
        print_message(
            "%s, albedo %.1f: one further bounce %.3f (expected %.3f), eight %.3f (%.3f)\n", gi,
            rho, mean[1] / mean[0], 1 + rho, all, 1 / (1 - rho));
        CHECK(mean[1] > 1.1 * mean[0] && mean[2] > mean[1]);
        CHECK(all - 1 > least * rho / (1 - rho) && all - 1 < 1.4 * rho / (1 - rho));
    }
}

// The facing wall receives too little light, and a wall some of its own.
TEST_GPU(lpv_bounces_are_near_the_geometric_series)
{
    bounces_are_near_the_geometric_series(gpu, "lpv:dim=16,steps=64", 0, 0.6);
    bounces_are_near_the_geometric_series(gpu, "holpv:dim=16,steps=64", 0, 0.6);
}

// Finer cascades start from the coarsest cascade's light, which holds all bounces, and reflect it
// once. The coarsest makes only the steps that light needs to cross it, so that the last of eight
// bounces do not propagate far.
TEST_GPU(lpv_bounces_of_cascades_are_near_the_geometric_series)
{
    bounces_are_near_the_geometric_series(gpu, "lpv:dim=16,cascades=3,steps=8", 0, 0.3);
    bounces_are_near_the_geometric_series(gpu, "holpv:dim=16,cascades=3,steps=5", 0, 0.3);
}

// Walls at 22 and 45 degrees to the axes. As sides along the axes alone they reflect .46 and .34 of
// the series.
TEST_GPU(lpv_bounces_of_slopes_are_near_the_geometric_series)
{
    bounces_are_near_the_geometric_series(gpu, "lpv:dim=16,steps=64", GLM_PIf / 8, 0.5);
    bounces_are_near_the_geometric_series(gpu, "lpv:dim=16,steps=64", GLM_PI_4f, 0.42);
}

// Two cells along an edge of the box: each is a corner, whose light leaves by three sides at
// once and is reflected once.
TEST_GPU(lpv_bounces_of_a_few_cells_make_no_light)
{
    bounces_are_near_the_geometric_series(gpu, "holpv:dim=8,steps=64", 0, 0.6);
}

TEST_GPU(lpv_bounces_are_linear)
{
    struct frame_fixture s;
    begin(&s, gpu);
    const int matte = fixture_matte(&s, vec3_of(0.7f, 0.5f, 0.3f));
    fixture_floor(&s, 3, matte);
    fixture_quad(&s, vec3_of(-3, 0, -2), vec3_of(3, 0, -2), vec3_of(3, 3, -2), vec3_of(-3, 3, -2),
                 matte);
    fixture_add_point(&s, vec3_of(1, 1, 1), vec3_of(3, 2, 1));
    fixture_open(&s);
    float *e[4];
    double most = 0;
    for (int lights = 1; lights < 4; lights++) {
        struct lpv *lpv =
            lpv_fixture_create(gpu, "lpv:dim=16,steps=24,bounces=2,precision=float,closure=linear");
        const vec3s one = lights & 1 ? vec3_of(1, 1, 1) : vec3_of(0, 0, 0);
        const vec3s two = lights & 2 ? vec3_of(3, 2, 1) : vec3_of(0, 0, 0);
        s.lights[0].intensity = one;
        s.lights[1].intensity = two;
        use(&s, lpv);
        fixture_render(&s);
        e[lights] = fixture_read(&s, READ_IRRADIANCE);
        lpv_fixture_destroy(lpv);
    }
    const size_t count = (size_t)s.width * s.height * 3;
    for (size_t i = 0; i < count; i++) most = fmax(most, (double)e[3][i]);
    for (size_t i = 0; i < count; i++) // without clamped values; 11 bits of three results
        if (e[1][i] > 0 && e[2][i] > 0)
            CHECK_NEAR((double)e[3][i], (double)e[1][i] + (double)e[2][i], 2e-3 * most);
    for (int i = 1; i < 4; i++) free(e[i]);
    fixture_finish(&s);
}

// Surfaces are cached while nothing moves and recomputed after a move.
TEST_GPU(lpv_surfaces_follow_moving_meshes)
{
    struct frame_fixture s;
    begin(&s, gpu);
    const int matte = fixture_matte(&s, vec3_of(0.7f, 0.5f, 0.3f));
    fixture_floor(&s, 3, matte);
    const int slab = fixture_quad(&s, vec3_of(-1, 1, 0), vec3_of(1, 1, 0), vec3_of(1, 2, 0),
                                  vec3_of(-1, 2, 0), matte);
    fixture_open(&s);
    struct lpv *kept = lpv_fixture_create(gpu, "lpv:dim=16,steps=16,bounces=1");
    use(&s, kept);
    const double first = render_sum(&s), second = render_sum(&s);
    CHECK(first > 0 && first == second);
    // Rotated by a right angle around the vertical axis: its normal is along x.
    mat4s *m = &s.pose.world_from_node[s.scene->instances[slab].node];
    *m = glms_rotate_make(GLM_PI_2f, vec3_of(0, 1, 0));
    const double turned = render_sum(&s);
    double areas[NUMBERS];
    read_areas(kept, areas);
    CHECK(areas[0] > 1.0 && areas[4 * SIDE_NUMBERS] < 0.1);
    lpv_fixture_destroy(kept);
    struct lpv *fresh = lpv_fixture_create(gpu, "lpv:dim=16,steps=16,bounces=1");
    use(&s, fresh);
    CHECK(render_sum(&s) == turned);
    lpv_fixture_destroy(fresh);
    fixture_finish(&s);
}
