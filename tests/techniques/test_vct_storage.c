// How the light of voxels is kept: what that costs in walls that are thin.
#include "techniques/vct_rig.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static double mean_irradiance(struct vct_rig *rig, vec3s eye, vec3s target)
{
    studio_look(&rig->studio, eye, target);
    studio_render(&rig->studio);
    float *e = studio_read(&rig->studio, READ_IRRADIANCE);
    double sum = 0.0;
    for (int i = 0; i < 32 * 32 * 3; i++) sum += (double)e[i];
    free(e);
    return sum / (32 * 32 * 3);
}

// ---- A thin wall

static const struct box3 ROOM = { { { 0, 0, 0 } }, { { 12, 8, 9 } } };

// A room of which a wall, one voxel thick, cuts off a third; a light in the larger part.
static void divide(struct vct_rig *rig, struct gpu *gpu, int resolution)
{
    vct_rig_init(rig, gpu);
    struct studio *s = &rig->studio;
    studio_box(s, ROOM.min, ROOM.max, true, studio_matte(s, vec3_of(0.7f, 0.7f, 0.7f)));
    struct vct_grid grid;
    CHECK(vct_grid_fit(ROOM, resolution, &grid));
    // The wall is a sheet in the middle of its voxels, seen and lit from both sides.
    const float x = grid.cell_m * (floorf(8.0f / grid.cell_m) + 0.5f);
    struct material sheet = material_default();
    sheet.base_color = vec4_of(vec3_of(0.7f, 0.7f, 0.7f), 1);
    sheet.metallic = 0;
    sheet.double_sided = true;
    studio_quad(s, vec3_of(x, 0, 9), vec3_of(x, 0, 0), vec3_of(x, 8, 0), vec3_of(x, 8, 9),
                studio_material(s, &sheet));
    studio_add_point(s, vec3_of(3, 5, 4), vec3_of(300, 300, 300));
}

// Irradiance on the floor behind the wall over that before it. In truth there is none behind it.
static double leak(struct gpu *gpu, int resolution, const char *more)
{
    struct vct_rig rig;
    char options[128];
    divide(&rig, gpu, resolution);
    snprintf(options, sizeof options, "resolution=%d,%s", resolution, more);
    vct_rig_open(&rig, options);
    const double lit = mean_irradiance(&rig, vec3_of(4.5f, 6, 4.5f), vec3_of(4.51f, 0, 4.5f));
    const double dark = mean_irradiance(&rig, vec3_of(10.2f, 6, 4.5f), vec3_of(10.21f, 0, 4.5f));
    CHECK(lit > 0.0);
    vct_rig_finish(&rig);
    return dark / lit;
}

TEST_GPU(six_ways_keep_light_before_a_thin_wall)
{
    print_message("light behind a wall one voxel thick, over that before it\n");
    for (int resolution = 32; resolution <= 64; resolution *= 2) {
        const double isotropic = leak(gpu, resolution, "anisotropic=false");
        const double anisotropic = leak(gpu, resolution, "anisotropic=true");
        print_message("%d voxels: isotropic %.4f, anisotropic %.4f\n", resolution, isotropic,
                      anisotropic);
        // One volume for all ways has the light of both sides in one texel, and half of the wall's
        // opacity: a tenth comes through at least. Six ways keep the sides apart; what they let
        // through are cones that meet the wall between two of their steps.
        CHECK(isotropic > 0.1);
        CHECK(anisotropic < 0.1);
        CHECK(anisotropic < 0.5 * isotropic);
    }
}

TEST_GPU(one_volume_for_all_ways_has_the_mean_of_what_it_holds)
{
    struct vct_rig rig;
    divide(&rig, gpu, 32);
    vct_rig_open(&rig, "resolution=32,anisotropic=false");
    studio_render(&rig.studio);
    double most = 0.0;
    // 16 texels along a side, 12 of them and more in use: a level's are halves as long as both are
    // even.
    for (uint32_t level = 1; level < vct_volume_mips(&rig.vct->options); level++) {
        const int dim = 16 >> level, fine_dim = 2 * dim;
        float *fine = vct_rig_light(&rig, level - 1), *coarse = vct_rig_light(&rig, level);
        int size[3], checked = 0;
        for (int a = 0; a < 3; a++)
            size[a] = (rig.vct->grid.cells[a] / 2 + (1 << (level - 1)) - 1) >> (level - 1);
        for (int z = 0; 2 * z + 1 < size[2]; z++)
            for (int y = 0; 2 * y + 1 < size[1]; y++)
                for (int x = 0; 2 * x + 1 < size[0]; x++)
                    for (int k = 0; k < 4; k++, checked++) {
                        double mean = 0.0;
                        for (int i = 0; i < 8; i++) {
                            const int fx = 2 * x + (i & 1), fy = 2 * y + (i >> 1 & 1),
                                      fz = 2 * z + (i >> 2);
                            mean += 0.125 *
                                    (double)fine[4 * ((fz * fine_dim + fy) * fine_dim + fx) + k];
                        }
                        const double got = (double)coarse[4 * ((z * dim + y) * dim + x) + k];
                        CHECK_NEAR(got, mean, 1e-3 * mean + 1e-6); // a half float has 11 bits
                        most = fmax(most, got);
                    }
        CHECK(checked > 0);
        free(fine);
        free(coarse);
    }
    CHECK(most > 0.0);
    vct_rig_finish(&rig);
}
