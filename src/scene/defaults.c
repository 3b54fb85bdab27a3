// A camera and a sun for scenes that bring none.
//
// Both start from a survey of the scene by rays: does geometry surround its middle? If so it is a
// place, and the camera stands in it; if not it is a thing, and the camera stands before it. All
// lengths are relative to the bounds, so that a scene in other units than metres works as well.
// Where memory is short, the view from outside serves.
#include "scene/defaults.h"

#include "scene/raycast.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>

static const float OUTSIDE_FOV = 0.7853982f; // 45°
static const float INSIDE_FOV = 1.0471976f;  // 60°

// A daylight sun at the top of its usual range, and a faint, clear sky: a few hundredths of the
// sun's light, enough for a closed-off corner not to be black while the sun's own indirect light
// prevails.
static const vec3s SUN_LUX = { { 100000.0f, 95000.0f, 88000.0f } };
static const vec3s SKY = { { 600.0f, 750.0f, 1000.0f } };

enum { MIDDLE_ACROSS = 5, MIDDLE_HEIGHTS = 3 };
enum { MIDDLE_POINTS = MIDDLE_ACROSS * MIDDLE_ACROSS * MIDDLE_HEIGHTS };

struct survey {
    const struct scene_pose *pose;
    struct raycast raycast;
    bool has_rays;
    float diagonal;
    vec3s middle[MIDDLE_POINTS]; // points around the middle that are in a room
    int middle_count;
    float storey; // height in the bounds, 0…1, at which most of the lowest such points are
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

bool scene_is_dark(const struct scene *scene)
{
    return scene->light_count == 0 && luminance(scene->sky) <= 0.0f && !scene_has_emission(scene);
}

// A point of the bounds, each coordinate from 0 to 1.
static vec3s in_bounds(const struct survey *survey, float x, float y, float z)
{
    struct box3 bounds = survey->pose->bounds;
    vec3s size = box3_size(bounds);
    return vec3_of(bounds.min.x + x * size.x, bounds.min.y + y * size.y, bounds.min.z + z * size.z);
}

// What rays in all directions from one point meet.
struct outlook {
    float front, back; // fractions that meet surfaces facing the point, or facing away from it
    float mean, least; // distance to what they meet
};

enum { OUTLOOK_RAYS = 64 };

static struct outlook look_around(const struct survey *survey, vec3s eye)
{
    struct outlook outlook = { .least = INFINITY };
    int met = 0;
    for (uint32_t i = 0; i < OUTLOOK_RAYS; i++) {
        vec3s direction = sample_sphere(r2_sequence(i));
        struct raycast_hit hit;
        if (!raycast_closest(&survey->raycast, eye, direction, INFINITY, &hit)) continue;
        met++;
        outlook.mean += hit.distance;
        outlook.least = fminf(outlook.least, hit.distance);
        if (hit.front) {
            outlook.front += 1.0f / OUTLOOK_RAYS;
        } else {
            outlook.back += 1.0f / OUTLOOK_RAYS;
        }
    }
    if (met > 0) outlook.mean /= (float)met;
    return outlook;
}

// A point of a room: most of what it sees faces it, and hardly anything turns its back, as a solid
// would from within.
static bool is_in_room(const struct outlook *outlook)
{
    return outlook->front > 0.6f && outlook->back < 0.15f;
}

// Whether geometry surrounds the middle: whether at least half of a block of points there, the
// middle two fifths in each horizontal direction at several heights, are in a room. Hollow things
// have fewer, rooms more. Keeps those points.
static bool is_surrounded(struct survey *survey)
{
    int in_storey[MIDDLE_HEIGHTS] = { 0 };
    survey->middle_count = 0;
    for (int i = 0; i < MIDDLE_POINTS; i++) {
        float x = 0.3f + 0.1f * (float)(i % MIDDLE_ACROSS);
        float z = 0.3f + 0.1f * (float)(i / MIDDLE_ACROSS % MIDDLE_ACROSS);
        float y = 0.2f + 0.2f * (float)(i / (MIDDLE_ACROSS * MIDDLE_ACROSS));
        vec3s point = in_bounds(survey, x, y, z);
        struct outlook outlook = look_around(survey, point);
        if (!is_in_room(&outlook)) continue;
        survey->middle[survey->middle_count++] = point;
        in_storey[i / (MIDDLE_ACROSS * MIDDLE_ACROSS)]++;
    }
    int lowest = 0;
    while (lowest + 1 < MIDDLE_HEIGHTS && 2 * in_storey[lowest] < MIDDLE_ACROSS * MIDDLE_ACROSS) {
        lowest++;
    }
    survey->storey = 0.2f + 0.2f * (float)lowest;
    return 2 * survey->middle_count > MIDDLE_POINTS;
}

// How much of the middle is to be seen from a place: nothing from a hollow wall or a room beside.
static float middle_in_view(const struct survey *survey, vec3s eye)
{
    int seen = 0;
    for (int i = 0; i < survey->middle_count; i++) {
        vec3s towards = glms_vec3_sub(survey->middle[i], eye);
        seen += !raycast_blocked(&survey->raycast, eye, towards, 1.0f);
    }
    return (float)seen / (float)survey->middle_count;
}

// Where the view from outside comes from: before the scene (+z, as glTF has it), to the right and
// above.
static const vec3s THREE_QUARTER = { { 0.55f, 0.42f, 1.0f } };

// Far enough for all corners of the bounds to be in a square picture.
static struct world_camera outside_camera(const struct scene_pose *pose)
{
    float near_m = default_near(pose);
    if (box3_is_empty(pose->bounds)) {
        return camera_look_at(vec3_of(0, 0, 3), vec3_of(0, 0, 0), OUTSIDE_FOV, near_m);
    }
    vec3s centre = box3_centre(pose->bounds), back = glms_vec3_normalize(THREE_QUARTER);
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
    distance = fmaxf(margin * distance, 10.0f * near_m); // a scene of a single point has no size
    camera.eye = glms_vec3_muladds(back, distance, centre);
    return camera;
}

// Eye height over a floor with so much air above it: a person's in a room of a size that metres
// make sense for, else a third of the air.
static float eye_height(float clear_height)
{
    bool human = clear_height > 1.9f && clear_height < 60.0f;
    return human ? fminf(1.7f, 0.6f * clear_height) : 0.35f * clear_height;
}

enum { COMPASS = 64, PLACES = 13 };

// A place to stand and the best direction to look from there.
struct stand {
    bool usable;
    vec3s eye, forward;
    float score, clear_height;
};

// Clear distances all around at eye height. A ray that leaves the scene sees nothing worth showing
// and counts as the nearest thing would; one that meets a surface from behind is in something's
// inside.
static bool look_along_horizon(const struct survey *survey, vec3s eye, float *clear)
{
    int behind = 0;
    for (int i = 0; i < COMPASS; i++) {
        float angle = 2.0f * GLM_PIf * (float)i / COMPASS;
        struct raycast_hit hit;
        clear[i] = 0.0f;
        if (!raycast_closest(&survey->raycast, eye, vec3_of(cosf(angle), 0, sinf(angle)), INFINITY,
                             &hit)) {
            continue;
        }
        clear[i] = hit.distance;
        behind += !hit.front;
        if (hit.distance < 0.015f * survey->diagonal) return false;
    }
    return 4 * behind < COMPASS;
}

// The best of all directions: a long view that is open to both sides, too. Half of its worth is the
// view itself, half the mean of the fan of 45 degrees around it; and a place in a wide hall is
// worth more than one in a narrow aisle.
static void choose_direction(const float *clear, const struct outlook *outlook, struct stand *stand)
{
    const int fan = COMPASS / 16;
    for (int i = 0; i < COMPASS; i++) {
        float sum = 0.0f;
        for (int k = -fan; k <= fan; k++) sum += clear[(i + k + COMPASS) % COMPASS];
        float score = 0.5f * clear[i] + 0.5f * sum / (float)(2 * fan + 1);
        score *= sqrtf(outlook->mean);
        if (score <= stand->score) continue;
        float angle = 2.0f * GLM_PIf * (float)i / COMPASS;
        stand->score = score;
        // Raised a little where there is much air above, so that a hall's height is seen.
        float rise = 0.1f * fminf(stand->clear_height / fmaxf(clear[i], 1e-20f), 1.5f);
        stand->forward = glms_vec3_normalize(vec3_of(cosf(angle), rise, sinf(angle)));
    }
}

// Drops from mid-height onto the floor below (x, z) of the bounds and looks from eye height above
// it.
static struct stand stand_at(const struct survey *survey, float x, float z)
{
    struct stand stand = { 0 };
    vec3s middle = in_bounds(survey, x, survey->storey, z);
    struct raycast_hit floor, ceiling;
    if (!raycast_closest(&survey->raycast, middle, vec3_of(0, -1, 0), INFINITY, &floor) ||
        !floor.front) {
        return stand;
    }
    float above = survey->pose->bounds.max.y - middle.y;
    if (raycast_closest(&survey->raycast, middle, vec3_of(0, 1, 0), INFINITY, &ceiling)) {
        if (!ceiling.front) return stand;
        above = ceiling.distance;
    }
    stand.clear_height = floor.distance + above;
    stand.eye = middle;
    stand.eye.y += eye_height(stand.clear_height) - floor.distance;
    float clear[COMPASS];
    struct outlook outlook = look_around(survey, stand.eye);
    stand.usable = is_in_room(&outlook) && outlook.least > 0.01f * survey->diagonal &&
                   look_along_horizon(survey, stand.eye, clear);
    if (stand.usable) choose_direction(clear, &outlook, &stand);
    // A quarter of the middle is as good as all of it: the far end of a long room sees no more.
    stand.score *= fminf(4.0f * middle_in_view(survey, stand.eye), 1.0f);
    return stand;
}

struct stand_job {
    const struct survey *survey;
    struct stand stands[PLACES * PLACES];
};

static void try_stand(void *user, size_t i)
{
    struct stand_job *job = user;
    // From 6% to 94% of the bounds.
    float x = 0.06f + 0.88f * (float)(i % PLACES) / (float)(PLACES - 1);
    float z = 0.06f + 0.88f * (float)(i / PLACES) / (float)(PLACES - 1);
    job->stands[i] = stand_at(job->survey, x, z);
}

// The place with the longest view; false where there is none to stand on.
static bool inside_camera(struct survey *survey)
{
    struct stand_job job = { .survey = survey };
    parallel_for(PLACES * PLACES, 4, try_stand, &job);
    const struct stand *best = NULL;
    for (int i = 0; i < PLACES * PLACES; i++) {
        const struct stand *stand = &job.stands[i];
        if (stand->usable && stand->score > 0.0f && (!best || stand->score > best->score)) {
            best = stand;
        }
    }
    if (!best) return false;
    survey->camera = camera_look_at(best->eye, glms_vec3_add(best->eye, best->forward), INSIDE_FOV,
                                    default_near(survey->pose));
    return true;
}

static void survey_scene(struct survey *survey, const struct scene_pose *pose)
{
    *survey = (struct survey){ .pose = pose, .diagonal = bounds_diagonal(pose) };
    survey->camera = outside_camera(pose);
    if (box3_is_empty(pose->bounds)) return;
    survey->has_rays = raycast_init(&survey->raycast, pose->scene->host, pose);
    if (!survey->has_rays) return;
    survey->inside = is_surrounded(survey) && inside_camera(survey);
}

struct world_camera default_camera(const struct scene_pose *pose)
{
    struct survey survey;
    survey_scene(&survey, pose);
    raycast_finish(&survey.raycast);
    return survey.camera;
}

// A visible piece of surface; its normal faces who sees it.
struct sample {
    vec3s position, normal;
};

enum { SAMPLES = 1024, ELEVATIONS = 5, AZIMUTHS = 24, SUNS = ELEVATIONS * AZIMUTHS };

struct sun_job {
    const struct survey *survey;
    struct sample samples[SAMPLES];
    int sample_count;
    int worth[SUNS];
};

static void add_sample(struct sun_job *job, vec3s eye, vec3s direction)
{
    struct raycast_hit hit;
    const struct survey *survey = job->survey;
    if (!raycast_closest(&survey->raycast, eye, direction, INFINITY, &hit)) return;
    vec3s normal = hit.front ? hit.normal : glms_vec3_negate(hit.normal);
    vec3s position = glms_vec3_muladds(direction, hit.distance, eye);
    // Off the surface, so that a ray to the sun does not meet it again.
    position = glms_vec3_muladds(normal, 1e-4f * survey->diagonal, position);
    job->samples[job->sample_count++] = (struct sample){ position, normal };
}

// Half of the samples are what the camera sees, half what is to be seen all around from five places
// on its way.
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

// The way the light of candidate `i` shines: elevations of 35 to 75 degrees, azimuths all around.
static vec3s sun_candidate(int i)
{
    float elevation = glm_rad(35.0f + 10.0f * (float)(i / AZIMUTHS));
    float azimuth = 2.0f * GLM_PIf * ((float)(i % AZIMUTHS) + 0.5f) / AZIMUTHS;
    return vec3_of(cosf(elevation) * cosf(azimuth), -sinf(elevation),
                   cosf(elevation) * sinf(azimuth));
}

// Worth is the number of samples lit, and twice the smaller of those on level and on upright
// surfaces once more: a floor and a wall in the sun tell more about a room, and light it from more
// sides, than the floor alone.
static void weigh_sun(void *user, size_t i)
{
    struct sun_job *job = user;
    vec3s towards = glms_vec3_negate(sun_candidate((int)i));
    const float grazing = 0.15f; // hardly any light arrives at a lower cosine
    int lit[2] = { 0, 0 };
    for (int s = 0; s < job->sample_count; s++) {
        const struct sample *sample = &job->samples[s];
        if (glms_vec3_dot(sample->normal, towards) < grazing) continue;
        if (raycast_blocked(&job->survey->raycast, sample->position, towards, INFINITY)) continue;
        lit[sample->normal.y > 0.7f]++;
    }
    int smaller = lit[0] < lit[1] ? lit[0] : lit[1];
    job->worth[i] = lit[0] + lit[1] + 2 * smaller;
}

// The candidate of the greatest worth. False where none lights anything.
static bool inside_sun(const struct survey *survey, vec3s *direction)
{
    struct sun_job *job = host_alloc(survey->pose->scene->host, 1, sizeof *job);
    if (!job) return false;
    job->survey = survey;
    gather_samples(job);
    parallel_for(SUNS, 1, weigh_sun, job);
    int best = 0;
    for (int i = 1; i < SUNS; i++) {
        if (job->worth[i] > job->worth[best]) best = i;
    }
    bool any = job->worth[best] > 0;
    if (any) *direction = sun_candidate(best);
    host_free(survey->pose->scene->host, job);
    return any;
}

struct default_lighting default_lighting(const struct scene_pose *pose)
{
    struct survey survey;
    survey_scene(&survey, pose);
    // From the viewer's upper left, so that what is seen is lit and still has a shaded side.
    vec3s right = glms_vec3_cross(survey.camera.forward, survey.camera.up);
    vec3s level = glms_vec3_cross(vec3_of(0, 1, 0), right);
    vec3s direction = glms_vec3_add(glms_vec3_scale(right, 0.7f), glms_vec3_scale(level, 0.6f));
    direction = glms_vec3_normalize(glms_vec3_add(direction, vec3_of(0, -1, 0)));
    if (survey.inside) inside_sun(&survey, &direction);
    raycast_finish(&survey.raycast);
    return (struct default_lighting){ .sun_direction = direction, .sun_lux = SUN_LUX, .sky = SKY };
}
