// Path tracing for reference and compare: set up from the options, until there are enough samples
// or Ctrl-C, written to a resumable EXR.
#pragma once

#include "output.h"

struct tracing {
    struct session *session;
    struct ag_reference *reference;
    int wanted;      // samples per pixel, including resumed ones
    int begun, done; // resumed samples; current samples
    double seconds;  // rendering time of this run
    float fov_rad;   // vertical, of the camera
};

// Layers of a resumable EXR, and color.
extern const char tracing_kept_layers[];

// Main memory of tracing and of writing that many layers.
uint64_t tracing_bytes_per_pixel(int layer_count);
// Requires a loaded and lit scene. The reference has no samples yet.
enum status tracing_begin(struct tracing *tracing, struct session *session,
                          const struct ag_camera *camera, int wanted);
// The reference of the options; camera: of the session.
struct ag_reference_desc tracing_describe(const struct session *session,
                                          const struct ag_camera *camera);
// Takes over a reference that has all samples already.
void tracing_take(struct tracing *tracing, struct session *session, const struct ag_camera *camera,
                  struct ag_reference *reference, double seconds);
void tracing_end(struct tracing *tracing); // accepts zero
// Loads the samples of a checkpoint.
enum ag_result tracing_resume(struct tracing *tracing, const char *path);
// The options that differ between a file and this run, as text with the file's values:
// "--seed 5, --size 32x24"; false where the file's attributes tell none.
bool tracing_differences(const struct tracing *t, const char *path, char out[SPEC_SIZE]);

// Writes the samples so far.
struct tracing_keeper {
    enum status (*keep)(void *user); // NULL: none
    void *user;
    double every_s;
    bool first; // also call it after the first step
};
// Renders with a progress bar. Calls the keeper at intervals and at the end, also after the first
// Ctrl-C (then done < wanted). A second Ctrl-C ends the program.
enum status tracing_converge(struct tracing *tracing, const struct tracing_keeper *keeper);

// Writes an EXR of these layers; attributes record how it was made, `more` adds some.
enum ag_result tracing_write_exr(const struct tracing *tracing, const struct output *output,
                                 const char *path, const struct ag_attribute *more, int more_count);
