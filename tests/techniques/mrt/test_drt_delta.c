// Delta operators of a room with one box: laws, and rays of another ray caster through the scene.
#include "framework/test.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "core/sh.h"
#include "scene/view/raycast.h"

#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/objects/clutter_operators.h"
#include "techniques/mrt/objects/delta.h"
#include "techniques/mrt/objects/delta_cache.h"

#include <math.h>
#include <string.h>

enum { TEXELS = 8, ALL = 6 * TEXELS * TEXELS, RAYS = 1024, CHECKED_RAYS = 16384, FACES = 6 };
enum { CONSTANT, LINEAR, MODES };

// A closed room of one block, 2 m along its edges, and a box that stands on its floor.
struct room {
    struct scene *scene;
    struct scene_pose pose;
    struct mrt_block_map map;
    struct mrt_clutter clutter;
    struct trace_scene *objects;
    struct matrix_f32 l_imp, t_db;
    const struct matrix_f32 *l_of_blocks[1], *t_of_blocks[1];
    struct mrt_clutter_rays rays;
    struct mrt_shape shape;
    struct mrt_delta_block delta;
};

static void add_box(struct scene *scene, struct box3 box, bool inwards)
{
    vec3s positions[24];
    uint32_t indices[36];
    for (uint32_t f = 0; f < 6; f++) {
        for (uint32_t k = 0; k < 4; k++) {
            const float u = k == 1 || k == 2 ? 1.0f : 0.0f, v = k >= 2 ? 1.0f : 0.0f;
            const vec3s cell = cube_face_point((int)f, u, v);
            for (int a = 0; a < 3; a++)
                positions[4 * f + k].raw[a] =
                    box.min.raw[a] + (cell.raw[a] + 0.5f) * (box.max.raw[a] - box.min.raw[a]);
        }
        const uint32_t quad[6] = { 0, 1, 2, 0, 2, 3 };
        for (uint32_t k = 0; k < 6; k++) indices[6 * f + k] = 4 * f + quad[inwards ? 5 - k : k];
    }
    const struct mesh mesh = { .vertex_count = 24,
                               .index_count = 36,
                               .positions = positions,
                               .indices = indices,
                               .material = -1 };
    const struct node node = node_default();
    const struct instance instance = { .node = scene_add_node(scene, &node),
                                       .mesh = scene_add_mesh(scene, &mesh),
                                       .skin = -1 };
    CHECK(instance.mesh >= 0 && scene_add_instance(scene, &instance) >= 0);
}

// Radiosity that is linear in space: bilinear lookup is exact but for half a texel at edges.
static float linear(vec3s cell)
{
    return 1.0f + 0.8f * cell.x - 0.5f * cell.y + 0.3f * cell.z;
}

// Radiosity of the box by the direction of a side.
static float radiosity_of_side(vec3s normal)
{
    return 2.0f + normal.x - 0.5f * normal.y + 0.25f * normal.z;
}

static const struct box3 BOX = { { { -0.4f, -1.0f, -0.3f } }, { { 0.3f, 0.1f, 0.4f } } };

// In its middle is the first of 2³ probes.
static const struct box3 HOLLOW = { { { -0.8f, -0.8f, -0.8f } }, { { -0.2f, -0.2f, -0.2f } } };
static const struct box3 HOLE = { { { -0.7f, -0.7f, -0.7f } }, { { -0.3f, -0.3f, -0.3f } } };

enum content { EMPTY, WITH_BOX, WITH_HOLLOW_BOX };

static void room_init(struct room *room, enum content content)
{
    const struct mrt_clutter_options options = { 32.0f, 16 };
    const struct box3 shell = { vec3_of(-1, -1, -1), vec3_of(1, 1, 1) };
    *room =
        (struct room){ .scene = scene_create(test_host(), "room"), .shape = mrt_cube(TEXELS, 0) };
    add_box(room->scene, shell, true);
    if (content == WITH_BOX) add_box(room->scene, BOX, false);
    if (content == WITH_HOLLOW_BOX) {
        add_box(room->scene, HOLLOW, false);
        add_box(room->scene, HOLE, true);
    }
    CHECK(pose_init(&room->pose, room->scene, -1, 0.0f));
    CHECK(mrt_block_map_init(test_host(), "test", 1, &room->map));
    mrt_block_init(&room->map.blocks[0], "room", MRT_BLOCK_CUBE);
    mrt_block_set_box(&room->map.blocks[0], shell);
    CHECK(mrt_clutter_init(&room->clutter, test_host(), &room->pose, &room->map, &options));
}

// T_d→b is the least-squares fit of both modes: in a cube `linear` less 1 sums to 0.
static void fill_modes(struct room *room)
{
    double square = 0.0;
    CHECK(matrix_f32_init(test_host(), &room->l_imp, ALL, MODES) &&
          matrix_f32_init(test_host(), &room->t_db, MODES, ALL));
    for (int t = 0; t < ALL; t++) {
        const float value = linear(mrt_shape_texel(&room->shape, t).position);
        room->l_imp.at[t * MODES + CONSTANT] = 1.0f;
        room->l_imp.at[t * MODES + LINEAR] = value;
        square += (double)((value - 1.0f) * (value - 1.0f));
    }
    for (int t = 0; t < ALL; t++) {
        const float linear_part = (room->l_imp.at[t * MODES + LINEAR] - 1.0f) / (float)square;
        room->t_db.at[LINEAR * ALL + t] = linear_part;
        room->t_db.at[CONSTANT * ALL + t] = 1.0f / ALL - linear_part;
    }
}

static void room_trace(struct room *room)
{
    room->objects = trace_scene_create(test_host(), &room->clutter.objects.pose);
    CHECK(room->objects);
    fill_modes(room);
    room->l_of_blocks[0] = &room->l_imp;
    room->t_of_blocks[0] = &room->t_db;
    room->rays = (struct mrt_clutter_rays){ .map = &room->map,
                                            .l_imp = room->l_of_blocks,
                                            .t_db = room->t_of_blocks,
                                            .resolution = TEXELS,
                                            .clutter = &room->clutter,
                                            .objects = room->objects,
                                            .rays = RAYS,
                                            .probes = 2 };
    CHECK(mrt_delta_block_init(&room->delta, test_host(), &room->rays, 0));
}

static void room_finish(struct room *room)
{
    mrt_delta_block_finish(&room->delta);
    matrix_f32_finish(test_host(), &room->l_imp);
    matrix_f32_finish(test_host(), &room->t_db);
    trace_scene_destroy(room->objects);
    mrt_clutter_finish(&room->clutter);
    mrt_block_map_finish(&room->map);
    pose_finish(&room->pose);
    scene_destroy(room->scene);
}

TEST(objects_are_clutter_and_walls_are_not)
{
    struct room room;
    room_init(&room, WITH_BOX);
    CHECK(room.clutter.triangles == 12 && room.clutter.face_count == FACES);
    CHECK(room.clutter.walls.scene.instances[1].mesh < 0);
    CHECK(room.clutter.objects.scene.instances[0].mesh < 0);
    room_finish(&room);
    room_init(&room, EMPTY);
    CHECK(room.clutter.triangles == 0);
    room_finish(&room);
}

// Light of uniform radiosity 1 without clutter, in a value of a measure.
static double uniform_light(enum mrt_measure measure, int value)
{
    struct mrt_rays rays;
    double sum = 0.0;
    CHECK(mrt_rays_init(test_host(), measure, RAYS, &rays));
    for (int r = 0; r < rays.count; r++)
        sum += (double)rays.weight[r * rays.values + value % rays.values];
    mrt_rays_finish(test_host(), &rays);
    return sum;
}

// If walls and clutter have the same radiosity, clutter changes nothing.
TEST(a_room_of_one_radiosity_stays_so)
{
    struct room room;
    room_init(&room, WITH_BOX);
    room_trace(&room);
    double least = 1.0;
    for (int m = 0; m < MRT_MEASURES; m++) {
        const struct mrt_delta *of = &room.delta.of[m];
        static const int values[MRT_MEASURES] = { 1, 4, 9 };
        double expected[9];
        for (int q = 0; q < values[m]; q++) expected[q] = uniform_light((enum mrt_measure)m, q);
        for (size_t r = 0; r < of->b.rows; r++) {
            double sum = (double)of->b.at[r * of->b.stride + CONSTANT];
            for (size_t f = 0; f < of->c.columns; f++)
                sum += (double)of->c.at[r * of->c.stride + f];
            CHECK_NEAR(sum, expected[r % (size_t)values[m]], 1e-4);
            if (m == MRT_IRRADIANCE && !of->inside[r])
                least = fmin(least, (double)of->b.at[r * of->b.stride + CONSTANT]);
        }
    }
    print_message("least light of walls that the box lets pass to a texel: %.3f\n", least);
    CHECK(least < 0.6);
    room_finish(&room);
}

// Irradiance of a texel by rays through the whole scene.
static double traced(const struct raycast *rays, vec3s position, mat3s frame, uint32_t texel)
{
    struct rng rng = rng_for(texel, 1, 2);
    const vec3s normal = frame.col[2];
    double sum = 0.0;
    for (int i = 0; i < CHECKED_RAYS; i++) {
        const vec3s way = glms_mat3_mulv(frame, sample_hemisphere_cosine(rng_vec2(&rng)));
        const vec3s from = glms_vec3_muladds(normal, 1e-4f, position);
        struct raycast_hit hit;
        if (!raycast_closest(rays, from, way, INFINITY, &hit)) continue;
        const vec3s at = glms_vec3_muladds(way, hit.distance, from);
        const bool wall = glms_vec3_max(glms_vec3_abs(at)) > 1.0f - 1e-5f;
        sum += (double)(wall ? linear(glms_vec3_scale(at, 0.5f)) : radiosity_of_side(hit.normal));
    }
    return sum / CHECKED_RAYS;
}

static double side_light(const struct room *room, size_t texel)
{
    const struct mrt_delta *of = &room->delta.of[MRT_IRRADIANCE];
    double sum = 0.0;
    for (int f = 0; f < room->clutter.face_count; f++) {
        const uint32_t first = room->clutter.texels[room->clutter.faces[f].first_texel];
        sum += (double)(of->c.at[texel * of->c.stride + (size_t)f] *
                        radiosity_of_side(chart_texel_normal(&room->clutter.charts, first)));
    }
    return sum;
}

// Unshadowed light, by the dictionary's own gather.
static double unshadowed(const struct room *room, int texel)
{
    struct mrt_rays rays;
    float row[ALL] = { 0 };
    double sum = 0.0;
    CHECK(mrt_rays_init(test_host(), MRT_IRRADIANCE, CHECKED_RAYS, &rays));
    mrt_gather(&room->shape, mrt_shape_texel(&room->shape, texel), &rays, row, ALL);
    mrt_rays_finish(test_host(), &rays);
    for (int t = 0; t < ALL; t++)
        sum += (double)(row[t] * room->l_imp.at[(size_t)t * room->l_imp.stride + LINEAR]);
    return sum;
}

TEST(one_bounce_equals_that_of_rays_through_the_scene)
{
    struct room room;
    struct raycast rays;
    double worst = 0.0, without = 0.0;
    room_init(&room, WITH_BOX);
    room_trace(&room);
    CHECK(raycast_init(&rays, test_host(), &room.pose));
    const struct mrt_delta *of = &room.delta.of[MRT_IRRADIANCE];
    for (int t = 0; t < ALL; t += 5) {
        if (of->inside[t]) continue;
        const struct mrt_point point = mrt_shape_texel(&room.shape, t);
        const double expected =
            traced(&rays, glms_vec3_scale(point.position, 2.0f), point.frame, (uint32_t)t);
        const double plain = unshadowed(&room, t);
        const double found =
            (double)of->b.at[(size_t)t * of->b.stride + LINEAR] + side_light(&room, (size_t)t);
        worst = fmax(worst, fabs(found / expected - 1.0));
        without = fmax(without, fabs(plain / expected - 1.0));
    }
    print_message("at most %.3f of the light from rays, %.3f without operators\n", worst, without);
    CHECK(worst < 0.03);
    CHECK(without > 0.3);
    raycast_finish(&rays);
    room_finish(&room);
}

// The modes keep their coefficients, but for the damping, where the box hides a part of the floor.
TEST(light_of_the_modes_is_projected_to_itself)
{
    struct room room;
    room_init(&room, WITH_BOX);
    room_trace(&room);
    const struct matrix_f32 *t_db = &room.delta.t_db;
    for (size_t to = 0; to < MODES; to++)
        for (size_t from = 0; from < MODES; from++) {
            double sum = 0.0;
            for (size_t t = 0; t < ALL; t++)
                sum += (double)(t_db->at[to * t_db->stride + t] * room.l_imp.at[t * MODES + from]);
            CHECK_NEAR(sum, to == from ? 1.0 : 0.0, 0.02);
        }
    room_finish(&room);
}

TEST(texels_below_the_box_are_inside)
{
    struct room room;
    room_init(&room, WITH_BOX);
    room_trace(&room);
    const struct mrt_delta *of = &room.delta.of[MRT_IRRADIANCE];
    for (int t = 0; t < ALL; t++) {
        const vec3s at = glms_vec3_scale(mrt_shape_texel(&room.shape, t).position, 2.0f);
        bool below = at.y < -0.999f;
        for (int a = 0; a < 3; a += 2)
            below = below && at.raw[a] > BOX.min.raw[a] && at.raw[a] < BOX.max.raw[a];
        CHECK(of->inside[t] == below);
    }
    room_finish(&room);
}

TEST(no_light_enters_a_closed_box)
{
    struct room room;
    room_init(&room, WITH_HOLLOW_BOX);
    room_trace(&room);
    const struct mrt_delta *of = &room.delta.of[MRT_PROBE];
    for (int i = 0; i < 8; i++) CHECK((of->open[i] == 0.0f) == (i == 0) && !of->inside[i]);
    for (int f = 0; f < CUBE_FACES; f++) CHECK(of->kept[0][f] == 0.0f);
    room_finish(&room);
}

// Rows inside become means of rows outside; all others stay.
TEST(inpainting_takes_valid_neighbors_alone)
{
    struct matrix_f32 rows = { 0 };
    bool inside[16] = { false };
    CHECK(matrix_f32_init(test_host(), &rows, 16, 1));
    for (size_t i = 0; i < 16; i++) rows.at[i * rows.stride] = 1000.0f;
    inside[5] = inside[6] = true;
    // The neighbours of 5, (1, 1) of 4².
    static const int around[7] = { 0, 1, 2, 4, 8, 9, 10 };
    for (int i = 0; i < 7; i++) rows.at[(size_t)around[i] * rows.stride] = (float)i;
    rows.at[5 * rows.stride] = NAN;
    mrt_inpaint(&rows, 4, 1, 1, inside);
    CHECK_NEAR(rows.at[5 * rows.stride], 3.0, 1e-5);
    CHECK(rows.at[0] == 0.0f && rows.at[15 * rows.stride] == 1000.0f);
    CHECK(isfinite(rows.at[6 * rows.stride]));
    matrix_f32_finish(test_host(), &rows);
}

// A convex object in a closed room sees walls alone.
TEST(faces_receive_the_light_of_walls)
{
    struct room room;
    room_init(&room, WITH_BOX);
    room_trace(&room);
    struct mrt_gather_faces faces;
    CHECK(mrt_gather_faces_init(&faces, test_host(), &room.rays, 0));
    CHECK(faces.count == 1 && faces.from[0].source == 0);
    for (size_t f = 0; f < FACES; f++) {
        const float *row = faces.from[0].of_b.at + f * faces.from[0].of_b.stride;
        const uint32_t texel = room.clutter.texels[room.clutter.faces[f].first_texel];
        const vec3s normal = chart_texel_normal(&room.clutter.charts, texel);
        for (size_t k = 0; k < FACES; k++)
            CHECK_NEAR(faces.of_c.at[f * faces.of_c.stride + k], 0.0, 1e-3);
        // The bottom lies on the floor.
        if (normal.y > -0.5f) CHECK_NEAR(row[CONSTANT], 1.0, 1e-3);
        // Sides see walls that they face: brighter towards +x, darker upwards.
        if (normal.x > 0.5f) CHECK(row[LINEAR] > 1.1f);
        if (normal.x < -0.5f) CHECK(row[LINEAR] < 1.0f);
    }
    mrt_gather_faces_finish(&faces);
    room_finish(&room);
}

// The irradiance that a texel of the light map has at a normal, of mode `mode`.
static double map_light(const struct mrt_clutter_transfer *map, size_t texel, int mode,
                        vec3s normal)
{
    float basis[4];
    double sum = 0.0;
    sh_eval(2, normal, basis);
    for (size_t q = 0; q < 4; q++)
        sum += (double)(basis[q] * map->b.at[(4 * texel + q) * map->b.stride + (size_t)mode]);
    return sum;
}

TEST(the_light_map_of_clutter_has_the_light_of_rays)
{
    struct room room;
    struct raycast rays;
    struct mrt_clutter_transfer map;
    double worst = 0.0, tilted = 0.0;
    room_init(&room, WITH_BOX);
    room_trace(&room);
    CHECK(raycast_init(&rays, test_host(), &room.pose));
    CHECK(mrt_clutter_transfer_init(&map, test_host(), &room.rays, 0));
    CHECK(map.texel_count == room.clutter.charts.texel_count);
    for (size_t i = 0; i < map.texel_count; i += 7) {
        const uint32_t texel = room.clutter.texels[i];
        const mat3s frame = mrt_frame_of_normal(chart_texel_normal(&room.clutter.charts, texel));
        if (frame.col[2].y < -0.5f) continue; // the bottom lies on the floor
        const vec3s position = room.clutter.charts.texels[texel].position;
        const double expected = traced(&rays, position, frame, texel);
        const double found = map_light(&map, i, LINEAR, frame.col[2]);
        worst = fmax(worst, fabs(found / expected - 1.0));
        // Radiosity 1 in front of the surface: (1 + cosine) / 2 at a normal beside its own.
        const vec3s beside = vec3_unit(glms_vec3_add(frame.col[2], frame.col[0]));
        const double at_45 = map_light(&map, i, CONSTANT, beside);
        tilted = fmax(tilted, fabs(at_45 - 0.5 * (1.0 + sqrt(0.5))));
        CHECK(!map.inside[i]);
    }
    print_message("at most %.3f of the light from rays, %.3f at 45 degrees\n", worst, tilted);
    CHECK(worst < 0.03);
    CHECK(tilted < 0.1);
    mrt_clutter_transfer_finish(&map);
    raycast_finish(&rays);
    room_finish(&room);
}

// Two closed blocks beside each other, in a shell, with one more box.
static void pair_init(struct room *pair, struct box3 box)
{
    const struct mrt_clutter_options options = { 16.0f, 16 };
    const struct box3 shell = { vec3_of(-3, -1, -1), vec3_of(1, 1, 1) };
    *pair = (struct room){ .scene = scene_create(test_host(), "pair") };
    add_box(pair->scene, shell, true);
    add_box(pair->scene, box, false);
    // Clutter in any case.
    add_box(pair->scene, (struct box3){ vec3_of(0.5f, -1, 0.5f), vec3_of(0.7f, -0.6f, 0.7f) },
            false);
    CHECK(pose_init(&pair->pose, pair->scene, -1, 0.0f));
    CHECK(mrt_block_map_init(test_host(), "test", 2, &pair->map));
    for (int b = 0; b < 2; b++) {
        const float low = b == 0 ? -3.0f : -1.0f;
        mrt_block_init(&pair->map.blocks[b], b == 0 ? "low" : "high", MRT_BLOCK_CUBE);
        mrt_block_set_box(&pair->map.blocks[b],
                          (struct box3){ vec3_of(low, -1, -1), vec3_of(low + 2.0f, 1, 1) });
    }
    CHECK(mrt_clutter_init(&pair->clutter, test_host(), &pair->pose, &pair->map, &options));
}

static const struct box3 SCREEN = { { { -0.6f, -0.9f, -0.9f } }, { { -0.4f, 0.9f, 0.5f } } };
static const struct box3 PARTITION = { { { -1.05f, -1, -1 } }, { { -0.95f, 1, 1 } } };

TEST(blocks_open_where_clutter_alone_is_between_them)
{
    struct room pair;
    bool any;
    pair_init(&pair, PARTITION);
    CHECK(mrt_open_clutter_walls(&pair.map, &pair.clutter, false, &any));
    CHECK(!any && pair.map.blocks[0].neighbor[1].block < 0);
    room_finish(&pair);
    pair_init(&pair, SCREEN);
    CHECK(pair.clutter.triangles == 24);
    CHECK(mrt_open_clutter_walls(&pair.map, &pair.clutter, false, &any));
    CHECK(any && pair.map.blocks[0].neighbor[1].block == 1);
    room_finish(&pair);
}

// Each ray through an opening ends on a wall or on clutter: if both have radiosity 1, all of them
// count.
TEST(light_through_an_opening_is_of_walls_or_of_clutter)
{
    enum { ENTRY_RAYS = 256 };
    struct room pair;
    struct matrix_f32 ones[2] = { { 0 }, { 0 } }, u_r = { 0 };
    const struct matrix_f32 *l_imp[2] = { &ones[0], &ones[1] };
    struct mrt_delta_entry entry;
    struct mrt_rays rays;
    bool any;
    double all = 0.0, faces = 0.0;
    pair_init(&pair, SCREEN);
    CHECK(mrt_open_clutter_walls(&pair.map, &pair.clutter, false, &any));
    pair.objects = trace_scene_create(test_host(), &pair.clutter.objects.pose);
    for (int b = 0; b < 2; b++) {
        const struct mrt_shape shape = mrt_block_shape(&pair.map.blocks[b], TEXELS);
        CHECK(matrix_f32_init(test_host(), &ones[b], (size_t)mrt_shape_texels(&shape), 1));
        for (size_t i = 0; i < ones[b].rows; i++) ones[b].at[i * ones[b].stride] = 1.0f;
    }
    CHECK(matrix_f32_init(test_host(), &u_r, ALL, 1));
    for (size_t i = 0; i < ALL; i++) u_r.at[i * u_r.stride] = 1.0f;
    const struct mrt_clutter_rays all_rays = { .map = &pair.map,
                                               .l_imp = l_imp,
                                               .resolution = TEXELS,
                                               .clutter = &pair.clutter,
                                               .objects = pair.objects };
    const struct mrt_entered_opening opening = { 0, 1, &u_r, (const int[]){ 1 }, 1 };
    CHECK(mrt_delta_entry_init(&entry, test_host(), &all_rays, &opening));
    CHECK(mrt_rays_init(test_host(), MRT_IRRADIANCE, ENTRY_RAYS, &rays));
    const struct mrt_shape open = mrt_cube(TEXELS, 1u << 1), closed = mrt_cube(TEXELS, 0);
    for (int t = 0; t < ALL; t++)
        for (int r = 0; r < ENTRY_RAYS && t / (TEXELS * TEXELS) != 1; r++) {
            const struct mrt_point point = mrt_shape_texel(&closed, t);
            struct mrt_hit hit;
            mrt_shape_trace(&open, point.position, glms_mat3_mulv(point.frame, rays.direction[r]),
                            &hit);
            all += hit.opening >= 0 ? 1.0 / ENTRY_RAYS : 0.0;
        }
    for (size_t f = 0; f < entry.sources[0].c.columns; f++)
        faces += (double)entry.sources[0].c.at[f];
    print_message("%.3f of the light through the opening is of clutter\n", faces / all);
    CHECK(entry.sources[0].hidden && faces > 0.4 * all);
    CHECK_RELATIVE((double)entry.sources[0].b.at[0] + faces, all, 1e-3);
    mrt_rays_finish(test_host(), &rays);
    mrt_delta_entry_finish(&entry);
    for (int b = 0; b < 2; b++) matrix_f32_finish(test_host(), &ones[b]);
    matrix_f32_finish(test_host(), &u_r);
    room_finish(&pair);
}

// Two blocks, of which the first has the box: a basis more, and a response more for each of its two
// openings and for its faces.
TEST(the_size_of_operators_is_known_before_rays)
{
    struct room room;
    struct mrt_block_map map;
    room_init(&room, WITH_BOX);
    CHECK(mrt_block_map_init(test_host(), "test", 2, &map));
    for (int b = 0; b < 2; b++) {
        const float x = 100.0f * (float)b;
        mrt_block_init(&map.blocks[b], b ? "empty" : "room", MRT_BLOCK_CUBE);
        mrt_block_set_box(&map.blocks[b],
                          (struct box3){ vec3_of(x - 1, -1, -1), vec3_of(x + 1, 1, 1) });
    }
    struct mrt_block_basis basis = { 0 };
    struct mrt_block_response response = { 0 };
    struct mrt_opening openings[5] = {
        { .block = 0 }, { .block = 0 }, { .block = 1 }, { .block = 1 }, { .block = 1 }
    };
    basis.u[MRT_VECTOR] = (struct matrix_f32){ .rows = 40, .columns = 9 };
    response.u[MRT_VECTOR] = (struct matrix_f32){ .rows = 40, .columns = 3 };
    struct mrt_operators operators = { .bases = &basis,
                                       .basis_count = 2,
                                       .responses = &response,
                                       .response_count = 5,
                                       .openings = openings,
                                       .opening_count = 5 };
    int blocks;
    CHECK(mrt_clutter_numbers(&operators, &map, &room.clutter, &blocks) == 3 * 40 * 9);
    CHECK(blocks == 1);
    response.u[MRT_VECTOR].columns = 4;
    CHECK(mrt_clutter_numbers(&operators, &map, &room.clutter, &blocks) == (5 + 3) * 40 * 4);
    mrt_block_map_finish(&map);
    room_finish(&room);
}
