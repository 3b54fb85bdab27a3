// The path tracer at work, as reference and compare use it: begun as the options say, until there
// are enough samples or Ctrl-C, into an EXR that can be gone on with.
#pragma once

#include "output.h"

struct tracing {
    struct session *session;
    struct ag_reference *reference;
    int wanted;      // samples per pixel, those of the file that was gone on with among them
    int begun, done; // samples of that file; by now
    double seconds;  // spent in rendering by this run
};

// The layers of an EXR that can be gone on with, and color.
extern const char tracing_kept_layers[];

// The scene is loaded and lit; its reference has no sample yet.
enum status tracing_begin(struct tracing *tracing, struct session *session,
                          const struct ag_camera *camera, int wanted);
void tracing_end(struct tracing *tracing); // accepts zero
// Goes on from a file of the same image.
enum ag_result tracing_resume(struct tracing *tracing, const char *path);

// Puts down what there is.
struct tracing_keeper {
    enum status (*keep)(void *user); // NULL: nobody does
    void *user;
    double every_s;
    bool first; // also after the first samples
};
// Renders with a bar. The keeper comes now and then and in the end, if the first Ctrl-C ends the
// work, too; then done is less than wanted. A second one ends the program.
enum status tracing_converge(struct tracing *tracing, const struct tracing_keeper *keeper);

// An EXR of these layers; its attributes say how it was made, `more` adds some.
enum ag_result tracing_write_exr(const struct tracing *tracing, const struct output *output,
                                 const char *path, const struct ag_attribute *more, int more_count);
