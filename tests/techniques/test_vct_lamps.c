// Light of small things that glow: as much as there is, with a shadow, wherever they go.
#include "techniques/vct_rig.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 48, MOST_LAMPS = 20 };

static const double PI = 3.14159265358979323846;
static const float HEIGHT = 2.5f, HALF = 0.3f, RADIANCE = 100.0f;

// A dark floor seen from above, with square lamps over it that shine down.
static void furnish(struct vct_rig *rig, struct gpu *gpu, int small_emitters, const vec3s *at)
{
    vct_rig_init(rig, gpu);
    struct frame_fixture *s = &rig->frame_fixture;
    s->width = s->height = SIZE;
    struct material light = material_default();
    light.emissive = vec3_of(RADIANCE, RADIANCE, RADIANCE);
    const int emitter = fixture_material(s, &light);
    fixture_floor(s, 4, fixture_matte(s, vec3_of(0, 0, 0)));
    for (int i = 0; i < small_emitters; i++) {
        const vec3s c = at[i];
        fixture_quad(s, vec3_of(c.x - HALF, c.y, c.z - HALF), vec3_of(c.x + HALF, c.y, c.z - HALF),
                     vec3_of(c.x + HALF, c.y, c.z + HALF), vec3_of(c.x - HALF, c.y, c.z + HALF),
                     emitter);
    }
    fixture_look(s, vec3_of(0, 2.3f, 3.5f), vec3_of(0, 0, 0.2f));
}

// ∫ L cos θ cos θ'/d² dA over the lamp, by midpoints; lux.
static double irradiance_by(vec3s emitter, double x, double z)
{
    enum { N = 20 };
    const double half = (double)HALF, h = (double)emitter.y, part = 2.0 * half / N;
    double sum = 0.0;
    for (int i = 0; i < N; i++)
        for (int k = 0; k < N; k++) {
            const double dx = (double)emitter.x - half + (i + 0.5) * part - x,
                         dz = (double)emitter.z - half + (k + 0.5) * part - z;
            const double d2 = dx * dx + dz * dz + h * h;
            sum += (double)RADIANCE * h * h / (d2 * d2) * part * part;
        }
    return sum;
}

struct lit_floor {
    double error, mean, most; // of irradiance, absolute; lux
    int pixels;
};

// The lit floor against the sum over all lamps.
static struct lit_floor measure(struct vct_rig *rig, int small_emitters, const vec3s *at)
{
    struct lit_floor m = { 0 };
    float *e = fixture_read(&rig->frame_fixture, READ_IRRADIANCE),
          *p = fixture_read(&rig->frame_fixture, READ_POSITION),
          *n = fixture_read(&rig->frame_fixture, READ_NORMAL),
          *depth = fixture_read(&rig->frame_fixture, READ_DEPTH);
    for (int i = 0; i < SIZE * SIZE; i++) {
        // Farther off a block of pixels that share what they found is as wide as light changes.
        if (depth[i] <= 0.0f || n[3 * i + 1] < 0.9f || p[3 * i + 1] > 0.1f) continue;
        if (fabsf(p[3 * i]) > 2.0f || fabsf(p[3 * i + 2]) > 1.5f) continue;
        double expected = 0.0;
        for (int k = 0; k < small_emitters; k++)
            expected += irradiance_by(at[k], (double)p[3 * i], (double)p[3 * i + 2]);
        const double off = fabs((double)e[3 * i + 1] - expected);
        m.error += off;
        m.mean += expected;
        m.most = fmax(m.most, off / expected);
        m.pixels++;
    }
    free(e), free(p), free(n), free(depth);
    m.error /= m.pixels;
    m.mean /= m.pixels;
    return m;
}

TEST_GPU(a_lamp_lights_the_floor_below_it_as_its_integral_says)
{
    static const char *const options[] = { "bounces=1,interleave=1", "bounces=1",
                                           "bounces=1,small_emitters=false" };
    const vec3s at = vec3_of(0.4f, HEIGHT, -0.3f);
    struct lit_floor m[3];
    for (int i = 0; i < 3; i++) {
        struct vct_rig rig;
        furnish(&rig, gpu, 1, &at);
        vct_rig_open(&rig, options[i]);
        fixture_render(&rig.frame_fixture);
        m[i] = measure(&rig, 1, &at);
        vct_rig_finish(&rig);
        print_message("%s: off by %.3f of the mean, %.2f at most, %d pixels\n", options[i],
                      m[i].error / m[i].mean, m[i].most, m[i].pixels);
    }
    CHECK(m[0].pixels > 300);
    // Twelve points in place of an area, half floats, and cones of which n·(Σ d) is ½ but for 2 %.
    CHECK(m[0].error < 0.03 * m[0].mean);
    CHECK(m[0].most < 0.06);
    // What is interpolated between pixels.
    CHECK(m[1].error < 0.04 * m[1].mean);
    // Cones of 1/25 of the hemisphere meet a lamp of 1/40 of it by chance.
    CHECK(m[2].error > 4.0 * m[1].error);
}

// Sixteen are looked for, of which each sample takes one; the others stay with the cones.
TEST_GPU(many_lamps_bring_what_all_of_them_bring)
{
    vec3s at[MOST_LAMPS];
    for (int i = 0; i < MOST_LAMPS; i++)
        at[i] = vec3_of(-3.2f + 1.6f * (float)(i % 5), HEIGHT, -2.4f + 1.6f * (float)(i / 5));
    struct vct_rig rig;
    furnish(&rig, gpu, MOST_LAMPS, at);
    vct_rig_open(&rig, "resolution=64,bounces=1");
    fixture_render(&rig.frame_fixture);
    CHECK(rig.vct->small_emitters.count == VCT_MAX_SMALL_EMITTERS);
    const struct lit_floor m = measure(&rig, MOST_LAMPS, at);
    print_message("%d small emitters: off by %.3f of the mean\n", MOST_LAMPS, m.error / m.mean);
    CHECK(m.error < 0.1 * m.mean);
    vct_rig_finish(&rig);
}

// Light behind a wall between lamp and floor, over light without it.
TEST_GPU(what_stands_before_a_lamp_throws_a_shadow)
{
    const vec3s emitter = vec3_of(0, HEIGHT, 0);
    double light[2];
    for (int wall = 0; wall < 2; wall++) {
        struct vct_rig rig;
        furnish(&rig, gpu, 1, &emitter);
        struct frame_fixture *s = &rig.frame_fixture;
        // A board over the floor: from 0.5 m on to its right all of the lamp is behind it.
        if (wall)
            fixture_box(s, vec3_of(0.2f, 1.0f, -1.5f), vec3_of(3.5f, 1.1f, 1.5f), false,
                        fixture_matte(s, vec3_of(0, 0, 0)));
        fixture_look(s, vec3_of(1.2f, 0.6f, 3.9f), vec3_of(1.2f, 0, 0));
        vct_rig_open(&rig, "resolution=64,bounces=1");
        fixture_render(s);
        float *e = fixture_read(s, READ_IRRADIANCE), *p = fixture_read(s, READ_POSITION);
        light[wall] = 0.0;
        for (int i = 0; i < SIZE * SIZE; i++)
            if (fabsf(p[3 * i + 1]) < 0.01f && fabsf(p[3 * i] - 1.5f) < 0.5f &&
                fabsf(p[3 * i + 2]) < 0.6f)
                light[wall] += (double)e[3 * i + 1];
        free(e), free(p);
        vct_rig_finish(&rig);
    }
    print_message("behind a board: %.4f of the light\n", light[1] / light[0]);
    CHECK(light[0] > 0.0);
    // What six ways let through a wall one voxel thick (test_vct_storage).
    CHECK(light[1] < 0.05 * light[0]);
}

// A lamp that has moved lights as one that was there from the first: nothing of it is left behind.
TEST_GPU(a_lamp_takes_its_light_along)
{
    const vec3s from = vec3_of(-1, HEIGHT, 0), to = vec3_of(1, HEIGHT, 0);
    struct vct_rig moved, there;
    furnish(&moved, gpu, 1, &from);
    vct_rig_open(&moved, "resolution=32,bounces=1");
    fixture_render(&moved.frame_fixture);
    const struct scene *scene = moved.frame_fixture.scene;
    moved.frame_fixture.pose.world_from_node[scene->instances[1].node].raw[3][0] += to.x - from.x;
    fixture_render(&moved.frame_fixture);
    furnish(&there, gpu, 1, &to);
    vct_rig_open(&there, "resolution=32,bounces=1");
    fixture_render(&there.frame_fixture);
    float *a = fixture_read(&moved.frame_fixture, READ_IRRADIANCE),
          *b = fixture_read(&there.frame_fixture, READ_IRRADIANCE);
    double apart = 0.0, sum = 0.0;
    for (int i = 0; i < SIZE * SIZE * 3; i++) {
        apart += fabs((double)a[i] - (double)b[i]);
        sum += (double)b[i];
    }
    print_message("a moved emitter: %.6f of the light off\n", apart / sum);
    // Its points are moved by a matrix instead of standing where they are: rounding.
    CHECK(sum > 0.0 && apart < 1e-3 * sum);
    free(a), free(b);
    vct_rig_finish(&moved);
    vct_rig_finish(&there);
}

// ---- What voxels reflect of it

static const float ROOM[3] = { 4, 3, 4 };
static const double ALBEDO = 0.6;

// A lamp that shines up, in the middle of a room, to a place of this normal; lux.
static double irradiance_from_below(vec3s at, vec3s normal)
{
    enum { N = 6 };
    const double part = 2.0 * (double)HALF / N;
    double sum = 0.0;
    for (int i = 0; i < N * N; i++) {
        const vec3s from = vec3_of(2.0f - HALF + (float)((i % N + 0.5) * part), 1,
                                   2.0f - HALF + (float)((i / N + 0.5) * part));
        const vec3s way = glms_vec3_sub(from, at);
        const double d2 = (double)glms_vec3_norm2(way), there = (double)-way.y,
                     here = (double)glms_vec3_dot(way, normal);
        if (there > 0.0 && here > 0.0)
            sum += (double)RADIANCE * there * here / (d2 * d2) * part * part;
    }
    return sum;
}

// What ceiling and walls reflect of it to a place on the floor, by midpoints of their squares; lux.
static double reflected_to(vec3s floor)
{
    enum { N = 24 };
    double sum = 0.0;
    for (int face = 0; face < 5; face++) { // the ceiling; low and high walls along x, then z
        const int axis = face == 0 ? 1 : face < 3 ? 0 : 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
        const bool high = face == 0 || face % 2 == 0;
        vec3s normal = vec3_of(0, 0, 0), at;
        normal.raw[axis] = high ? -1.0f : 1.0f;
        at.raw[axis] = high ? ROOM[axis] : 0.0f;
        const double area = (double)ROOM[b] * (double)ROOM[c] / (N * N);
        for (int i = 0; i < N * N; i++) {
            at.raw[b] = ((float)(i % N) + 0.5f) / N * ROOM[b];
            at.raw[c] = ((float)(i / N) + 0.5f) / N * ROOM[c];
            const vec3s way = glms_vec3_sub(at, floor);
            const double d2 = (double)glms_vec3_norm2(way), here = (double)way.y,
                         there = -(double)glms_vec3_dot(way, normal);
            sum +=
                ALBEDO / PI * irradiance_from_below(at, normal) * here * there / (d2 * d2) * area;
        }
    }
    return sum;
}

TEST_GPU(voxels_reflect_what_lamps_bring_them)
{
    struct vct_rig rig;
    vct_rig_init(&rig, gpu);
    struct frame_fixture *s = &rig.frame_fixture;
    struct material shining = material_default();
    shining.emissive = vec3_of(RADIANCE, RADIANCE, RADIANCE);
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(ROOM[0], ROOM[1], ROOM[2]), true,
                fixture_matte(s, vec3_of((float)ALBEDO, (float)ALBEDO, (float)ALBEDO)));
    fixture_quad(s, vec3_of(2 - HALF, 1, 2 + HALF), vec3_of(2 + HALF, 1, 2 + HALF),
                 vec3_of(2 + HALF, 1, 2 - HALF), vec3_of(2 - HALF, 1, 2 - HALF),
                 fixture_material(s, &shining));
    fixture_look(s, vec3_of(2, 2.5f, 3.8f), vec3_of(2, 0, 1.5f));
    vct_rig_open(&rig, "resolution=64,bounces=1");
    fixture_render(s);
    CHECK(rig.vct->small_emitters.count == 1);
    float *e = fixture_read(s, READ_IRRADIANCE), *p = fixture_read(s, READ_POSITION);
    double light = 0.0, expected = 0.0;
    for (uint32_t k = 0; k < s->width * s->height; k += 3) {
        if (fabsf(p[3 * k + 1]) > 0.01f) continue;
        light += (double)e[3 * k + 1];
        expected += reflected_to(vec3_of(p[3 * k], 0, p[3 * k + 2]));
    }
    free(e), free(p);
    vct_rig_finish(&rig);
    print_message("reflected light: %.3f of what there is\n", light / expected);
    // Cones lose some hundredths of what they look for, and blocks of voxels are lit in one place.
    CHECK(expected > 0.0 && light / expected > 0.9 && light / expected < 1.1);
}
