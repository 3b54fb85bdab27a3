// Geometry of straight and bent tubes.
#include "tube.h"

#include "core/sampling.h"

#include <math.h>

static const float BEND_RADIUS = 0.5f; // of the axis, around the edge of the cell

// Bends are around the vertical through (±½, 0, −½).
static float side_of(enum tube_bend bend)
{
    return bend == TUBE_LEFT ? 1.0f : -1.0f;
}

struct tube_frame tube_axis(enum tube_bend bend, float along)
{
    if (bend == TUBE_STRAIGHT)
        return (struct tube_frame){ vec3_of(0, 0, along - 0.5f), vec3_of(1, 0, 0),
                                    vec3_of(0, 0, 1) };
    float side = side_of(bend), angle = GLM_PI_2f * along;
    vec3s outward = vec3_of(-side * cosf(angle), 0, sinf(angle));
    vec3s centre = vec3_of(side * 0.5f, 0, -0.5f);
    return (struct tube_frame){ glms_vec3_muladds(outward, BEND_RADIUS, centre),
                                glms_vec3_scale(outward, -side),
                                vec3_of(side * sinf(angle), 0, cosf(angle)) };
}

struct tube_place tube_locate(enum tube_bend bend, vec3s point)
{
    float left = point.x, along = point.z + 0.5f;
    if (bend != TUBE_STRAIGHT) {
        float side = side_of(bend), x = side * (side * 0.5f - point.x), z = point.z + 0.5f;
        left = side * (BEND_RADIUS - sqrtf(x * x + z * z));
        along = atan2f(z, x) / GLM_PI_2f;
    }
    float around = atan2f(point.y, left) / (2.0f * GLM_PIf);
    return (struct tube_place){ around < 0.0f ? around + 1.0f : around,
                                sqrtf(left * left + point.y * point.y), along };
}

vec3s tube_wall(enum tube_bend bend, float around, float along)
{
    struct tube_frame axis = tube_axis(bend, along);
    float angle = 2.0f * GLM_PIf * around;
    vec3s at = glms_vec3_muladds(axis.left, TUBE_RADIUS * cosf(angle), axis.origin);
    at.y += TUBE_RADIUS * sinf(angle);
    return at;
}

vec3s tube_inside(enum tube_bend bend, vec3s unit)
{
    vec2s disk = sample_disk((vec2s){ { unit.x, unit.y } });
    struct tube_frame axis = tube_axis(bend, unit.z);
    vec3s at = glms_vec3_muladds(axis.left, TUBE_RADIUS * disk.x, axis.origin);
    at.y += TUBE_RADIUS * disk.y;
    return at;
}

static float straight_wall(vec3s from, vec3s direction)
{
    float a = direction.x * direction.x + direction.y * direction.y;
    float b = from.x * direction.x + from.y * direction.y;
    float c = from.x * from.x + from.y * from.y - TUBE_RADIUS * TUBE_RADIUS;
    if (a < 1e-12f) return INFINITY;
    return (-b + sqrtf(glm_max(b * b - a * c, 0.0f))) / a;
}

// A bend is a part of the torus (q² + R² − r²)² = 4R² (x² + z²) around the edge of the cell. Along
// a ray the difference of both sides is a quartic, negative inside.
struct quartic {
    double of[5]; // coefficient of each power of the distance
};

// Rounding may set a point of the wall outside: the torus through that point is taken then.
static struct quartic bend_quartic(float side, vec3s from, vec3s direction)
{
    const double axis = (double)BEND_RADIUS, tube = (double)TUBE_RADIUS, k = 4.0 * axis * axis;
    const double x = (double)from.x - (double)side * axis, y = (double)from.y,
                 z = (double)from.z + axis;
    const double dx = (double)direction.x, dy = (double)direction.y, dz = (double)direction.z;
    const double a = dx * dx + dy * dy + dz * dz, b = x * dx + y * dy + z * dz,
                 c = x * x + y * y + z * z + axis * axis - tube * tube;
    const double start = c * c - k * (x * x + z * z);
    return (struct quartic){ { start < 0.0 ? start : 0.0, 4.0 * b * c - 2.0 * k * (x * dx + z * dz),
                               4.0 * b * b + 2.0 * a * c - k * (dx * dx + dz * dz), 4.0 * a * b,
                               a * a } };
}

static double quartic_value(const struct quartic *f, double t)
{
    return f->of[0] + t * (f->of[1] + t * (f->of[2] + t * (f->of[3] + t * f->of[4])));
}

static double quartic_slope(const struct quartic *f, double t)
{
    return f->of[1] + t * (2.0 * f->of[2] + t * (3.0 * f->of[3] + t * 4.0 * f->of[4]));
}

static const double CONVERGED = 1e-6; // step of Newton's method; the error is its square

// The zero where a convex part that begins at 0 or below becomes positive. Newton's method
// approaches it from above and cannot pass it.
static bool rises_convex(const struct quartic *f, double begin, double end, double *zero)
{
    double t = end, step = INFINITY;
    if (!(quartic_value(f, end) > 0.0)) return false;
    for (int i = 0; i < 64 && t > begin && step > CONVERGED; i++) {
        step = quartic_value(f, t) / quartic_slope(f, t);
        t -= step;
    }
    *zero = t > begin ? t : begin;
    return true;
}

// The zero where a concave part becomes positive, approached from below. The maximum may be below
// 0.
static bool rises_concave(const struct quartic *f, double begin, double end, double *zero)
{
    double t = begin, step = INFINITY;
    for (int i = 0; i < 64 && step > CONVERGED; i++) {
        const double slope = quartic_slope(f, t);
        if (!(slope > 0.0)) return false;
        step = -quartic_value(f, t) / slope;
        t += step;
        if (t > end) return false;
    }
    *zero = t;
    return true;
}

// Points of inflection, in order; the quartic is concave between them. Equal where there are none.
static void inflections(const struct quartic *f, double out[2])
{
    const double a = 6.0 * f->of[4], b = 1.5 * f->of[3], c = f->of[2];
    const double root = sqrt(b * b > a * c ? b * b - a * c : 0.0);
    out[0] = (-b - root) / a;
    out[1] = (-b + root) / a;
}

static double clamped(double x, double least, double most)
{
    return x < least ? least : x > most ? most : x;
}

// The first place where the quartic becomes positive, or `limit`. Parts of one curvature have one
// such place at most. A start on the wall is a zero too, but there the quartic falls.
static float bend_wall(float side, vec3s from, vec3s direction, float limit)
{
    static const float FAR = 2.0f; // more than any chord of the torus
    const struct quartic f = bend_quartic(side, from, direction);
    const double end = (double)glm_min(limit, FAR);
    double part[2], zero;
    inflections(&f, part);
    for (int i = 0; i < 2; i++) part[i] = clamped(part[i], 0.0, end);
    if (rises_convex(&f, 0.0, part[0], &zero) || rises_concave(&f, part[0], part[1], &zero) ||
        rises_convex(&f, part[1], end, &zero))
        return (float)zero;
    return (float)end;
}

enum tube_exit tube_trace(enum tube_bend bend, vec3s from, vec3s direction, float *distance)
{
    float side = side_of(bend), begin = INFINITY, end = INFINITY;
    if (direction.z < 0.0f) begin = glm_max((-0.5f - from.z) / direction.z, 0.0f);
    if (bend == TUBE_STRAIGHT && direction.z > 0.0f) end = (0.5f - from.z) / direction.z;
    if (bend != TUBE_STRAIGHT && side * direction.x > 0.0f)
        end = (side * 0.5f - from.x) / direction.x;
    float limit = glm_min(begin, glm_max(end, 0.0f));
    float wall = bend == TUBE_STRAIGHT ? straight_wall(from, direction)
                                       : bend_wall(side, from, direction, limit);
    *distance = glm_min(wall, limit);
    return wall < limit ? TUBE_WALL : begin < end ? TUBE_BEGIN : TUBE_END;
}
