// What stands behind the public handles, and what every public function does at its door: check the
// caller's arguments, forward, turn the module's failure into an ag_result.
#pragma once

#include <afterglow/afterglow.h>

#include "core/host.h"
#include "scene/pose.h"

#include <math.h>

enum { API_MESSAGE_SIZE = 1024 };

struct ag_context {
    struct host host; // what the modules get; its user is this context
    void (*log)(void *user, enum ag_log_level level, const char *message);
    void *(*reallocate)(void *user, void *old, size_t bytes);
    void *user;
    enum ag_log_level log_up_to;
    bool validation;        // AFTERGLOW_VALIDATION
    char *shader_dir;       // AFTERGLOW_SHADER_DIR, NULL: embedded shaders
    bool warned_layer_name; // a former layer name was used
    char last_error[API_MESSAGE_SIZE];
};

struct gpu;
struct ag_device {
    struct ag_context *context;
    struct gpu *gpu;
    bool adopted;
};

struct ag_scene {
    struct ag_context *context;
    struct scene *scene;
    struct scene_pose pose; // for questions about a moment; zero until the first
    uint64_t version;       // counts changes of the scene
    uint64_t pose_version;  // the version that `pose` was made for
    int renderers;          // that use the scene
};

// Makes `pose` the scene's at a moment: from scratch where *pose_version is not the scene's. False:
// out of memory.
bool api_pose_at(const struct ag_scene *scene, struct scene_pose *pose, uint64_t *pose_version,
                 int animation, double time_s);
// The index that pose_update takes: 0 stands for the first animation, if there is one.
bool api_animation_exists(const struct ag_scene *scene, int animation);

// AG_OK, or what the last failure means to the caller.
enum ag_result api_done(struct ag_context *context, bool ok);
// Logs "cannot call <function>: <why>" where there is a context; returns AG_ERROR_ARGUMENT.
enum ag_result api_refuse(struct ag_context *context, const char *function, const char *why, ...)
    __attribute__((format(printf, 3, 4)));

// At the door of every function: returns AG_ERROR_ARGUMENT unless the condition holds. `context`
// may be NULL.
#define AG_REQUIRE(context, condition, ...)                                                        \
    AG_REQUIRE_FOR(__func__, context, condition, __VA_ARGS__)
// The same in a part of a public function, which the message names.
#define AG_REQUIRE_FOR(function, context, condition, ...)                                          \
    do {                                                                                           \
        if (!(condition)) return api_refuse((context), (function), __VA_ARGS__);                   \
    } while (0)

// Forward and up, unit and orthogonal; where the camera's up says nothing, any.
struct world_camera api_camera(const struct ag_camera *camera);
enum ag_result api_camera_check(struct ag_context *context, const char *function,
                                const struct ag_camera *camera);

// Hands a finished image over to the caller; takes *image in any case.
struct image;
enum ag_result api_give_image(struct ag_context *context, bool ok, struct image *image,
                              struct ag_image **out);

// Reference layers keep their former names for one release; each context warns once.
const char *api_layer_name(struct ag_context *context, const char *name); // the present name
// exr_read by either name of a layer, from files that have either.
bool api_read_layer(struct ag_context *context, const char *path, const char *layer,
                    struct image *out);

static inline bool api_finite(const float *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i])) return false;
    return true;
}

static inline bool api_finite_at_least(const float *values, int count, float least)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i]) || values[i] < least) return false;
    return true;
}

static inline vec3s api_vec3(const float v[3])
{
    return vec3_of(v[0], v[1], v[2]);
}

static inline void api_store(float out[3], vec3s v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}
