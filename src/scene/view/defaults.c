// Default camera and sun.
//
// Rays from points around the scene's centre classify it: an interior (geometry surrounds most of
// the points) gets a camera inside, or in front of its only open side; an object a camera in front
// of it. Lengths are relative to the bounds, because files may use other units than metres. Without
// memory for the rays the scene counts as an object.
#include "scene/view/defaults.h"

#include "scene/view/direct_light.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>

static const float OUTSIDE_FOV = 0.7853982f; // 45°
static const float INSIDE_FOV = 1.0471976f;  // 60°

// Direct sunlight at noon and a faint, clear sky: a few percent of the sun's illuminance, so that
// no corner is black and indirect sunlight dominates.
static const vec3s SUN_LUX = { { 100000.0f, 95000.0f, 88000.0f } };
static const vec3s SKY = { { 600.0f, 750.0f, 1000.0f } };

enum { MIDDLE_ACROSS = 5, MIDDLE_HEIGHTS = 3 };
enum { MIDDLE_POINTS = MIDDLE_ACROSS * MIDDLE_ACROSS * MIDDLE_HEIGHTS };

struct survey {
    const struct scene_pose *pose;
    struct raycast raycast;
    bool has_rays;
    struct direct_light direct;
    float diagonal;
    vec3s interior[MIDDLE_POINTS]; // enclosed points around the centre
    int interior_count;
    float level; // lowest height, as a fraction of the bounds, at which most points are enclosed
    bool inside;
    struct world_camera camera;
};

static float bounds_diagonal(const struct scene_pose *pose)
{
    if (box3_is_empty(pose->bounds)) return 1.0f;
    float diagonal = glms_vec3_norm(box3_size(pose->bounds));
    return diagonal > 0.0f && isfinite(diagonal) ? diagonal : 1.0f;
}

float default_near(const struct scene_pose *pose)
{
    return 5e-4f * bounds_diagonal(pose);
}

// A point of the bounds from coordinates in 0…1.
static vec3s point_in_bounds(const struct survey *survey, float x, float y, float z)
{
    struct box3 bounds = survey->pose->bounds;
    vec3s size = box3_size(bounds);
    return vec3_of(bounds.min.x + x * size.x, bounds.min.y + y * size.y, bounds.min.z + z * size.z);
}

// Statistics of the hits of rays in all directions from a point.
struct surroundings {
    float front, back; // fractions of rays that hit front faces, and back faces
    float mean, least; // hit distance
};

enum { SPHERE_RAYS = 64 };

static struct surroundings surroundings_of(const struct survey *survey, vec3s point)
{
    struct surroundings around = { .least = INFINITY };
    int hits = 0;
    for (uint32_t i = 0; i < SPHERE_RAYS; i++) {
        vec3s direction = sample_sphere(r2_sequence(i));
        struct raycast_hit hit;
        if (!raycast_closest(&survey->raycast, point, direction, INFINITY, &hit)) continue;
        hits++;
        around.mean += hit.distance;
        around.least = fminf(around.least, hit.distance);
        if (hit.front) {
            around.front += 1.0f / SPHERE_RAYS;
        } else {
            around.back += 1.0f / SPHERE_RAYS;
        }
    }
    if (hits > 0) around.mean /= (float)hits;
    return around;
}

// Whether a point is inside a room: most rays hit front faces. Inside a solid they hit back faces.
static bool is_enclosed(const struct surroundings *around)
{
    return around->front > 0.6f && around->back < 0.15f;
}

// Whether the scene is an interior: more than half of the points of a grid around the centre (the
// middle two fifths of each horizontal axis, three heights) are enclosed. Keeps those points.
static bool is_interior(struct survey *survey)
{
    int enclosed[MIDDLE_HEIGHTS] = { 0 };
    survey->interior_count = 0;
    for (int i = 0; i < MIDDLE_POINTS; i++) {
        float x = 0.3f + 0.1f * (float)(i % MIDDLE_ACROSS);
        float z = 0.3f + 0.1f * (float)(i / MIDDLE_ACROSS % MIDDLE_ACROSS);
        float y = 0.2f + 0.2f * (float)(i / (MIDDLE_ACROSS * MIDDLE_ACROSS));
        vec3s point = point_in_bounds(survey, x, y, z);
        struct surroundings around = surroundings_of(survey, point);
        if (!is_enclosed(&around)) continue;
        survey->interior[survey->interior_count++] = point;
        enclosed[i / (MIDDLE_ACROSS * MIDDLE_ACROSS)]++;
    }
    int lowest = 0;
    while (lowest + 1 < MIDDLE_HEIGHTS && 2 * enclosed[lowest] < MIDDLE_ACROSS * MIDDLE_ACROSS) {
        lowest++;
    }
    survey->level = 0.2f + 0.2f * (float)lowest;
    return 2 * survey->interior_count > MIDDLE_POINTS;
}

// Fraction of the interior points visible from a position; 0 in a hollow wall or an adjacent room.
static float interior_visibility(const struct survey *survey, vec3s position)
{
    int visible = 0;
    for (int i = 0; i < survey->interior_count; i++) {
        vec3s towards = glms_vec3_sub(survey->interior[i], position);
        visible += !raycast_blocked(&survey->raycast, position, towards, 1.0f);
    }
    return (float)visible / (float)survey->interior_count;
}

// Directions to the outside camera, the first preferred: in front of the scene (+z, as in glTF), to
// the right and above; then from the left, and from behind.
enum { SIDES = 4 };
static const vec3s THREE_QUARTER[SIDES] = { { { 0.55f, 0.42f, 1.0f } },
                                            { { -0.55f, 0.42f, 1.0f } },
                                            { { 0.55f, 0.42f, -1.0f } },
                                            { { -0.55f, 0.42f, -1.0f } } };

// All corners of the bounds are in a square image.
static struct world_camera outside_camera(const struct scene_pose *pose, vec3s towards_camera)
{
    float near_m = default_near(pose);
    if (box3_is_empty(pose->bounds)) {
        return camera_look_at(vec3_of(0, 0, 3), vec3_of(0, 0, 0), OUTSIDE_FOV, near_m);
    }
    vec3s centre = box3_centre(pose->bounds), back = glms_vec3_normalize(towards_camera);
    struct world_camera camera = camera_look_at(back, vec3_of(0, 0, 0), OUTSIDE_FOV, near_m);
    vec3s right = glms_vec3_cross(camera.forward, camera.up);
    float tangent = tanf(0.5f * OUTSIDE_FOV), distance = 0.0f;
    for (int i = 0; i < 8; i++) {
        vec3s corner = vec3_of(i & 1 ? pose->bounds.max.x : pose->bounds.min.x,
                               i & 2 ? pose->bounds.max.y : pose->bounds.min.y,
                               i & 4 ? pose->bounds.max.z : pose->bounds.min.z);
        vec3s offset = glms_vec3_sub(corner, centre);
        float across =
            fmaxf(fabsf(glms_vec3_dot(offset, right)), fabsf(glms_vec3_dot(offset, camera.up)));
        distance = fmaxf(distance, across / tangent + glms_vec3_dot(offset, back));
    }
    const float margin = 1.05f;
    distance = fmaxf(margin * distance, 10.0f * near_m); // a single point has no size
    camera.eye = glms_vec3_muladds(back, distance, centre);
    return camera;
}

enum { VIEW_ACROSS = 16 };

// The directly lit share of the visible surfaces in a square image.
static float lit_share_of_view(const struct survey *survey, const struct world_camera *camera)
{
    struct lit_count count = { 0 };
    vec3s right = glms_vec3_cross(camera->forward, camera->up);
    float half = tanf(0.5f * camera->vertical_fov_rad);
    for (int i = 0; i < VIEW_ACROSS * VIEW_ACROSS; i++) {
        float x = ((float)(i % VIEW_ACROSS) + 0.5f) / (0.5f * VIEW_ACROSS) - 1.0f;
        float y = ((float)(i / VIEW_ACROSS) + 0.5f) / (0.5f * VIEW_ACROSS) - 1.0f;
        vec3s direction = glms_vec3_muladds(right, half * x, camera->forward);
        direction = glms_vec3_muladds(camera->up, half * y, direction);
        direct_light_count(&survey->direct, camera->eye, glms_vec3_normalize(direction), &count);
    }
    return lit_share(&count);
}

// Directly lit share of a view above which more does not make it better.
static const float LIT_ENOUGH = 0.1f;

// The first side of which enough is lit, or the one with the largest lit share.
static struct world_camera lit_outside_camera(const struct survey *survey)
{
    struct world_camera best = survey->camera;
    float most = lit_share_of_view(survey, &best);
    for (int i = 1; i < SIDES && most < LIT_ENOUGH; i++) {
        struct world_camera camera = outside_camera(survey->pose, THREE_QUARTER[i]);
        float share = lit_share_of_view(survey, &camera);
        if (share <= most) continue;
        most = share;
        best = camera;
    }
    return best;
}

// Camera height above a floor with this clear height: a person's eye level where the scene's units
// are plausibly metres, else about a third of the clear height.
static float camera_height(float clear_height)
{
    bool human = clear_height > 1.9f && clear_height < 60.0f;
    return human ? fminf(1.7f, 0.6f * clear_height) : 0.35f * clear_height;
}

enum { DIRECTIONS = 64, GRID = 13 };

// A candidate camera position above a floor, and its best viewing direction.
struct viewpoint {
    bool usable;
    vec3s position, forward;
    float score, clear_height;
};

// Hit distances of horizontal rays. A ray that leaves the scene counts as distance 0: there is
// nothing to show. False too close to a surface, or where a quarter of the rays hit back faces.
static bool horizontal_distances(const struct survey *survey, vec3s position, float *clear)
{
    int back = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        float angle = 2.0f * GLM_PIf * (float)i / DIRECTIONS;
        struct raycast_hit hit;
        clear[i] = 0.0f;
        if (!raycast_closest(&survey->raycast, position, vec3_of(cosf(angle), 0, sinf(angle)),
                             INFINITY, &hit)) {
            continue;
        }
        clear[i] = hit.distance;
        back += !hit.front;
        if (hit.distance < 0.015f * survey->diagonal) return false;
    }
    return 4 * back < DIRECTIONS;
}

enum { LIT_RAYS = 512 };

// For each direction a factor by the directly lit share of what is visible around it: 1 where
// enough is lit, 0.1 where nothing is. 1 in scenes without punctual lights.
static void lit_factors(const struct survey *survey, vec3s position, float factors[DIRECTIONS])
{
    struct lit_count counts[DIRECTIONS] = { 0 };
    vec3s directions[DIRECTIONS];
    const float cos_view = 0.82f; // cone of 35°, about that of the camera
    for (int i = 0; i < DIRECTIONS; i++) {
        float angle = 2.0f * GLM_PIf * (float)i / DIRECTIONS;
        directions[i] = vec3_of(cosf(angle), 0, sinf(angle));
        factors[i] = 1.0f;
    }
    if (survey->direct.count == 0) return;
    for (uint32_t r = 0; r < LIT_RAYS; r++) {
        vec3s ray = sample_sphere(r2_sequence(r));
        struct lit_count one = { 0 };
        direct_light_count(&survey->direct, position, ray, &one);
        for (int i = 0; i < DIRECTIONS; i++) {
            if (glms_vec3_dot(ray, directions[i]) < cos_view) continue;
            counts[i].hits += one.hits;
            counts[i].lit += one.lit;
        }
    }
    for (int i = 0; i < DIRECTIONS; i++)
        factors[i] = 0.1f + 0.9f * fminf(lit_share(&counts[i]) / LIT_ENOUGH, 1.0f);
}

// The direction of the highest score: half the free distance along it, half the mean over a fan of
// 45 degrees around it, times the square root of the mean distance in all directions, which prefers
// wide halls to narrow aisles, times a factor by its direct light.
static void choose_direction(const struct survey *survey, const float *clear,
                             const struct surroundings *around, struct viewpoint *viewpoint)
{
    const int fan = DIRECTIONS / 16;
    float factors[DIRECTIONS];
    lit_factors(survey, viewpoint->position, factors);
    for (int i = 0; i < DIRECTIONS; i++) {
        float sum = 0.0f;
        for (int k = -fan; k <= fan; k++) sum += clear[(i + k + DIRECTIONS) % DIRECTIONS];
        float score = 0.5f * clear[i] + 0.5f * sum / (float)(2 * fan + 1);
        score *= factors[i] * sqrtf(around->mean);
        if (score <= viewpoint->score) continue;
        float angle = 2.0f * GLM_PIf * (float)i / DIRECTIONS;
        viewpoint->score = score;
        // Tilted up below a high ceiling, so that the height of a hall is visible.
        float rise = 0.1f * fminf(viewpoint->clear_height / fmaxf(clear[i], 1e-20f), 1.5f);
        viewpoint->forward = glms_vec3_normalize(vec3_of(cosf(angle), rise, sinf(angle)));
    }
}

// The viewpoint above the floor at (x, z) of the bounds. The floor is the first hit downwards from
// the height where most points are enclosed.
static struct viewpoint viewpoint_at(const struct survey *survey, float x, float z)
{
    struct viewpoint viewpoint = { 0 };
    vec3s middle = point_in_bounds(survey, x, survey->level, z);
    struct raycast_hit floor, ceiling;
    if (!raycast_closest(&survey->raycast, middle, vec3_of(0, -1, 0), INFINITY, &floor) ||
        !floor.front) {
        return viewpoint;
    }
    float above = survey->pose->bounds.max.y - middle.y;
    if (raycast_closest(&survey->raycast, middle, vec3_of(0, 1, 0), INFINITY, &ceiling)) {
        if (!ceiling.front) return viewpoint;
        above = ceiling.distance;
    }
    viewpoint.clear_height = floor.distance + above;
    viewpoint.position = middle;
    viewpoint.position.y += camera_height(viewpoint.clear_height) - floor.distance;
    float clear[DIRECTIONS];
    struct surroundings around = surroundings_of(survey, viewpoint.position);
    viewpoint.usable = is_enclosed(&around) && around.least > 0.01f * survey->diagonal &&
                       horizontal_distances(survey, viewpoint.position, clear);
    if (viewpoint.usable) choose_direction(survey, clear, &around, &viewpoint);
    // A quarter of the interior points suffices: the end of a long room sees no more.
    viewpoint.score *= fminf(4.0f * interior_visibility(survey, viewpoint.position), 1.0f);
    return viewpoint;
}

struct viewpoint_job {
    const struct survey *survey;
    struct viewpoint viewpoints[GRID * GRID];
};

static void evaluate_viewpoint(void *user, size_t i)
{
    struct viewpoint_job *job = user;
    // From 6% to 94% of the bounds.
    float x = 0.06f + 0.88f * (float)(i % GRID) / (float)(GRID - 1);
    float z = 0.06f + 0.88f * (float)(i / GRID) / (float)(GRID - 1);
    job->viewpoints[i] = viewpoint_at(job->survey, x, z);
}

// The viewpoint of the highest score; false when there is none.
static bool inside_camera(struct survey *survey)
{
    struct viewpoint_job job = { .survey = survey };
    parallel_for(GRID * GRID, 4, evaluate_viewpoint, &job);
    const struct viewpoint *best = NULL;
    for (int i = 0; i < GRID * GRID; i++) {
        const struct viewpoint *viewpoint = &job.viewpoints[i];
        if (viewpoint->usable && viewpoint->score > 0.0f &&
            (!best || viewpoint->score > best->score)) {
            best = viewpoint;
        }
    }
    if (!best) return false;
    survey->camera = camera_look_at(best->position, glms_vec3_add(best->position, best->forward),
                                    INSIDE_FOV, default_near(survey->pose));
    return true;
}

// ---- Interiors with an open side, such as the Cornell box: seen from a corner they are walls in
// close-up, seen through the open side they are seen whole.

enum { OPENING_ACROSS = 8, OPENING_RAYS = OPENING_ACROSS * OPENING_ACROSS };

// Whether rays from outside pass the first tenth of the bounds through this side: nine of ten,
// since a frame or furniture may reach it. axis: 0 or 2; towards the positive or the negative end.
static bool is_open_side(const struct survey *survey, int axis, bool positive)
{
    const float depth = box3_size(survey->pose->bounds).raw[axis];
    vec3s inwards = vec3_of(0, 0, 0);
    inwards.raw[axis] = positive ? -1.0f : 1.0f;
    int passed = 0;
    for (int i = 0; i < OPENING_RAYS; i++) {
        float across = ((float)(i % OPENING_ACROSS) + 0.5f) / OPENING_ACROSS;
        float y = ((float)(i / OPENING_ACROSS) + 0.5f) / OPENING_ACROSS;
        float at = positive ? 1.0f : 0.0f;
        vec3s start = axis == 0 ? point_in_bounds(survey, at, y, across)
                                : point_in_bounds(survey, across, y, at);
        start.raw[axis] -= 0.1f * depth * inwards.raw[axis];
        passed += !raycast_blocked(&survey->raycast, start, inwards, 0.2f * depth);
    }
    return 10 * passed >= 9 * OPENING_RAYS;
}

// A level view of the whole interior through its only open side, if that shows most of its middle.
static bool open_side_camera(struct survey *survey)
{
    vec3s towards = vec3_of(0, 0, 0);
    int open = 0;
    for (int side = 0; side < 4; side++) {
        const int axis = side & 2;
        const bool positive = side & 1;
        if (!is_open_side(survey, axis, positive)) continue;
        open++;
        towards.raw[axis] = positive ? 1.0f : -1.0f;
    }
    if (open != 1) return false;
    const struct world_camera camera = outside_camera(survey->pose, towards);
    if (interior_visibility(survey, camera.eye) < 0.5f) return false;
    survey->camera = camera;
    return true;
}

static void survey_scene(struct survey *survey, const struct scene_pose *pose)
{
    *survey = (struct survey){ .pose = pose, .diagonal = bounds_diagonal(pose) };
    survey->camera = outside_camera(pose, THREE_QUARTER[0]);
    if (box3_is_empty(pose->bounds)) return;
    survey->has_rays = raycast_init(&survey->raycast, pose->scene->host, pose);
    if (!survey->has_rays) return;
    direct_light_init(&survey->direct, pose, &survey->raycast, 1e-4f * survey->diagonal);
    survey->inside = is_interior(survey) && (open_side_camera(survey) || inside_camera(survey));
    if (!survey->inside && survey->direct.count > 0) survey->camera = lit_outside_camera(survey);
}

struct world_camera default_camera(const struct scene_pose *pose)
{
    struct survey survey;
    survey_scene(&survey, pose);
    raycast_finish(&survey.raycast);
    return survey.camera;
}

// A visible surface point; its normal faces the ray's origin.
struct sample {
    vec3s position, normal;
};

enum { SAMPLES = 1024, ELEVATIONS = 5, AZIMUTHS = 24, SUNS = ELEVATIONS * AZIMUTHS };

struct sun_job {
    const struct survey *survey;
    struct sample samples[SAMPLES];
    int sample_count;
    int score[SUNS];
};

static void add_sample(struct sun_job *job, vec3s origin, vec3s direction)
{
    struct raycast_hit hit;
    const struct survey *survey = job->survey;
    if (!raycast_closest(&survey->raycast, origin, direction, INFINITY, &hit)) return;
    vec3s normal = hit.front ? hit.normal : glms_vec3_negate(hit.normal);
    vec3s position = glms_vec3_muladds(direction, hit.distance, origin);
    // Offset along the normal against self-intersection of the shadow ray.
    position = glms_vec3_muladds(normal, 1e-4f * survey->diagonal, position);
    job->samples[job->sample_count++] = (struct sample){ position, normal };
}

// Half of the samples are visible to the camera; half are visible from five points along its
// viewing direction.
static void gather_samples(struct sun_job *job)
{
    const struct world_camera *camera = &job->survey->camera;
    vec3s right = glms_vec3_cross(camera->forward, camera->up);
    float half = tanf(0.5f * camera->vertical_fov_rad), aspect = 1.6f;
    for (uint32_t i = 0; i < SAMPLES / 2; i++) {
        vec2s u = r2_sequence(i);
        vec3s direction = glms_vec3_muladds(right, aspect * half * (2 * u.x - 1), camera->forward);
        direction = glms_vec3_muladds(camera->up, half * (2 * u.y - 1), direction);
        add_sample(job, camera->eye, glms_vec3_normalize(direction));
    }
    struct raycast_hit ahead = { .distance = 0 };
    raycast_closest(&job->survey->raycast, camera->eye, camera->forward, INFINITY, &ahead);
    for (uint32_t i = 0; i < SAMPLES / 2; i++) {
        float along = ahead.distance * (0.1f + 0.2f * (float)(i % 5));
        add_sample(job, glms_vec3_muladds(camera->forward, along, camera->eye),
                   sample_sphere(r2_sequence(i)));
    }
}

// Direction from candidate sun `i`: elevations of 35 to 75 degrees, all azimuths.
static vec3s sun_candidate(int i)
{
    float elevation = glm_rad(35.0f + 10.0f * (float)(i / AZIMUTHS));
    float azimuth = 2.0f * GLM_PIf * ((float)(i % AZIMUTHS) + 0.5f) / AZIMUTHS;
    return vec3_of(cosf(elevation) * cosf(azimuth), -sinf(elevation),
                   cosf(elevation) * sinf(azimuth));
}

// Score: the number of lit samples, plus twice the smaller count of lit horizontal and lit upright
// ones. Sun on a floor and a wall shows the room better than sun on the floor alone.
static void score_sun(void *user, size_t i)
{
    struct sun_job *job = user;
    vec3s towards = glms_vec3_negate(sun_candidate((int)i));
    const float grazing = 0.15f; // cosine below which irradiance is negligible
    int lit[2] = { 0, 0 };
    for (int s = 0; s < job->sample_count; s++) {
        const struct sample *sample = &job->samples[s];
        if (glms_vec3_dot(sample->normal, towards) < grazing) continue;
        if (raycast_blocked(&job->survey->raycast, sample->position, towards, INFINITY)) continue;
        lit[sample->normal.y > 0.7f]++;
    }
    int smaller = lit[0] < lit[1] ? lit[0] : lit[1];
    job->score[i] = lit[0] + lit[1] + 2 * smaller;
}

// The candidate of the highest score. False when no candidate lights any sample.
static bool inside_sun(const struct survey *survey, vec3s *direction)
{
    struct sun_job *job = host_alloc(survey->pose->scene->host, 1, sizeof *job);
    if (!job) return false;
    job->survey = survey;
    gather_samples(job);
    parallel_for(SUNS, 1, score_sun, job);
    int best = 0;
    for (int i = 1; i < SUNS; i++) {
        if (job->score[i] > job->score[best]) best = i;
    }
    bool any = job->score[best] > 0;
    if (any) *direction = sun_candidate(best);
    host_free(survey->pose->scene->host, job);
    return any;
}

struct default_lighting default_lighting(const struct scene_pose *pose)
{
    struct survey survey;
    survey_scene(&survey, pose);
    // From the camera's upper left: visible surfaces are lit, with some shading.
    vec3s right = glms_vec3_cross(survey.camera.forward, survey.camera.up);
    vec3s level = glms_vec3_cross(vec3_of(0, 1, 0), right);
    vec3s direction = glms_vec3_add(glms_vec3_scale(right, 0.7f), glms_vec3_scale(level, 0.6f));
    direction = glms_vec3_normalize(glms_vec3_add(direction, vec3_of(0, -1, 0)));
    if (survey.inside) inside_sun(&survey, &direction);
    raycast_finish(&survey.raycast);
    return (struct default_lighting){ .sun_direction = direction, .sun_lux = SUN_LUX, .sky = SKY };
}
