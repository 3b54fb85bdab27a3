// Shared by commands that open a scene: context, scene, light and camera.
#pragma once

#include "arguments.h"

#include <afterglow/afterglow.h>

enum { SPEC_SIZE = 256, MAX_NOTES = 5, NOTE_SIZE = 1024, LIGHT_SIZE = 4096 };

struct session {
    const struct arguments *arguments;
    struct ag_context *context;
    struct ag_scene *scene;
    struct ag_environment *environment; // of the option; NULL: none
    const char *name;                   // of the scene, as given to session_load
    int animation;                      // index for API calls
    char camera_name[SPEC_SIZE];        // in results: a name, or the options for it
    char light[LIGHT_SIZE];             // in results: the options for it; "": that of the scene
    bool made_up_light;                 // the scene has none
    bool made_up;                       // the scene has no camera; the generated one stays fixed
    struct ag_camera made_up_camera;
    char notes[MAX_NOTES][NOTE_SIZE]; // about default light and camera, see session_say
    int note_count;
};

// Default light and camera of a scene without, as option values; "" if not needed.
struct defaults {
    char light[SPEC_SIZE]; // the value of --light
    char sky[SPEC_SIZE];   // of --sky
    char eye[SPEC_SIZE], target[SPEC_SIZE], fov[SPEC_SIZE];
    struct light_value light_value; // parsed from the text
    float sky_radiance[3];
    struct ag_camera camera;
};

enum status session_begin(struct session *session, const struct arguments *arguments);
// Loads the scene and finds the animation. scale: metres per unit of its file.
enum status session_load(struct session *session, const char *name, float scale);
void session_end(struct session *session); // accepts zero

// Values are rounded to six digits, so that printed options give identical results.
enum status defaults_light(struct session *session, struct defaults *out);
enum status defaults_camera(struct session *session, double time_s, struct defaults *out);

// Applies the options for lights and sky; a scene without light gets the defaults.
enum status session_light(struct session *session);
// The camera at a time.
enum status session_camera(struct session *session, double time_s, struct ag_camera *out);
// The longest side of the scene, m; 0 before it is loaded.
float session_scene_size_m(const struct session *session);
// Prints the notes about default light and camera. Call it after everything that can fail early,
// so that an error is the only line.
void session_say(struct session *session);
