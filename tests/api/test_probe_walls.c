// Published probes beside walls: none of the light of the room behind a thin wall, and all of the
// light of their own.
#include "api/renderer_fixture.h"

#include <math.h>

// A bake of a second or two; probes along an edge of a block.
#define BLOCKS                                                                                     \
    "probes=true,map=auto,texels=8,rays=256,prior_modes=16,modes=12,lightfield_positions=4,"       \
    "lightfield_directions=6,lightfield_modes=16,response_modes=12,block_probes="

static const float WALL = 0.05f; // thickness

static const struct {
    const char *gi;
    bool needs_bake;
} techniques[] = {
    { "radiosity:texels=16384,probes=true", true },
    { "radiosity:texels=16384,probe_spacing=1.3,probes=true", true },
    { "mrt:" BLOCKS "2", true },
    { "mrt:" BLOCKS "4", true },
    { "drt:" BLOCKS "2", true },
    { "lpv:probes=true", false },
    { "holpv:probes=true", false },
};
enum { TECHNIQUES = sizeof techniques / sizeof *techniques };

// ---- scenes

// A closed box; its faces look outwards, or inwards.
static void add_box(struct renderer_fixture *s, const float low[3], const float high[3],
                    bool inwards)
{
    static const uint32_t outside[36] = { 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                          2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5 };
    float corners[24];
    uint32_t faces[36];
    int mesh;
    for (int i = 0; i < 24; i++) corners[i] = i / 3 >> i % 3 & 1 ? high[i % 3] : low[i % 3];
    for (int i = 0; i < 36; i++) faces[i] = outside[inwards ? 35 - i : i];
    const struct ag_mesh_desc desc = {
        .positions = corners, .vertex_count = 8, .indices = faces, .index_count = 36
    };
    assert_int_equal(ag_scene_add_mesh(s->scene, &desc, &mesh), AG_OK);
    assert_int_equal(ag_scene_add_instance(s->scene, mesh, NULL, NULL), AG_OK);
}

// In the middle of a room; mrt looks for blocks around it.
static void add_point_light(struct renderer_fixture *s, int axis, float along, float candela)
{
    struct ag_light_desc light;
    ag_light_desc_default(&light, AG_LIGHT_POINT);
    light.position[axis] = along;
    light.position[1] = 1.6f;
    for (int c = 0; c < 3; c++) light.intensity[c] = candela;
    assert_int_equal(ag_scene_add_light(s->scene, &light, NULL), AG_OK);
}

static struct renderer_fixture open_empty(void)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_material_desc white;
    ag_renderer_destroy(s.renderer);
    ag_scene_destroy(s.scene);
    s.renderer = NULL;
    assert_int_equal(ag_scene_create(s.context, &s.scene), AG_OK);
    ag_material_desc_default(&white);
    for (int c = 0; c < 3; c++) white.base_color[c] = 0.7f;
    white.specular = 0;
    assert_int_equal(ag_scene_add_material(s.scene, &white, NULL), AG_OK);
    return s;
}

static void look_from(struct renderer_fixture *s, const float eye[3], const float target[3])
{
    assert_int_equal(ag_scene_look_at(s->scene, eye, target, 1.0f, &s->frame.camera), AG_OK);
}

// The point (x, y, z), or with axis 2 (z, y, x).
struct point {
    float at[3];
};
static struct point turned(int axis, float x, float y, float z)
{
    return axis == 2 ? (struct point){ { z, y, x } } : (struct point){ { x, y, z } };
}

// Closed rooms of 4 x 3 x 4 m, below and above 0 along x or z, with a wall between them; the lower
// one is lit.
static struct renderer_fixture open_two_rooms(int axis)
{
    const float t = WALL;
    const float slabs[7][2][3] = {
        { { -4, -t, -2 }, { 4, 0, 2 } },
        { { -4, 3, -2 }, { 4, 3 + t, 2 } },
        { { -4 - t, -t, -2 - t }, { -4, 3 + t, 2 + t } },
        { { 4, -t, -2 - t }, { 4 + t, 3 + t, 2 + t } },
        { { -4, -t, -2 - t }, { 4, 3 + t, -2 } },
        { { -4, -t, 2 }, { 4, 3 + t, 2 + t } },
        { { -t / 2, 0, -2 }, { t / 2, 3, 2 } },
    };
    struct renderer_fixture s = open_empty();
    for (int i = 0; i < 7; i++) {
        const float *low = slabs[i][0], *high = slabs[i][1];
        add_box(&s, turned(axis, low[0], low[1], low[2]).at,
                turned(axis, high[0], high[1], high[2]).at, false);
    }
    add_point_light(&s, axis, -2, 300);
    add_point_light(&s, axis, 2, 0);
    look_from(&s, turned(axis, -3.8f, 2.5f, 1.8f).at, turned(axis, 0, 0.8f, -1.5f).at);
    return s;
}

static struct renderer_fixture open_one_room(void)
{
    struct renderer_fixture s = open_empty();
    add_box(&s, (const float[3]){ -2, 0, -2 }, (const float[3]){ 2, 3, 2 }, true);
    add_point_light(&s, 0, 0.5f, 300);
    look_from(&s, (const float[3]){ -1.8f, 2.5f, 1.8f }, (const float[3]){ 0, 0.8f, -1.5f });
    return s;
}

// Closes the fixture.
static struct ag_probes *probes_of(struct renderer_fixture *s, int technique)
{
    struct ag_renderer_desc desc = fixture_renderer_desc(techniques[technique].gi);
    struct ag_technique_info needs = { .needs_bake = techniques[technique].needs_bake };
    struct ag_bake *bake = fixture_bake(s, desc.gi, &needs);
    const struct ag_bake *bakes[] = { bake };
    struct ag_probes *probes = NULL;
    desc.bakes = bakes;
    desc.bake_count = bake ? 1 : 0;
    if (ag_renderer_create(s->device, s->scene, &desc, &s->renderer) != AG_OK ||
        ag_renderer_render(s->renderer, &s->frame) != AG_OK ||
        ag_renderer_read_probes(s->renderer, &probes) != AG_OK)
        fail_msg("%s: %s", desc.gi, ag_context_last_error(s->context));
    ag_bake_destroy(bake);
    return probes;
}

static void axis_normal(int i, float out[3])
{
    for (int a = 0; a < 3; a++) out[a] = a != i / 2 ? 0.0f : i % 2 ? 1.0f : -1.0f;
}

// ---- a wall

// Green irradiance of the six directions of the axes, summed.
static double light_at(const struct ag_probes *probes, struct point point)
{
    double sum = 0.0;
    for (int i = 0; i < 6; i++) {
        float normal[3], lux[3];
        axis_normal(i, normal);
        ag_probes_irradiance(probes, point.at, normal, lux);
        sum += (double)lux[1];
    }
    return sum;
}

// The most light at a distance behind the wall, over the mean at the same distance before it.
static double share_behind(const struct ag_probes *probes, int axis, float distance)
{
    const float x = 0.5f * WALL + distance;
    double before = 0.0, most = 0.0;
    for (int i = 0; i < 9; i++) {
        const float y = 0.6f + 0.9f * (float)(i % 3), z = -1.1f + 1.2f * (float)(i / 3);
        before += light_at(probes, turned(axis, -x, y, z)) / 9;
        most = fmax(most, light_at(probes, turned(axis, x, y, z)));
    }
    CHECK(before > 6 * 50); // lux
    return most / before;
}

TEST(probes_light_nothing_behind_a_thin_wall)
{
    double most = 0.0;
    for (int i = 0; i < 2 * TECHNIQUES; i++) {
        const int technique = i / 2, axis = i % 2 ? 2 : 0;
        struct renderer_fixture s = open_two_rooms(axis);
        struct ag_probes *probes = probes_of(&s, technique);
        const double near = share_behind(probes, axis, 0.025f),
                     far = share_behind(probes, axis, 0.175f);
        print_message("%s: behind a wall of 5 cm across %c %.5f of the lit room's light at 2.5 cm, "
                      "%.5f at 17.5 cm\n",
                      techniques[technique].gi, axis ? 'z' : 'x', near, far);
        most = fmax(most, fmax(near, far));
        ag_probes_destroy(s.context, probes);
        fixture_close(&s);
    }
    CHECK(most <= 0.01);
}

// ---- an open room

// Between the probes without regard to walls, inside the grid.
static double interpolated(const struct ag_probes *probes, const float at[3], const float n[3])
{
    const double basis[9] = { 0.282094792,
                              0.488602512 * (double)n[1],
                              0.488602512 * (double)n[2],
                              0.488602512 * (double)n[0],
                              1.092548431 * (double)(n[0] * n[1]),
                              1.092548431 * (double)(n[1] * n[2]),
                              0.315391565 * (double)(3 * n[2] * n[2] - 1),
                              1.092548431 * (double)(n[0] * n[2]),
                              0.546274215 * (double)(n[0] * n[0] - n[1] * n[1]) };
    double sum = 0.0;
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1.0;
        size_t probe = 0;
        for (int a = 2; a >= 0; a--) {
            const int last = probes->counts[a] - 1;
            const float place =
                fminf(fmaxf((at[a] - probes->first[a]) / probes->spacing, 0.0f), (float)last);
            const int low = (int)place, high = corner >> a & 1;
            weight *= high ? (double)(place - (float)low) : 1.0 - (double)(place - (float)low);
            probe = probe * (size_t)probes->counts[a] +
                    (size_t)(low + high <= last ? low + high : last);
        }
        for (int k = 0; k < 9; k++)
            sum += weight * basis[k] * (double)probes->coefficients[27 * probe + 3 * (size_t)k + 1];
    }
    return fmax(sum, 0.0);
}

// Whether all probes around a place are in the room of open_one_room.
static bool is_among_probes_of_the_room(const struct ag_probes *probes, const float at[3])
{
    static const float low[3] = { -2, 0, -2 }, high[3] = { 2, 3, 2 };
    for (int a = 0; a < 3; a++) {
        const float last = (float)(probes->counts[a] - 1);
        const float place = (at[a] - probes->first[a]) / probes->spacing;
        const float below = fminf(fmaxf(floorf(place), 0.0f), last),
                    above = fminf(fmaxf(ceilf(place), 0.0f), last);
        if (probes->first[a] + probes->spacing * below <= low[a] ||
            probes->first[a] + probes->spacing * above >= high[a])
            return false;
    }
    return true;
}

// The change of the light of all directions by visibility, over the light.
static double change_at(const struct ag_probes *probes, const float at[3])
{
    double before = 0.0, after = 0.0;
    for (int i = 0; i < 6; i++) {
        float normal[3], lux[3];
        axis_normal(i, normal);
        ag_probes_irradiance(probes, at, normal, lux);
        before += interpolated(probes, at, normal);
        after += (double)lux[1];
    }
    CHECK(before > 6 * 20); // lux
    return fabs(after / before - 1.0);
}

TEST(probes_of_an_open_room_keep_its_light)
{
    double all = 0.0;
    for (int i = 0; i < TECHNIQUES; i++) {
        struct renderer_fixture s = open_one_room();
        struct ag_probes *probes = probes_of(&s, i);
        double most = 0.0;
        int places = 0;
        for (int k = 0; k < 7 * 7 * 7; k++) { // up to 5 cm from the walls
            const float at[3] = { -1.95f + 0.65f * (float)(k % 7),
                                  0.05f + 0.48f * (float)(k / 7 % 7),
                                  -1.95f + 0.65f * (float)(k / 49) };
            if (!is_among_probes_of_the_room(probes, at)) continue;
            most = fmax(most, change_at(probes, at));
            places++;
        }
        CHECK(places >= 100);
        print_message("%s: visibility changes the light of an open room by %.4f at most\n",
                      techniques[i].gi, most);
        all = fmax(all, most);
        ag_probes_destroy(s.context, probes);
        fixture_close(&s);
    }
    CHECK(all <= 0.05);
}

// ---- the data behind it

static size_t count_of(const struct ag_probes *probes)
{
    return (size_t)probes->counts[0] * (size_t)probes->counts[1] * (size_t)probes->counts[2];
}

// Along x, y and z the room has a wall before its first and behind its last probe.
static void check_walls(const struct ag_probes *probes, const struct ag_probes_visibility *v)
{
    size_t closed = 0;
    assert_null(v->depths);
    assert_null(v->offsets);
    assert_non_null(v->walls);
    for (size_t i = 0; i < 3 * count_of(probes); i++) {
        CHECK(v->walls[2 * i] >= 0.0f && v->walls[2 * i] <= 1.0f);
        CHECK(v->walls[2 * i + 1] >= 0.0f && v->walls[2 * i + 1] <= 1.0f);
        closed += v->walls[2 * i] == 1.0f;
    }
    CHECK(closed > 0 && closed < count_of(probes));
}

// The probe in the middle sees the nearest wall.
static void check_depths(const struct ag_probes *probes, const struct ag_probes_visibility *v)
{
    const size_t points = (size_t)v->tile_side * (size_t)v->tile_side;
    const int *n = probes->counts;
    const int middle = (n[2] / 2 * n[1] + n[1] / 2) * n[0] + n[0] / 2;
    const float *tile = v->depths + 2 * points * (size_t)middle;
    double nearest = 0.0, farthest = 1e9;
    assert_null(v->walls);
    for (size_t i = 0; i < count_of(probes); i++) CHECK(v->offsets[4 * i + 3] == 1.0f);
    for (size_t i = 0; i < points; i++) {
        nearest = fmax(nearest, (double)tile[2 * i]);
        farthest = fmin(farthest, (double)tile[2 * i]);
    }
    CHECK((double)probes->spacing / nearest > 0.5 && (double)probes->spacing / nearest < 2.0);
    CHECK_NEAR(farthest, 0.3, 1e-3); // farther than lookups between probes need
}

TEST(probes_tell_what_they_see)
{
    const struct {
        int technique;
        enum ag_probes_visibility_kind kind;
    } cases[] = { { 0, AG_PROBES_VISIBILITY_DEPTHS }, { 5, AG_PROBES_VISIBILITY_WALLS } };
    for (int i = 0; i < 2; i++) {
        struct renderer_fixture s = open_one_room();
        struct ag_probes *probes = probes_of(&s, cases[i].technique);
        struct ag_probes_visibility visibility;
        struct ag_probes_handle handle;
        const bool depths = cases[i].kind == AG_PROBES_VISIBILITY_DEPTHS;
        ag_probes_get_visibility(probes, &visibility);
        assert_int_equal(ag_renderer_probes_handle(s.renderer, &handle), AG_OK);
        CHECK(visibility.kind == cases[i].kind && handle.visibility == cases[i].kind);
        CHECK((handle.vk_depth_image != NULL) == depths && handle.vk_image != NULL);
        if (depths)
            check_depths(probes, &visibility);
        else
            check_walls(probes, &visibility);
        ag_probes_get_visibility(NULL, &visibility);
        CHECK(visibility.kind == AG_PROBES_VISIBILITY_NONE && !visibility.depths);
        ag_probes_destroy(s.context, probes);
        fixture_close(&s);
    }
}
