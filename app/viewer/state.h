// The state of the viewer, for its own files.
#pragma once

#include "viewer/window/interface.h"
#include "viewer/blocks/block_edit.h"
#include "viewer/scene/edits.h"
#include "viewer/camera/gizmo.h"
#include "viewer/window/host_image.h"
#include "viewer/camera/look.h"
#include "viewer/methods/method.h"
#include "viewer/methods/pace.h"
#include "viewer/inspect/paint.h"
#include "viewer/camera/path.h"
#include "viewer/inspect/pixel.h"
#include "viewer/inspect/probe_balls.h"
#include "viewer/camera/record.h"
#include "viewer/methods/rendering.h"
#include "viewer/methods/truth.h"
#include "viewer.h"

// Frames after a change: until the image has converged, and until the reference begins again.
enum { SETTLE_FRAMES = 24, REST_FRAMES = 2 };
enum { VIEWER_PASSES = 96, VIEWER_HISTORY = 180, VIEWER_MESSAGE = 1024 };

// The part of the window that shows the image, in pixels.
struct region {
    float x0, y0, x1, y1;
};

// Milliseconds of passes, and the last frames of each for the plot.
struct times {
    int count, newest, frames; // passes; column of the newest frame; columns that are filled
    char names[VIEWER_PASSES][48];
    float ms[VIEWER_PASSES][VIEWER_HISTORY];
    float frame_ms[VIEWER_HISTORY];
    uint64_t frame; // number of the newest frame that was added
};

enum { VIEWER_OPTIONS = 1024 };

struct undo;

struct viewer {
    const struct viewer_desc *desc;
    struct window *window;
    struct gpu gpu;
    struct swapchain swapchain;
    struct ag_device *device;
    struct ag_device_info device_info;
    struct rendering main, other; // other: of a split screen, without a renderer if there is none

    struct method method, other_method;
    char gi[METHOD_SPEC], other_gi[METHOD_SPEC]; // running
    char frame_options[VIEWER_OPTIONS];          // "": those of the command line
    enum ag_tonemap tonemap;
    enum ag_metering metering; // with auto_exposure
    bool split;
    float split_at; // 0…1 of the region
    bool side_by_side;

    struct look look;
    struct ag_camera camera; // of the next frame
    int scene_camera;        // its index while it is shown unchanged; -1: not of the scene
    struct ag_camera given;  // of the command line
    bool turning, orbiting, dragging_split;
    float mouse_x, mouse_y; // pixels; in the right one of two images: the place in the left one
    bool mouse_right;       // it is in the right one
    float mouse_from_x;     // of the mouse as it moves, pixels of the window
    bool keys[512];

    bool auto_exposure;
    float exposure_ev;
    int layer;              // index of viewer_layers
    const char *debug_view; // shown in its place; NULL: none
    float scale;            // of the image
    bool playing;
    double time_s;
    struct path path;
    struct record record;
    struct edits edits;
    struct environments environments;
    char environment_file[ENVIRONMENT_PATH_SIZE]; // of the panel
    struct undo *undo;                            // NULL: out of memory
    char change[48];                              // by the user, no step of undo yet; "": none
    bool restoring;                               // changes are those of undo

    struct bake_job *bake_job;     // NULL: none runs
    struct truth *truth;           // NULL: no comparison with the reference
    struct host_image truth_image; // the newest one
    bool difference;               // shows the errors instead
    bool changed;                  // since the reference began
    bool offered;                  // the reference has the image of this method

    bool lighting; // the tab Light is shown
    struct gizmo gizmo;
    bool inspecting;     // the surface under the mouse is shown
    bool picking;        // a click waits for its frame
    bool pick_right;     // in the right one of two images
    int pick_at[2];      // pixels of the rendering
    int picked_instance; // chosen by a click; -1: none

    struct block_edit block_edit;
    struct times times;
    struct pace pace;
    char opening[1024];             // a file that the next frame opens; "": none
    bool opening_said;              // a frame has shown that
    const struct viewer_desc *next; // its scene; NULL: none
    struct pixels pixels;
    struct probe_balls probe_balls;
    struct paint paint;
    unsigned version; // of the image: viewer_touch counts it up
    bool updating;    // the newest frame lacks light that is being made
    int dirty;        // further frames to render, until what accumulates has settled
    bool quit;
    uint64_t frame;               // frames of the window so far
    float frame_s;                // smoothed duration of a frame of the window
    char message[VIEWER_MESSAGE]; // shown in the status line
    double message_until_s;
    bool message_warns;
    char screenshot[1024]; // to be written with the next frame; "": none
    bool screenshot_failed;
    char file[512]; // of the button "Save image"
    char session[512];
    char scene_file[1024];
    float budget_ms; // line in the plot of times
    int show_tab;    // to be shown by the next frame; -1: the user's
    struct script *script;
};
