// Materials of static surfaces that change while a renderer uses them: indirect light is that of a
// bake of the changed scene, or a warning says once that it is not.
#include "api/renderer_fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- A white room with a block and a panel under its ceiling

enum { WALLS, BLOCK, PANEL };

static const float CORNERS[24] = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                   0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1 };
static const uint32_t OUTWARD[36] = { 0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                      3, 6, 2, 3, 7, 6, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5 };

static void add_box(struct ag_scene *scene, const float least[3], const float size[3], bool inward,
                    int material)
{
    float positions[24];
    uint32_t indices[36];
    int mesh;
    for (int i = 0; i < 24; i++) positions[i] = least[i % 3] + size[i % 3] * CORNERS[i];
    for (int i = 0; i < 36; i++) indices[i] = OUTWARD[inward ? 35 - i : i];
    const struct ag_mesh_desc desc = { .positions = positions,
                                       .vertex_count = 8,
                                       .indices = indices,
                                       .index_count = 36,
                                       .material = material };
    assert_int_equal(ag_scene_add_mesh(scene, &desc, &mesh), AG_OK);
    assert_int_equal(ag_scene_add_instance(scene, mesh, NULL, NULL), AG_OK);
}

static void add_material(struct ag_scene *scene, float red, float green, float blue)
{
    struct ag_material_desc material;
    ag_material_desc_default(&material);
    material.base_color[0] = red;
    material.base_color[1] = green;
    material.base_color[2] = blue;
    assert_int_equal(ag_scene_add_material(scene, &material, NULL), AG_OK);
}

static struct ag_scene *make_room(struct ag_context *context)
{
    static const float ROOM[2][3] = { { -2, 0, -2 }, { 4, 3, 4 } };
    static const float CUBE[2][3] = { { -1.2f, 0, -1 }, { 1, 1.2f, 1 } };
    static const float RED[3] = { 100, 20, 10 };
    struct ag_scene *scene = NULL;
    struct ag_area_light_desc panel;
    assert_int_equal(ag_scene_create(context, &scene), AG_OK);
    add_material(scene, 0.7f, 0.7f, 0.7f);
    add_material(scene, 0.8f, 0.3f, 0.2f);
    add_box(scene, ROOM[0], ROOM[1], true, WALLS);
    add_box(scene, CUBE[0], CUBE[1], false, BLOCK);
    ag_area_light_desc_default(&panel);
    panel.position[1] = 2.9f;
    memcpy(panel.radiance, RED, sizeof RED);
    assert_int_equal(ag_scene_add_area_light(scene, &panel, NULL), AG_OK);
    return scene;
}

// ---- Changes

static void set_panel(struct ag_material_desc *m, float red, float green, float blue)
{
    m->emissive[0] = red;
    m->emissive[1] = green;
    m->emissive[2] = blue;
}

static void brighten(struct ag_material_desc *m)
{
    set_panel(m, 400, 80, 40);
}

static void turn_blue(struct ag_material_desc *m)
{
    set_panel(m, 10, 20, 100);
}

static void paint(struct ag_material_desc *m)
{
    m->base_color[0] = m->base_color[1] = m->base_color[2] = 0.3f;
}

static void plate(struct ag_material_desc *m)
{
    m->metallic = 1.0f;
    m->roughness = 0.6f;
    m->base_color[0] = 0.1f;
    m->base_color[1] = m->base_color[2] = 0.9f;
}

struct change {
    const char *name;
    int material;
    void (*apply)(struct ag_material_desc *material);
};
static const struct change changes[] = {
    { "panel four times as bright", PANEL, brighten },
    { "panel from red to blue", PANEL, turn_blue },
    { "white walls painted", WALLS, paint },
    { "block of metal", BLOCK, plate },
};
enum { CHANGES = sizeof changes / sizeof *changes, EMISSION = 3, ALL = 15 }; // bits of `changes`

// Returns what the material was.
static struct ag_material_desc apply(struct ag_scene *scene, const struct change *change)
{
    struct ag_material_info info;
    assert_int_equal(ag_scene_get_material(scene, change->material, &info), AG_OK);
    const struct ag_material_desc before = info.material;
    change->apply(&info.material);
    assert_int_equal(ag_scene_set_material(scene, change->material, &info.material), AG_OK);
    return before;
}

static void restore(struct ag_scene *scene, const struct change *change,
                    const struct ag_material_desc *before)
{
    assert_int_equal(ag_scene_set_material(scene, change->material, before), AG_OK);
}

// ---- Renderers

// follows: bits of `changes` whose light is that of a bake of the changed scene. error: mean
// difference of the images over their mean, at most.
#define SMALL_MRT                                                                                  \
    "maze=plane,texels=6,rays=256,modes=12,lightfield_positions=4,lightfield_directions=6,"        \
    "lightfield_supersampling=1,lightfield_modes=16,lightfield_rounds=0,response_modes=8,"         \
    "block_probes=2"

struct subject {
    const char *gi;
    unsigned follows;
    bool bakes;
    double error;
    bool moves; // the block is movable
};

static struct ag_scene *make_room_for(struct ag_context *context, const struct subject *subject)
{
    struct ag_scene *scene = make_room(context);
    if (subject->moves)
        assert_int_equal(ag_scene_set_instance_mobility(scene, BLOCK, AG_MOBILITY_MOVABLE), AG_OK);
    return scene;
}

// The scene outlives the renderer; a bake of the scene ends, so that surfaces may change.
static struct ag_renderer *make_renderer(struct renderer_fixture *s, struct ag_scene *scene,
                                         const struct subject *subject)
{
    const struct ag_technique_info info = { .needs_bake = subject->bakes };
    struct renderer_fixture of_bake = *s;
    struct ag_renderer *renderer = NULL;
    struct ag_renderer_desc desc = fixture_renderer_desc(subject->gi);
    of_bake.scene = scene;
    struct ag_bake *bake = fixture_bake(&of_bake, subject->gi, &info);
    const struct ag_bake *bakes[] = { bake };
    desc.bakes = bakes;
    desc.bake_count = bake != NULL;
    desc.wait_for_updates = true;
    if (ag_renderer_create(s->device, scene, &desc, &renderer) != AG_OK)
        fail_msg("%s: %s", subject->gi, ag_context_last_error(s->context));
    ag_bake_destroy(bake);
    return renderer;
}

// Frames until light has followed.
static int frames = 1;

static struct ag_image *irradiance_of(struct renderer_fixture *s, struct ag_renderer *renderer)
{
    for (int i = 0; i < frames; i++)
        assert_int_equal(ag_renderer_render(renderer, &s->frame), AG_OK);
    return fixture_read_from(s, renderer, "irradiance");
}

static struct ag_image *fresh_irradiance(struct renderer_fixture *s, const struct subject *subject,
                                         const struct change *change)
{
    struct ag_scene *scene = make_room_for(s->context, subject);
    apply(scene, change);
    struct ag_renderer *renderer = make_renderer(s, scene, subject);
    struct ag_image *image = irradiance_of(s, renderer);
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
    return image;
}

// One warning at the first frame, none later.
static void check_warning(struct renderer_fixture *s, struct ag_renderer *renderer, bool expected)
{
    if (expected != (fixture_last_warning[0] != 0))
        fail_msg("warning \"%s\", expected %s", fixture_last_warning, expected ? "one" : "none");
    if (expected && !strstr(fixture_last_warning, "bake")) fail_msg("%s", fixture_last_warning);
    fixture_last_warning[0] = 0;
    ag_image_destroy(s->context, irradiance_of(s, renderer));
    assert_string_equal(fixture_last_warning, "");
}

static void check_change(struct renderer_fixture *s, const struct subject *subject, int k)
{
    const bool follows = subject->follows >> k & 1;
    struct ag_scene *scene = make_room_for(s->context, subject);
    struct ag_renderer *renderer = make_renderer(s, scene, subject);
    struct ag_image *before = irradiance_of(s, renderer);
    fixture_last_warning[0] = 0;
    const struct ag_material_desc former = apply(scene, &changes[k]);
    struct ag_image *now = irradiance_of(s, renderer);
    check_warning(s, renderer, !follows);
    restore(scene, &changes[k], &former);
    struct ag_image *back = irradiance_of(s, renderer);
    struct ag_image *fresh = fresh_irradiance(s, subject, &changes[k]);
    const double error = fixture_difference(now, fresh), change = fixture_difference(before, fresh);
    print_message("%-10.10s %-28s changes by %.3f, differs by %.5f, back by %.3g\n", subject->gi,
                  changes[k].name, change, error, fixture_difference(back, before));
    if (follows) CHECK(error <= subject->error);
    if (follows && subject->bakes) CHECK(change > 0.01);
    CHECK(fixture_difference(back, before) <= (subject->bakes ? 0.0 : subject->error));
    struct ag_image *images[] = { before, now, back, fresh };
    for (int i = 0; i < 4; i++) ag_image_destroy(s->context, images[i]);
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
}

static void check_changes(const struct subject *subject)
{
    static const float EYE[3] = { 1.6f, 1.6f, 1.7f }, TARGET[3] = { -0.6f, 0.8f, -0.8f };
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_scene *scene = make_room(s.context);
    frames = strncmp(subject->gi, "vct", 3) == 0 ? 17 : 1; // its light follows within 16
    assert_int_equal(ag_scene_look_at(scene, EYE, TARGET, 1.2f, &s.frame.camera), AG_OK);
    ag_scene_destroy(scene);
    for (int k = 0; k < CHANGES; k++) check_change(&s, subject, k);
    fixture_close(&s);
}

TEST(radiosity_follows_emission_and_reflectance)
{
    check_changes(
        &(struct subject){ "radiosity:texels=4096,rays=64,sources=16", ALL, true, 0.0, false });
}

TEST(ort_follows_emission)
{
    check_changes(
        &(struct subject){ "ort:texels=2048,rays=64,offsets=64", EMISSION, true, 0.0, false });
}

TEST(prt_warns)
{
    check_changes(&(struct subject){ "prt:texels=2048,rays=64", 0, true, 0.0, false });
}

TEST(mrt_follows_emission_and_reflectance)
{
    check_changes(&(struct subject){ "mrt:" SMALL_MRT, ALL, true, 0.0, false });
}

TEST(drt_follows_emission_and_reflectance)
{
    check_changes(&(struct subject){ "drt:" FIXTURE_SMALL_DICTIONARY, ALL, true, 0.0, false });
}

// The bake is that of the movable block alone; lpv follows the rest.
TEST(dnrt_warns_of_its_objects)
{
    check_changes(&(struct subject){ "lpv:dim=16,probes=true+dnrt:size=16,rays=16",
                                     EMISSION | 1 << 2, true, 0.0, true });
}

// Without a bake all surfaces are those of the frame. vct still settles after its frames.
TEST(techniques_without_a_bake_follow_or_depend_on_neither)
{
    struct ag_technique_info info;
    char gi[FIXTURE_SPEC];
    for (int t = 0; ag_technique_get(t, &info); t++) {
        if (info.needs_bake) continue;
        fixture_print_base(t, &info, gi);
        check_changes(&(struct subject){ gi, ALL, false, 0.05, false });
    }
}

static double mean_of(const struct ag_image *image)
{
    const int count = image->width * image->height * image->channels;
    double sum = 0;
    for (int i = 0; i < count; i++) sum += (double)image->pixels[i] / count;
    return sum;
}

static double mean_irradiance(struct renderer_fixture *s, struct ag_renderer *renderer)
{
    struct ag_image *image = irradiance_of(s, renderer);
    const double mean = mean_of(image);
    ag_image_destroy(s->context, image);
    return mean;
}

// ---- A furnace: in a closed room of albedo ρ and emission L the irradiance is π L / (1 − ρ)

static struct ag_material_desc furnace_material(float albedo, float emission)
{
    struct ag_material_desc m;
    ag_material_desc_default(&m);
    m.specular = 0.0f;
    for (int c = 0; c < 3; c++) {
        m.base_color[c] = albedo;
        m.emissive[c] = emission;
    }
    return m;
}

TEST(radiosity_of_a_furnace_follows_its_albedo_and_emission)
{
    static const float LEAST[3] = { -2, 0, -2 }, SIZE[3] = { 4, 3, 4 };
    static const float EYE[3] = { 1.6f, 1.6f, 1.7f }, TARGET[3] = { -0.6f, 0.8f, -0.8f };
    const struct subject subject = { "radiosity:texels=2048,rays=64,sources=16", 0, true, 0.0,
                                     false };
    const struct ag_material_desc dark = furnace_material(0.5f, 10.0f);
    const struct ag_material_desc bright = furnace_material(0.8f, 25.0f);
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_scene *scene = NULL;
    assert_int_equal(ag_scene_create(s.context, &scene), AG_OK);
    assert_int_equal(ag_scene_add_material(scene, &dark, NULL), AG_OK);
    add_box(scene, LEAST, SIZE, true, 0);
    assert_int_equal(ag_scene_look_at(scene, EYE, TARGET, 1.2f, &s.frame.camera), AG_OK);
    struct ag_renderer *renderer = make_renderer(&s, scene, &subject);
    const double before = mean_irradiance(&s, renderer) / (M_PI * 10.0 / 0.5);
    assert_int_equal(ag_scene_set_material(scene, 0, &bright), AG_OK);
    const double after = mean_irradiance(&s, renderer) / (M_PI * 25.0 / 0.2);
    print_message("irradiance of the furnace: %.4f, changed %.4f of the exact one\n", before,
                  after);
    CHECK(fabs(before - 1.0) < 0.01 && fabs(after - 1.0) < 0.01);
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
    fixture_close(&s);
}

// ---- Keys, and updates over frames

static uint64_t key_hash(struct ag_scene *scene)
{
    struct ag_bake *bake = NULL;
    struct ag_bake_info info;
    uint64_t hash = 14695981039346656037u; // FNV-1a
    assert_int_equal(ag_bake_create(scene, "radiosity:texels=4096,rays=64,sources=16", NULL, &bake),
                     AG_OK);
    assert_int_equal(ag_bake_get_info(bake, &info), AG_OK);
    for (const char *c = info.key; *c; c++) hash = (hash ^ (unsigned char)*c) * 1099511628211u;
    ag_bake_destroy(bake);
    return hash;
}

static void turn_dark(struct ag_material_desc *m)
{
    set_panel(m, 0, 0, 0);
}

static void show_backs(struct ag_material_desc *m)
{
    m->double_sided = !m->double_sided;
}

TEST(a_bake_of_radiosity_is_that_of_the_scene_with_other_factors)
{
    const struct change others[] = { { "", PANEL, turn_dark }, { "", BLOCK, show_backs } };
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = make_room(context);
    const uint64_t key = key_hash(scene);
    for (int k = 0; k < CHANGES; k++) {
        apply(scene, &changes[k]);
        assert_true(key_hash(scene) == key);
    }
    for (int k = 0; k < 2; k++) {
        const struct ag_material_desc before = apply(scene, &others[k]);
        assert_true(key_hash(scene) != key);
        restore(scene, &others[k], &before);
    }
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

// Index of the image that is the same to the bit; -1: none.
static int find_same(const struct ag_image *image, struct ag_image *const *among, int count)
{
    for (int i = 0; i < count; i++)
        if (fixture_difference(image, among[i]) == 0.0) return i;
    return -1;
}

// A change during an update over frames: each image is whole, of one of the three moments.
TEST(updates_over_frames_take_materials_over_between_two_updates)
{
    enum { MOMENTS = 3, FRAMES = 14 };
    static const float EYE[3] = { 1.6f, 1.6f, 1.7f }, TARGET[3] = { -0.6f, 0.8f, -0.8f };
    struct subject subject = { "radiosity:texels=4096,rays=64,sources=16", 0, true, 0.0, false };
    const struct change *steps[2] = { &changes[1], &changes[2] };
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_scene *scene = make_room(s.context);
    struct ag_image *moments[MOMENTS];
    frames = 1;
    assert_int_equal(ag_scene_look_at(scene, EYE, TARGET, 1.2f, &s.frame.camera), AG_OK);
    struct ag_renderer *at_once = make_renderer(&s, scene, &subject);
    subject.gi = "radiosity:texels=4096,rays=64,sources=16,frames=4";
    struct ag_renderer *over_frames = make_renderer(&s, scene, &subject);
    ag_image_destroy(s.context, irradiance_of(&s, over_frames));
    moments[0] = irradiance_of(&s, at_once);
    int last = 0;
    for (int i = 0; i < FRAMES; i++) {
        if (i == 1 || i == 3) {
            apply(scene, steps[i / 2]);
            moments[1 + i / 2] = irradiance_of(&s, at_once);
        }
        struct ag_image *image = irradiance_of(&s, over_frames);
        const int now = find_same(image, moments, i < 1 ? 1 : i < 3 ? 2 : MOMENTS);
        if (now < last) fail_msg("frame %d is that of moment %d after %d", i, now, last);
        ag_image_destroy(s.context, image);
        last = now;
    }
    assert_int_equal(last, MOMENTS - 1);
    for (int i = 0; i < MOMENTS; i++) ag_image_destroy(s.context, moments[i]);
    ag_renderer_destroy(at_once);
    ag_renderer_destroy(over_frames);
    ag_scene_destroy(scene);
    fixture_close(&s);
}

// ---- More emissive materials than a bake has columns

static void add_panels(struct ag_scene *scene, int count)
{
    for (int i = 0; i < count; i++) {
        struct ag_area_light_desc panel;
        ag_area_light_desc_default(&panel);
        panel.position[0] = 0.4f * (float)(i % 8) - 1.5f;
        panel.position[1] = 2.5f;
        panel.position[2] = 0.5f * (float)(i / 8) - 1.0f;
        panel.width = panel.height = 0.3f;
        panel.radiance[0] = panel.radiance[1] = panel.radiance[2] = 200.0f;
        assert_int_equal(ag_scene_add_area_light(scene, &panel, NULL), AG_OK);
    }
}

// The first panel has columns of its own; the last one shares them, and warns.
TEST(radiosity_warns_once_of_an_emissive_material_without_columns)
{
    enum { PANELS = 20 };
    static const float EYE[3] = { 1.6f, 1.6f, 1.7f }, TARGET[3] = { -0.6f, 0.8f, -0.8f };
    const struct subject subject = { "radiosity:texels=2048,rays=64,sources=16", 0, true, 0.0,
                                     false };
    const struct change first = { "", PANEL, brighten }, last = { "", PANEL + PANELS, brighten };
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_scene *scene = make_room(s.context);
    add_panels(scene, PANELS);
    assert_int_equal(ag_scene_look_at(scene, EYE, TARGET, 1.2f, &s.frame.camera), AG_OK);
    struct ag_renderer *renderer = make_renderer(&s, scene, &subject);
    const double before = mean_irradiance(&s, renderer);
    fixture_last_warning[0] = 0;
    apply(scene, &first);
    const double brighter = mean_irradiance(&s, renderer);
    print_message("mean irradiance %.1f, with a brighter panel %.1f lux\n", before, brighter);
    CHECK(brighter > 1.1 * before);
    assert_string_equal(fixture_last_warning, "");
    apply(scene, &last);
    const double stays = mean_irradiance(&s, renderer);
    CHECK(fabs(stays - brighter) < 1e-6 * brighter);
    CHECK(strstr(fixture_last_warning, "more emissive materials than a bake keeps apart"));
    fixture_last_warning[0] = 0;
    apply(scene, &(struct change){ "", PANEL + PANELS, turn_blue });
    mean_irradiance(&s, renderer);
    assert_string_equal(fixture_last_warning, "");
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
    fixture_close(&s);
}
