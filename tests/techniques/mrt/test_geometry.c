// Geometry images of levels, and the walls that stand for surfaces.
#include "framework/test.h"
#include "techniques/mrt/mrt_map_fixture.h"

#include "core/rng.h"

#include "techniques/mrt/level/geometry.h"
#include "techniques/mrt/level/map/make_map.h"

#include <math.h>

enum { RESOLUTION = 8 };

struct level {
    struct scene *scene;
    struct scene_pose pose;
    struct trace_scene *trace;
    struct mrt_block_map map;
    struct mrt_atlas atlas;
    struct mrt_geometry_texel *geometry;
};

static struct level make_at(const char *spec, bool single, int resolution)
{
    struct level l = { .scene = scene_load(test_host(), spec) };
    CHECK(l.scene && pose_init(&l.pose, l.scene, -1, 0.0f));
    CHECK((l.trace = trace_scene_create(test_host(), &l.pose)) != NULL);
    CHECK(single ? mrt_map_single(test_host(), &l.pose, &l.map)
                 : mrt_block_map_of_scene(test_host(), l.scene, &l.map));
    CHECK(mrt_atlas_init(test_host(), &l.map, resolution, &l.atlas));
    CHECK((l.geometry = mrt_geometry_create(test_host(), &l.map, &l.atlas, l.trace)) != NULL);
    return l;
}

static struct level make(const char *spec, bool single)
{
    return make_at(spec, single, RESOLUTION);
}

static void finish(struct level *l)
{
    host_free(test_host(), l->geometry);
    mrt_atlas_finish(&l->atlas);
    mrt_block_map_finish(&l->map);
    trace_scene_destroy(l->trace);
    pose_finish(&l->pose);
    scene_destroy(l->scene);
}

// Walls of the maze are half of 0.24 m inside the borders of the blocks: at 16 texels the outermost
// ones begin inside them.
TEST(texels_of_a_maze_are_on_its_walls)
{
    enum { FINE = 16 };
    struct level l = make_at("@maze:blocks=7,light=point", false, FINE);
    int missed = 0, far = 0;
    for (int i = 0; i < l.atlas.texels; i++) {
        const struct mrt_geometry_texel *texel = &l.geometry[i];
        const struct mrt_tile *tile = &l.atlas.tiles[i / (FINE * FINE)];
        const struct mrt_block *block = &l.map.blocks[tile->block];
        vec3s cell, inward = glms_vec3_negate(cube_from_face(tile->face).col[2]);
        missed += !texel->found;
        CHECK(mrt_warp_inverse(block->corner, texel->position, &cell));
        float depth = 0.5f + glms_vec3_dot(inward, cell);
        far += !(depth > -0.001f && depth < 0.045f);
        CHECK(glms_vec3_dot(inward, texel->normal) > 0.99f);
        float reflectance = glms_vec3_max(texel->reflectance);
        CHECK_NEAR(reflectance, 0.55, 0.25);
    }
    print_message("%d texels, %d without a surface, %d away from their wall\n", l.atlas.texels,
                  missed, far);
    CHECK(missed == 0 && far == 0);
    finish(&l);
}

TEST(texels_of_an_open_side_have_no_surface_and_no_reflectance)
{
    struct level l = make("@cornell:light=point", true);
    int n = RESOLUTION * RESOLUTION, front = l.atlas.tile_of_face[CUBE_FRONT];
    for (int i = 0; i < l.atlas.texels; i++) {
        const struct mrt_geometry_texel *texel = &l.geometry[i];
        CHECK(texel->found || i / n == front); // open towards +z
        CHECK(texel->found || glms_vec3_norm(texel->reflectance) == 0.0f);
        CHECK(isfinite(glms_vec3_norm(texel->position)));
        CHECK_NEAR(glms_vec3_norm(texel->normal), 1, 1e-4);
    }
    CHECK(!l.geometry[front * n + n / 2].found);
    finish(&l);
}

TEST(texels_of_an_emitter_emit)
{
    struct level l = make("@cornell", true);
    float most = 0.0f;
    for (int i = 0; i < l.atlas.texels; i++)
        most = fmaxf(most, glms_vec3_max(l.geometry[i].emission));
    CHECK(most > 0.0f);
    finish(&l);
}

// ---- walls of surfaces

// The wall of a block that stands for a surface in it: the one that faces its way most. The point
// is projected onto the wall along an axis of the cell.
struct wall_point {
    int face;
    float s, t; // clamped to [0, 1]
};

// The surface's normal in the cell: gradients transform with the transposed Jacobian.
static vec3s normal_in_cell(const struct mrt_block *block, vec3s cell, vec3s normal)
{
    mat3s j = mrt_warp_jacobian(block->corner, cell);
    return vec3_unit(glms_mat3_mulv(glms_mat3_transpose(j), normal));
}

static float clamped(float x)
{
    return fminf(fmaxf(x, 0.0f), 1.0f);
}

static float outside(vec3s cell)
{
    return fmaxf(glms_vec3_max(glms_vec3_abs(cell)) - 0.5f, 0.0f);
}

// False: the point is farther from the cell than `beyond`, a part of its edge, or the surface faces
// away from all walls.
static bool wall_of_surface(const struct mrt_block *block, vec3s position, vec3s normal,
                            float beyond, struct wall_point *out)
{
    vec3s cell;
    if (!mrt_warp_inverse(block->corner, position, &cell) || outside(cell) > beyond) return false;
    vec3s n = normal_in_cell(block, cell, normal);
    float most = 0.0f;
    out->face = -1;
    for (int f = 0; f < CUBE_FACES; f++) {
        // The inner normal of a wall is that of its frame, reversed.
        float along = -glms_vec3_dot(cube_from_face(f).col[2], n);
        if (mrt_block_is_open(block, f) || along <= most) continue;
        most = along;
        out->face = f;
    }
    if (out->face < 0) return false;
    mat3s frame = cube_from_face(out->face);
    out->s = clamped(0.5f + glms_vec3_dot(frame.col[0], cell));
    out->t = clamped(0.5f + glms_vec3_dot(frame.col[1], cell));
    return true;
}

// A texel's own surface belongs to that texel.
TEST(the_wall_of_a_texel_is_its_own)
{
    struct level l = make("@maze:blocks=7,light=point", false);
    int n = RESOLUTION * RESOLUTION;
    for (int i = 0; i < l.atlas.texels; i++) {
        const struct mrt_tile *tile = &l.atlas.tiles[i / n];
        struct wall_point point = { 0 };
        CHECK(wall_of_surface(&l.map.blocks[tile->block], l.geometry[i].position,
                              l.geometry[i].normal, 0.25f, &point));
        CHECK(point.face == tile->face);
        CHECK_NEAR(point.s, ((float)(i % n % RESOLUTION) + 0.5f) / RESOLUTION, 1e-3);
        CHECK_NEAR(point.t, ((float)(i % n / RESOLUTION) + 0.5f) / RESOLUTION, 1e-3);
    }
    finish(&l);
}
