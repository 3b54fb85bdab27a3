// The light volume and cone tracing against plain C twins and closed forms.
#include "techniques/vct/vct_twin.h"

#include <math.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

// A room 12 m wide inside of the grid, a block, a point light.
static void make_scene(struct vct_fixture *fixture, struct gpu *gpu)
{
    vct_fixture_init(fixture, gpu);
    struct frame_fixture *s = &fixture->frame_fixture;
    fixture_box(s, vec3_of(0.3f, 0.2f, 0.4f), vec3_of(11.2f, 9.1f, 10.7f), true,
                fixture_matte(s, vec3_of(0.7f, 0.5f, 0.3f)));
    fixture_box(s, vec3_of(6, 0.2f, 3), vec3_of(8, 4, 6), false,
                fixture_matte(s, vec3_of(0.2f, 0.5f, 0.8f)));
    fixture_add_point(s, vec3_of(3, 7, 5), vec3_of(300, 500, 200));
    fixture_look(s, vec3_of(1, 6, 9), vec3_of(8, 2, 3));
}

// ---- Mips

// Four columns along the direction: the nearer texel over the farther; the mean of those in use.
static void coarser(const struct vct_twin_volume *v, int direction, const int at[3], double out[4])
{
    const int axis = direction / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
    int columns = 0;
    for (int k = 0; k < 4; k++) out[k] = 0.0;
    for (int i = 0; i < 4; i++) {
        int near[3] = { 2 * at[0], 2 * at[1], 2 * at[2] }, far[3];
        near[b] += i & 1;
        near[c] += i >> 1;
        for (int a = 0; a < 3; a++) far[a] = near[a];
        far[axis]++;
        if (!vct_twin_in_use(v, near)) continue;
        columns++;
        static const float none[4] = { 0 };
        const float *low = vct_twin_texel(v, direction, near),
                    *high = vct_twin_in_use(v, far) ? vct_twin_texel(v, direction, far) : none;
        const float *first = direction % 2 == 0 ? low : high,
                    *second = direction % 2 == 0 ? high : low;
        const double nearer = (double)first[3], farther = (double)second[3];
        const double seen = vct_fixture_visible_alpha(1.0 - fmin(nearer, 1.0), farther,
                                                      fmin(nearer + farther, 1.0));
        const double part = farther > 0.0 ? seen / farther : 0.0;
        for (int k = 0; k < 4; k++) out[k] += (double)first[k] + part * (double)second[k];
    }
    for (int k = 0; k < 4; k++) out[k] /= columns;
}

TEST_GPU(mips_of_the_light_volume_match_the_twin)
{
    struct vct_fixture fixture;
    make_scene(&fixture, gpu);
    vct_fixture_open(&fixture, "resolution=48");
    fixture_render(&fixture.frame_fixture);
    const uint32_t mips = vct_volume_mips(&fixture.vct->options);
    CHECK(mips >= 3);
    double most = 0.0;
    for (uint32_t level = 1; level < mips; level++) {
        struct vct_twin_volume fine = vct_twin_volume(&fixture, level - 1),
                               coarse = vct_twin_volume(&fixture, level);
        for (int direction = 0; direction < VCT_TWIN_DIRECTIONS; direction++)
            for (int z = 0; z < coarse.size[2]; z++)
                for (int y = 0; y < coarse.size[1]; y++)
                    for (int x = 0; x < coarse.size[0]; x++) {
                        const int at[3] = { x, y, z };
                        double expected[4];
                        coarser(&fine, direction, at, expected);
                        const float *got = vct_twin_texel(&coarse, direction, at);
                        // A half float has 11 bits.
                        for (int k = 0; k < 4; k++)
                            CHECK_NEAR((double)got[k], expected[k],
                                       1e-3 * fabs(expected[k]) + 1e-6);
                        most = fmax(most, expected[0]);
                    }
        free(fine.light);
        free(coarse.light);
    }
    CHECK(most > 0.0);
    vct_fixture_finish(&fixture);
}

// ---- A cone

TEST_GPU(traced_cones_match_the_twin)
{
    struct vct_fixture fixture;
    make_scene(&fixture, gpu);
    fixture.frame_fixture.input.environment.sky = vec3_of(3, 2, 1);
    vct_fixture_open(&fixture, "resolution=48,cones=5,interleave=1,step_size=0.5");
    fixture_render(&fixture.frame_fixture);
    const struct vct *vct = fixture.vct;
    struct vct_twin twin = vct_twin_of(&fixture);
    const double scale = (double)frame_radiance_scale(fixture.frame_fixture.frame);
    const double texel_m = 2.0 * (double)vct->clipmap.levels[0].grid.cell_m;
    const double wide = 0.5 * (double)vct_cone_width(VCT_CONES_5);
    vec3s lines[VCT_MAX_CONES];
    vct_cone_axes(VCT_CONES_5, lines);
    int lit = 0;
    for (uint32_t y = 1; y < 32; y += 6)
        for (uint32_t x = 1; x < 32; x += 6) {
            const vec3s p = fixture_pixel(&fixture.frame_fixture, READ_POSITION, x, y);
            const vec3s n = fixture_pixel(&fixture.frame_fixture, READ_NORMAL, x, y);
            const vec3s got = fixture_pixel(&fixture.frame_fixture, READ_IRRADIANCE, x, y);
            double at[3], normal[3], expected[3] = { 0 }, cosines = 0.0;
            for (int a = 0; a < 3; a++) {
                normal[a] = (double)n.raw[a];
                at[a] = (double)(p.raw[a] - vct->clipmap.levels[0].grid.origin_m.raw[a]) / texel_m;
            }
            for (int i = 0; i < vct_cone_count(VCT_CONES_5); i++) {
                double direction[3], sum[4];
                const double cosine = (double)glms_vec3_dot(n, lines[i]);
                for (int a = 0; a < 3; a++)
                    direction[a] = (cosine < 0.0 ? -1.0 : 1.0) * (double)lines[i].raw[a];
                vct_twin_trace(&twin, at, normal, direction, wide, sum);
                for (int k = 0; k < 3; k++) {
                    const double sky = (double)fixture.frame_fixture.input.environment.sky.raw[k];
                    expected[k] += fabs(cosine) * (sum[k] / scale + (1.0 - sum[3]) * sky);
                }
                cosines += fabs(cosine);
            }
            for (int k = 0; k < 3; k++) expected[k] *= PI / cosines;
            for (int k = 0; k < 3; k++) {
                // Texture filters may have weights of 8 bits, and rounding decides where the level
                // changes.
                CHECK_NEAR((double)got.raw[k], expected[k], 0.02 * expected[k] + 0.05);
                lit += expected[k] > 1.0;
            }
        }
    CHECK(lit > 20);
    vct_twin_finish(&twin);
    vct_fixture_finish(&fixture);
}

// ---- Closed forms

static double mean(const float *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += (double)values[i];
    return sum / (double)count;
}

// Black walls of uniform radiance: E = π L everywhere.
TEST_GPU(furnace_irradiance_is_pi_times_radiance)
{
    struct vct_fixture fixture;
    vct_fixture_init(&fixture, gpu);
    struct material m = material_default();
    m.emissive = vec3_of(10, 10, 10);
    m.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    m.metallic = 0;
    m.specular = 0; // reflects nothing
    fixture_box(&fixture.frame_fixture, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true,
                fixture_material(&fixture.frame_fixture, &m));
    fixture_look(&fixture.frame_fixture, vec3_of(2, 3, 8), vec3_of(9, 3, 1));
    vct_fixture_open(&fixture, "resolution=48");
    fixture_render(&fixture.frame_fixture);
    float *e = fixture_read(&fixture.frame_fixture, READ_IRRADIANCE);
    const double got = mean(e, 32 * 32 * 3) / (PI * 10.0);
    print_message("furnace: %.3f of the irradiance\n", got);
    // Cones lose some percent where the texel size changes inside of a wall.
    CHECK(got > 0.98 && got < 1.005);
    free(e);
    vct_fixture_finish(&fixture);
}

// The sky is visible inside of a closed room only by leaks through walls one voxel thick.
TEST_GPU(a_closed_room_occludes_the_sky)
{
    struct vct_fixture fixture;
    vct_fixture_init(&fixture, gpu);
    fixture_box(&fixture.frame_fixture, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true,
                fixture_matte(&fixture.frame_fixture, vec3_of(0, 0, 0)));
    fixture_look(&fixture.frame_fixture, vec3_of(2, 3, 8), vec3_of(9, 3, 1));
    fixture.frame_fixture.input.environment.sky = vec3_of(10, 10, 10);
    vct_fixture_open(&fixture, "resolution=48");
    fixture_render(&fixture.frame_fixture);
    float *e = fixture_read(&fixture.frame_fixture, READ_IRRADIANCE);
    const double got = mean(e, 32 * 32 * 3) / (PI * 10.0);
    print_message("closed room: %.3f of the sky\n", got);
    CHECK(got < 0.01);
    free(e);
    vct_fixture_finish(&fixture);
}

TEST(cone_weights_integrate_the_hemisphere)
{
    for (int choice = VCT_CONES_1; choice <= VCT_CONES_25; choice++) {
        struct vct_cone cones[VCT_MAX_CONES];
        vct_cone_set(choice, cones);
        double sum = 0.0, up = 0.0;
        for (int i = 0; i < vct_cone_count(choice); i++) {
            sum += (double)cones[i].weight;
            up += (double)(cones[i].weight * cones[i].direction.z);
            CHECK_NEAR((double)glms_vec3_norm(cones[i].direction), 1.0, 1e-6);
        }
        CHECK_NEAR(sum, PI, 1e-5);                                     // ∫ cos dω
        if (choice > VCT_CONES_1) CHECK_NEAR(up / PI, 2.0 / 3.0, 0.1); // ∫ cos² dω / π
    }
}
