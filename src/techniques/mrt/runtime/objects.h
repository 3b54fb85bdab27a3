// Buffers, images and pipelines of a run time: created at once, or planned on a thread that has no
// GPU, created later and filled over frames.
#pragma once

#include "techniques/mrt/runtime/runtime.h"

// With runtime->plan the object is planned: `out` is a member of the run time, and gets its handle
// from mrt_plan_create. `desc`, `name` and `shader` are constant.
//
// A storage buffer with this content; zeros where data is NULL, 16 of them where bytes is 0.
bool mrt_buffer_of(struct mrt_runtime *runtime, const char *name, const void *data, size_t bytes,
                   gpu_buffer *out);
// The same of `count` items that `fill` writes; zeros where it is NULL.
bool mrt_table_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                      const char *name, size_t count, size_t size,
                      void (*fill)(const struct mrt_runtime_input *input, void *items),
                      gpu_buffer *out);
bool mrt_image_of(struct mrt_runtime *runtime, const struct gpu_image_desc *desc, gpu_image *out);
bool mrt_pipeline_of(struct mrt_runtime *runtime, const char *name, const struct gpu_shader *shader,
                     const struct gpu_constant *constants, int count, gpu_pipeline *out);

enum { MRT_PLAN_CONSTANTS = 8 };

struct mrt_plan_item {
    enum { MRT_PLAN_BUFFER, MRT_PLAN_IMAGE, MRT_PLAN_PIPELINE } kind;
    size_t handle; // offset in struct mrt_runtime
    const char *name;
    size_t bytes; // of a buffer
    void *data;   // its content, NULL: zeros
    struct gpu_image_desc image;
    const struct gpu_shader *shader;
    struct gpu_constant constants[MRT_PLAN_CONSTANTS];
    int constant_count;
};

struct mrt_plan {
    struct host *host;
    struct mrt_plan_item *items;
    size_t count, capacity;
    size_t item, offset; // the next byte that mrt_plan_record copies
};

// Creates all objects of a planned run time, whose gpu is set. The objects of a failure are
// destroyed with the run time.
bool mrt_plan_create(const struct mrt_plan *plan, struct mrt_runtime *runtime);
// Copies the next bytes of the content, at most `most`. Returns whether that was the rest.
bool mrt_plan_record(struct mrt_plan *plan, const struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                     size_t most);
void mrt_plan_finish(struct mrt_plan *plan); // accepts zero
