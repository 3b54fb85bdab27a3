// dnrt in frames: the change of each pixel against the bake, evaluated on the CPU.
#include "techniques/baked_fixture.h"
#include "techniques/dnrt/probe_fixture.h"
#include "techniques/dnrt/sphere_fixture.h"

#include "core/half.h"
#include "core/sh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SOURCE "lpv:geometry=off,dim=16,cascades=1,bounces=0,probes=true"
enum { N = 16, BALLS = 2 };
static const float REACH = 2.0f, FADE = 2.0f; // the defaults

struct dnrt_scene {
    struct frame_fixture fixture;
    struct baked_fixture run;
};

static const vec3s CENTRE[BALLS] = { { { -0.2f, 0.8f, 0.1f } }, { { 0.6f, 0.7f, -0.3f } } };
static const float RADIUS[BALLS] = { 0.4f, 0.3f };
static const vec3s SUN_DIRECTION = { { 0.3f, -1, -0.6f } };
static const float SUN_LUX = 1000;

static versors turn_of(int ball)
{
    return glms_quatv(0.9f + (float)ball, vec3_of(0.48f, 0.6f, -0.64f));
}

static void add_ball(struct frame_fixture *s, int mesh, int ball)
{
    struct node node = node_default();
    node.translation = CENTRE[ball];
    node.rotation = turn_of(ball);
    node.scale = vec3_of(RADIUS[ball], RADIUS[ball], RADIUS[ball]);
    s->scene->instances[fixture_instance(s, mesh, &node)].movable = true;
}

// A floor and a red wall in the sun, and those of two balls that have a bit in `balls`.
static void open_scene(struct dnrt_scene *d, struct gpu *gpu, const char *gi, unsigned balls)
{
    struct frame_fixture *s = &d->fixture;
    fixture_init(s, gpu);
    fixture_floor(s, 3, fixture_matte(s, vec3_of(0.7f, 0.7f, 0.7f)));
    fixture_quad(s, vec3_of(-3, 0, -2), vec3_of(3, 0, -2), vec3_of(3, 3, -2), vec3_of(-3, 3, -2),
                 fixture_matte(s, vec3_of(0.8f, 0.1f, 0.1f)));
    const int mesh = sphere_fixture_add(s->scene, fixture_matte(s, vec3_of(0.2f, 0.4f, 0.9f)));
    for (int b = 0; b < BALLS; b++)
        if (balls >> b & 1) add_ball(s, mesh, b);
    fixture_add_sun(s, SUN_DIRECTION, vec3_of(SUN_LUX, SUN_LUX, SUN_LUX));
    fixture_look(s, vec3_of(0, 2.4f, 3.4f), vec3_of(0, 0.4f, -0.6f));
    s->input.want_id_layer = true;
    baked_fixture_open(&d->run, s, gi);
    s->indirect.needs |= FRAME_LEAVES_DYNAMIC; // also of a source alone
    fixture_render(s);
}

static void close_scene(struct dnrt_scene *d)
{
    baked_fixture_close(&d->run, &d->fixture);
}

// ---- the change of a pixel, by the definition

struct ball_volume {
    vec3s centre;
    mat3s object_from_world; // rotation
    float radius, half;
    bool quadratic;
    float light[3][9]; // π c in the object's frame, lux
    float lamps[3][9]; // π d, of the sun
    const float *scale;
    const struct tensor *volume;
};

// The sun lights all of each ball.
static void add_sun(struct ball_volume *v)
{
    const vec3s to_sun = glms_vec3_normalize(glms_vec3_negate(SUN_DIRECTION));
    float zonal[3], cosine[9];
    zh_clamped_cosine(3, zonal);
    zh_rotate(3, zonal, glms_mat3_mulv(v->object_from_world, to_sun), cosine);
    for (int c = 0; c < 3; c++)
        for (int j = 0; j < 9; j++) v->lamps[c][j] = GLM_PIf * SUN_LUX * cosine[j];
}

static struct ball_volume volume_of(struct dnrt_scene *d, int ball, bool quadratic)
{
    const struct tensors *bake = d->run.baked.bakes.of_term[1];
    struct ball_volume v = {
        .centre = CENTRE[ball],
        .radius = RADIUS[ball],
        .half = REACH * RADIUS[ball],
        .quadratic = quadratic,
        .object_from_world = glms_mat3_transpose(glms_quat_mat3(turn_of(ball))),
        .scale = baked_tensor(bake, "scale")->data,
        .volume = baked_tensor(bake, "volume"),
    };
    float c[3][9];
    probe_fixture_at(&d->run, &d->fixture, v.centre, c);
    for (int i = 0; i < 3; i++) {
        sh_rotate(3, v.object_from_world, c[i], v.light[i]);
        for (int j = 0; j < 9; j++) v.light[i][j] *= GLM_PIf;
    }
    add_sun(&v);
    return v;
}

static float sample_of(const struct ball_volume *v, int plane, int index)
{
    const size_t at = (size_t)plane * N * N * N + (size_t)index;
    return v->scale[plane] * (v->volume->type == TENSOR_F16
                                  ? float_from_half(((const uint16_t *)v->volume->data)[at])
                                  : (float)(((const uint8_t *)v->volume->data)[at] - 128) / 127);
}

// π Σ (c_j m_j + d_j t_j) of the volume of a normal, t = m + k.
static float interpolate(const struct ball_volume *v, int normal, int colour, const float at[3])
{
    const int count = (int)v->volume->shape[1], planes = (int)v->volume->shape[2];
    float sum = 0;
    for (int k = 0; k < 8; k++) {
        float weight = 1;
        int index = 0;
        for (int i = 2; i >= 0; i--) {
            const int low = (int)fminf(floorf(at[i]), N - 2);
            const float part = at[i] - (float)low;
            weight *= k >> i & 1 ? part : 1 - part;
            index = index * N + low + (k >> i & 1);
        }
        for (int j = 0; j < count; j++) {
            const int first = planes * (count * normal + j);
            const float m = sample_of(v, first + colour, index);
            sum += weight * v->light[colour][j] * m;
            if (planes == 4)
                sum += weight * v->lamps[colour][j] * (m + sample_of(v, first + 3, index));
        }
    }
    return sum;
}

// Weights of the volumes for a receiver: of n_o; of x, y and z, where a sphere has the part
// ½ + ½ cosθ d/r above the horizon; of each axis both ways, that alone near an axis.
static void weights_of(const struct ball_volume *v, vec3s position, vec3s normal, float weights[6])
{
    const vec3s to_centre = glms_vec3_sub(v->centre, position);
    const vec3s n = glms_mat3_mulv(v->object_from_world, normal);
    const vec3s n_o = glms_mat3_mulv(v->object_from_world, glms_vec3_normalize(to_centre));
    const float distance = glms_vec3_norm(to_centre), cosine = glms_vec3_dot(n_o, n);
    const float part = glm_clamp(0.5f + 0.5f * cosine * distance / v->radius, 0, 1);
    const float alone =
        powf(n.x * n.x * n.x * n.x + n.y * n.y * n.y * n.y + n.z * n.z * n.z * n.z, 8);
    for (int i = 0; i < 6; i++) weights[i] = 0;
    if (v->volume->shape[0] == 1) weights[0] = fmaxf(cosine, 0);
    for (int i = 0; i < 3; i++) {
        const float above =
            part * n.raw[i] + part * (1 - part) * fminf(v->radius / distance, 1) * n_o.raw[i];
        if (v->volume->shape[0] == 3) weights[i] = above;
        if (v->volume->shape[0] != 6) continue;
        weights[2 * i] = (1 - alone) * above;
        weights[2 * i + 1] = -weights[2 * i];
        weights[2 * i + (n.raw[i] < 0)] += alone * n.raw[i] * n.raw[i];
    }
}

static vec3s change_of(const struct ball_volume *v, vec3s position, vec3s normal)
{
    const vec3s from_centre = glms_vec3_sub(position, v->centre);
    const vec3s p = glms_vec3_divs(glms_mat3_mulv(v->object_from_world, from_centre), v->half);
    const float border = glms_vec3_max(glms_vec3_abs(p));
    vec3s change = vec3_of(0, 0, 0);
    if (border >= FADE) return change;
    const float end = 1 / (FADE * FADE);
    const float fall = border > 1 ? (1 / (border * border) - end) / (1 - end) : 1;
    float at[3], weights[6];
    weights_of(v, position, normal, weights);
    for (int i = 0; i < 3; i++) {
        const float u = p.raw[i] / fmaxf(border, 1);
        at[i] = (0.5f + 0.5f * (v->quadratic ? copysignf(sqrtf(fabsf(u)), u) : u)) * (float)(N - 1);
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < (int)v->volume->shape[0]; i++)
            change.raw[c] += weights[i] * fall * interpolate(v, i, c, at);
    return change;
}

// Adds the change of the light at the first ball by the second one, π times coefficients over
// normals: irradiance V (n·n_o)₊.
static void add_bounce(const struct ball_volume *from, struct ball_volume *to)
{
    const vec3s n_o = glms_vec3_normalize(glms_vec3_sub(from->centre, to->centre));
    const vec3s change = change_of(from, to->centre, n_o);
    float zonal[3], cosine[9];
    zh_clamped_cosine(3, zonal);
    zh_rotate(3, zonal, glms_mat3_mulv(to->object_from_world, n_o), cosine);
    for (int c = 0; c < 3; c++)
        for (int j = 0; j < 9; j++) to->light[c][j] += GLM_PIf * change.raw[c] * cosine[j];
}

// ---- tests

struct pixels {
    float *irradiance, *position, *normal, *id;
    size_t count;
};

static struct pixels read_pixels(struct dnrt_scene *d)
{
    struct frame_fixture *s = &d->fixture;
    return (struct pixels){ fixture_read(s, READ_IRRADIANCE), fixture_read(s, READ_POSITION),
                            fixture_read(s, READ_NORMAL), fixture_read(s, READ_ID),
                            (size_t)s->width * s->height };
}

static void free_pixels(struct pixels *p)
{
    free(p->irradiance);
    free(p->position);
    free(p->normal);
    free(p->id);
}

static vec3s at(const float *image, size_t pixel)
{
    return vec3_of(image[3 * pixel], image[3 * pixel + 1], image[3 * pixel + 2]);
}

static bool is_ground(const struct pixels *p, size_t pixel)
{
    return p->id[2 * pixel] == 0 || p->id[2 * pixel] == 1;
}

// Own pixels of a ball have the change by the other one; here the balls are far enough apart.
static vec3s sum_of_changes(const struct ball_volume volumes[BALLS], unsigned balls,
                            const struct pixels *p, size_t i)
{
    vec3s sum = vec3_of(0, 0, 0);
    for (int b = 0; b < BALLS; b++)
        if (balls >> b & 1)
            sum = glms_vec3_add(sum, change_of(&volumes[b], at(p->position, i), at(p->normal, i)));
    return sum;
}

// The light of several objects is the sum of each alone.
static void check_change(struct gpu *gpu, const char *options, unsigned balls)
{
    char gi[192];
    struct dnrt_scene with, without;
    struct ball_volume volumes[BALLS];
    snprintf(gi, sizeof gi, "%s+dnrt:size=16,rays=64%s", SOURCE, options);
    open_scene(&without, gpu, SOURCE, balls);
    struct pixels before = read_pixels(&without);
    close_scene(&without);
    open_scene(&with, gpu, gi, balls);
    struct pixels after = read_pixels(&with);
    for (int b = 0; b < BALLS; b++)
        volumes[b] = volume_of(&with, b, strstr(options, "quadratic") != NULL);
    double most = 0, worst = 0;
    for (size_t i = 0; i < after.count; i++) {
        if (!is_ground(&after, i)) continue;
        const vec3s actual = glms_vec3_sub(at(after.irradiance, i), at(before.irradiance, i));
        const vec3s least = glms_vec3_negate(at(before.irradiance, i));
        const vec3s expected = glms_vec3_maxv(sum_of_changes(volumes, balls, &after, i), least);
        most = fmax(most, (double)glms_vec3_norm(expected));
        worst = fmax(worst, (double)glms_vec3_distance(actual, expected));
    }
    print_message("%s: largest change %.3g lux, error %.2g of it\n", gi, most, worst / most);
    CHECK(most > 1 && worst < 0.01 * most);
    free_pixels(&before);
    free_pixels(&after);
    close_scene(&with);
}

// With the balls that have a bit in `balls`.
static struct pixels pixels_of(struct gpu *gpu, const char *gi, unsigned balls)
{
    struct dnrt_scene d;
    open_scene(&d, gpu, gi, balls);
    const struct pixels p = read_pixels(&d);
    close_scene(&d);
    return p;
}

TEST_GPU(pixels_change_as_the_bake_says)
{
    check_change(gpu, "", 1);
    check_change(gpu, ",direct=true", 1);
    check_change(gpu, ",coefficients=9,direct=true", 2);
    check_change(gpu, ",bits=8", 3);
}

TEST_GPU(pixels_change_by_volumes_of_several_normals)
{
    check_change(gpu, ",normals=3,grid=quadratic,direct=true", 3);
    check_change(gpu, ",normals=6,coefficients=9,bits=8", 3);
}

// Compares the change by a second bounce with the expected one by a least-squares factor, since the
// change of a pixel is of the size of the image's rounding.
static void check_bounce(struct gpu *gpu, const char *options)
{
    char gi[192];
    struct dnrt_scene d;
    struct ball_volume first[BALLS], second[BALLS];
    snprintf(gi, sizeof gi, "%s+dnrt:size=16,rays=64,%s", SOURCE, options);
    struct pixels before = pixels_of(gpu, gi, 3);
    snprintf(gi, sizeof gi, "%s+dnrt:size=16,rays=64,bounces=2,%s", SOURCE, options);
    open_scene(&d, gpu, gi, 3);
    struct pixels after = read_pixels(&d);
    for (int b = 0; b < BALLS; b++)
        first[b] = second[b] = volume_of(&d, b, strstr(options, "quadratic") != NULL);
    for (int b = 0; b < BALLS; b++) add_bounce(&first[1 - b], &second[b]);
    double product = 0, square = 0;
    for (size_t i = 0; i < after.count; i++) {
        if (!is_ground(&after, i)) continue;
        const vec3s actual = glms_vec3_sub(at(after.irradiance, i), at(before.irradiance, i));
        const vec3s expected = glms_vec3_sub(sum_of_changes(second, 3, &after, i),
                                             sum_of_changes(first, 3, &after, i));
        product += (double)glms_vec3_dot(actual, expected);
        square += (double)glms_vec3_norm2(expected);
    }
    print_message("%s: factor %.4f, root of the sum of squares %.3g lux\n", gi, product / square,
                  sqrt(square));
    CHECK(square > 1 && fabs(product / square - 1) < 0.03);
    free_pixels(&before);
    free_pixels(&after);
    close_scene(&d);
}

TEST_GPU(objects_get_the_light_that_others_change)
{
    check_bounce(gpu, "bits=16");
    check_bounce(gpu, "direct=true,normals=3,coefficients=9,bits=8,grid=quadratic");
}

// Two balls reflect light onto each other.
TEST_GPU(further_bounces_converge)
{
    enum { MOST = 3 };
    struct pixels of[MOST];
    double change[MOST] = { 0 };
    for (int b = 0; b < MOST; b++) {
        char gi[192];
        snprintf(gi, sizeof gi, "%s+dnrt:size=16,rays=64,bounces=%d", SOURCE, b + 1);
        of[b] = pixels_of(gpu, gi, 3);
        for (size_t i = 0; b > 0 && i < 3 * of[b].count; i++)
            change[b] += fabs((double)of[b].irradiance[i] - (double)of[b - 1].irradiance[i]);
    }
    print_message("changes by bounces 2 and 3: %g %g\n", change[1], change[2]);
    CHECK(change[1] > 0 && change[2] > 0 && change[2] < 0.5 * change[1]);
    for (int b = 0; b < MOST; b++) free_pixels(&of[b]);
}

TEST_GPU(pixels_far_from_objects_equal_those_of_the_source_to_the_bit)
{
    struct pixels before = pixels_of(gpu, SOURCE, 2);
    struct pixels after = pixels_of(gpu, SOURCE "+dnrt:size=16,rays=16,fade=1.5", 2);
    size_t far = 0, near = 0;
    for (size_t i = 0; i < after.count; i++) {
        const vec3s from = glms_vec3_sub(at(after.position, i), CENTRE[1]);
        const bool same = memcmp(before.irradiance + 3 * i, after.irradiance + 3 * i, 12) == 0;
        if (glms_vec3_norm(from) > 1.7321f * 1.5f * REACH * RADIUS[1]) {
            CHECK(same);
            far++;
        }
        near += !same;
    }
    CHECK(far > 20 && near > 20);
    free_pixels(&before);
    free_pixels(&after);
}

static struct pixels pixels_in_light(struct gpu *gpu, float first_lux, float lux)
{
    struct dnrt_scene d;
    open_scene(&d, gpu, SOURCE "+dnrt:size=16,rays=16", 3);
    const vec3s direction = glms_vec3_normalize(vec3_of(0.3f, -1, -0.6f));
    const float frames[] = { first_lux, first_lux, lux };
    for (int i = 0; i < 3; i++) {
        d.fixture.lights[0].intensity = vec3_of(frames[i], frames[i], frames[i]);
        d.fixture.lights[0].direction = direction;
        fixture_render(&d.fixture);
    }
    const struct pixels p = read_pixels(&d);
    close_scene(&d);
    return p;
}

// Volumes are computed again where the light of an object changes, and only there.
TEST_GPU(volumes_follow_the_light)
{
    struct pixels still = pixels_in_light(gpu, 700, 700);
    struct pixels changed = pixels_in_light(gpu, 1000, 700);
    struct pixels before = pixels_in_light(gpu, 1000, 1000);
    const size_t bytes = 3 * still.count * sizeof *still.irradiance;
    CHECK(memcmp(still.irradiance, changed.irradiance, bytes) == 0);
    CHECK(memcmp(still.irradiance, before.irradiance, bytes) != 0);
    free_pixels(&still);
    free_pixels(&changed);
    free_pixels(&before);
}

static void check_memory(struct gpu *gpu, const char *options)
{
    char gi[192];
    struct dnrt_scene d;
    struct gpu_memory owners[32];
    snprintf(gi, sizeof gi, "%s+dnrt:size=16,rays=16%s", SOURCE, options);
    open_scene(&d, gpu, gi, 1);
    const int count = gpu_memory_by_owner(gpu, owners, 32);
    const uint64_t estimate = technique_memory(d.run.spec.technique[1], d.run.spec.options[1],
                                               d.fixture.width, d.fixture.height);
    uint64_t bytes = 0;
    for (int i = 0; i < count && i < 32; i++)
        if (strcmp(owners[i].owner, "dnrt") == 0) bytes = owners[i].bytes;
    print_message("%s: %llu bytes estimated, %llu allocated\n", gi, (unsigned long long)estimate,
                  (unsigned long long)bytes);
    // Tables of 192 objects, and buffers that the device rounds up.
    CHECK(bytes >= estimate && bytes <= estimate + 32768);
    close_scene(&d);
}

TEST_GPU(an_object_has_the_memory_of_the_estimate)
{
    check_memory(gpu, "");
    check_memory(gpu, ",coefficients=9,bits=8,direct=true");
    check_memory(gpu, ",normals=6");
    check_memory(gpu, ",intrusion=shadow,map_size=32");
}
