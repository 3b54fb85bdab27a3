// The tubes of the tunnel dictionary: their geometry, their operators, and light through a chain of
// them against rays through the joined tubes.
#include "framework/test.h"
#include "techniques/mrt/mrt_bake_fixture.h"

#include "core/rng.h"
#include "core/sampling.h"

#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/dictionary/prior.h"
#include "techniques/mrt/dictionary/tube_symmetry.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TEXELS = 4, RESOLUTION = TUBE_TEXELS * TEXELS };

TEST(texels_of_a_tube_are_found_again)
{
    for (int bend = TUBE_STRAIGHT; bend <= TUBE_RIGHT; bend++) {
        struct mrt_shape tube = mrt_tube(RESOLUTION, (enum tube_bend)bend);
        for (int t = 0; t < mrt_shape_texels(&tube); t++) {
            struct mrt_point at = mrt_shape_texel(&tube, t);
            CHECK(mrt_shape_texel_near(&tube, at.position) == t);
            CHECK_NEAR(glms_mat3_det(at.frame), 1.0, 1e-5);
            CHECK_NEAR(tube_locate((enum tube_bend)bend, at.position).radius, TUBE_RADIUS, 1e-5);
        }
    }
}

TEST(rays_in_a_tube_end_on_its_wall_or_in_the_plane_of_an_opening)
{
    for (int bend = TUBE_STRAIGHT; bend <= TUBE_RIGHT; bend++)
        for (uint32_t i = 0; i < 2000; i++) {
            struct rng rng = rng_for(i, (uint32_t)bend, 3);
            vec2s u = rng_vec2(&rng);
            vec3s from = tube_inside((enum tube_bend)bend, vec3_of(u.x, u.y, rng_float(&rng)));
            vec3s ray = sample_sphere(rng_vec2(&rng));
            float distance;
            enum tube_exit exit = tube_trace((enum tube_bend)bend, from, ray, &distance);
            vec3s at = glms_vec3_muladds(ray, distance, from);
            struct tube_place place = tube_locate((enum tube_bend)bend, at);
            if (exit == TUBE_WALL) {
                CHECK_NEAR(place.radius, TUBE_RADIUS, 1e-3);
                CHECK(place.along > -1e-3f && place.along < 1.001f);
            } else {
                CHECK(place.radius < TUBE_RADIUS + 1e-4f);
                CHECK_NEAR(place.along, exit == TUBE_END, 1e-3);
            }
        }
}

// ---- walls of bends

enum { BEND_RAYS = 2000 };

struct bend_ray {
    enum tube_bend bend;
    vec3s from, direction;
};

// From a wall into the tube, at angles to the wall of 0.001 to 0.1 rad.
static struct bend_ray ray_along_wall(enum tube_bend bend, struct rng *rng)
{
    const vec2s at = rng_vec2(rng), u = rng_vec2(rng);
    const float angle = powf(10.0f, 2.0f * u.x - 3.0f), turn = 2.0f * GLM_PIf * u.y,
                around = 2.0f * GLM_PIf * at.x;
    const struct tube_frame axis = tube_axis(bend, at.y);
    vec3s inward = glms_vec3_scale(axis.left, -cosf(around));
    inward.y -= sinf(around);
    const mat3s frame = { .col = { axis.forward, glms_vec3_cross(inward, axis.forward), inward } };
    const vec3s way = vec3_of(cosf(angle) * cosf(turn), cosf(angle) * sinf(turn), sinf(angle));
    return (struct bend_ray){ bend, tube_wall(bend, at.x, at.y), glms_mat3_mulv(frame, way) };
}

static struct bend_ray ray_from_inside(enum tube_bend bend, struct rng *rng)
{
    const vec2s u = rng_vec2(rng);
    return (struct bend_ray){ bend, tube_inside(bend, vec3_of(u.x, u.y, rng_float(rng))),
                              sample_sphere(rng_vec2(rng)) };
}

static struct bend_ray bend_ray(uint32_t i)
{
    struct rng rng = rng_for(i, 1, 3);
    const enum tube_bend bend = i & 1 ? TUBE_LEFT : TUBE_RIGHT;
    return i & 2 ? ray_from_inside(bend, &rng) : ray_along_wall(bend, &rng);
}

// How far the point at distance t of a ray is outside the tube, which has no ends here.
static double beyond_wall(const struct bend_ray *ray, double t)
{
    const double side = ray->bend == TUBE_LEFT ? 0.5 : -0.5;
    const double x = (double)ray->from.x - side + t * (double)ray->direction.x,
                 y = (double)ray->from.y + t * (double)ray->direction.y,
                 z = (double)ray->from.z + 0.5 + t * (double)ray->direction.z;
    return hypot(hypot(x, z) - 0.5, y) - (double)TUBE_RADIUS;
}

// The distance at which a ray leaves the wall: small steps, then bisection. Steps near the start
// are short, as rays along the wall are; rounding may begin them outside.
static double marched_distance(const struct bend_ray *ray, double limit)
{
    double inside = 0.0, t = 0.0;
    bool was_inside = false;
    while (t < limit && !(was_inside && beyond_wall(ray, t) > 0.0)) {
        was_inside = was_inside || beyond_wall(ray, t) <= 0.0;
        inside = t;
        t += 1e-7 + fmin(0.005 * t, 1e-3);
    }
    for (double outside = t; outside - inside > 1e-12;) {
        const double middle = 0.5 * (inside + outside);
        *(beyond_wall(ray, middle) > 0.0 ? &outside : &inside) = middle;
    }
    return fmin(inside, limit);
}

// The openings are the planes z = −½ and x = ±½.
static double opening_distance(const struct bend_ray *ray)
{
    const double side = ray->bend == TUBE_LEFT ? 1.0 : -1.0;
    const double back = (double)ray->direction.z, way = side * (double)ray->direction.x;
    const double begin = back < 0.0 ? (-0.5 - (double)ray->from.z) / back : 4.0;
    const double end = way > 0.0 ? (0.5 - side * (double)ray->from.x) / way : 4.0;
    return fmax(fmin(begin, end), 0.0);
}

static double most_beyond_wall(const struct bend_ray *ray, double distance)
{
    enum { SAMPLES = 1000 };
    double most = -1.0;
    for (int i = 0; i <= SAMPLES; i++) most = fmax(most, beyond_wall(ray, distance * i / SAMPLES));
    return most;
}

static double last_slope(const struct bend_ray *ray, double t)
{
    return (beyond_wall(ray, t) - beyond_wall(ray, t - 1e-6)) / 1e-6;
}

// Distances follow from the radius by the angle between ray and wall.
TEST(rays_in_a_bend_end_where_they_first_leave_it)
{
    static const double ROUNDING = 1e-6;
    double sum = 0.0, marched = 0.0;
    for (uint32_t i = 0; i < BEND_RAYS; i++) {
        const struct bend_ray ray = bend_ray(i);
        float distance;
        const enum tube_exit exit = tube_trace(ray.bend, ray.from, ray.direction, &distance);
        const double t = (double)distance, opening = opening_distance(&ray),
                     expected = marched_distance(&ray, opening);
        CHECK(most_beyond_wall(&ray, t) < ROUNDING);
        if (exit == TUBE_WALL) {
            CHECK_NEAR(beyond_wall(&ray, t), 0.0, ROUNDING);
            CHECK_NEAR((t - expected) * last_slope(&ray, expected), 0.0, ROUNDING);
        } else {
            CHECK_NEAR(t, opening, ROUNDING);
            CHECK_NEAR(t, expected, ROUNDING);
        }
        sum += t;
        marched += expected;
    }
    CHECK_RELATIVE(sum, marched, 1e-5);
}

TEST(rays_out_of_a_wall_of_a_bend_end_at_once)
{
    for (uint32_t i = 0; i < BEND_RAYS; i++) {
        struct rng rng = rng_for(i, 2, 3);
        struct bend_ray ray = ray_along_wall(i & 1 ? TUBE_LEFT : TUBE_RIGHT, &rng);
        float distance;
        ray.direction = glms_vec3_negate(ray.direction);
        tube_trace(ray.bend, ray.from, ray.direction, &distance);
        CHECK(distance >= 0.0f && most_beyond_wall(&ray, (double)distance) < 1e-6);
        CHECK_NEAR(beyond_wall(&ray, (double)distance), 0.0, 1e-6);
    }
}

// From an element of the wall to a disk at distance h: (Z² + ½) / √(Z² + 1) − Z, Z = h / 2r
// (Howell's catalogue of configuration factors).
static double end_factor(double h)
{
    double z = h / (2.0 * (double)TUBE_RADIUS);
    return (z * z + 0.5) / sqrt(z * z + 1.0) - z;
}

TEST(wall_of_a_straight_tube_sees_its_ends_by_the_known_factor)
{
    struct mrt_shape tube = mrt_tube(RESOLUTION, TUBE_STRAIGHT);
    struct mrt_rays rays;
    size_t n = (size_t)mrt_shape_texels(&tube);
    float *row = host_alloc(test_host(), n, sizeof *row);
    CHECK(row && mrt_rays_init(test_host(), MRT_IRRADIANCE, 16384, &rays));
    for (int j = 0; j < RESOLUTION; j++) {
        double sum = 0.0, h = (j + 0.5) / RESOLUTION;
        memset(row, 0, n * sizeof *row);
        mrt_gather(&tube, mrt_shape_texel(&tube, j * RESOLUTION + 5), &rays, row, n);
        for (size_t i = 0; i < n; i++) sum += (double)row[i];
        CHECK_NEAR(sum, 1.0 - end_factor(h) - end_factor(1.0 - h), 2e-3);
    }
    mrt_rays_finish(test_host(), &rays);
    host_free(test_host(), row);
}

// A right bend is the mirror image of a left one.
TEST(bends_are_mirror_images)
{
    struct mrt_shape left = mrt_tube(RESOLUTION, TUBE_LEFT),
                     right = mrt_tube(RESOLUTION, TUBE_RIGHT);
    struct mrt_hit a, b;
    for (uint32_t i = 0; i < 500; i++) {
        struct rng rng = rng_for(i, 9, 3);
        vec2s u = rng_vec2(&rng);
        vec3s from = tube_inside(TUBE_LEFT, vec3_of(u.x, u.y, rng_float(&rng)));
        vec3s ray = sample_sphere(rng_vec2(&rng));
        mrt_shape_trace(&left, from, ray, &a);
        from.x = -from.x;
        ray.x = -ray.x;
        mrt_shape_trace(&right, from, ray, &b);
        CHECK_NEAR(a.distance, b.distance, 1e-4);
        CHECK((a.opening < 0) == (b.opening < 0));
    }
}

// ---- symmetry

// Motions leave distances and visibility as they are.
TEST(motions_of_a_tube_take_rays_to_rays)
{
    for (int bend = TUBE_STRAIGHT; bend <= TUBE_LEFT; bend++) {
        const struct mrt_shape tube = mrt_tube(RESOLUTION, (enum tube_bend)bend);
        const int n = mrt_shape_texels(&tube);
        for (int t = 0; t < n; t++) {
            struct tube_motion motion;
            const int from = tube_representative(&tube, tube_orbit_of(&tube, t, &motion));
            CHECK(tube_moved_texel(&tube, motion, from) == t);
            for (int k = 0; k < n; k += 7) {
                const int moved = tube_moved_texel(&tube, motion, k);
                const struct mrt_point a = mrt_shape_texel(&tube, from),
                                       b = mrt_shape_texel(&tube, k), c = mrt_shape_texel(&tube, t),
                                       d = mrt_shape_texel(&tube, moved);
                CHECK_NEAR(glms_vec3_distance(a.position, b.position),
                           glms_vec3_distance(c.position, d.position), 1e-5);
                CHECK_NEAR(glms_vec3_dot(a.frame.col[2], b.frame.col[2]),
                           glms_vec3_dot(c.frame.col[2], d.frame.col[2]), 1e-5);
            }
        }
    }
}

// The light that a lit tube gathers from lights inside by its operators, against its own rays.
static double error_of_gather(const struct mrt_dictionary *d, int shape, enum mrt_measure measure)
{
    const struct mrt_element *e = &d->element[shape];
    const struct matrix_f32 *u = measure == MRT_VECTOR  ? &e->u_vec
                                 : measure == MRT_PROBE ? &e->u_bvol
                                                        : &e->u_b;
    const size_t texels = e->l_imp.rows;
    struct mrt_rays rays;
    CHECK(mrt_rays_init(test_host(), measure, 4096, &rays));
    const size_t values = (size_t)rays.values, points = u->rows / values;
    float *rows = host_alloc(test_host(), values * texels, sizeof *rows);
    double difference = 0.0, all = 0.0;
    for (size_t i = 0; i < points; i += 5) {
        memset(rows, 0, values * texels * sizeof *rows);
        mrt_gather(&e->shape, mrt_gather_point(&e->shape, d->options.block_probes, measure, (int)i),
                   &rays, rows, texels);
        for (size_t v = 0; v < values; v++)
            for (size_t k = 0; k < 8; k++) {
                double sum = 0.0;
                for (size_t t = 0; t < texels; t++)
                    sum +=
                        (double)rows[v * texels + t] * (double)e->l_imp.at[t * e->l_imp.stride + k];
                const double got = (double)u->at[(i * values + v) * u->stride + k];
                difference += (got - sum) * (got - sum);
                all += sum * sum;
            }
    }
    host_free(test_host(), rows);
    mrt_rays_finish(test_host(), &rays);
    return sqrt(difference / all);
}

// Rows by symmetry and the mirrored bend are those that rays of their own would give.
static void check_gathers(const struct mrt_dictionary *d)
{
    for (int shape = 0; shape < d->element_count; shape++)
        for (int m = MRT_IRRADIANCE; m <= MRT_PROBE; m++) {
            const double error = error_of_gather(d, shape, (enum mrt_measure)m);
            print_message("tube %d, measure %d: error %.4f\n", shape, m, error);
            CHECK(error < 0.01);
        }
}

// ---- a chain of tubes

enum { TUBES = 4, LIGHTS = 8 };

// A ray that leaves a tube by `face`, in the frame of that face, or back.
static void cross(int face, bool outward, vec3s *at, vec3s *ray)
{
    mat3s frame = cube_from_face(face);
    if (outward) frame = glms_mat3_transpose(frame);
    if (!outward) at->z = 0.5f;
    *at = glms_mat3_mulv(frame, *at);
    *ray = glms_mat3_mulv(frame, *ray);
    if (outward) at->z = -0.5f;
}

static int end_of(enum tube_bend bend)
{
    static const int ends[] = { CUBE_FRONT, CUBE_RIGHT, CUBE_LEFT };
    return ends[bend];
}

static bool trace_chain(const enum tube_bend *bend, int tube, vec3s at, vec3s ray,
                        struct mrt_hit *hit)
{
    for (;;) {
        struct mrt_shape shape = mrt_tube(RESOLUTION, bend[tube]);
        mrt_shape_trace(&shape, at, ray, hit);
        if (hit->opening < 0) return tube == 0;
        at = glms_vec3_muladds(ray, hit->distance, at);
        if (hit->opening == CUBE_BACK) {
            if (tube-- == 0) return false;
            cross(end_of(bend[tube]), false, &at, &ray);
        } else {
            if (tube + 1 == TUBES) return false;
            cross(end_of(bend[tube++]), true, &at, &ray);
        }
    }
}

static void gather_chain(const enum tube_bend *bend, int tube, int texel,
                         const struct mrt_rays *rays, const struct matrix_f32 *radiosity,
                         double out[LIGHTS])
{
    struct mrt_shape shape = mrt_tube(RESOLUTION, bend[tube]);
    struct mrt_point at = mrt_shape_texel(&shape, texel);
    struct mrt_hit hit;
    memset(out, 0, LIGHTS * sizeof *out);
    for (int i = 0; i < rays->count; i++) {
        vec3s ray = glms_mat3_mulv(at.frame, rays->direction[i]);
        if (!trace_chain(bend, tube, at.position, ray, &hit)) continue;
        for (size_t l = 0; l < LIGHTS; l++)
            for (int k = 0; k < hit.texels; k++)
                out[l] += (double)(rays->weight[i] * hit.weight[k] *
                                   radiosity->at[(size_t)hit.texel[k] * LIGHTS + l]);
    }
}

// Texels × lights: point lights at up to 0.8 of the radius, in the middle 0.8 of the first tube.
static struct matrix_f32 light_tube(void)
{
    struct mrt_shape shape = mrt_tube(RESOLUTION, TUBE_STRAIGHT);
    struct matrix_f32 out;
    CHECK(matrix_f32_init(test_host(), &out, (size_t)mrt_shape_texels(&shape), LIGHTS));
    for (uint32_t l = 0; l < LIGHTS; l++) {
        struct rng rng = rng_for(l, 2, 7);
        vec3s unit;
        for (int a = 0; a < 3; a++) unit.raw[a] = 0.1f + 0.8f * rng_float(&rng);
        for (size_t t = 0; t < out.rows; t++)
            out.at[t * LIGHTS + l] =
                mrt_point_light(mrt_shape_texel(&shape, (int)t), tube_inside(TUBE_STRAIGHT, unit));
    }
    return out;
}

static struct matrix_f32 product(const struct matrix_f32 *a, const struct matrix_f32 *b)
{
    struct matrix_f32 out;
    CHECK(matrix_f32_init(test_host(), &out, a->rows, b->columns));
    CHECK(matrix_f32_multiply(test_host(), 1.0f, a, NOT_TRANSPOSED, b, NOT_TRANSPOSED, 0.0f, &out));
    return out;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Median over the lights of the relative L2 error at the texels of a tube.
static double median_error(const struct matrix_f32 *irradiance, const enum tube_bend *bend,
                           int tube, const struct mrt_rays *rays,
                           const struct matrix_f32 *radiosity)
{
    double difference[LIGHTS] = { 0 }, all[LIGHTS] = { 0 }, exact[LIGHTS];
    for (size_t t = 0; t < irradiance->rows; t += 11) {
        gather_chain(bend, tube, (int)t, rays, radiosity, exact);
        for (size_t l = 0; l < LIGHTS; l++) {
            double d = (double)irradiance->at[t * LIGHTS + l] - exact[l];
            difference[l] += d * d;
            all[l] += exact[l] * exact[l];
        }
    }
    for (int l = 0; l < LIGHTS; l++) difference[l] = sqrt(difference[l] / all[l]);
    qsort(difference, LIGHTS, sizeof *difference, ascending);
    return difference[LIGHTS / 2];
}

static void replace(struct matrix_f32 *m, struct matrix_f32 by)
{
    matrix_f32_finish(test_host(), m);
    *m = by;
}

static void compare_tubes(const struct mrt_dictionary *d, const enum tube_bend *bend,
                          const double *bound)
{
    struct matrix_f32 radiosity = light_tube();
    struct mrt_rays rays;
    CHECK(mrt_rays_init(test_host(), MRT_IRRADIANCE, 16384, &rays));
    struct matrix_f32 light = product(&d->element[TUBE_STRAIGHT].t_db, &radiosity);
    struct matrix_f32 own = product(&d->element[TUBE_STRAIGHT].u_b, &light);
    double error = median_error(&own, bend, 0, &rays, &radiosity);
    print_message("tubes %d %d %d %d, distance 0: error %.3f\n", bend[0], bend[1], bend[2], bend[3],
                  error);
    CHECK(error < bound[0]);
    replace(&light, product(&d->element[TUBE_STRAIGHT].r_b[CUBE_FRONT], &light));
    for (int tube = 1; tube < TUBES; tube++) {
        if (tube > 1) replace(&light, product(&d->r_turn[bend[tube - 1]], &light));
        struct matrix_f32 r = product(&d->entered[bend[tube]].t_r, &light);
        replace(&own, product(&d->entered[bend[tube]].u_r, &r));
        matrix_f32_finish(test_host(), &r);
        error = median_error(&own, bend, tube, &rays, &radiosity);
        print_message("distance %d: error %.3f\n", tube, error);
        CHECK(error < bound[tube]);
    }
    mrt_rays_finish(test_host(), &rays);
    matrix_f32_finish(test_host(), &radiosity);
    matrix_f32_finish(test_host(), &light);
    matrix_f32_finish(test_host(), &own);
}

TEST(light_through_tubes_is_near_that_of_the_joined_tubes)
{
    static const enum tube_bend chains[][TUBES] = {
        { TUBE_STRAIGHT, TUBE_STRAIGHT, TUBE_STRAIGHT, TUBE_STRAIGHT },
        { TUBE_STRAIGHT, TUBE_LEFT, TUBE_STRAIGHT, TUBE_RIGHT },
        { TUBE_STRAIGHT, TUBE_RIGHT, TUBE_LEFT, TUBE_STRAIGHT },
    };
    // The errors reached, plus a tenth at most.
    static const double bounds[][TUBES] = { { 0.005, 0.067, 0.084, 0.207 },
                                            { 0.005, 0.073, 0.154, 0.512 },
                                            { 0.005, 0.063, 0.348, 0.236 } };
    struct mrt_dictionary_options options = mrt_fixture_options();
    options.maze = MRT_TUNNEL;
    options.texels = TEXELS;
    options.rays = 4096;
    struct bake *bake = mrt_fixture_bake(&options, 0, false);
    struct mrt_dictionary d;
    CHECK(mrt_dictionary_init(test_host(), bake_tensors(bake), &options, &d));
    check_gathers(&d);
    for (size_t i = 0; i < sizeof chains / sizeof *chains; i++)
        compare_tubes(&d, chains[i], bounds[i]);
    mrt_dictionary_finish(test_host(), &d);
    bake_destroy(bake);
}
