// The light volume and the cones through it against plain C twins, and closed forms.
#include "techniques/vct_rig.h"

#include <math.h>
#include <stdlib.h>

enum { WAYS = 6 };

static const double PI = 3.14159265358979323846;

// A room 12 m wide whose walls stand away from the grid's border, a block in it, a point light.
static void furnish(struct vct_rig *rig, struct gpu *gpu)
{
    vct_rig_init(rig, gpu);
    struct studio *s = &rig->studio;
    studio_box(s, vec3_of(0.3f, 0.2f, 0.4f), vec3_of(11.2f, 9.1f, 10.7f), true,
               studio_matte(s, vec3_of(0.7f, 0.5f, 0.3f)));
    studio_box(s, vec3_of(6, 0.2f, 3), vec3_of(8, 4, 6), false,
               studio_matte(s, vec3_of(0.2f, 0.5f, 0.8f)));
    studio_add_point(s, vec3_of(3, 7, 5), vec3_of(300, 500, 200));
    studio_look(s, vec3_of(1, 6, 9), vec3_of(8, 2, 3));
}

// ---- Mips

struct volume {
    float *light;
    int dim;     // texels along a side of one way
    int size[3]; // in use
};

static struct volume volume_of(const struct vct_rig *rig, uint32_t level)
{
    struct volume v = { .light = vct_rig_light(rig, level),
                        .dim = (int)vct_volume_dim(&rig->vct->options) >> level };
    for (int a = 0; a < 3; a++)
        v.size[a] = (rig->vct->clips[0].grid.cells[a] / 2 + (1 << level) - 1) >> level;
    return v;
}

static const float *texel(const struct volume *v, int way, const int at[3])
{
    return v->light +
           4 * (((size_t)at[2] * (size_t)v->dim + (size_t)at[1]) * WAYS * (size_t)v->dim +
                (size_t)(way * v->dim + at[0]));
}

static bool in_use(const struct volume *v, const int at[3])
{
    return at[0] < v->size[0] && at[1] < v->size[1] && at[2] < v->size[2];
}

// Four columns along the way, each the nearer texel over the farther, averaged over what is in use.
static void coarser(const struct volume *v, int way, const int at[3], double out[4])
{
    const int axis = way / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
    int columns = 0;
    for (int k = 0; k < 4; k++) out[k] = 0.0;
    for (int i = 0; i < 4; i++) {
        int near[3] = { 2 * at[0], 2 * at[1], 2 * at[2] }, far[3];
        near[b] += i & 1;
        near[c] += i >> 1;
        for (int a = 0; a < 3; a++) far[a] = near[a];
        far[axis]++;
        if (!in_use(v, near)) continue;
        columns++;
        static const float none[4] = { 0 };
        const float *low = texel(v, way, near), *high = in_use(v, far) ? texel(v, way, far) : none;
        const float *first = way % 2 == 0 ? low : high, *second = way % 2 == 0 ? high : low;
        const double nearer = (double)first[3], farther = (double)second[3];
        const double seen =
            vct_rig_shown(1.0 - fmin(nearer, 1.0), farther, fmin(nearer + farther, 1.0));
        const double part = farther > 0.0 ? seen / farther : 0.0;
        for (int k = 0; k < 4; k++) out[k] += (double)first[k] + part * (double)second[k];
    }
    for (int k = 0; k < 4; k++) out[k] /= columns;
}

TEST_GPU(each_level_of_the_light_volume_is_that_of_the_twin)
{
    struct vct_rig rig;
    furnish(&rig, gpu);
    vct_rig_open(&rig, "resolution=48");
    studio_render(&rig.studio);
    const uint32_t mips = vct_volume_mips(&rig.vct->options);
    CHECK(mips >= 3);
    double most = 0.0;
    for (uint32_t level = 1; level < mips; level++) {
        struct volume fine = volume_of(&rig, level - 1), coarse = volume_of(&rig, level);
        for (int way = 0; way < WAYS; way++)
            for (int z = 0; z < coarse.size[2]; z++)
                for (int y = 0; y < coarse.size[1]; y++)
                    for (int x = 0; x < coarse.size[0]; x++) {
                        const int at[3] = { x, y, z };
                        double expected[4];
                        coarser(&fine, way, at, expected);
                        const float *got = texel(&coarse, way, at);
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
    vct_rig_finish(&rig);
}

// ---- A cone

static void filtered(const struct volume *v, int way, const double at[3], double out[4])
{
    int low[3], high[3];
    double f[3];
    for (int a = 0; a < 3; a++) {
        const double clamped = fmin(fmax(at[a], 0.5), v->size[a] - 0.5) - 0.5;
        low[a] = (int)floor(clamped);
        if (low[a] > v->size[a] - 1) low[a] = v->size[a] - 1;
        high[a] = low[a] + 1 < v->size[a] ? low[a] + 1 : low[a];
        f[a] = clamped - low[a];
    }
    for (int k = 0; k < 4; k++) out[k] = 0.0;
    for (int i = 0; i < 8; i++) {
        const int corner[3] = { i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1],
                                i & 4 ? high[2] : low[2] };
        const double weight =
            (i & 1 ? f[0] : 1 - f[0]) * (i & 2 ? f[1] : 1 - f[1]) * (i & 4 ? f[2] : 1 - f[2]);
        const float *t = texel(v, way, corner);
        for (int k = 0; k < 4; k++) out[k] += weight * (double)t[k];
    }
}

struct sample {
    double light[4], axes[3];
};

static struct sample look(const struct volume *v, const double at[3], const double direction[3],
                          const double counted[3])
{
    struct sample s = { 0 };
    for (int a = 0; a < 3; a++) {
        double t[4];
        filtered(v, 2 * a + (direction[a] < 0.0), at, t);
        for (int k = 0; k < 4; k++) s.light[k] += fabs(counted[a]) * t[k];
        if (fabs(counted[a]) > 0.0) s.axes[a] = t[3];
    }
    return s;
}

static void cover(double sum[4], const struct sample *here, const struct sample *before)
{
    const double alpha = here->light[3];
    double sheet = 0.0;
    for (int a = 0; a < 3; a++) sheet = fmax(sheet, before->axes[a] + here->axes[a]);
    if (alpha <= 0.0) return;
    const double covered = vct_rig_shown(1.0 - sum[3], alpha, fmin(sheet, 1.0));
    for (int k = 0; k < 3; k++) sum[k] += covered * here->light[k] / alpha;
    sum[3] += covered;
}

static double smooth(double low, double high, double x)
{
    const double t = fmin(fmax((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// What lies half a texel back along the surface, to which `here` is added.
static struct sample behind(const struct volume *fine, const double from[3], const double normal[3],
                            const double direction[3], double add[4])
{
    double along = 0.0, level_with[3], at[3];
    for (int a = 0; a < 3; a++) along += direction[a] * normal[a];
    for (int a = 0; a < 3; a++) {
        level_with[a] = direction[a] - along * normal[a];
        at[a] = from[a] - 0.5 * level_with[a];
    }
    const struct sample s = look(fine, at, direction, level_with);
    const double ahead = smooth(0.25, 0.5, add[3] / fmax(add[3] + s.light[3], 1e-6));
    for (int k = 0; k < 4; k++) add[k] += s.light[k];
    for (int k = 0; k < 3; k++) add[k] *= ahead;
    return s;
}

// As vct_trace.glsl says it, step by step.
static void trace(const struct volume *levels, int level_count, const double from[3],
                  const double normal[3], const double direction[3], double wide, double sum[4])
{
    double end = 1e6, out_of[3] = { 0 }, speed = 0.0;
    for (int a = 0; a < 3; a++) {
        if (fabs(direction[a]) < 1e-6) continue;
        const double until =
            ((direction[a] > 0.0 ? levels[0].size[a] : 0.0) - from[a]) / direction[a];
        if (until >= end) continue;
        end = until;
        speed = fabs(direction[a]);
        for (int b = 0; b < 3; b++) out_of[b] = b == a ? direction[a] : 0.0;
    }
    double t = 0.0;
    struct sample before = { 0 };
    for (int k = 0; k < 4; k++) sum[k] = 0.0;
    for (int i = 0; i < 256 && sum[3] <= 0.98; i++) {
        int level = (int)(log2(fmax(wide * t, 1.0)) + 0.5);
        if (level >= level_count) level = level_count - 1;
        const double length = (double)(1 << level), middle = t + 0.5 * length;
        if (middle > end && (middle - end) * speed > length) return;
        double at[3];
        for (int a = 0; a < 3; a++) at[a] = (from[a] + direction[a] * fmin(middle, end)) / length;
        struct sample here = look(&levels[level], at, direction, middle > end ? out_of : direction);
        if (i == 0) before = behind(&levels[0], from, normal, direction, here.light);
        cover(sum, &here, &before);
        before = here;
        t += length;
    }
    if (sum[3] <= 0.98) return;
    for (int k = 0; k < 4; k++) sum[k] /= sum[3];
}

TEST_GPU(cones_bring_what_those_of_the_twin_do)
{
    struct vct_rig rig;
    furnish(&rig, gpu);
    rig.studio.input.sky = vec3_of(3, 2, 1);
    vct_rig_open(&rig, "resolution=48,cones=5,interleave=1,stride=0.5");
    studio_render(&rig.studio);
    const struct vct *vct = rig.vct;
    const int mips = (int)vct_volume_mips(&vct->options);
    struct volume levels[8];
    for (int i = 0; i < mips; i++) levels[i] = volume_of(&rig, (uint32_t)i);
    const double scale = (double)frame_radiance_scale(rig.studio.frame);
    const double texel_m = 2.0 * (double)vct->clips[0].grid.cell_m;
    const double wide = 0.5 * (double)vct_cone_width(VCT_CONES_5);
    vec3s lines[VCT_MAX_CONES];
    vct_cone_lines(VCT_CONES_5, lines);
    int lit = 0;
    for (uint32_t y = 1; y < 32; y += 6)
        for (uint32_t x = 1; x < 32; x += 6) {
            const vec3s p = studio_pixel(&rig.studio, READ_POSITION, x, y);
            const vec3s n = studio_pixel(&rig.studio, READ_NORMAL, x, y);
            const vec3s got = studio_pixel(&rig.studio, READ_IRRADIANCE, x, y);
            double from[3], normal[3], expected[3] = { 0 }, cosines = 0.0;
            for (int a = 0; a < 3; a++) {
                normal[a] = (double)n.raw[a];
                from[a] =
                    (double)(p.raw[a] - vct->clips[0].grid.origin_m.raw[a]) / texel_m + normal[a];
            }
            for (int i = 0; i < vct_cone_count(VCT_CONES_5); i++) {
                double direction[3], sum[4];
                const double cosine = (double)glms_vec3_dot(n, lines[i]);
                for (int a = 0; a < 3; a++)
                    direction[a] = (cosine < 0.0 ? -1.0 : 1.0) * (double)lines[i].raw[a];
                trace(levels, mips, from, normal, direction, wide, sum);
                for (int k = 0; k < 3; k++) {
                    const double sky = (double)rig.studio.input.sky.raw[k];
                    expected[k] += fabs(cosine) * (sum[k] / scale + (1.0 - sum[3]) * sky);
                }
                cosines += fabs(cosine);
            }
            for (int k = 0; k < 3; k++) expected[k] *= PI / cosines;
            for (int k = 0; k < 3; k++) {
                // Filters may weigh in steps of 1/256, and levels change where rounding says.
                CHECK_NEAR((double)got.raw[k], expected[k], 0.02 * expected[k] + 0.05);
                lit += expected[k] > 1.0;
            }
        }
    CHECK(lit > 20);
    for (int i = 0; i < mips; i++) free(levels[i].light);
    vct_rig_finish(&rig);
}

// ---- Closed forms

static double mean(const float *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += (double)values[i];
    return sum / (double)count;
}

// Black walls that shine evenly: E = π L everywhere.
TEST_GPU(a_furnace_has_pi_times_its_radiance)
{
    struct vct_rig rig;
    vct_rig_init(&rig, gpu);
    struct material m = material_default();
    m.emissive = vec3_of(10, 10, 10);
    m.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    m.metallic = 0;
    studio_box(&rig.studio, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true,
               studio_material(&rig.studio, &m));
    studio_look(&rig.studio, vec3_of(2, 3, 8), vec3_of(9, 3, 1));
    vct_rig_open(&rig, "resolution=48");
    studio_render(&rig.studio);
    float *e = studio_read(&rig.studio, READ_IRRADIANCE);
    const double got = mean(e, 32 * 32 * 3) / (PI * 10.0);
    print_message("furnace: %.3f of the irradiance\n", got);
    // Cones lose a little where the width of their texels changes inside of a wall.
    CHECK(got > 0.93 && got < 1.01);
    free(e);
    vct_rig_finish(&rig);
}

// What shines outside of a closed room is not seen inside but for what walls one voxel thick let
// through.
TEST_GPU(a_closed_room_keeps_the_sky_out)
{
    struct vct_rig rig;
    vct_rig_init(&rig, gpu);
    studio_box(&rig.studio, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true,
               studio_matte(&rig.studio, vec3_of(0, 0, 0)));
    studio_look(&rig.studio, vec3_of(2, 3, 8), vec3_of(9, 3, 1));
    rig.studio.input.sky = vec3_of(10, 10, 10);
    vct_rig_open(&rig, "resolution=48");
    studio_render(&rig.studio);
    float *e = studio_read(&rig.studio, READ_IRRADIANCE);
    const double got = mean(e, 32 * 32 * 3) / (PI * 10.0);
    print_message("closed room: %.3f of the sky\n", got);
    CHECK(got < 0.07);
    free(e);
    vct_rig_finish(&rig);
}

TEST(cones_share_the_hemisphere)
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
