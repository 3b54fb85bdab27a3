// Occupied voxels: the exact set of a separating-axis twin, on borders of the grid, for moving and
// degenerate triangles.
#include "techniques/vct/vct_fixture.h"

#include "core/rng.h"
#include "techniques/vct/vct_voxel_count.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DIM = 16 };

// ---- Twin: each voxel of a triangle's bounds against 13 axes (Akenine-Möller 2001)

static bool separated(vec3s axis, const vec3s at[3])
{
    const float p = glms_vec3_dot(axis, at[0]), q = glms_vec3_dot(axis, at[1]),
                r = glms_vec3_dot(axis, at[2]);
    const float reach = 0.5f * (fabsf(axis.x) + fabsf(axis.y) + fabsf(axis.z));
    // Slack for rounding where a triangle touches a face exactly.
    const float slack = 1e-4f * reach;
    return fminf(p, fminf(q, r)) > reach + slack || fmaxf(p, fmaxf(q, r)) < -reach - slack;
}

static bool touches(vec3s voxel_middle, const vec3s corners[3])
{
    vec3s at[3];
    for (int i = 0; i < 3; i++) at[i] = glms_vec3_sub(corners[i], voxel_middle);
    const vec3s normal = glms_vec3_cross(glms_vec3_sub(at[1], at[0]), glms_vec3_sub(at[2], at[1]));
    if (separated(normal, at)) return false;
    for (int axis = 0; axis < 3; axis++) {
        vec3s unit = vec3_of(0, 0, 0);
        unit.raw[axis] = 1.0f;
        if (separated(unit, at)) return false;
        for (int i = 0; i < 3; i++)
            if (separated(glms_vec3_cross(unit, glms_vec3_sub(at[(i + 1) % 3], at[i])), at))
                return false;
    }
    return true;
}

struct twin {
    bool voxels[DIM][DIM][DIM]; // z, y, x
};

static int within(int at, int low, int high)
{
    return at < low ? low : at > high ? high : at;
}

// A coordinate on a voxel border belongs to the upper voxel as a minimum, to the lower one as a
// maximum; on the border of the scene to the voxel inside.
static void twin_add(struct twin *twin, const struct vct_grid *grid, const vec3s world[3])
{
    vec3s at[3];
    int first[3], last[3];
    for (int i = 0; i < 3; i++)
        at[i] = glms_vec3_scale(glms_vec3_sub(world[i], grid->origin_m), 1.0f / grid->cell_m);
    if (!(glms_vec3_norm2(
              glms_vec3_cross(glms_vec3_sub(at[1], at[0]), glms_vec3_sub(at[2], at[1]))) > 0.0f))
        return;
    for (int a = 0; a < 3; a++) {
        const float low = fminf(at[0].raw[a], fminf(at[1].raw[a], at[2].raw[a]));
        const float high = fmaxf(at[0].raw[a], fmaxf(at[1].raw[a], at[2].raw[a]));
        const int begin = -grid->first[a], end = begin + grid->scene[a] - 1;
        first[a] = (int)floorf(low);
        last[a] = (int)ceilf(high) - 1;
        if (last[a] < first[a]) last[a] = first[a];
        first[a] = within(first[a], begin, end);
        last[a] = within(last[a], begin, end);
        if (last[a] < 0 || first[a] >= grid->cells[a]) return;
        first[a] = within(first[a], 0, grid->cells[a] - 1);
        last[a] = within(last[a], 0, grid->cells[a] - 1);
    }
    for (int z = first[2]; z <= last[2]; z++)
        for (int y = first[1]; y <= last[1]; y++)
            for (int x = first[0]; x <= last[0]; x++)
                if (touches(vec3_of((float)x + 0.5f, (float)y + 0.5f, (float)z + 0.5f), at))
                    twin->voxels[z][y][x] = true;
}

static int check_same(const struct vct_fixture *fixture, const struct twin *twin,
                      const struct vct_voxel_set *set)
{
    uint32_t *mask = vct_fixture_mask(fixture, set);
    int count = 0;
    for (int z = 0; z < DIM; z++)
        for (int y = 0; y < DIM; y++)
            for (int x = 0; x < DIM; x++) {
                const bool has = vct_fixture_occupied(fixture, mask, x, y, z);
                if (has != twin->voxels[z][y][x])
                    fail_msg("voxel %d %d %d: %d, twin %d", x, y, z, has, twin->voxels[z][y][x]);
                count += has;
            }
    free(mask);
    return count;
}

// ---- Random triangles

static vec3s random_point(struct rng *rng)
{
    return vec3_of(11.3f * rng_float(rng), 8.1f * rng_float(rng), 9.7f * rng_float(rng));
}

// Three sizes: the whole scene, a few voxels, less than a voxel.
static void random_triangle(struct rng *rng, int kind, vec3s out[3])
{
    out[0] = random_point(rng);
    for (int k = 1; k < 3; k++) {
        const float part = kind == 0 ? 1.0f : kind == 1 ? 0.25f : 0.02f;
        out[k] = glms_vec3_lerp(out[0], random_point(rng), part);
    }
}

// In each clip-map level.
static void check_random_triangles(struct gpu *gpu, const char *options)
{
    enum { TRIANGLES = 45 };
    struct vct_fixture fixture;
    vec3s triangles[TRIANGLES][3];
    struct rng rng = rng_for(11, 0, 0);
    vct_fixture_init(&fixture, gpu);
    const int matte = fixture_matte(&fixture.frame_fixture, vec3_of(0.5f, 0.5f, 0.5f));
    for (int i = 0; i < TRIANGLES; i++) {
        random_triangle(&rng, i % 3, triangles[i]);
        vct_fixture_add_triangle(&fixture, triangles[i], matte);
    }
    fixture_look(&fixture.frame_fixture, vec3_of(5, 4, 6), vec3_of(6, 4, 4));
    vct_fixture_open(&fixture, options);
    fixture_render(&fixture.frame_fixture);
    for (int clip = 0; clip < fixture.vct->clipmap.count; clip++) {
        const struct vct_grid *grid = &fixture.vct->clipmap.levels[clip].grid;
        struct twin twin = { 0 };
        for (int i = 0; i < TRIANGLES; i++) twin_add(&twin, grid, triangles[i]);
        const int count = check_same(&fixture, &twin, &fixture.vct->voxels.levels[clip].static_set);
        CHECK(count > 100 && count < DIM * DIM * DIM / 2); // neither full nor empty
        // The CPU's count may differ for triangles that touch a face exactly.
        uint32_t counted = 0;
        CHECK(vct_count_touched(test_host(), &fixture.frame_fixture.pose, grid, DIM, UINT32_MAX - 1,
                                &counted));
        CHECK(abs((int)counted - count) <= 2);
    }
    vct_fixture_finish(&fixture);
}

TEST_GPU(occupied_voxels_match_the_twin)
{
    check_random_triangles(gpu, "resolution=16,levels=3");
}

TEST_GPU(rasterized_voxels_match_the_twin)
{
    check_random_triangles(gpu, "resolution=16,levels=3,voxels=raster");
}

static void check_same_words(const struct vct_fixture *a, gpu_buffer in_a,
                             const struct vct_fixture *b, gpu_buffer in_b)
{
    uint32_t *p = vct_fixture_buffer_words(a, in_a), *q = vct_fixture_buffer_words(b, in_b);
    CHECK(memcmp(p, q, gpu_buffer_bytes(a->frame_fixture.gpu, in_a)) == 0);
    free(p);
    free(q);
}

static uint32_t *texels_of(const struct vct_fixture *fixture, gpu_image image, size_t *bytes)
{
    const struct gpu_image_desc *desc = gpu_image_info(fixture->frame_fixture.gpu, image);
    *bytes = (size_t)desc->width * desc->height * (size_t)gpu_format_bytes(desc->format);
    uint32_t *texels = malloc(*bytes);
    assert_non_null(texels);
    assert_true(gpu_image_download(fixture->frame_fixture.gpu, image, 0, 0, texels, *bytes));
    return texels;
}

static void check_same_texels(const struct vct_fixture *a, gpu_image in_a,
                              const struct vct_fixture *b, gpu_image in_b)
{
    size_t bytes, bytes_b;
    uint32_t *p = texels_of(a, in_a, &bytes), *q = texels_of(b, in_b, &bytes_b);
    CHECK(bytes == bytes_b && memcmp(p, q, bytes) == 0);
    free(p);
    free(q);
}

// A box, a block and slivers, which almost vanish when rasterized, and the attributes of their
// voxels. The rasterizer accumulates all triangles; the compute pass writes voxels of a single
// large triangle directly.
TEST_GPU(rasterized_attributes_equal_computed_ones)
{
    struct vct_fixture fixtures[2];
    for (int i = 0; i < 2; i++) {
        struct vct_fixture *fixture = &fixtures[i];
        struct rng rng = rng_for(12, 0, 0);
        vct_fixture_init(fixture, gpu);
        const int red = fixture_matte(&fixture->frame_fixture, vec3_of(0.7f, 0.3f, 0.1f));
        fixture_box(&fixture->frame_fixture, vec3_of(0, 0, 0), vec3_of(12, 9, 10), true, red);
        fixture_box(&fixture->frame_fixture, vec3_of(3, 0, 3), vec3_of(4.1f, 5.3f, 5.7f), false,
                    red);
        for (int k = 0; k < 200; k++) {
            vec3s corners[3];
            random_triangle(&rng, k % 3, corners);
            if (k % 2 == 0) corners[2] = glms_vec3_lerp(corners[1], corners[2], 1e-3f);
            vct_fixture_add_triangle(fixture, corners, red);
        }
        // Large triangles span more than one tile of columns.
        vct_fixture_open(fixture, i == 0 ? "resolution=48" : "resolution=48,voxels=raster");
        fixture_render(&fixture->frame_fixture);
    }
    check_same_words(&fixtures[0], fixtures[0].vct->voxels.levels[0].static_set.mask, &fixtures[1],
                     fixtures[1].vct->voxels.levels[0].static_set.mask);
    check_same_texels(&fixtures[0], fixtures[0].vct->voxels.levels[0].static_set.surfaces,
                      &fixtures[1], fixtures[1].vct->voxels.levels[0].static_set.surfaces);
    for (int i = 0; i < 2; i++) vct_fixture_finish(&fixtures[i]);
}

TEST_GPU(degenerate_triangles_occupy_no_voxels)
{
    struct vct_fixture fixture;
    struct twin twin = { 0 };
    vct_fixture_init(&fixture, gpu);
    const int matte = fixture_matte(&fixture.frame_fixture, vec3_of(0.5f, 0.5f, 0.5f));
    const vec3s real[3] = { vec3_of(0, 0, 0), vec3_of(2, 0, 0.5f), vec3_of(0.3f, 2, 1) };
    const vec3s line[3] = { vec3_of(0, 0, 0), vec3_of(4, 4, 4), vec3_of(8, 8, 8) };
    const vec3s point[3] = { vec3_of(7, 7, 7), vec3_of(7, 7, 7), vec3_of(7, 7, 7) };
    vct_fixture_add_triangle(&fixture, real, matte);
    vct_fixture_add_triangle(&fixture, line, matte);
    vct_fixture_add_triangle(&fixture, point, matte);
    vct_fixture_open(&fixture, "resolution=16");
    fixture_render(&fixture.frame_fixture);
    twin_add(&twin, &fixture.vct->clipmap.levels[0].grid, real);
    CHECK(check_same(&fixture, &twin, &fixture.vct->voxels.levels[0].static_set) > 0);
    vct_fixture_finish(&fixture);
}

// 12 m in 12 cells of 1 m: the walls lie in the border of the grid and must be kept.
TEST_GPU(walls_on_the_border_of_the_grid_are_kept)
{
    struct vct_fixture fixture;
    vct_fixture_init(&fixture, gpu);
    fixture_box(&fixture.frame_fixture, vec3_of(0, 0, 0), vec3_of(12, 12, 12), true,
                fixture_matte(&fixture.frame_fixture, vec3_of(0.5f, 0.5f, 0.5f)));
    vct_fixture_open(&fixture, "resolution=16");
    fixture_render(&fixture.frame_fixture);
    CHECK(fixture.vct->clipmap.levels[0].grid.cell_m == 1.0f &&
          fixture.vct->clipmap.levels[0].grid.origin_m.x == 0.0f);
    for (int axis = 0; axis < 3; axis++)
        CHECK(fixture.vct->clipmap.levels[0].grid.cells[axis] == 12);
    uint32_t *mask = vct_fixture_mask(&fixture, &fixture.vct->voxels.levels[0].static_set);
    for (int z = 0; z < DIM; z++)
        for (int y = 0; y < DIM; y++)
            for (int x = 0; x < DIM; x++) {
                const bool inside = x < 12 && y < 12 && z < 12;
                const bool border = x == 0 || y == 0 || z == 0 || x == 11 || y == 11 || z == 11;
                CHECK(vct_fixture_occupied(&fixture, mask, x, y, z) == (inside && border));
            }
    free(mask);
    vct_fixture_finish(&fixture);
}

TEST_GPU(moving_objects_are_in_the_dynamic_set)
{
    struct vct_fixture fixture;
    struct twin still = { 0 }, moving = { 0 };
    vct_fixture_init(&fixture, gpu);
    const int matte = fixture_matte(&fixture.frame_fixture, vec3_of(0.5f, 0.5f, 0.5f));
    const vec3s one[3] = { vec3_of(0, 0, 0), vec3_of(12, 0, 0), vec3_of(0, 0.3f, 12) };
    vec3s other[3] = { vec3_of(3, 5.2f, 3), vec3_of(8, 5.4f, 3), vec3_of(3, 9.7f, 3.3f) };
    vct_fixture_add_triangle(&fixture, one, matte);
    const int instance = vct_fixture_add_triangle(&fixture, other, matte);
    vct_fixture_open(&fixture, "resolution=16");
    fixture_render(&fixture.frame_fixture);
    const vec3s step = vec3_of(1.5f, -1, 2);
    mat4s *world = &fixture.frame_fixture.pose
                        .world_from_node[fixture.frame_fixture.scene->instances[instance].node];
    *world = glms_translate(*world, step);
    fixture_render(&fixture.frame_fixture);
    fixture_render(&fixture.frame_fixture);
    for (int i = 0; i < 3; i++) other[i] = glms_vec3_add(other[i], step);
    twin_add(&still, &fixture.vct->clipmap.levels[0].grid, one);
    twin_add(&moving, &fixture.vct->clipmap.levels[0].grid, other);
    CHECK(check_same(&fixture, &still, &fixture.vct->voxels.levels[0].static_set) > 0);
    CHECK(check_same(&fixture, &moving, &fixture.vct->voxels.levels[0].dynamic_set) > 0);
    vct_fixture_finish(&fixture);
}
