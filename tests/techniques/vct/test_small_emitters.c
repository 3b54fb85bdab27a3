// Small emitters, sampled with visibility cones: irradiance, shadows, motion, and their bounce.
#include "techniques/vct/vct_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 48, EMITTER_COUNT = 20 };

static const double PI = 3.14159265358979323846;
static const float HEIGHT = 2.5f, HALF = 0.3f, RADIANCE = 100.0f;

// A black floor seen from above; square emitters over it face down. Returns their material.
static int make_scene(struct vct_fixture *fixture, struct gpu *gpu, int small_emitters,
                      const vec3s *at)
{
    vct_fixture_init(fixture, gpu);
    struct frame_fixture *s = &fixture->frame_fixture;
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
    return emitter;
}

// ∫ L cos θ cos θ'/d² dA over the emitter by the midpoint rule; lux.
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

// Irradiance of the floor against the sum of the integrals of all emitters.
static struct lit_floor measure(struct vct_fixture *fixture, int small_emitters, const vec3s *at)
{
    struct lit_floor m = { 0 };
    float *e = fixture_read(&fixture->frame_fixture, READ_IRRADIANCE),
          *p = fixture_read(&fixture->frame_fixture, READ_POSITION),
          *n = fixture_read(&fixture->frame_fixture, READ_NORMAL),
          *depth = fixture_read(&fixture->frame_fixture, READ_DEPTH);
    for (int i = 0; i < SIZE * SIZE; i++) {
        // Beyond this region a block of pixels that share cones is as wide as the light's gradient.
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

TEST_GPU(a_small_emitter_matches_its_irradiance_integral)
{
    static const char *const options[] = { "bounces=1,interleave=1", "bounces=1",
                                           "bounces=1,small_emitters=false" };
    const vec3s at = vec3_of(0.4f, HEIGHT, -0.3f);
    struct lit_floor m[3];
    for (int i = 0; i < 3; i++) {
        struct vct_fixture fixture;
        make_scene(&fixture, gpu, 1, &at);
        vct_fixture_open(&fixture, options[i]);
        fixture_render(&fixture.frame_fixture);
        m[i] = measure(&fixture, 1, &at);
        vct_fixture_finish(&fixture);
        print_message("%s: error %.3f of the mean, %.2f at most, %d pixels\n", options[i],
                      m[i].error / m[i].mean, m[i].most, m[i].pixels);
    }
    CHECK(m[0].pixels > 300);
    // Error of 12 sample points, half floats, and n·(Σ d) = ½ within 2 %.
    CHECK(m[0].error < 0.03 * m[0].mean);
    CHECK(m[0].most < 0.06);
    // Interpolation between pixels.
    CHECK(m[1].error < 0.04 * m[1].mean);
    // Cones of 1/25 of the hemisphere undersample an emitter of 1/40 of it.
    CHECK(m[2].error > 4.0 * m[1].error);
}

// More emitters than groups: some share the points of a group.
TEST_GPU(many_small_emitters_match_the_sum_of_integrals)
{
    vec3s at[EMITTER_COUNT];
    for (int i = 0; i < EMITTER_COUNT; i++)
        at[i] = vec3_of(-3.2f + 1.6f * (float)(i % 5), HEIGHT, -2.4f + 1.6f * (float)(i / 5));
    struct vct_fixture fixture;
    make_scene(&fixture, gpu, EMITTER_COUNT, at);
    vct_fixture_open(&fixture, "resolution=64,bounces=1");
    fixture_render(&fixture.frame_fixture);
    CHECK(fixture.vct->small_emitters.count == VCT_MAX_SMALL_EMITTERS);
    CHECK(fixture.vct->small_emitters.draw_count == EMITTER_COUNT);
    const struct lit_floor m = measure(&fixture, EMITTER_COUNT, at);
    print_message("%d small emitters: error %.3f of the mean\n", EMITTER_COUNT, m.error / m.mean);
    CHECK(m.error < 0.05 * m.mean);
    vct_fixture_finish(&fixture);
}

// The emitters of many_small_emitters_match_the_sum_of_integrals as one mesh, as wide as the scene.
TEST_GPU(connected_parts_of_a_mesh_are_small_emitters)
{
    vec3s at[EMITTER_COUNT], positions[4 * EMITTER_COUNT];
    uint32_t indices[6 * EMITTER_COUNT];
    for (uint32_t i = 0; i < EMITTER_COUNT; i++) {
        at[i] = vec3_of(-3.2f + 1.6f * (float)(i % 5), HEIGHT, -2.4f + 1.6f * (float)(i / 5));
        const uint32_t quad[6] = { 0, 1, 2, 0, 2, 3 };
        for (uint32_t k = 0; k < 4; k++)
            positions[4 * i + k] = vec3_of(at[i].x + (k == 1 || k == 2 ? HALF : -HALF), HEIGHT,
                                           at[i].z + (k >= 2 ? HALF : -HALF));
        for (uint32_t k = 0; k < 6; k++) indices[6 * i + k] = 4 * i + quad[k];
    }
    struct vct_fixture fixture;
    const int emitter = make_scene(&fixture, gpu, 0, at);
    struct scene *scene = fixture.frame_fixture.scene;
    const int mesh = scene_add_mesh(scene, &(struct mesh){ .name = "emitters",
                                                           .vertex_count = 4 * EMITTER_COUNT,
                                                           .index_count = 6 * EMITTER_COUNT,
                                                           .positions = positions,
                                                           .indices = indices,
                                                           .material = emitter });
    fixture_instance(&fixture.frame_fixture, mesh, NULL);
    vct_fixture_open(&fixture, "resolution=64,bounces=1");
    fixture_render(&fixture.frame_fixture);
    CHECK(fixture.vct->small_emitters.draw_count == 1);
    const struct lit_floor m = measure(&fixture, EMITTER_COUNT, at);
    print_message("one mesh of %d emitters: error %.3f of the mean\n", EMITTER_COUNT,
                  m.error / m.mean);
    CHECK(m.error < 0.05 * m.mean);
    vct_fixture_finish(&fixture);
}

// Irradiance below an occluder over that without it.
TEST_GPU(an_occluder_shadows_a_small_emitter)
{
    const vec3s emitter = vec3_of(0, HEIGHT, 0);
    double light[2];
    for (int wall = 0; wall < 2; wall++) {
        struct vct_fixture fixture;
        make_scene(&fixture, gpu, 1, &emitter);
        struct frame_fixture *s = &fixture.frame_fixture;
        // A board over the floor: from 0.5 m on to its right the whole emitter is occluded.
        if (wall)
            fixture_box(s, vec3_of(0.2f, 1.0f, -1.5f), vec3_of(3.5f, 1.1f, 1.5f), false,
                        fixture_matte(s, vec3_of(0, 0, 0)));
        fixture_look(s, vec3_of(1.2f, 0.6f, 3.9f), vec3_of(1.2f, 0, 0));
        vct_fixture_open(&fixture, "resolution=64,bounces=1");
        fixture_render(s);
        float *e = fixture_read(s, READ_IRRADIANCE), *p = fixture_read(s, READ_POSITION);
        light[wall] = 0.0;
        for (int i = 0; i < SIZE * SIZE; i++)
            if (fabsf(p[3 * i + 1]) < 0.01f && fabsf(p[3 * i] - 1.5f) < 0.5f &&
                fabsf(p[3 * i + 2]) < 0.6f)
                light[wall] += (double)e[3 * i + 1];
        free(e), free(p);
        vct_fixture_finish(&fixture);
    }
    print_message("behind a board: %.4f of the light\n", light[1] / light[0]);
    CHECK(light[0] > 0.0);
    // The leak of anisotropic voxels through a wall one voxel thick (techniques.vct.storage).
    CHECK(light[1] < 0.05 * light[0]);
}

// A moved emitter equals a static one at the same position; its old position is dark.
TEST_GPU(a_moved_emitter_equals_a_static_one)
{
    const vec3s from = vec3_of(-1, HEIGHT, 0), to = vec3_of(1, HEIGHT, 0);
    struct vct_fixture moved, there;
    make_scene(&moved, gpu, 1, &from);
    vct_fixture_open(&moved, "resolution=32,bounces=1");
    fixture_render(&moved.frame_fixture);
    const struct scene *scene = moved.frame_fixture.scene;
    moved.frame_fixture.pose.world_from_node[scene->instances[1].node].raw[3][0] += to.x - from.x;
    fixture_render(&moved.frame_fixture);
    make_scene(&there, gpu, 1, &to);
    vct_fixture_open(&there, "resolution=32,bounces=1");
    fixture_render(&there.frame_fixture);
    float *a = fixture_read(&moved.frame_fixture, READ_IRRADIANCE),
          *b = fixture_read(&there.frame_fixture, READ_IRRADIANCE);
    double difference = 0.0, sum = 0.0;
    for (int i = 0; i < SIZE * SIZE * 3; i++) {
        difference += fabs((double)a[i] - (double)b[i]);
        sum += (double)b[i];
    }
    print_message("a moved emitter: difference %.6f of the light\n", difference / sum);
    // Rounding: its sample points are transformed by another matrix.
    CHECK(sum > 0.0 && difference < 1e-3 * sum);
    free(a), free(b);
    vct_fixture_finish(&moved);
    vct_fixture_finish(&there);
}

// ---- First bounce of an emitter

static const float ROOM[3] = { 4, 3, 4 };
static const double ALBEDO = 0.6;

// Irradiance by an emitter facing up in the middle of the room, at a point of this normal; lux.
static double irradiance_from_below(vec3s at, vec3s normal)
{
    enum { N = 6 };
    const double part = 2.0 * (double)HALF / N;
    double sum = 0.0;
    for (int i = 0; i < N * N; i++) {
        const vec3s from = vec3_of(2.0f - HALF + (float)((i % N + 0.5) * part), 1,
                                   2.0f - HALF + (float)((i / N + 0.5) * part));
        const vec3s to_emitter = glms_vec3_sub(from, at);
        const double d2 = (double)glms_vec3_norm2(to_emitter), there = (double)-to_emitter.y,
                     here = (double)glms_vec3_dot(to_emitter, normal);
        if (there > 0.0 && here > 0.0)
            sum += (double)RADIANCE * there * here / (d2 * d2) * part * part;
    }
    return sum;
}

// First bounce off ceiling and walls at a point of the floor, by the midpoint rule; lux.
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
            const vec3s to_surface = glms_vec3_sub(at, floor);
            const double d2 = (double)glms_vec3_norm2(to_surface), here = (double)to_surface.y,
                         there = -(double)glms_vec3_dot(to_surface, normal);
            sum +=
                ALBEDO / PI * irradiance_from_below(at, normal) * here * there / (d2 * d2) * area;
        }
    }
    return sum;
}

TEST_GPU(voxels_reflect_light_of_small_emitters)
{
    struct vct_fixture fixture;
    vct_fixture_init(&fixture, gpu);
    struct frame_fixture *s = &fixture.frame_fixture;
    struct material emissive = material_default();
    emissive.emissive = vec3_of(RADIANCE, RADIANCE, RADIANCE);
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(ROOM[0], ROOM[1], ROOM[2]), true,
                fixture_matte(s, vec3_of((float)ALBEDO, (float)ALBEDO, (float)ALBEDO)));
    fixture_quad(s, vec3_of(2 - HALF, 1, 2 + HALF), vec3_of(2 + HALF, 1, 2 + HALF),
                 vec3_of(2 + HALF, 1, 2 - HALF), vec3_of(2 - HALF, 1, 2 - HALF),
                 fixture_material(s, &emissive));
    fixture_look(s, vec3_of(2, 2.5f, 3.8f), vec3_of(2, 0, 1.5f));
    vct_fixture_open(&fixture, "resolution=64,bounces=1");
    fixture_render(s);
    CHECK(fixture.vct->small_emitters.count == 1);
    float *e = fixture_read(s, READ_IRRADIANCE), *p = fixture_read(s, READ_POSITION);
    double light = 0.0, expected = 0.0;
    for (uint32_t k = 0; k < s->width * s->height; k += 3) {
        if (fabsf(p[3 * k + 1]) > 0.01f) continue;
        light += (double)e[3 * k + 1];
        expected += reflected_to(vec3_of(p[3 * k], 0, p[3 * k + 2]));
    }
    free(e), free(p);
    vct_fixture_finish(&fixture);
    print_message("reflected light: %.3f of the reference\n", light / expected);
    // Visibility cones lose some hundredths, and each block of voxels is lit at one point.
    CHECK(expected > 0.0 && light / expected > 0.9 && light / expected < 1.1);
}
