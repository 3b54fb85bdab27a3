// Clip-map levels: their placement, and that their voxels equal those of any grid at that place.
// Their light is tested in techniques.vct.clip_light.
#include "techniques/vct/vct_fixture.h"

#include "core/rng.h"
#include "techniques/vct/vct_voxel_count.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- Placement

static vec3s random_camera(struct rng *rng)
{
    return vec3_of(60.0f * rng_float(rng) - 20.0f, 60.0f * rng_float(rng) - 20.0f,
                   60.0f * rng_float(rng) - 20.0f);
}

TEST(a_level_is_aligned_to_texels_of_the_coarser_level)
{
    const struct box3 bounds = { { { -1.3f, 0.2f, 2 } }, { { 19.1f, 5.4f, 13 } } };
    struct rng rng = rng_for(5, 0, 0);
    for (int dim = 16; dim <= 256; dim += 16) {
        struct vct_grid scene;
        CHECK(vct_grid_fit(bounds, dim, &scene));
        for (int i = 0; i < 60; i++) {
            const int halvings = 1 + i % 5;
            const vec3s camera = random_camera(&rng);
            const struct vct_grid grid = vct_grid_around(&scene, dim, halvings, camera),
                                  coarse = vct_grid_around(&scene, dim, halvings - 1, camera);
            const struct box3 used = vct_grid_cone_box(&scene, dim, halvings, camera, 4.0f);
            CHECK(grid.cell_m == ldexpf(scene.cell_m, -halvings));
            for (int a = 0; a < 3; a++) {
                const int last = grid.first[a] + grid.cells[a];
                CHECK(grid.scene[a] == scene.cells[a] << halvings);
                CHECK(grid.first[a] % 4 == 0 && grid.cells[a] % 2 == 0);
                CHECK(grid.first[a] >= 0 && last <= grid.scene[a]);
                CHECK(grid.cells[a] == (grid.scene[a] < dim ? grid.scene[a] : dim));
                // The cone box is half a texel, one voxel, inside of each side that is not the
                // scene's.
                if (grid.first[a] > 0) CHECK(used.min.raw[a] >= (float)grid.first[a] + 0.99f);
                if (last < grid.scene[a]) CHECK(used.max.raw[a] <= (float)last - 0.99f);
                // It is inside of the next coarser grid.
                CHECK(2 * coarse.first[a] <= grid.first[a]);
                CHECK(2 * (coarse.first[a] + coarse.cells[a]) >= last);
            }
        }
    }
}

// The cone box moves continuously with the camera, some times faster near the border of the scene.
TEST(the_cone_box_moves_continuously_with_the_camera)
{
    const struct box3 bounds = { { { 0, 0, 0 } }, { { 27, 13, 20 } } };
    struct vct_grid scene;
    CHECK(vct_grid_fit(bounds, 32, &scene));
    const float step = 0.01f / ldexpf(scene.cell_m, -2); // voxels
    struct box3 last = vct_grid_cone_box(&scene, 32, 2, vec3_of(-3, 1, 1), 4.0f);
    int moved = 0, stood = 0;
    for (int i = 1; i < 3300; i++) {
        const vec3s camera = vec3_of(-3 + 0.01f * (float)i, 1, 1);
        const struct box3 used = vct_grid_cone_box(&scene, 32, 2, camera, 4.0f);
        const float low = used.min.x - last.min.x, high = used.max.x - last.max.x;
        CHECK(low > -1e-3f && low < 6.0f * step && high > -1e-3f && high < 6.0f * step);
        moved += low > 0.5f * step;
        stood += low == 0.0f;
        last = used;
    }
    CHECK(moved > 1000 && stood > 300);
    const vec3s odd[] = { { { 1e30f, -1e30f, 0 } }, { { NAN, INFINITY, -INFINITY } } };
    for (int i = 0; i < 2; i++) {
        const struct vct_grid grid = vct_grid_around(&scene, 32, 2, odd[i]);
        for (int a = 0; a < 3; a++)
            CHECK(grid.first[a] >= 0 && grid.first[a] + grid.cells[a] <= grid.scene[a]);
    }
}

// ---- Voxels

// On a lattice of 1/64 m: rounding does not depend on the origin of a grid.
static vec3s lattice_point(struct rng *rng, vec3s about, float reach)
{
    vec3s p;
    for (int a = 0; a < 3; a++) {
        const float at = about.raw[a] + reach * (2.0f * rng_float(rng) - 1.0f);
        p.raw[a] = roundf(64.0f * fminf(fmaxf(at, 0.0f), 27.0f)) / 64.0f;
    }
    return p;
}

static void add_rubble(struct vct_fixture *fixture, int count)
{
    struct rng rng = rng_for(21, 0, 0);
    const int red = fixture_matte(&fixture->frame_fixture, vec3_of(0.7f, 0.3f, 0.1f));
    for (int i = 0; i < count; i++) {
        const vec3s middle = lattice_point(&rng, vec3_of(13.5f, 13.5f, 13.5f), 13.5f);
        const float reach = i % 3 == 0 ? 9.0f : i % 3 == 1 ? 2.0f : 0.2f;
        vec3s corners[3];
        for (int k = 0; k < 3; k++) corners[k] = lattice_point(&rng, middle, reach);
        vct_fixture_add_triangle(fixture, corners, red);
    }
}

struct voxels {
    struct vct_grid grid;
    uint32_t *mask, *before, *surfaces;
};

static struct voxels voxels_of(const struct vct_fixture *fixture, int clip)
{
    const struct vct_voxel_set *set = &fixture->vct->voxels.levels[clip].static_set;
    const size_t bytes = (size_t)gpu_groups(vct_capacity(&fixture->vct->options), VCT_VOXEL_ROW) *
                         2 * VCT_VOXEL_ROW * 16;
    struct voxels v = { fixture->vct->clipmap.levels[clip].grid,
                        vct_fixture_buffer_words(fixture, set->mask),
                        vct_fixture_buffer_words(fixture, set->word_offsets), malloc(bytes) };
    CHECK(v.surfaces &&
          gpu_image_download(fixture->frame_fixture.gpu, set->surfaces, 0, 0, v.surfaces, bytes));
    return v;
}

static void free_voxels(struct voxels *v)
{
    free(v->mask);
    free(v->before);
    free(v->surfaces);
}

// The occupied faces of a voxel, counted from the scene's corner, as bits, and the surface texels
// of the first one; those of the others follow.
static uint32_t faces_at(const struct vct_fixture *fixture, const struct voxels *v, const int at[3],
                         const uint32_t **surfaces)
{
    const int x = at[0] - v->grid.first[0], y = at[1] - v->grid.first[1],
              z = at[2] - v->grid.first[2], dim = fixture->vct->options.resolution / 2;
    const uint32_t index =
        (uint32_t)(8 * (((z / 2) * dim + y / 2) * dim + x / 2) + x % 2 + 2 * (y % 2) + 4 * (z % 2));
    const uint32_t word = v->mask[index / 4], shift = 8 * (index % 4);
    const uint32_t slot =
        v->before[index / 4] + (uint32_t)__builtin_popcount(word & ((1u << shift) - 1));
    *surfaces = v->surfaces + (size_t)slot * 8; // two texels
    return word >> shift & 0xffu;
}

// Compares the intersection of two grids of one voxel size. Returns the number of occupied voxels.
static int check_same_voxels(const struct vct_fixture *fixture, const struct voxels *a,
                             const struct voxels *b)
{
    int first[3], last[3], at[3], count = 0;
    for (int i = 0; i < 3; i++) {
        const int ends[2] = { a->grid.first[i] + a->grid.cells[i],
                              b->grid.first[i] + b->grid.cells[i] };
        first[i] = a->grid.first[i] > b->grid.first[i] ? a->grid.first[i] : b->grid.first[i];
        last[i] = ends[0] < ends[1] ? ends[0] : ends[1];
        CHECK(first[i] < last[i]);
    }
    for (at[2] = first[2]; at[2] < last[2]; at[2]++)
        for (at[1] = first[1]; at[1] < last[1]; at[1]++)
            for (at[0] = first[0]; at[0] < last[0]; at[0]++) {
                const uint32_t *p, *q, faces = faces_at(fixture, a, at, &p);
                CHECK(faces == faces_at(fixture, b, at, &q));
                count += faces != 0;
                for (int k = 0; k < __builtin_popcount(faces); k++)
                    if (memcmp(p + 8 * k, q + 8 * k, 4 * sizeof *p) != 0)
                        fail_msg("voxel %d %d %d differs", at[0], at[1], at[2]);
            }
    return count;
}

// A triangle clipped by the border of a grid writes the same values to the voxels inside: voxels do
// not depend on the camera, to the bit.
static void check_voxels_of_three_cameras(struct gpu *gpu, const char *options)
{
    const vec3s cameras[] = { { { 10, 9, 12 } }, { { 11.4f, 10.2f, 13.3f } }, { { 4, 20, 9 } } };
    struct vct_fixture fixtures[3];
    struct voxels voxels[3];
    for (int i = 0; i < 3; i++) {
        vct_fixture_init(&fixtures[i], gpu);
        add_rubble(&fixtures[i], 600);
        fixture_box(&fixtures[i].frame_fixture, vec3_of(0, 0, 0), vec3_of(27, 27, 27), true,
                    fixture_matte(&fixtures[i].frame_fixture, vec3_of(0.5f, 0.5f, 0.5f)));
        fixture_look(&fixtures[i].frame_fixture, cameras[i], vec3_of(0, 13, 27));
        vct_fixture_open(&fixtures[i], options);
        fixture_render(&fixtures[i].frame_fixture);
        CHECK(fixtures[i].vct->clipmap.levels[0].grid.cell_m == 1.0f);
    }
    for (int clip = 1; clip < fixtures[0].vct->clipmap.count; clip++) {
        for (int i = 0; i < 3; i++) voxels[i] = voxels_of(&fixtures[i], clip);
        for (int i = 1; i < 3; i++) {
            CHECK(memcmp(voxels[0].grid.first, voxels[i].grid.first, sizeof(int32_t[3])) != 0);
            if (clip > 1 && i == 2) continue; // too far away for the finest to overlap
            const int count = check_same_voxels(&fixtures[0], &voxels[0], &voxels[i]);
            print_message("%s: level %d: %d common voxels\n", options, clip + 1, count);
            CHECK(count > 200);
        }
        for (int i = 0; i < 3; i++) free_voxels(&voxels[i]);
    }
    for (int i = 0; i < 3; i++) vct_fixture_finish(&fixtures[i]);
}

TEST_GPU(voxels_are_independent_of_the_camera)
{
    check_voxels_of_three_cameras(gpu, "resolution=32,levels=3");
}

TEST_GPU(rasterized_voxels_are_independent_of_the_camera)
{
    check_voxels_of_three_cameras(gpu, "resolution=32,levels=3,voxels=raster");
}

static int occupied(const struct voxels *v, int dim)
{
    int count = 0;
    for (int i = 0; i < dim * dim * dim; i++)
        count += (v->mask[i / 4] >> (8 * (i % 4)) & 0xffu) != 0;
    return count;
}

TEST_GPU(rasterized_voxels_equal_computed_ones_in_each_level)
{
    struct vct_fixture fixtures[2];
    for (int i = 0; i < 2; i++) {
        vct_fixture_init(&fixtures[i], gpu);
        add_rubble(&fixtures[i], 150);
        fixture_box(&fixtures[i].frame_fixture, vec3_of(9.2f, 8.1f, 10.9f),
                    vec3_of(10.7f, 10.3f, 13.1f), false,
                    fixture_matte(&fixtures[i].frame_fixture, vec3_of(0.5f, 0.5f, 0.5f)));
        fixture_look(&fixtures[i].frame_fixture, vec3_of(10, 9, 12), vec3_of(0, 13, 27));
        vct_fixture_open(&fixtures[i], i == 0 ? "resolution=32,levels=5"
                                              : "resolution=32,levels=5,voxels=raster");
        fixture_render(&fixtures[i].frame_fixture);
    }
    for (int clip = 0; clip < 5; clip++) {
        struct voxels a = voxels_of(&fixtures[0], clip), b = voxels_of(&fixtures[1], clip);
        const int count = check_same_voxels(&fixtures[0], &a, &b);
        CHECK(count > 50 && count == occupied(&a, 32) && count == occupied(&b, 32));
        uint32_t counted = 0; // on the CPU; differs for triangles that touch a face exactly
        CHECK(vct_count_touched(test_host(), &fixtures[0].frame_fixture.pose, &a.grid, 32,
                                UINT32_MAX - 1, &counted));
        print_message("level %d: %d voxels, %u on the CPU\n", clip + 1, count, counted);
        CHECK(abs((int)counted - count) <= 2 + count / 100);
        free_voxels(&a);
        free_voxels(&b);
    }
    for (int i = 0; i < 2; i++) vct_fixture_finish(&fixtures[i]);
}

// ---- Updates

static bool ran(const struct gpu *gpu, const char *pass)
{
    struct gpu_timing timings[64];
    const int count = gpu_frame_timings(gpu, timings, 64);
    for (int i = 0; i < count; i++)
        if (strcmp(timings[i].name, pass) == 0) return true;
    return false;
}

static bool voxelized(struct vct_fixture *fixture)
{
    fixture_render(&fixture->frame_fixture);
    CHECK(gpu_wait(fixture->frame_fixture.gpu));
    CHECK(ran(fixture->frame_fixture.gpu, "vct.cones"));
    return ran(fixture->frame_fixture.gpu, "vct.mark") ||
           ran(fixture->frame_fixture.gpu, "vct.add");
}

TEST_GPU(a_level_is_kept_until_the_camera_moves_a_step)
{
    struct vct_fixture fixture;
    vct_fixture_hall(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=32,levels=3");
    CHECK(voxelized(&fixture));
    CHECK(!voxelized(&fixture));
    const struct vct_grid finest = fixture.vct->clipmap.levels[2].grid,
                          middle = fixture.vct->clipmap.levels[1].grid;
    fixture_look(&fixture.frame_fixture, vec3_of(12.01f, 5, 15), vec3_of(13, 5, 4));
    CHECK(!voxelized(&fixture));
    int first = finest.first[0];
    for (int i = 1; i < 40 && fixture.vct->clipmap.levels[2].grid.first[0] == first; i++) {
        fixture_look(&fixture.frame_fixture, vec3_of(12 + 0.05f * (float)i, 5, 15),
                     vec3_of(13, 5, 4));
        const bool updated = voxelized(&fixture);
        CHECK(updated == (fixture.vct->clipmap.levels[2].grid.first[0] != first));
    }
    CHECK(fixture.vct->clipmap.levels[2].grid.first[0] == first + 4);
    CHECK(fixture.vct->clipmap.levels[1].grid.first[0] == middle.first[0]);
    CHECK(!voxelized(&fixture));
    vct_fixture_finish(&fixture);
}

// Returns the first of the six faces' instances.
static int add_box(struct vct_fixture *fixture, vec3s at)
{
    const int instance = fixture->frame_fixture.scene->instance_count;
    fixture_box(&fixture->frame_fixture, at, glms_vec3_add(at, vec3_of(1.5f, 2.25f, 1.25f)), false,
                fixture_matte(&fixture->frame_fixture, vec3_of(0.3f, 0.8f, 0.5f)));
    return instance;
}

// A moved object occupies the voxels that a static object would in every level.
TEST_GPU(moving_objects_are_in_each_level)
{
    const vec3s from = vec3_of(10, 4, 13), step = vec3_of(1.25f, 0.5f, -0.75f);
    struct vct_fixture moved, still;
    vct_fixture_hall(&moved, gpu);
    const int box = add_box(&moved, from);
    vct_fixture_open(&moved, "resolution=32,levels=3");
    fixture_render(&moved.frame_fixture);
    for (int face = 0; face < 6; face++) {
        const int node = moved.frame_fixture.scene->instances[box + face].node;
        mat4s *world = &moved.frame_fixture.pose.world_from_node[node];
        *world = glms_translate(*world, step);
    }
    fixture_render(&moved.frame_fixture);
    vct_fixture_hall(&still, gpu);
    add_box(&still, glms_vec3_add(from, step));
    vct_fixture_open(&still, "resolution=32,levels=3");
    fixture_render(&still.frame_fixture);
    for (int clip = 0; clip < 3; clip++) {
        const struct vct_level_voxels *c = &moved.vct->voxels.levels[clip];
        uint32_t *rest = vct_fixture_mask(&moved, &c->static_set),
                 *moving = vct_fixture_mask(&moved, &c->dynamic_set),
                 *expected = vct_fixture_mask(&still, &still.vct->voxels.levels[clip].static_set);
        int count = 0;
        for (int i = 0; i < 32 * 32 * 32 / 4; i++) {
            CHECK((rest[i] | moving[i]) == expected[i]);
            count += __builtin_popcount(moving[i]);
        }
        CHECK(count > 4);
        free(rest);
        free(moving);
        free(expected);
    }
    vct_fixture_finish(&moved);
    vct_fixture_finish(&still);
}

// ---- Errors, memory

static char logged[256];

static void record_log(void *user, enum log_level level, const char *message)
{
    (void)user;
    if (level == LOG_ERROR) snprintf(logged, sizeof logged, "%s", message);
}

TEST_GPU(an_octree_has_one_level)
{
    struct vct_options options;
    struct host host = *test_host();
    host.log = record_log;
    option_defaults(&technique_vct.options, &options);
    CHECK(
        option_parse(test_host(), &technique_vct.options, "vct", "levels=2,storage=svo", &options));
    const struct technique_create how = { .host = &host, .gpu = gpu, .options = &options };
    CHECK(!technique_vct.check(&how));
    CHECK(strstr(logged, "storage=mips") != NULL);
}

TEST_GPU(memory_estimate_of_levels_matches_the_allocation)
{
    for (int levels = 2; levels <= 5; levels += 3) {
        struct vct_fixture fixture;
        struct vct_options options;
        struct gpu_memory owners[32];
        char text[64];
        snprintf(text, sizeof text, "resolution=32,levels=%d,trace=rays,temporal=true", levels);
        option_defaults(&technique_vct.options, &options);
        CHECK(option_parse(test_host(), &technique_vct.options, "vct", text, &options));
        const double estimated_bytes = (double)technique_memory(&technique_vct, &options, 32, 32);
        vct_fixture_hall(&fixture, gpu);
        vct_fixture_open(&fixture, text);
        const int count = gpu_memory_by_owner(gpu, owners, 32);
        double bytes = 0.0;
        for (int i = 0; i < count; i++)
            if (strcmp(owners[i].owner, "vct") == 0) bytes = (double)owners[i].bytes;
        print_message("%d levels: %.1f MiB\n", levels, estimated_bytes / 1048576.0);
        // The device may round each allocation up.
        CHECK(bytes >= estimated_bytes && bytes <= 1.02 * estimated_bytes + 4096 * levels);
        vct_fixture_finish(&fixture);
    }
}
