#include "techniques/gtao/gtao_twin.h"

#include <math.h>

enum { ANGLES = 2048, SECTORS = 32, MAX_STEPS = 64 };

struct twin_camera {
    vec3s eye, right, down, forward;
    float focal_px;
};

struct point {
    int x, y;
    vec3s position, normal, to_camera;
    float radius_m, radius_px;
};

// Samples of one side, by rising distance on the screen.
struct side {
    double tangent;              // angle from the line of sight, as the others
    double n_view, n_along;      // components of the normal
    double integral[ANGLES + 1]; // of the weight, up to angle i of ANGLES
    int count;
    double front[MAX_STEPS], back[MAX_STEPS], weight[MAX_STEPS];
};

static struct twin_camera camera_of(const struct frame_fixture *s)
{
    const struct world_camera *c = &s->input.camera;
    return (struct twin_camera){ .eye = c->eye,
                                 .right = glms_vec3_cross(c->forward, c->up),
                                 .down = glms_vec3_negate(c->up),
                                 .forward = c->forward,
                                 .focal_px =
                                     0.5f * (float)s->height / tanf(0.5f * c->vertical_fov_rad) };
}

static vec3s at(const float *pixels, int index)
{
    return vec3_of(pixels[3 * index], pixels[3 * index + 1], pixels[3 * index + 2]);
}

static struct point point_at(const struct gtao_twin *twin, const struct twin_camera *camera,
                             const struct frame_fixture *s, int x, int y)
{
    const int index = y * (int)s->width + x;
    struct point p = {
        .x = x, .y = y, .position = at(twin->position, index), .normal = at(twin->normal, index)
    };
    const vec3s away = glms_vec3_sub(p.position, camera->eye);
    const float distance_m = glms_vec3_dot(away, camera->forward);
    p.to_camera = glms_vec3_negate(glms_vec3_normalize(away));
    p.radius_px =
        fminf(twin->radius_m * camera->focal_px / distance_m, twin->reach * (float)s->height);
    p.radius_m = p.radius_px * distance_m / camera->focal_px;
    return p;
}

// Rotated with the view axis to the line of sight.
static vec3s perpendicular(const struct twin_camera *camera, const struct point *p, float angle)
{
    const vec3s in_image =
        glms_vec3_muladds(camera->right, cosf(angle), glms_vec3_scale(camera->down, sinf(angle)));
    const vec3s sight = glms_vec3_negate(p->to_camera);
    const vec3s axis = glms_vec3_cross(camera->forward, sight);
    const float turn = atan2f(glms_vec3_norm(axis), glms_vec3_dot(camera->forward, sight));
    return turn < 1e-6f ? in_image : glms_vec3_rotate(in_image, turn, glms_vec3_normalize(axis));
}

// Offset in the image of a small movement along `along`, per metre.
static void image_offset(const struct twin_camera *camera, const struct point *p, vec3s along,
                         float out[2])
{
    const vec3s away = glms_vec3_sub(p->position, camera->eye);
    const float d = glms_vec3_dot(away, camera->forward);
    const float forward = glms_vec3_dot(along, camera->forward);
    const vec3s axes[2] = { camera->right, camera->down };
    for (int i = 0; i < 2; i++)
        out[i] = camera->focal_px / d *
                 (glms_vec3_dot(along, axes[i]) - glms_vec3_dot(away, axes[i]) / d * forward);
}

static double angle_of(const struct point *p, vec3s along, vec3s v)
{
    return atan2(fmax((double)glms_vec3_dot(v, along), 0.0),
                 (double)glms_vec3_dot(v, p->to_camera));
}

// Moved into the slice, parallel to the tangent plane.
static vec3s into_slice(const struct point *p, vec3s along, vec3s v)
{
    const vec3s across = glms_vec3_cross(p->to_camera, along);
    const vec3s flat = glms_vec3_muladds(p->normal, -glms_vec3_dot(p->normal, across), across);
    return glms_vec3_muladds(flat, -glms_vec3_dot(v, across) / glms_vec3_dot(flat, across), v);
}

static void add_sample(const struct gtao_twin *twin, const struct twin_camera *camera,
                       const struct point *p, vec3s along, vec3s position, struct side *side)
{
    const vec3s front = into_slice(p, along, glms_vec3_sub(position, p->position));
    const float r = glms_vec3_norm(front);
    const float weight = (1.0f - r / p->radius_m) / fmaxf(twin->falloff, 1e-6f);
    if (weight <= 0.0f || glms_vec3_dot(front, p->normal) <= r / 1024.0f) return;
    const vec3s away = glms_vec3_normalize(glms_vec3_sub(position, camera->eye));
    const vec3s back = glms_vec3_muladds(away, twin->thickness_m, front);
    const double behind = angle_of(p, along, back);
    side->front[side->count] = angle_of(p, along, front);
    side->back[side->count] = behind;
    side->weight[side->count++] = fmin((double)weight, 1.0);
}

static void find_samples(const struct gtao_twin *twin, const struct twin_camera *camera,
                         const struct frame_fixture *s, const struct point *p, vec3s along,
                         float jitter, struct side *side)
{
    float offset[2];
    image_offset(camera, p, along, offset);
    for (int i = 0; i < twin->steps; i++) {
        const float metres = p->radius_m * ((float)i + jitter) / (float)twin->steps;
        const int x = p->x + (int)roundf(offset[0] * metres);
        const int y = p->y + (int)roundf(offset[1] * metres);
        if (x < 0 || y < 0 || x >= (int)s->width || y >= (int)s->height) break;
        const int index = y * (int)s->width + x;
        if (twin->depth[index] <= 0.0f || (x == p->x && y == p->y)) continue;
        add_sample(twin, camera, p, along, at(twin->position, index), side);
    }
}

// ∫ (n·ω) |sin θ| dθ
static void integrate(struct side *side)
{
    side->integral[0] = 0.0;
    for (int i = 0; i < ANGLES; i++) {
        const double angle = side->tangent * (i + 0.5) / ANGLES;
        side->integral[i + 1] =
            side->integral[i] + (side->n_view * cos(angle) + side->n_along * sin(angle)) *
                                    sin(angle) * side->tangent / ANGLES;
    }
}

static double share_up_to(const struct side *side, double angle)
{
    const double place = fmin(angle / side->tangent, 1.0) * ANGLES;
    const int i = (int)fmin(place, ANGLES - 1);
    const double low = side->integral[i], high = side->integral[i + 1];
    return (low + (high - low) * (place - i)) / side->integral[ANGLES];
}

// Weight of the first sample whose horizon is above a direction.
static double occluded_by_horizons(const struct side *side)
{
    double sum = 0.0;
    for (int a = 0; a < ANGLES; a++) {
        const double angle = side->tangent * (a + 0.5) / ANGLES;
        for (int i = 0; i < side->count; i++)
            if (side->front[i] <= angle) {
                sum += side->weight[i] * (side->integral[a + 1] - side->integral[a]);
                break;
            }
    }
    return sum;
}

static double occluded_by_bitmask(const struct side *side, float jitter)
{
    double sum = 0.0;
    for (int k = 0; k < SECTORS; k++) {
        const double share = (k + (double)jitter) / SECTORS;
        for (int i = 0; i < side->count; i++) {
            const bool to_end = side->back[i] >= side->tangent;
            if (share < share_up_to(side, side->front[i])) continue;
            if (!to_end && share >= share_up_to(side, side->back[i])) continue;
            sum += side->weight[i] * side->integral[ANGLES] / SECTORS;
            break;
        }
    }
    return sum;
}

// As screen_pattern and screen_rotation of the shader.
static unsigned pattern_of(int x, int y)
{
    const unsigned both = (unsigned)(x ^ y), row = (unsigned)y;
    return (both & 1u) << 3 | (row & 1u) << 2 | (both & 2u) | (row & 2u) >> 1;
}

double gtao_twin_visibility(const struct gtao_twin *twin, const struct frame_fixture *s, int x,
                            int y)
{
    const struct twin_camera camera = camera_of(s);
    const struct point p = point_at(twin, &camera, s, x, y);
    const unsigned pattern = pattern_of(x, y);
    const float rotation = fmodf((float)pattern * 0.61803399f, 1.0f);
    const float jitter = ((float)(pattern * 5u & 15u) + 0.5f) / 16.0f;
    double occluded = 0.0, whole = 0.0;
    for (int i = 0; i < 2 * twin->slices; i++) {
        struct side side = { .count = 0 };
        const float angle = GLM_PIf * ((float)i + rotation) / (float)twin->slices;
        const vec3s along = perpendicular(&camera, &p, angle);
        side.n_view = (double)glms_vec3_dot(p.normal, p.to_camera);
        side.n_along = (double)glms_vec3_dot(p.normal, along);
        side.tangent = atan2(side.n_view, -side.n_along);
        integrate(&side);
        find_samples(twin, &camera, s, &p, along, jitter, &side);
        occluded +=
            twin->bitmask ? occluded_by_bitmask(&side, jitter) : occluded_by_horizons(&side);
        whole += side.integral[ANGLES];
    }
    const double fade = fmin(fmax((double)p.radius_px - 1.0, 0.0), 1.0);
    return 1.0 - fade * occluded / whole;
}
