// The clip map: grids with smaller voxels about the eye. Where they lie, that they hold what any
// grid there would, that light in them is as it is in one grid, and that a picture does not show
// when they move on.
#include "techniques/vct_rig.h"

#include "core/rng.h"
#include "techniques/vct/vct_remarks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FLOATS = 32 * 32 * 3 };

static const double PI = 3.14159265358979323846;

// Irradiance of one more frame, all of it finite. To be freed.
static float *irradiance(struct vct_rig *rig)
{
    studio_render(&rig->studio);
    float *e = studio_read(&rig->studio, READ_IRRADIANCE);
    for (int i = 0; i < FLOATS; i++) CHECK(isfinite(e[i]) && e[i] >= 0.0f);
    return e;
}

static double mean(const float *values)
{
    double sum = 0.0;
    for (int i = 0; i < FLOATS; i++) sum += (double)values[i];
    return sum / FLOATS;
}

static double mean_irradiance(struct vct_rig *rig)
{
    float *e = irradiance(rig);
    const double sum = mean(e);
    free(e);
    return sum;
}

static double apart(const float *a, const float *b)
{
    double sum = 0.0;
    for (int i = 0; i < FLOATS; i++) sum += fabs((double)a[i] - (double)b[i]);
    return sum / FLOATS;
}

// ---- Where grids lie

static vec3s random_eye(struct rng *rng)
{
    return vec3_of(60.0f * rng_float(rng) - 20.0f, 60.0f * rng_float(rng) - 20.0f,
                   60.0f * rng_float(rng) - 20.0f);
}

TEST(a_part_lies_in_the_scene_on_texels_of_the_next_coarser_one)
{
    const struct box3 bounds = { { { -1.3f, 0.2f, 2 } }, { { 19.1f, 5.4f, 13 } } };
    struct rng rng = rng_for(5, 0, 0);
    for (int dim = 16; dim <= 256; dim += 16) {
        struct vct_grid scene;
        CHECK(vct_grid_fit(bounds, dim, &scene));
        for (int i = 0; i < 60; i++) {
            const int halvings = 1 + i % 5;
            const vec3s eye = random_eye(&rng);
            const struct vct_grid grid = vct_grid_about(&scene, dim, halvings, eye),
                                  coarse = vct_grid_about(&scene, dim, halvings - 1, eye);
            const struct box3 used = vct_grid_used(&scene, dim, halvings, eye, 4.0f);
            CHECK(grid.cell_m == ldexpf(scene.cell_m, -halvings));
            for (int a = 0; a < 3; a++) {
                const int last = grid.first[a] + grid.cells[a];
                CHECK(grid.scene[a] == scene.cells[a] << halvings);
                CHECK(grid.first[a] % 4 == 0 && grid.cells[a] % 2 == 0);
                CHECK(grid.first[a] >= 0 && last <= grid.scene[a]);
                CHECK(grid.cells[a] == (grid.scene[a] < dim ? grid.scene[a] : dim));
                // What is used is within it, and half a texel, a voxel, away from a side that is
                // not the scene's.
                if (grid.first[a] > 0) CHECK(used.min.raw[a] >= (float)grid.first[a] + 0.99f);
                if (last < grid.scene[a]) CHECK(used.max.raw[a] <= (float)last - 0.99f);
                // And the next coarser one has it all.
                CHECK(2 * coarse.first[a] <= grid.first[a]);
                CHECK(2 * (coarse.first[a] + coarse.cells[a]) >= last);
            }
        }
    }
}

// What cones look into has no steps: it moves as the eye does, and by the scene's border faster,
// by no more than a few times.
TEST(what_is_used_of_a_part_moves_with_the_eye)
{
    const struct box3 bounds = { { { 0, 0, 0 } }, { { 27, 13, 20 } } };
    struct vct_grid scene;
    CHECK(vct_grid_fit(bounds, 32, &scene));
    const float step = 0.01f / ldexpf(scene.cell_m, -2); // voxels
    struct box3 last = vct_grid_used(&scene, 32, 2, vec3_of(-3, 1, 1), 4.0f);
    int moved = 0, stood = 0;
    for (int i = 1; i < 3300; i++) {
        const vec3s eye = vec3_of(-3 + 0.01f * (float)i, 1, 1);
        const struct box3 used = vct_grid_used(&scene, 32, 2, eye, 4.0f);
        const float low = used.min.x - last.min.x, high = used.max.x - last.max.x;
        CHECK(low > -1e-3f && low < 6.0f * step && high > -1e-3f && high < 6.0f * step);
        moved += low > 0.5f * step;
        stood += low == 0.0f;
        last = used;
    }
    CHECK(moved > 1000 && stood > 300);
    const vec3s odd[] = { { { 1e30f, -1e30f, 0 } }, { { NAN, INFINITY, -INFINITY } } };
    for (int i = 0; i < 2; i++) {
        const struct vct_grid grid = vct_grid_about(&scene, 32, 2, odd[i]);
        for (int a = 0; a < 3; a++)
            CHECK(grid.first[a] >= 0 && grid.first[a] + grid.cells[a] <= grid.scene[a]);
    }
}

// ---- What is in their voxels

// On a lattice of 1/64 m, so that no rounding depends on where a grid begins.
static vec3s lattice_point(struct rng *rng, vec3s about, float reach)
{
    vec3s p;
    for (int a = 0; a < 3; a++) {
        const float at = about.raw[a] + reach * (2.0f * rng_float(rng) - 1.0f);
        p.raw[a] = roundf(64.0f * fminf(fmaxf(at, 0.0f), 27.0f)) / 64.0f;
    }
    return p;
}

static void add_rubble(struct vct_rig *rig, int count)
{
    struct rng rng = rng_for(21, 0, 0);
    const int red = studio_matte(&rig->studio, vec3_of(0.7f, 0.3f, 0.1f));
    for (int i = 0; i < count; i++) {
        const vec3s middle = lattice_point(&rng, vec3_of(13.5f, 13.5f, 13.5f), 13.5f);
        const float reach = i % 3 == 0 ? 9.0f : i % 3 == 1 ? 2.0f : 0.2f;
        vec3s positions[3], normals[3];
        uint32_t indices[3] = { 0, 1, 2 };
        for (int k = 0; k < 3; k++) {
            positions[k] = lattice_point(&rng, middle, reach);
            normals[k] = vec3_of(0, 1, 0);
        }
        const int mesh = scene_add_mesh(rig->studio.scene, &(struct mesh){ .name = "triangle",
                                                                           .vertex_count = 3,
                                                                           .index_count = 3,
                                                                           .positions = positions,
                                                                           .normals = normals,
                                                                           .indices = indices,
                                                                           .material = red });
        CHECK(mesh >= 0);
        studio_instance(&rig->studio, mesh, NULL);
    }
}

struct voxels {
    struct vct_grid grid;
    uint32_t *mask, *before, *surfaces;
};

static struct voxels voxels_of(const struct vct_rig *rig, int clip)
{
    const struct vct_clip *c = &rig->vct->clips[clip];
    const size_t bytes = (size_t)gpu_groups(vct_capacity(&rig->vct->options), VCT_RECORD_ROW) * 2 *
                         VCT_RECORD_ROW * 16;
    struct voxels v = { c->grid, vct_rig_words(rig, c->rest.mask),
                        vct_rig_words(rig, c->rest.before), malloc(bytes) };
    CHECK(v.surfaces &&
          gpu_image_download(rig->studio.gpu, c->rest.surfaces, 0, 0, v.surfaces, bytes));
    return v;
}

static void free_voxels(struct voxels *v)
{
    free(v->mask);
    free(v->before);
    free(v->surfaces);
}

// What is in a voxel, counted from the scene's corner; NULL where it is empty.
static const uint32_t *surface_at(const struct vct_rig *rig, const struct voxels *v,
                                  const int at[3])
{
    const int x = at[0] - v->grid.first[0], y = at[1] - v->grid.first[1],
              z = at[2] - v->grid.first[2], dim = rig->vct->options.resolution / 2;
    if (!vct_rig_has(rig, v->mask, x, y, z)) return NULL;
    const uint32_t index =
        (uint32_t)(8 * (((z / 2) * dim + y / 2) * dim + x / 2) + x % 2 + 2 * (y % 2) + 4 * (z % 2));
    const uint32_t below = v->mask[index / 32] & ((1u << (index % 32)) - 1);
    const uint32_t slot = v->before[index / 32] + (uint32_t)__builtin_popcount(below);
    return v->surfaces + (size_t)slot * 8; // two texels
}

// Of two grids with the same voxels all that are in both. Returns how many are occupied.
static int check_same_voxels(const struct vct_rig *rig, const struct voxels *a,
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
                const uint32_t *p = surface_at(rig, a, at), *q = surface_at(rig, b, at);
                CHECK((p == NULL) == (q == NULL));
                if (!p) continue;
                count++;
                if (memcmp(p, q, 4 * sizeof *p) != 0)
                    fail_msg("voxel %d %d %d is another one", at[0], at[1], at[2]);
            }
    return count;
}

// Triangles that a grid's border cuts leave in its voxels what they leave where nothing cuts them:
// wherever the eye is, a place has the same voxels, to the bit.
static void check_voxels_wherever_the_eye_is(struct gpu *gpu, const char *options)
{
    const vec3s eyes[] = { { { 10, 9, 12 } }, { { 11.4f, 10.2f, 13.3f } }, { { 4, 20, 9 } } };
    struct vct_rig rigs[3];
    struct voxels voxels[3];
    for (int i = 0; i < 3; i++) {
        vct_rig_init(&rigs[i], gpu);
        add_rubble(&rigs[i], 600);
        studio_box(&rigs[i].studio, vec3_of(0, 0, 0), vec3_of(27, 27, 27), true,
                   studio_matte(&rigs[i].studio, vec3_of(0.5f, 0.5f, 0.5f)));
        studio_look(&rigs[i].studio, eyes[i], vec3_of(0, 13, 27));
        vct_rig_open(&rigs[i], options);
        studio_render(&rigs[i].studio);
        CHECK(rigs[i].vct->clips[0].grid.cell_m == 1.0f);
    }
    for (int clip = 1; clip < rigs[0].vct->clip_count; clip++) {
        for (int i = 0; i < 3; i++) voxels[i] = voxels_of(&rigs[i], clip);
        for (int i = 1; i < 3; i++) {
            CHECK(memcmp(voxels[0].grid.first, voxels[i].grid.first, sizeof(int32_t[3])) != 0);
            if (clip > 1 && i == 2) continue; // too far away for the finest to overlap
            const int count = check_same_voxels(&rigs[0], &voxels[0], &voxels[i]);
            print_message("%s: level %d: %d voxels are in both\n", options, clip + 1, count);
            CHECK(count > 200);
        }
        for (int i = 0; i < 3; i++) free_voxels(&voxels[i]);
    }
    for (int i = 0; i < 3; i++) vct_rig_finish(&rigs[i]);
}

TEST_GPU(voxels_are_the_same_wherever_the_eye_is)
{
    check_voxels_wherever_the_eye_is(gpu, "resolution=32,levels=3");
}

TEST_GPU(voxels_by_raster_are_the_same_wherever_the_eye_is)
{
    check_voxels_wherever_the_eye_is(gpu, "resolution=32,levels=3,voxels=raster");
}

static int occupied(const struct voxels *v, int dim)
{
    int count = 0;
    for (int i = 0; i < dim * dim * dim / 32; i++) count += __builtin_popcount(v->mask[i]);
    return count;
}

TEST_GPU(the_rasteriser_finds_the_same_in_every_level)
{
    struct vct_rig rigs[2];
    for (int i = 0; i < 2; i++) {
        vct_rig_init(&rigs[i], gpu);
        add_rubble(&rigs[i], 150);
        studio_box(&rigs[i].studio, vec3_of(9.2f, 8.1f, 10.9f), vec3_of(10.7f, 10.3f, 13.1f), false,
                   studio_matte(&rigs[i].studio, vec3_of(0.5f, 0.5f, 0.5f)));
        studio_look(&rigs[i].studio, vec3_of(10, 9, 12), vec3_of(0, 13, 27));
        vct_rig_open(&rigs[i],
                     i == 0 ? "resolution=32,levels=5" : "resolution=32,levels=5,voxels=raster");
        studio_render(&rigs[i].studio);
    }
    for (int clip = 0; clip < 5; clip++) {
        struct voxels a = voxels_of(&rigs[0], clip), b = voxels_of(&rigs[1], clip);
        const int count = check_same_voxels(&rigs[0], &a, &b);
        CHECK(count > 50 && count == occupied(&a, 32) && count == occupied(&b, 32));
        uint32_t counted = 0; // on the CPU, but for triangles that touch a face exactly
        CHECK(vct_count_touched(test_host(), &rigs[0].studio.pose, &a.grid, 32, UINT32_MAX - 1,
                                &counted));
        print_message("level %d: %d voxels, %u on the CPU\n", clip + 1, count, counted);
        CHECK(abs((int)counted - count) <= 2 + count / 100);
        free_voxels(&a);
        free_voxels(&b);
    }
    for (int i = 0; i < 2; i++) vct_rig_finish(&rigs[i]);
}

// ---- What is kept

static bool ran(const struct gpu *gpu, const char *pass)
{
    struct gpu_timing timings[64];
    const int count = gpu_frame_timings(gpu, timings, 64);
    for (int i = 0; i < count; i++)
        if (strcmp(timings[i].name, pass) == 0) return true;
    return false;
}

static bool voxelised(struct vct_rig *rig)
{
    studio_render(&rig->studio);
    CHECK(gpu_wait(rig->studio.gpu));
    CHECK(ran(rig->studio.gpu, "vct.cones"));
    return ran(rig->studio.gpu, "vct.mark") || ran(rig->studio.gpu, "vct.add");
}

static void furnish(struct vct_rig *rig, struct gpu *gpu)
{
    vct_rig_init(rig, gpu);
    struct studio *s = &rig->studio;
    studio_box(s, vec3_of(0, 0, 0), vec3_of(27, 12, 20), true,
               studio_matte(s, vec3_of(0.7f, 0.6f, 0.5f)));
    for (int i = 0; i < 5; i++)
        studio_box(s, vec3_of(3.0f + 5.0f * (float)i, 0, 8), vec3_of(4.1f + 5.0f * (float)i, 9, 9),
                   false, studio_matte(s, vec3_of(0.3f, 0.5f, 0.8f)));
    studio_add_point(s, vec3_of(9, 9, 15), vec3_of(900, 900, 900));
    studio_look(s, vec3_of(12, 5, 15), vec3_of(13, 4, 4));
}

TEST_GPU(a_grid_is_kept_until_the_eye_has_gone_a_step)
{
    struct vct_rig rig;
    furnish(&rig, gpu);
    vct_rig_open(&rig, "resolution=32,levels=3");
    CHECK(voxelised(&rig));
    CHECK(!voxelised(&rig));
    const struct vct_grid finest = rig.vct->clips[2].grid, middle = rig.vct->clips[1].grid;
    studio_look(&rig.studio, vec3_of(12.01f, 5, 15), vec3_of(13, 5, 4));
    CHECK(!voxelised(&rig));
    int first = finest.first[0];
    for (int i = 1; i < 40 && rig.vct->clips[2].grid.first[0] == first; i++) {
        studio_look(&rig.studio, vec3_of(12 + 0.05f * (float)i, 5, 15), vec3_of(13, 5, 4));
        const bool anew = voxelised(&rig);
        CHECK(anew == (rig.vct->clips[2].grid.first[0] != first));
    }
    CHECK(rig.vct->clips[2].grid.first[0] == first + 4);
    CHECK(rig.vct->clips[1].grid.first[0] == middle.first[0]);
    CHECK(!voxelised(&rig));
    vct_rig_finish(&rig);
}

// ---- Light

static void shine(struct vct_rig *rig, struct gpu *gpu, bool glows)
{
    vct_rig_init(rig, gpu);
    struct material m = material_default();
    if (glows) m.emissive = vec3_of(10, 10, 10);
    m.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    m.metallic = 0;
    studio_box(&rig->studio, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true,
               studio_material(&rig->studio, &m));
    if (!glows) rig->studio.input.sky = vec3_of(10, 10, 10);
}

static const char *const level_options[] = { "resolution=48,levels=3", "resolution=32,levels=4",
                                             "resolution=48,levels=2,interleave=1" };

// Black walls that shine evenly: E = π L everywhere, within the bounds of one grid. From places
// where the picture shows the borders of levels.
TEST_GPU(a_furnace_has_pi_times_its_radiance_with_levels)
{
    for (int i = 0; i < 3; i++) {
        struct vct_rig rig;
        shine(&rig, gpu, true);
        vct_rig_open(&rig, level_options[i]);
        const vec3s eyes[] = { { { 2, 3, 8 } }, { { 5.5f, 4, 4.5f } }, { { 1, 1, 1 } } };
        for (int k = 0; k < 3; k++) {
            studio_look(&rig.studio, eyes[k], vec3_of(9, 3, 1.5f));
            const double got = mean_irradiance(&rig) / (PI * 10.0);
            print_message("%s: furnace %.3f\n", level_options[i], got);
            CHECK(got > 0.93 && got < 1.01);
        }
        vct_rig_finish(&rig);
    }
}

TEST_GPU(a_closed_room_keeps_the_sky_out_with_levels)
{
    for (int i = 0; i < 3; i++) {
        struct vct_rig rig;
        shine(&rig, gpu, false);
        vct_rig_open(&rig, level_options[i]);
        studio_look(&rig.studio, vec3_of(2, 3, 8), vec3_of(9, 3, 1.5f));
        const double got = mean_irradiance(&rig) / (PI * 10.0);
        print_message("%s: %.4f of the sky in a closed room\n", level_options[i], got);
        CHECK(got < 0.01); // as with one grid: test_vct_storage
        vct_rig_finish(&rig);
    }
}

static double mean_visibility(struct gpu *gpu, const char *options)
{
    struct vct_rig rig;
    furnish(&rig, gpu);
    rig.technique = &technique_vctao;
    vct_rig_open(&rig, options);
    studio_render(&rig.studio);
    float *v = studio_read(&rig.studio, READ_VISIBILITY);
    double sum = 0.0;
    for (int i = 0; i < 32 * 32; i++) sum += (double)v[i] / (32 * 32);
    free(v);
    vct_rig_finish(&rig);
    return sum;
}

// Occlusion decays with metres in every grid: levels see what one grid as fine does.
TEST_GPU(occlusion_by_levels_is_that_of_one_fine_grid)
{
    const double fine = mean_visibility(gpu, "resolution=128"),
                 levels = mean_visibility(gpu, "resolution=32,levels=3"),
                 coarse = mean_visibility(gpu, "resolution=32");
    print_message("visibility: %.3f, with levels %.3f, with the coarse grid alone %.3f\n", fine,
                  levels, coarse);
    // Twice or half the fall-off would change it by 0.05 and more.
    CHECK_NEAR(levels, fine, 0.02);
}

// A slab of half a coarse voxel between a bright half of a room and a dark one, seen from close by
// on the dark side. In truth there is no light there.
static double leak(struct gpu *gpu, const char *options)
{
    struct vct_rig rig;
    vct_rig_init(&rig, gpu);
    struct studio *s = &rig.studio;
    const int white = studio_matte(s, vec3_of(0.7f, 0.7f, 0.7f));
    studio_box(s, vec3_of(0, 0, 0), vec3_of(24, 8, 9), true, white);
    studio_box(s, vec3_of(12.05f, 0, 0), vec3_of(12.45f, 8, 9), false, white);
    studio_add_point(s, vec3_of(8, 4, 4.5f), vec3_of(900, 900, 900));
    vct_rig_open(&rig, options);
    studio_look(s, vec3_of(14, 2.5f, 4.5f), vec3_of(12.45f, 1, 4.4f));
    const double e = mean_irradiance(&rig);
    CHECK(rig.vct->clips[0].grid.cell_m > 0.8f);
    vct_rig_finish(&rig);
    return e;
}

TEST_GPU(a_wall_thinner_than_a_coarse_voxel_leaks_less_with_levels)
{
    static const char *const ways[] = { "anisotropic=true", "anisotropic=false" };
    // One volume for all ways mixes what both sides of a voxel send out: there the wall has to have
    // texels of its own. Six ways keep the sides apart; what is left with levels is what cones miss
    // by its foot, and comes with a grid that is as fine everywhere too.
    const double most[] = { 0.7, 0.3 };
    for (int i = 0; i < 2; i++) {
        double got[2];
        for (int k = 0; k < 2; k++) {
            char options[96];
            snprintf(options, sizeof options, "resolution=32,bounces=1,levels=%d,%s", 1 + 2 * k,
                     ways[i]);
            got[k] = leak(gpu, options);
        }
        print_message("%s: %.3f lx behind a thin wall with one grid, %.3f with three\n", ways[i],
                      got[0], got[1]);
        CHECK(got[1] < most[i] * got[0]);
    }
}

// ---- While the eye moves

static float *seen_from(struct vct_rig *rig, float x)
{
    studio_look(&rig->studio, vec3_of(x, 5, 15), vec3_of(x + 1, 4, 4));
    return irradiance(rig);
}

static int finest_first(const struct vct_rig *rig)
{
    return rig->vct->clips[2].grid.first[0];
}

// The eye goes over the place where the finest grid moves on, by a tenth of a millimetre in all.
TEST_GPU(a_step_of_the_grids_is_not_seen)
{
    struct vct_rig rig;
    furnish(&rig, gpu);
    vct_rig_open(&rig, "resolution=32,levels=3");
    float low = 11.0f, high = 12.1f;
    free(seen_from(&rig, high));
    const int after = finest_first(&rig);
    free(seen_from(&rig, low));
    const int before = finest_first(&rig);
    CHECK(after == before + 4); // a step
    while (high - low > 1e-4f) {
        const float middle = 0.5f * (low + high);
        free(seen_from(&rig, middle));
        *(finest_first(&rig) == before ? &low : &high) = middle;
    }
    for (int i = 0; i < 20; i++) free(seen_from(&rig, low)); // light has come to rest
    float *last = seen_from(&rig, low), *now = seen_from(&rig, high);
    CHECK(finest_first(&rig) == after);
    double most = apart(now, last) / mean(last);
    print_message("change at a step: %.5f of the mean", most);
    // The frames after it, in which light goes on from voxel to voxel.
    for (int i = 0; i < 20; i++) {
        float *then = seen_from(&rig, high);
        most = fmax(most, apart(then, last) / mean(last));
        free(then);
    }
    print_message(", of the 20 frames after it %.5f at most\n", most);
    // A grey level of 8 bits is some parts in a thousand.
    CHECK(most < 0.0005);
    free(last);
    free(now);
    vct_rig_finish(&rig);
}

struct pan {
    double worst, level; // change of a pixel's mean and of the picture's, over its mean
    int steps;
};

static struct pan pan_with(struct gpu *gpu, const char *options)
{
    struct vct_rig rig;
    furnish(&rig, gpu);
    vct_rig_open(&rig, options);
    struct pan pan = { 0 };
    float *last = NULL;
    int first = 0;
    for (int i = 0; i < 32; i++) {
        float *now = seen_from(&rig, 5.0f + 0.1f * (float)i);
        const int clip = rig.vct->clip_count - 1;
        if (last) {
            pan.worst = fmax(pan.worst, apart(now, last) / mean(now));
            pan.level = fmax(pan.level, fabs(mean(now) / mean(last) - 1.0));
            pan.steps += rig.vct->clips[clip].grid.first[0] != first;
        }
        first = rig.vct->clips[clip].grid.first[0];
        free(last);
        last = now;
    }
    free(last);
    vct_rig_finish(&rig);
    return pan;
}

TEST_GPU(a_pan_changes_from_frame_to_frame_as_with_one_grid)
{
    const struct pan one = pan_with(gpu, "resolution=32"),
                     three = pan_with(gpu, "resolution=32,levels=3");
    print_message("worst change between frames: %.4f with one grid, %.4f with three over %d steps; "
                  "of the picture's mean %.4f and %.4f\n",
                  one.worst, three.worst, three.steps, one.level, three.level);
    CHECK(three.steps >= 3);
    // Smaller voxels show more of what moves past.
    CHECK(three.worst < 1.25 * one.worst);
    CHECK(three.level < 1.25 * one.level);
}

// ---- Odd places, views, errors

TEST_GPU(an_eye_outside_or_far_away_sees_finite_light)
{
    struct vct_rig rig;
    furnish(&rig, gpu);
    vct_rig_open(&rig, "resolution=16,levels=6,specular=true");
    const vec3s eyes[] = { { { -5, 6, 30 } },     { { 0, 0, 0 } },    { { 13, 400, 10 } },
                           { { 1e6f, 0, 1e6f } }, { { 27, 12, 20 } }, { { 12, 5, 15 } } };
    for (int i = 0; i < 6; i++) {
        studio_look(&rig.studio, eyes[i], vec3_of(13, 6, 10));
        mean_irradiance(&rig);
    }
    CHECK(mean_irradiance(&rig) > 0.0);
    vct_rig_finish(&rig);
}

struct viewer {
    struct vct *vct;
    gpu_image picture;
    const char *view;
};

static void record_view(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct viewer *viewer = user;
    technique_vct.record(viewer->vct, cmd, view);
    technique_vct.debug_view(viewer->vct, cmd, view, viewer->view, viewer->picture);
}

// Pixels of a view in red, the finest level's colour, and in others. All of it is finite.
static void count_pixels(struct vct_rig *rig, struct viewer *viewer, const char *view, int count[2])
{
    float rgba[32 * 32 * 4];
    viewer->view = view;
    studio_render(&rig->studio);
    CHECK(gpu_image_download_float(rig->studio.gpu, viewer->picture, 0, 0, rgba, 4,
                                   sizeof rgba / sizeof *rgba));
    count[0] = count[1] = 0;
    for (int i = 0; i < 32 * 32; i++) {
        const float *p = rgba + 4 * i;
        CHECK(p[3] == 1.0f);
        for (int k = 0; k < 3; k++) CHECK(isfinite(p[k]) && p[k] >= 0.0f);
        count[0] += p[0] > 4.0f * p[1];
        count[1] += p[0] > 0.0f && p[0] < 4.0f * p[1];
    }
}

TEST_GPU(views_show_the_finest_level_about_the_eye_and_others_beyond)
{
    struct vct_rig rig;
    furnish(&rig, gpu);
    vct_rig_open(&rig, "resolution=32,levels=3");
    struct viewer viewer = { .vct = rig.vct };
    const struct gpu_image_desc desc = { .name = "test.view",
                                         .format = GPU_RGBA16F,
                                         .width = 32,
                                         .height = 32,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    CHECK(gpu_image_create(gpu, &desc, &viewer.picture));
    rig.studio.indirect.record = record_view;
    rig.studio.indirect.user = &viewer;
    int count[2];
    studio_look(&rig.studio, vec3_of(12, 2, 15), vec3_of(13, 0, 5));
    count_pixels(&rig, &viewer, "levels", count);
    CHECK(count[0] > 50 && count[1] > 200 && count[0] + count[1] == 32 * 32); // a closed room
    static const char *const views[] = { "reflectance", "normals", "radiance", "room" };
    for (int i = 0; i < 4; i++) {
        count_pixels(&rig, &viewer, views[i], count);
        CHECK(count[0] + count[1] > 700); // reflectance, and normals plus a half, are in all pixels
    }
    // From afar the scene's grid comes before the finer ones about the nearest place.
    studio_look(&rig.studio, vec3_of(60, 30, 50), vec3_of(13, 6, 10));
    count_pixels(&rig, &viewer, "levels", count);
    CHECK(count[1] > 20);
    gpu_image_destroy(gpu, &viewer.picture);
    vct_rig_finish(&rig);
}

static char said[256];

static void listen(void *user, enum log_level level, const char *message)
{
    (void)user;
    if (level == LOG_ERROR) snprintf(said, sizeof said, "%s", message);
}

TEST_GPU(an_octree_has_one_level)
{
    struct vct_options options;
    struct host host = *test_host();
    host.log = listen;
    option_defaults(&technique_vct.options, &options);
    CHECK(
        option_parse(test_host(), &technique_vct.options, "vct", "levels=2,storage=svo", &options));
    const struct technique_create how = { .host = &host, .gpu = gpu, .options = &options };
    CHECK(!technique_vct.check(&how));
    CHECK(strstr(said, "storage=mips") != NULL);
}

TEST_GPU(levels_say_how_much_memory_they_take)
{
    for (int levels = 2; levels <= 5; levels += 3) {
        struct vct_rig rig;
        struct vct_options options;
        struct gpu_memory owners[32];
        char text[64];
        snprintf(text, sizeof text, "resolution=32,levels=%d", levels);
        option_defaults(&technique_vct.options, &options);
        CHECK(option_parse(test_host(), &technique_vct.options, "vct", text, &options));
        const double said_bytes = (double)technique_vct.memory_estimate(&options, 32, 32);
        furnish(&rig, gpu);
        vct_rig_open(&rig, text);
        const int count = gpu_memory_by_owner(gpu, owners, 32);
        double bytes = 0.0;
        for (int i = 0; i < count; i++)
            if (strcmp(owners[i].owner, "vct") == 0) bytes = (double)owners[i].bytes;
        print_message("%d levels: %.1f MiB\n", levels, said_bytes / 1048576.0);
        // The device may round each object up.
        CHECK(bytes >= said_bytes && bytes <= 1.02 * said_bytes + 4096 * levels);
        vct_rig_finish(&rig);
    }
}
