// afterglow view: a window in which a scene is looked at and lit, and methods are chosen, compared
// and measured. It uses the library as any other program does.
#pragma once

#include <afterglow/afterglow.h>

enum { VIEWER_RECENT = 10 };

struct viewer_desc {
    struct ag_context *context;
    struct ag_scene *scene; // lit; the viewer changes it
    const char *scene_name; // as on the command line
    const char *gi, *frame_options, *device;
    const char *scene_words;  // options of the command line that load the scene so, a blank first
    const char *light_words;  // likewise those that light it,
    const char *kept_words;   // those of them that stay when lights change,
    const char *environment;  // the value of --environment without its use; "": none,
    const char *camera_words; // and those of its camera
    struct ag_camera camera;
    int animation;
    double time_s;
    bool has_exposure;
    float exposure_ev;
    enum ag_tonemap tonemap;   // that of frame_options
    enum ag_metering metering; // likewise
    int width, height;         // of the window
    float scale;               // of the image's width and height; 0: chosen by the device
    const char *split;         // a GI spec or "reference" to compare with; NULL: none
    const char *session;       // a file to begin with, see session_file.h; NULL: none
    const char *script;        // a file, see script/script.h; NULL: none
    const char *screenshot;    // a .png of the last frame's window; NULL: none
    int frames;                // ends after N; 0: when the window is closed
    bool validate;             // with the validation layers
    int recent_count;          // scenes that were opened lately, the newest first
    const char *recent[VIEWER_RECENT];
    void *user; // of the functions
    // Writes the newest frame of a renderer as afterglow render does; false: see the last error.
    bool (*write)(void *user, struct ag_renderer *renderer, enum ag_tonemap curve,
                  const char *layer, const char *path);
    // On any thread: another context, with the scene as it was loaded and lit at first.
    bool (*open_copy)(void *user, struct ag_context **context, struct ag_scene **scene,
                      char error[512]);
    // On any thread: where the bake with that key is kept; false: nowhere, with a sentence.
    bool (*bake_path)(void *user, const char *key, char path[4096], char error[512]);
    // Another scene, or the scene of a session file, with this method; NULL: with a sentence. Its
    // description and the present one stay valid until the next call.
    const struct viewer_desc *(*open_scene)(void *user, const char *path, const char *gi,
                                            char error[512]);
    // Writes a text file, completely or not at all; false: with a sentence.
    bool (*write_text)(void *user, const char *path, const char *text, char error[512]);
};

// False with a sentence in `error`: no display, no device, or a file that cannot be used.
bool viewer_run(const struct viewer_desc *desc, char error[1024]);
