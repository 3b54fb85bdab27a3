// The structs behind public handles and the steps of every public function: check arguments, call
// the module, convert its failure into an ag_result.
#pragma once

#include <afterglow/afterglow.h>

#include "api/lifetime.h"
#include "core/host.h"
#include "scene/pose.h"

#include <math.h>

enum { API_MESSAGE_SIZE = 1024 };

struct ag_context {
    struct host host; // passed to the modules; its user is this context
    void (*log)(void *user, enum ag_log_level level, const char *message);
    void *(*reallocate)(void *user, void *old, size_t bytes);
    void *user;
    enum ag_log_level log_up_to;
    bool validation;        // AFTERGLOW_VALIDATION
    char *no_links_in;      // of the host
    char *shader_dir;       // AFTERGLOW_SHADER_DIR, NULL: embedded shaders
    char *importer;         // path of the importer program, NULL: none
    bool warned_layer_name; // a former layer name was used
    struct lifetime life;   // its users are all objects that have no other owner
    char last_error[API_MESSAGE_SIZE];
};

struct gpu;
struct ag_device {
    struct ag_context *context;
    struct gpu *gpu;
    bool adopted;
    struct ag_memory_callbacks memory; // zero: none
    struct lifetime life;              // its users are renderers and preparations
};

struct ag_scene {
    struct ag_context *context;
    struct scene *scene;
    struct scene_pose pose; // for queries at a moment; zero until the first
    struct moment {
        bool valid;
        uint64_t revision; // of the scene
        int animation;
        double time_s;
    } pose_moment;                        // of `pose`
    struct named_camera *cameras_by_name; // sorted; NULL until the first lookup
    struct lifetime life;
    int renderers, references, bakes; // its users; light maps count as bakes
};

// Objects that a context is the owner of: it stays until they are gone.
void api_context_use(struct ag_context *context);
void api_context_release(struct ag_context *context);
// Whether blocks of the one may be freed through the other.
bool api_same_memory(const struct ag_context *a, const struct ag_context *b);
// A user of the device has gone.
void api_device_release(struct ag_device *device);
// `users`: the member of the scene that counts users of that kind.
void api_scene_use(struct ag_scene *scene, int *users);
void api_scene_release(struct ag_scene *scene, int *users);

// The path of the importer program, owned by the caller; NULL: not found, or out of memory.
char *api_find_importer(struct host *host);

// Updates `pose` to a moment and to the changes of the scene; a zeroed one is created. False: out
// of memory, or beyond the limits of scene/limits.h.
bool api_pose_at(const struct ag_scene *scene, struct scene_pose *pose, int animation,
                 double time_s);
// Adds a light; `name` is a literal.
enum ag_result api_add_light(struct ag_scene *scene, const struct ag_light_desc *desc,
                             const char *name);
// Valid indices: -1 (rest pose), 0 (first animation, if any) and those of the scene.
bool api_animation_exists(const struct ag_scene *scene, int animation);

// AG_OK, or the ag_result for the host's last failure.
enum ag_result api_done(struct ag_context *context, bool ok);
// Logs "cannot call <function>: <why>" if there is a context; returns AG_ERROR_ARGUMENT.
enum ag_result api_refuse(struct ag_context *context, const char *function, const char *why, ...)
    __attribute__((format(printf, 3, 4)));

// Argument check of a public function: returns AG_ERROR_ARGUMENT unless the condition holds.
// `context` may be NULL.
#define AG_REQUIRE(context, condition, ...)                                                        \
    AG_REQUIRE_FOR(__func__, context, condition, __VA_ARGS__)
// The same in a helper; the message names the public `function`.
#define AG_REQUIRE_FOR(function, context, condition, ...)                                          \
    do {                                                                                           \
        if (!(condition)) return api_refuse((context), (function), __VA_ARGS__);                   \
    } while (0)

// Members that this version of the library does not know.
#define API_UNKNOWN_MEMBERS                                                                        \
    "reserved members are not 0: ag_..._desc_default was not called, or the program needs a "      \
    "newer library"
#define AG_REQUIRE_KNOWN(function, context, desc)                                                  \
    AG_REQUIRE_FOR((function), (context),                                                          \
                   api_zero((desc)->reserved, sizeof(desc)->reserved / sizeof *(desc)->reserved),  \
                   API_UNKNOWN_MEMBERS)
#define AG_REQUIRE_POINTER(context, pointer) AG_REQUIRE(context, pointer, #pointer " is NULL")
// For functions that create an object: *out is NULL unless they succeed.
#define AG_REQUIRE_OUT(context, out)                                                               \
    do {                                                                                           \
        AG_REQUIRE_POINTER(context, out);                                                          \
        *(out) = NULL;                                                                             \
    } while (0)

// The first camera of that name, -1: none. False: out of memory.
bool api_find_camera(struct ag_scene *scene, const char *name, int *index);

// forward and up become orthonormal; up is arbitrary if the camera's is parallel to forward.
struct world_camera api_camera(const struct ag_camera *camera);
enum ag_result api_camera_check(struct ag_context *context, const char *function,
                                const struct ag_camera *camera);

// Passes an image to the caller if `ok`; takes ownership of *image in any case.
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

static inline bool api_in_unit_range(const float *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!(values[i] >= 0.0f && values[i] <= 1.0f)) return false;
    return true;
}

static inline bool api_zero(const uint64_t *words, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (words[i]) return false;
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
