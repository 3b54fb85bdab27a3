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
    return (-b + sqrtf(fmaxf(b * b - a * c, 0.0f))) / a;
}

// Distance from a point inside a bend to its wall.
static float bend_clearance(float side, vec3s at)
{
    float x = at.x - side * 0.5f, z = at.z + 0.5f;
    float out = sqrtf(x * x + z * z) - BEND_RADIUS;
    return TUBE_RADIUS - sqrtf(out * out + at.y * at.y);
}

static const float CLOSE = 1e-5f; // clearance of a point on the wall

// The wall between two distances (x; y: their clearances), by regula falsi with the weights of the
// Illinois method: three steps on average.
static float find_wall(float side, vec3s from, vec3s direction, vec2s inside, vec2s outside)
{
    float middle = inside.x, last = 0.0f;
    for (int i = 0; i < 16; i++) {
        middle = inside.x + (outside.x - inside.x) * inside.y / (inside.y - outside.y);
        const float clearance = bend_clearance(side, glms_vec3_muladds(direction, middle, from));
        if (fabsf(clearance) < CLOSE) break;
        if (clearance > 0.0f) {
            inside = (vec2s){ { middle, clearance } };
            if (last > 0.0f) outside.y *= 0.5f;
        } else {
            outside = (vec2s){ { middle, clearance } };
            if (last < 0.0f) inside.y *= 0.5f;
        }
        last = clearance;
    }
    return middle;
}

// Sphere tracing, in which the clearance is a lower bound of the distance up to `limit`. Rays that
// graze the wall would take hundreds of steps: near it the secant of the last two points leads on.
// The first step leaves the wall on which the ray may begin.
static float bend_wall(float side, vec3s from, vec3s direction, float limit)
{
    static const float FIRST = 1e-3f, SECANT = 0.05f;
    float t = FIRST, before = 0.0f, clearance_before = 0.0f;
    for (int i = 0; i < 64; i++) {
        float clearance = bend_clearance(side, glms_vec3_muladds(direction, t, from));
        if (clearance < -CLOSE && i > 0)
            return find_wall(side, from, direction, (vec2s){ { before, clearance_before } },
                             (vec2s){ { t, clearance } });
        if (t >= limit || clearance < CLOSE) break;
        float slope = (clearance_before - clearance) / (t - before);
        before = t;
        clearance_before = clearance;
        t = fminf(t + (slope > 0.0f && clearance < SECANT ? clearance / slope : clearance), limit);
    }
    return t;
}

enum tube_exit tube_trace(enum tube_bend bend, vec3s from, vec3s direction, float *distance)
{
    float side = side_of(bend), begin = INFINITY, end = INFINITY;
    if (direction.z < 0.0f) begin = fmaxf((-0.5f - from.z) / direction.z, 0.0f);
    if (bend == TUBE_STRAIGHT && direction.z > 0.0f) end = (0.5f - from.z) / direction.z;
    if (bend != TUBE_STRAIGHT && side * direction.x > 0.0f)
        end = (side * 0.5f - from.x) / direction.x;
    float limit = fminf(begin, fmaxf(end, 0.0f));
    float wall = bend == TUBE_STRAIGHT ? straight_wall(from, direction)
                                       : bend_wall(side, from, direction, limit);
    *distance = fminf(wall, limit);
    return wall < limit ? TUBE_WALL : begin < end ? TUBE_BEGIN : TUBE_END;
}
