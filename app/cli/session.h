// What the commands that open a scene share: a context, the scene with the light and the camera
// that were asked for.
#pragma once

#include "arguments.h"

#include <afterglow/afterglow.h>

enum { SPEC_SIZE = 256, MAX_NOTES = 4, NOTE_SIZE = 1024 };

struct session {
    const struct arguments *arguments;
    struct ag_context *context;
    struct ag_scene *scene;
    int animation;               // for every call that asks for a moment
    char camera_name[SPEC_SIZE]; // as it is stored in results: a name, or the options that ask for
                                 // it
    bool made_up;                // the scene has no camera: this one stays, whatever moves
    struct ag_camera made_up_camera;
    char notes[MAX_NOTES][NOTE_SIZE]; // what was decided for the user, see session_say
    int note_count;
};

// What a scene gets that brings no light or no camera, as the options that ask for the same. ""
// where not needed.
struct defaults {
    char light[SPEC_SIZE]; // the value of --light
    char sky[SPEC_SIZE];   // of --sky
    char eye[SPEC_SIZE], target[SPEC_SIZE], fov[SPEC_SIZE];
    struct light_value light_value; // the same as numbers, read back from the text
    float sky_radiance[3];
    struct ag_camera camera;
};

enum status session_begin(struct session *session, const struct arguments *arguments);
// Loads the scene and finds the animation.
enum status session_load(struct session *session, const char *name);
void session_end(struct session *session); // accepts zero

// Rounded to six digits, so that the printed options and what is used are the same to the bit.
enum status defaults_light(struct session *session, struct defaults *out);
enum status defaults_camera(struct session *session, double time_s, struct defaults *out);

// Changes the scene's lights and sky as the options say; a dark scene that no option lights gets
// the default.
enum status session_light(struct session *session);
// The camera of a moment.
enum status session_camera(struct session *session, double time_s, struct ag_camera *out);
// Says which light and camera were decided on: when nothing that could fail early is left, so that
// an error stands alone.
void session_say(struct session *session);
