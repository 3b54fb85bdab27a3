// Boxes that rays meet: none is missed, and those away from a ray are not met.
#include "framework/test.h"

#include "core/rng.h"
#include "trace/ray_watch.h"

#include <math.h>

static vec3s random_point(uint64_t key, float edge)
{
    const vec2s a = rng_pair(rng_mix(3 * key)), b = rng_pair(rng_mix(3 * key + 1));
    return glms_vec3_scale(vec3_of(a.x - 0.5f, a.y - 0.5f, b.x - 0.5f), edge);
}

static bool met(const struct box3 *box, vec3s from, vec3s direction, float far)
{
    struct ray_watch watch = { .boxes = box, .count = 1 };
    ray_watch_segment(&watch, from, direction, far);
    return watch.met;
}

enum { RAYS = 20000 };

// A ray to a point on a face meets the box, whether it ends or goes on there; one that ends well
// before it does not.
TEST(ray_to_a_face_meets_its_box)
{
    for (uint64_t i = 0; i < RAYS; i++) {
        const vec3s centre = random_point(4 * i, 40.0f), size = random_point(4 * i + 1, 2.0f);
        const vec3s half = glms_vec3_abs(size);
        const struct box3 box = { glms_vec3_sub(centre, half), glms_vec3_add(centre, half) };
        const vec2s at = rng_pair(rng_mix(7 * i));
        vec3s end = centre;
        const int axis = (int)(i % 3);
        end.raw[axis] += i % 2 ? half.raw[axis] : -half.raw[axis];
        end.raw[(axis + 1) % 3] += (2.0f * at.x - 1.0f) * half.raw[(axis + 1) % 3];
        end.raw[(axis + 2) % 3] += (2.0f * at.y - 1.0f) * half.raw[(axis + 2) % 3];
        const vec3s from = random_point(4 * i + 2, 80.0f), way = glms_vec3_sub(end, from);
        const float length = glms_vec3_norm(way);
        CHECK(met(&box, from, way, 1.0f));
        CHECK(met(&box, from, glms_vec3_scale(way, 1.0f / length), length));
        CHECK(met(&box, from, way, INFINITY));
        const vec3s outside = glms_vec3_sub(glms_vec3_abs(glms_vec3_sub(from, centre)), half);
        if (glms_vec3_max(outside) < 0.1f) continue;
        CHECK(!met(&box, from, way, 0.5f * 0.1f / length));
        CHECK(!met(&box, from, glms_vec3_scale(glms_vec3_sub(from, centre), 1.0f / length),
                   INFINITY));
    }
}

TEST(ray_along_an_axis_meets_what_lies_on_it)
{
    const struct box3 box = { vec3_of(1, 1, 1), vec3_of(2, 2, 2) };
    CHECK(met(&box, vec3_of(1.5f, 1.5f, -5), vec3_of(0, 0, 1), INFINITY));
    CHECK(met(&box, vec3_of(1, 2, -5), vec3_of(0, 0, 1), INFINITY));
    CHECK(!met(&box, vec3_of(1.5f, 2.1f, -5), vec3_of(0, 0, 1), INFINITY));
    CHECK(!met(&box, vec3_of(1.5f, 1.5f, -5), vec3_of(0, 0, -1), INFINITY));
    CHECK(!met(&box, vec3_of(1.5f, 1.5f, -5), vec3_of(0, 0, 1), 5.5f));
    CHECK(met(&box, vec3_of(1.5f, 1.5f, 1.5f), vec3_of(0, 1, 0), 0.01f));
}
