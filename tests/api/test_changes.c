// Scenes that change while renderers use them: the next frame is that of a new renderer.
#include "api/renderer_fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PIXELS = FIXTURE_WIDTH * FIXTURE_HEIGHT };

// Column-major: turned about y, then moved.
static void placed(float out[16], float angle_rad, float x, float y, float z)
{
    const float c = cosf(angle_rad), s = sinf(angle_rad);
    const float matrix[16] = { c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, x, y, z, 1 };
    memcpy(out, matrix, sizeof matrix);
}

// A cube in the box.
struct cube {
    int material, mesh, instance;
    float size;
    bool movable;
};

static const float CORNERS[24] = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                   0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1 };
static const uint32_t FACES[36] = { 0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                    3, 6, 2, 3, 7, 6, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5 };

static void scaled(float out[24], float size)
{
    for (int i = 0; i < 24; i++) out[i] = size * (CORNERS[i] - 0.5f);
}

static void place(struct ag_scene *scene, const struct cube *cube, const float *matrix, int *out)
{
    assert_int_equal(ag_scene_add_instance(scene, cube->mesh, matrix, out), AG_OK);
    if (cube->movable)
        assert_int_equal(ag_scene_set_instance_mobility(scene, *out, AG_MOBILITY_MOVABLE), AG_OK);
}

static struct cube add_cube(struct ag_scene *scene, float size, bool movable)
{
    struct cube cube = { .size = size, .movable = movable };
    struct ag_material_desc material;
    float positions[24], matrix[16];
    ag_material_desc_default(&material);
    material.base_color[1] = 0.3f;
    assert_int_equal(ag_scene_add_material(scene, &material, &cube.material), AG_OK);
    scaled(positions, size);
    const struct ag_mesh_desc mesh = { .positions = positions,
                                       .vertex_count = 8,
                                       .indices = FACES,
                                       .index_count = 36,
                                       .material = cube.material };
    assert_int_equal(ag_scene_add_mesh(scene, &mesh, &cube.mesh), AG_OK);
    placed(matrix, 0.3f, 0.0f, 1.0f, 1.5f);
    place(scene, &cube, matrix, &cube.instance);
    return cube;
}

// ---- The changes

static void move_instance(struct ag_scene *scene, struct cube *cube)
{
    float matrix[16];
    placed(matrix, 1.1f, 1.0f, 1.5f, 1.1f);
    assert_int_equal(ag_scene_set_instance_transform(scene, cube->instance, matrix), AG_OK);
}

static void move_light(struct ag_scene *scene, struct cube *cube)
{
    (void)cube;
    struct ag_light_info light;
    assert_int_equal(ag_scene_get_light(scene, 0, 0, 0, &light), AG_OK);
    light.light.position[0] += 1.0f;
    light.light.intensity[2] *= 0.5f;
    assert_int_equal(ag_scene_set_light(scene, 0, &light.light), AG_OK);
}

static void switch_off(struct ag_scene *scene, struct cube *cube)
{
    (void)cube;
    struct ag_light_info light;
    const float sky[3] = { 1, 2, 3 };
    assert_int_equal(ag_scene_get_light(scene, 0, 0, 0, &light), AG_OK);
    light.light.enabled = false;
    assert_int_equal(ag_scene_set_light(scene, 0, &light.light), AG_OK);
    assert_int_equal(ag_scene_set_sky(scene, sky), AG_OK);
}

static void deform(struct ag_scene *scene, struct cube *cube)
{
    float positions[24];
    scaled(positions, 1.1f * cube->size);
    for (int i = 0; i < 8; i++) positions[3 * i] *= 1.0f + 0.5f * positions[3 * i + 1];
    assert_int_equal(ag_scene_update_mesh(scene, cube->mesh, positions, NULL), AG_OK);
}

static void add_instance(struct ag_scene *scene, struct cube *cube)
{
    float matrix[16];
    int instance;
    placed(matrix, 0.0f, -1.2f, 2.5f, 0.5f);
    place(scene, cube, matrix, &instance);
}

static void add(struct ag_scene *scene, struct cube *cube)
{
    add_instance(scene, cube);
    add_cube(scene, 0.8f, cube->movable);
}

static void take_away(struct ag_scene *scene, struct cube *cube)
{
    assert_int_equal(ag_scene_remove_instance(scene, cube->instance), AG_OK);
}

static void recolor(struct ag_scene *scene, struct cube *cube)
{
    struct ag_material_info info;
    assert_int_equal(ag_scene_get_material(scene, cube->material, &info), AG_OK);
    info.material.base_color[0] = 0.1f;
    info.material.emissive[1] = 60.0f;
    assert_int_equal(ag_scene_set_material(scene, cube->material, &info.material), AG_OK);
}

struct change {
    const char *name;
    void (*apply)(struct ag_scene *scene, struct cube *cube);
};
static const struct change changes[] = {
    { "move an instance", move_instance }, { "move a light", move_light },
    { "deform a mesh", deform },           { "add instances, a mesh and a material", add },
    { "remove an instance", take_away },   { "change a material", recolor },
    { "switch a light off", switch_off },
};

// ---- Equal frames

// bake: NULL where `gi` needs none.
static struct ag_renderer *new_renderer(struct renderer_fixture *s, const char *gi,
                                        const struct ag_bake *bake)
{
    struct ag_renderer *renderer = NULL;
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.bakes = &bake;
    desc.bake_count = bake != NULL;
    if (ag_renderer_create(s->device, s->scene, &desc, &renderer) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    return renderer;
}

static struct ag_image *color_of(struct renderer_fixture *s, struct ag_renderer *renderer)
{
    struct ag_image *image = NULL;
    assert_int_equal(ag_renderer_render(renderer, &s->frame), AG_OK);
    assert_int_equal(ag_renderer_read(renderer, "color", &image), AG_OK);
    return image;
}

// Mean absolute difference over the mean of the brighter one.
static double difference(const struct ag_image *a, const struct ag_image *b)
{
    double sum_a = 0, sum_b = 0, differences = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        sum_a += (double)a->pixels[i];
        sum_b += (double)b->pixels[i];
        differences += fabs((double)a->pixels[i] - (double)b->pixels[i]);
    }
    return differences / fmax(sum_a, sum_b);
}

struct differences {
    double change;  // between the frames before and after
    double error;   // between the frame after and that of a new renderer
    double settled; // the same SETTLING frames later
};

// Frames in which cone tracing traces the bounces of a change.
enum { SETTLING = 16 };

static struct differences differences_of(struct renderer_fixture *s, const char *gi,
                                         const struct ag_bake *bake, struct cube *cube,
                                         const struct change *change)
{
    struct ag_image *before = NULL;
    for (int i = 0; i < 3; i++) {
        ag_image_destroy(s->context, before);
        before = color_of(s, s->renderer);
    }
    change->apply(s->scene, cube);
    struct ag_image *now = color_of(s, s->renderer);
    struct ag_renderer *fresh = new_renderer(s, gi, bake);
    struct ag_image *expected = color_of(s, fresh);
    struct differences result = { difference(before, expected), difference(now, expected), 0 };
    for (int i = 0; i < SETTLING && result.error > 0.0; i++) {
        ag_image_destroy(s->context, now);
        now = color_of(s, s->renderer);
        result.settled = difference(now, expected);
    }
    ag_image_destroy(s->context, before);
    ag_image_destroy(s->context, now);
    ag_image_destroy(s->context, expected);
    ag_renderer_destroy(fresh);
    return result;
}

// Bounced light of cone tracing follows over frames (docs/techniques/vct.md); of all others, a
// frame depends on nothing but the scene.
static void check_differences(const char *technique, const struct differences *d)
{
    CHECK(d->change > 0.01);
    if (strcmp(technique, "vct") != 0) assert_true(d->error == 0.0);
    CHECK(d->error <= 0.25 * d->change);
    CHECK(d->settled <= 0.0025);
}

static void check_change(struct renderer_fixture *s, const char *technique, const char *gi,
                         const struct ag_bake *bake, struct cube *cube, const struct change *change)
{
    const struct differences d = differences_of(s, gi, bake, cube, change);
    printf("%-8s %-40s %.4f %.5f %.5f\n", technique, change->name, d.change, d.error, d.settled);
    check_differences(technique, &d);
}

static void check_changes(struct renderer_fixture *s, const char *technique, const char *gi,
                          const struct ag_bake *bake, struct cube like)
{
    struct cube cube = add_cube(s->scene, like.size, like.movable);
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++)
        check_change(s, technique, gi, bake, &cube, &changes[i]);
}

TEST(the_next_frame_is_that_of_a_new_renderer)
{
    struct ag_technique_info info;
    for (int t = 0; ag_technique_get(t, &info); t++) {
        if (!info.moving_geometry || info.needs_bake) continue;
        // Rays that accumulate differ by their noise.
        const char *gi = strcmp(info.name, "vct") == 0 ? "vct:temporal=false" : info.name;
        struct renderer_fixture s = fixture_open(gi, NULL);
        check_changes(&s, info.name, gi, NULL, (struct cube){ .size = 1.8f });
        fixture_close(&s);
    }
}

// With a bake of the scene without the cube. Nothing warns.
static void check_changes_of_bake(const char *technique, const char *gi, struct cube like)
{
    struct ag_technique_info info = { .needs_bake = true };
    struct renderer_fixture s = fixture_open("none", NULL), of_bake = s;
    // Surfaces of a scene stay while a bake uses it.
    assert_int_equal(ag_scene_load(s.context, "@cornell:light=point", &of_bake.scene), AG_OK);
    struct ag_bake *bake = fixture_bake(&of_bake, gi, &info);
    ag_renderer_destroy(s.renderer);
    s.renderer = new_renderer(&s, gi, bake);
    fixture_last_warning[0] = 0;
    check_changes(&s, technique, gi, bake, like);
    assert_string_equal(fixture_last_warning, "");
    ag_bake_destroy(bake);
    ag_scene_destroy(of_bake.scene);
    fixture_close(&s);
}

// Objects inside blocks move in drt, and it can be told to wait for their light.
TEST(the_next_frame_is_that_of_a_new_renderer_with_clutter)
{
    // Within the room: its box is the block.
    check_changes_of_bake("drt", "drt:map=single,update=wait," FIXTURE_SMALL_DICTIONARY,
                          (struct cube){ .size = 1.4f });
}

TEST(the_next_frame_is_that_of_a_new_renderer_with_movable_instances)
{
    check_changes_of_bake("radiosity", "radiosity:texels=4096,rays=64,sources=16",
                          (struct cube){ .size = 1.4f, .movable = true });
}

// Those for which the bake of an object stays right.
static const struct change changes_of_place[] = {
    { "move an instance", move_instance }, { "move a light", move_light },
    { "add an instance", add_instance },   { "remove an instance", take_away },
    { "switch a light off", switch_off },
};

// The bake is that of an equal scene: surfaces of a scene stay while a bake uses it.
static void check_objects(const char *gi)
{
    struct ag_technique_info info = { .needs_bake = true };
    struct renderer_fixture s = fixture_open("none", NULL), of_bake = s;
    struct cube cube = add_cube(s.scene, 1.4f, true);
    assert_int_equal(ag_scene_load(s.context, "@cornell:light=point", &of_bake.scene), AG_OK);
    add_cube(of_bake.scene, cube.size, cube.movable);
    struct ag_bake *bake = fixture_bake(&of_bake, gi, &info);
    ag_renderer_destroy(s.renderer);
    s.renderer = new_renderer(&s, gi, bake);
    for (size_t i = 0; i < sizeof changes_of_place / sizeof *changes_of_place; i++)
        check_change(&s, "dnrt", gi, bake, &cube, &changes_of_place[i]);
    ag_bake_destroy(bake);
    ag_scene_destroy(of_bake.scene);
    fixture_close(&s);
}

TEST(the_next_frame_is_that_of_a_new_renderer_with_objects_of_dnrt)
{
    check_objects("lpv:dim=16,cascades=1,probes=true+dnrt:size=16,rays=16");
}

// Depth maps are kept, and light of lamps and of the object itself follows.
TEST(the_next_frame_is_that_of_a_new_renderer_with_objects_in_the_light_of_lamps)
{
    check_objects("lpv:dim=16,cascades=1,probes=true+dnrt:size=16,rays=16,map_size=16,"
                  "intrusion=shadow,direct=true,self=true");
}

static void check_warning(struct renderer_fixture *s, const char *expected)
{
    ag_image_destroy(s->context, color_of(s, s->renderer));
    if (!strstr(fixture_last_warning, expected)) fail_msg("warning: %s", fixture_last_warning);
    fixture_last_warning[0] = 0;
    ag_image_destroy(s->context, color_of(s, s->renderer));
    assert_string_equal(fixture_last_warning, "");
}

TEST(radiosity_warns_once_of_changes_that_need_another_bake)
{
    static const char gi[] = "radiosity:texels=4096,rays=16,sources=8";
    struct ag_technique_info info = { .needs_bake = true };
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_bake *bake = fixture_bake(&s, gi, &info);
    struct ag_material_info material;
    float matrix[16];
    ag_renderer_destroy(s.renderer);
    s.renderer = new_renderer(&s, gi, bake);
    ag_bake_destroy(bake); // else the surfaces stay
    fixture_last_warning[0] = 0;
    ag_image_destroy(s.context, color_of(&s, s.renderer));
    assert_string_equal(fixture_last_warning, "");
    const struct cube cube = add_cube(s.scene, 0.5f, false);
    check_warning(&s, "static instances were added");
    assert_int_equal(ag_scene_get_material(s.scene, 0, &material), AG_OK);
    material.material.base_color[0] = 0.1f;
    assert_int_equal(ag_scene_set_material(s.scene, 0, &material.material), AG_OK);
    ag_image_destroy(s.context, color_of(&s, s.renderer));
    assert_string_equal(fixture_last_warning, "");
    material.material.double_sided = !material.material.double_sided;
    assert_int_equal(ag_scene_set_material(s.scene, 0, &material.material), AG_OK);
    check_warning(&s, "its sides, alpha or normals changed");
    placed(matrix, 0.2f, 0.5f, 0.4f, 0.2f);
    assert_int_equal(ag_scene_set_instance_transform(s.scene, cube.instance, matrix), AG_OK);
    assert_int_equal(ag_scene_set_instance_transform(s.scene, 5, matrix), AG_OK);
    check_warning(&s, "static geometry changed");
    fixture_close(&s);
}

// The camera moves with it: each pixel shows the same point of the cube. Emissive surfaces and the
// sky have no shadow maps, which would follow.
TEST(static_geometry_that_moves_keeps_its_light_of_radiosity)
{
    static const char gi[] = "radiosity:texels=16384,rays=64,sources=16";
    static const float before_m[3] = { 0, 1, 1.5f }, after_m[3] = { -0.3f, 2.2f, 0.4f };
    const struct ag_technique_info info = { .needs_bake = true };
    struct renderer_fixture s = fixture_open_lit("none");
    const struct cube cube = add_cube(s.scene, 1.0f, false);
    assert_int_equal(ag_scene_remove_lights(s.scene), AG_OK);
    struct ag_bake *bake = fixture_bake(&s, gi, &info);
    struct ag_image *irradiance[2];
    ag_renderer_destroy(s.renderer);
    s.renderer = new_renderer(&s, gi, bake);
    ag_bake_destroy(bake);
    for (int i = 0; i < 2; i++) {
        const float angle_rad = 0.3f + 0.5f * (float)i, *at = i == 0 ? before_m : after_m;
        const float eye[3] = { at[0] + 1.5f * sinf(angle_rad - 0.6f), at[1] + 0.6f,
                               at[2] + 1.5f * cosf(angle_rad - 0.6f) };
        float matrix[16];
        placed(matrix, angle_rad, at[0], at[1], at[2]);
        if (i == 1)
            assert_int_equal(ag_scene_set_instance_transform(s.scene, cube.instance, matrix),
                             AG_OK);
        assert_int_equal(ag_scene_look_at(s.scene, eye, at, 0.3f, &s.frame.camera), AG_OK);
        ag_image_destroy(s.context, color_of(&s, s.renderer));
        irradiance[i] = fixture_read(&s, "irradiance");
    }
    const double change = difference(irradiance[0], irradiance[1]);
    print_message("irradiance of the moved cube changes by %.2g\n", change);
    CHECK(change < 1e-4);
    for (int i = 0; i < 2; i++) ag_image_destroy(s.context, irradiance[i]);
    fixture_close(&s);
}

TEST(two_renderers_of_one_scene_follow_it)
{
    struct renderer_fixture s = fixture_open("lpv", NULL);
    struct ag_renderer *other = new_renderer(&s, "lpv", NULL);
    struct cube cube = add_cube(s.scene, 1.8f, false);
    for (int i = 0; i < 2; i++) ag_image_destroy(s.context, color_of(&s, s.renderer));
    ag_image_destroy(s.context, color_of(&s, other));
    move_instance(s.scene, &cube);
    ag_image_destroy(s.context, color_of(&s, s.renderer));
    recolor(s.scene, &cube);
    struct ag_image *a = color_of(&s, s.renderer), *b = color_of(&s, other);
    CHECK(difference(a, b) == 0.0);
    ag_image_destroy(s.context, a);
    ag_image_destroy(s.context, b);
    ag_renderer_destroy(other);
    fixture_close(&s);
}

// ---- Memory

static uint64_t device_bytes(struct ag_renderer *renderer)
{
    struct ag_memory owners[64];
    uint64_t sum = 0;
    const int count = ag_renderer_memory(renderer, owners, 64);
    for (int i = 0; i < count; i++) sum += owners[i].bytes;
    return sum;
}

// Each kind of change, back and forth.
static void change_all(struct ag_scene *scene, struct cube *cube, int frame)
{
    float matrix[16], positions[24];
    const float t = (float)frame;
    placed(matrix, 0.1f * t, 0.3f * sinf(t), 0.4f, 0.2f);
    assert_int_equal(ag_scene_set_instance_transform(scene, cube->instance, matrix), AG_OK);
    scaled(positions, 0.4f + 0.1f * sinf(t));
    assert_int_equal(ag_scene_update_mesh(scene, cube->mesh, positions, NULL), AG_OK);
    struct ag_material_info material;
    assert_int_equal(ag_scene_get_material(scene, cube->material, &material), AG_OK);
    material.material.emissive[0] = (float)(frame % 2);
    assert_int_equal(ag_scene_set_material(scene, cube->material, &material.material), AG_OK);
    struct ag_light_info light;
    assert_int_equal(ag_scene_get_light(scene, 0, 0, 0, &light), AG_OK);
    light.light.position[0] = 0.1f * sinf(t);
    assert_int_equal(ag_scene_set_light(scene, 0, &light.light), AG_OK);
    assert_int_equal(ag_scene_remove_lights(scene), AG_OK);
    assert_int_equal(ag_scene_add_light(scene, &light.light, NULL), AG_OK);
    const int removed = cube->instance;
    assert_int_equal(ag_scene_remove_instance(scene, removed), AG_OK);
    assert_int_equal(ag_scene_add_instance(scene, cube->mesh, matrix, &cube->instance), AG_OK);
    assert_int_equal(cube->instance, removed);
}

TEST(a_thousand_changed_frames_take_no_memory)
{
    enum { FRAMES = 1000, SETTLED = 20 };
    struct renderer_fixture s = fixture_open("lpv:dim=8,cascades=1,steps=2", NULL);
    struct cube cube = add_cube(s.scene, 1.8f, false);
    struct ag_scene_info info;
    uint64_t host_bytes = 0, gpu_bytes = 0;
    for (int i = 0; i < FRAMES; i++) {
        change_all(s.scene, &cube, i);
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
        if (i == SETTLED || i == FRAMES - 1) {
            assert_int_equal(ag_renderer_wait(s.renderer), AG_OK);
            assert_int_equal(ag_scene_get_info(s.scene, 0, 0, &info), AG_OK);
            if (i == SETTLED) {
                host_bytes = info.memory_bytes;
                gpu_bytes = device_bytes(s.renderer);
            }
        }
    }
    assert_int_equal(info.memory_bytes, host_bytes);
    assert_int_equal(device_bytes(s.renderer), gpu_bytes);
    fixture_close(&s);
}

// ---- What is refused

#define CHECK_REFUSED(s, call, why)                                                                \
    do {                                                                                           \
        assert_int_equal((call), AG_ERROR_ARGUMENT);                                               \
        CHECK(strstr(ag_context_last_error((s).context), (why)));                                  \
    } while (0)

TEST(wrong_changes_are_refused_and_change_nothing)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct cube cube = add_cube(s.scene, 1.8f, false);
    float matrix[16], positions[24];
    struct ag_material_info material;
    struct ag_light_info light;
    struct ag_instance_info instance;
    struct ag_image *before = color_of(&s, s.renderer);
    placed(matrix, 0, 0, 0, 0);
    CHECK_REFUSED(s, ag_scene_set_instance_transform(s.scene, 99, matrix), "instance 99");
    matrix[3] = 1;
    CHECK_REFUSED(s, ag_scene_set_instance_transform(s.scene, cube.instance, matrix), "affine");
    placed(matrix, 0, INFINITY, 0, 0);
    CHECK_REFUSED(s, ag_scene_set_instance_transform(s.scene, cube.instance, matrix), "finite");
    CHECK_REFUSED(s, ag_scene_set_instance_mobility(s.scene, cube.instance, (enum ag_mobility)7),
                  "mobility 7");
    scaled(positions, 1);
    positions[5] = NAN;
    CHECK_REFUSED(s, ag_scene_update_mesh(s.scene, cube.mesh, positions, NULL), "not finite");
    CHECK_REFUSED(s, ag_scene_update_mesh(s.scene, cube.mesh, NULL, NULL), "NULL");
    CHECK_REFUSED(s, ag_scene_update_mesh(s.scene, -1, positions, NULL), "mesh -1");
    assert_int_equal(ag_scene_get_material(s.scene, cube.material, &material), AG_OK);
    material.material.roughness = 2;
    CHECK_REFUSED(s, ag_scene_set_material(s.scene, cube.material, &material.material), "rough");
    assert_int_equal(ag_scene_get_light(s.scene, 0, 0, 0, &light), AG_OK);
    light.light.intensity[0] = -1;
    CHECK_REFUSED(s, ag_scene_set_light(s.scene, 0, &light.light), "intensity");
    CHECK_REFUSED(s, ag_scene_set_light(s.scene, 1, &light.light), "light 1");
    struct ag_image *after = color_of(&s, s.renderer);
    CHECK(difference(before, after) == 0.0);
    struct ag_mesh_info mesh;
    assert_int_equal(ag_scene_get_mesh(s.scene, cube.mesh, &mesh), AG_OK);
    CHECK(mesh.vertex_count == 8 && mesh.index_count == 36 && mesh.material == cube.material);
    CHECK_REFUSED(s, ag_scene_get_mesh(s.scene, 99, &mesh), "mesh 99");
    assert_int_equal(ag_scene_remove_instance(s.scene, cube.instance), AG_OK);
    CHECK_REFUSED(s, ag_scene_remove_instance(s.scene, cube.instance), "was removed");
    assert_int_equal(ag_scene_get_instance(s.scene, cube.instance, 0, 0, &instance), AG_OK);
    assert_int_equal(instance.mesh, -1);
    ag_image_destroy(s.context, before);
    ag_image_destroy(s.context, after);
    fixture_close(&s);
}
