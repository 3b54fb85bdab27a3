// Key frames of a mesh that an animation deforms.
#include "frame/frame_fixture.h"
#include "techniques/dnrt/floor_fixture.h"

#include "techniques/dnrt/dnrt_keys.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SOURCE "lpv:geometry=off,dim=16,cascades=1,bounces=0,probes=true"

// ---- a ball that shrinks to 0.4 in a second and grows to 0.8 in another; two small triangles,
// above and below, that keep the bounding sphere

enum { RINGS = 24, AROUND = 32, BALL = (RINGS + 1) * (AROUND + 1), VERTICES = BALL + 6 };

static float times[3] = { 0, 1, 2 }, weights[3] = { 0, 1, 1.0f / 3 };
static struct animation_channel channel = { .path = PATH_WEIGHTS,
                                            .interpolation = INTERPOLATE_LINEAR,
                                            .key_count = 3,
                                            .width = 1,
                                            .times_s = times,
                                            .values = weights };
static struct animation animation = { "shrink", 2, &channel, 1 };

static void add_ball(struct frame_fixture *s)
{
    static vec3s positions[VERTICES], normals[VERTICES], offsets[VERTICES];
    static uint32_t indices[6 * RINGS * AROUND + 6];
    uint32_t count = 0;
    for (int r = 0; r <= RINGS; r++)
        for (int a = 0; a <= AROUND; a++) {
            const float theta = GLM_PIf * (float)r / RINGS, phi = 2 * GLM_PIf * (float)a / AROUND;
            const vec3s n = vec3_of(sinf(theta) * cosf(phi), cosf(theta), sinf(theta) * sinf(phi));
            const int v = r * (AROUND + 1) + a;
            normals[v] = n;
            positions[v] = glms_vec3_scale(n, 0.4f);
            offsets[v] = glms_vec3_scale(n, -0.24f);
        }
    for (int v = 0; v < 6; v++) {
        const float side = v < 3 ? 1.0f : -1.0f, turn = 2.1f * (float)(v % 3);
        normals[BALL + v] = vec3_of(0, side, 0);
        positions[BALL + v] = vec3_of(1e-3f * cosf(turn), 0.5f * side, -1e-3f * side * sinf(turn));
        offsets[BALL + v] = vec3_of(0, 0, 0);
    }
    for (uint32_t r = 0; r < RINGS; r++)
        for (uint32_t a = 0; a < AROUND; a++) {
            const uint32_t i = r * (AROUND + 1) + a, below = i + AROUND + 1;
            const uint32_t quad[6] = { i, i + 1, below + 1, i, below + 1, below };
            memcpy(indices + count, quad, sizeof quad);
            count += 6;
        }
    for (uint32_t v = 0; v < 6; v++) indices[count++] = BALL + v;
    struct morph_target target = { offsets, NULL };
    const struct mesh mesh = { .name = "ball",
                               .vertex_count = VERTICES,
                               .index_count = count,
                               .positions = positions,
                               .normals = normals,
                               .indices = indices,
                               .morphs = &target,
                               .morph_count = 1,
                               .material = fixture_matte(s, vec3_of(0.2f, 0.4f, 0.9f)) };
    struct node node = node_default();
    node.translation = vec3_of(0.9f, 0.7f, 0);
    channel.node =
        s->scene->instances[fixture_instance(s, scene_add_mesh(s->scene, &mesh), &node)].node;
}

// ---- frames

// Irradiance of a frame at a time, baked for the pose of another. The caller frees it.
static float *render(struct gpu *gpu, const char *options, float bake_time, float time)
{
    struct frame_fixture s;
    char text[192];
    snprintf(text, sizeof text, "%s+dnrt:size=16,rays=64%s", SOURCE, options);
    fixture_init(&s, gpu);
    fixture_floor(&s, 1.2f, fixture_matte(&s, vec3_of(0.7f, 0.7f, 0.7f)));
    add_ball(&s);
    s.scene->animations = &animation;
    s.scene->animation_count = 1;
    fixture_add_sun(&s, vec3_of(1, -0.3f, 0), vec3_of(3000, 3000, 3000));
    fixture_look(&s, vec3_of(0, 2.4f, 3.4f), vec3_of(0, 0.4f, -0.6f));
    s.input.want_id_layer = true;
    float *irradiance = floor_irradiance(&s, gpu, text, bake_time, time);
    s.scene->animations = NULL;
    s.scene->animation_count = 0;
    fixture_finish(&s);
    return irradiance;
}

// ---- tests

static struct scene_pose pose_at(const struct scene *scene, float time)
{
    return (struct scene_pose){ .scene = scene, .animation = 0, .time_s = time };
}

TEST(keys_lie_evenly_over_the_animation)
{
    const struct scene scene = { .animations = &animation, .animation_count = 1 };
    const struct scene_pose pose = pose_at(&scene, 0), still = { .scene = &scene, .animation = -1 };
    CHECK(dnrt_keys_of(&pose, 5) == 5 && dnrt_keys_of(&still, 5) == 1);
    CHECK(dnrt_key_time(&pose, 5, 0) == 0 && dnrt_key_time(&pose, 5, 1) == 0.5f);
    CHECK(dnrt_key_time(&pose, 5, 4) < 2 && dnrt_key_time(&pose, 5, 4) > 1.999f);
}

TEST(a_moment_lies_between_two_keys)
{
    const struct scene scene = { .animations = &animation, .animation_count = 1 };
    for (int key = 0; key < 7; key++) {
        struct scene_pose pose = pose_at(&scene, 0);
        pose.time_s = dnrt_key_time(&pose, 7, key);
        const struct dnrt_between at = dnrt_keys_around(&pose, 7);
        CHECK(at.first == key && at.part == 0);
    }
    const struct scene_pose pose = pose_at(&scene, 2.0f * 3 + 0.625f);
    const struct dnrt_between at = dnrt_keys_around(&pose, 5);
    CHECK(at.first == 1 && at.next == 2);
    CHECK_NEAR(at.part, 0.25, 1e-5);
}

TEST_GPU(a_key_has_the_light_of_the_mesh_in_its_pose_to_the_bit)
{
    float *still = render(gpu, "", 1, 1), *keyed = render(gpu, ",keys=3", 0, 1);
    float *other = render(gpu, "", 0, 1);
    CHECK(memcmp(still, keyed, FLOOR_VALUES * sizeof *still) == 0);
    CHECK(floor_difference(still, other) > 100);
    free(still);
    free(keyed);
    free(other);
}

// The mean of the volumes that bakes of the keys' poses have at this moment; half floats round the
// images.
TEST_GPU(between_two_keys_the_light_is_their_mean)
{
    float *first = render(gpu, "", 0, 0.5f), *next = render(gpu, "", 1, 0.5f);
    float *half = render(gpu, ",keys=3", 0, 0.5f);
    double worst = 0, change = 0;
    for (int i = 0; i < FLOOR_VALUES; i++) {
        if (first[i] == 0 || next[i] == 0) continue; // the ball is there, or the sum ends at 0
        const double a = (double)first[i], b = (double)next[i];
        worst = fmax(worst, fabs((double)half[i] - 0.5 * (a + b)));
        change = fmax(change, fabs(a - b));
    }
    print_message("the keys differ by up to %g lux, their mean from half-way by %g\n", change,
                  worst);
    CHECK(change > 4 && worst < 2e-3 * change);
    free(first);
    free(next);
    free(half);
}

// The more keys, the closer a moment is to a bake of its own pose.
TEST_GPU(keys_bring_a_moment_close_to_its_pose)
{
    float *exact = render(gpu, "", 0.35f, 0.35f);
    double error[3];
    for (int i = 0; i < 3; i++) {
        float *keyed = render(gpu, (const char *[]){ "", ",keys=3", ",keys=5" }[i], 0, 0.35f);
        error[i] = floor_difference(keyed, exact);
        free(keyed);
    }
    print_message("1, 3 and 5 keys: %g, %g, %g lux from the pose's own\n", error[0], error[1],
                  error[2]);
    CHECK(error[1] < 0.5 * error[0] && error[2] < error[1]);
    free(exact);
}
