// GPU times of a renderer's passes over several frames; include/afterglow alone.
#ifndef AG_BENCH_PASSES_H
#define AG_BENCH_PASSES_H

#include <afterglow/afterglow.h>

enum { PASSES_MAX = 64, PASSES_MAX_FRAMES = 1000 };

struct pass_time {
    char name[48];            // as in ag_timing
    int count;                // frames with this pass
    double median_ms, p95_ms; // p95: nearest rank
};

// Renders 1 + `frames` frames and discards the first, which pays for caches and kept maps.
// 1 ≤ frames ≤ PASSES_MAX_FRAMES. *count passes, in order of their first appearance.
enum ag_result passes_measure(struct ag_renderer *renderer, const struct ag_frame_desc *frame,
                              int frames, struct pass_time out[PASSES_MAX], int *count);

// The same of several renderers, whose frames alternate: other load is that of all.
enum ag_result passes_measure_all(struct ag_renderer *const *renderers, int renderer_count,
                                  const struct ag_frame_desc *frame, int frames,
                                  struct pass_time (*out)[PASSES_MAX], int *counts);

// Renders 1 + `frames` frames with each renderer, alternating between renderers, and waits for each
// frame. After each but the first, `sample` gets the timings of renderer `index`.
typedef void (*passes_sample)(void *user, int index, const struct ag_timing *timings, int count);
enum ag_result passes_alternate(struct ag_renderer *const *renderers, int renderer_count,
                                const struct ag_frame_desc *frame, int frames, passes_sample sample,
                                void *user);

// The name of a pass within its technique: "cones" for "vct.cones" and "vct:cones=9"; NULL for
// passes of other owners.
const char *passes_stage(const char *pass, const char *gi);

// Medians of a technique's passes by stage, 0 where it lacks one: out_ms[i] is that of names[i].
void passes_of_stages(const struct pass_time *passes, int count, const char *gi,
                      const char *const *names, int name_count, double *out_ms);

// The smaller of `ms` and *least, where 0 stands for no value yet.
void passes_keep_least(double *least, double ms);

#endif
