// Buffers, images and pipelines of a run time: created at once, or planned on a thread that has no
// GPU, created later and filled over frames.
#pragma once

#include "techniques/mrt/runtime/runtime.h"

// `out` is a member of the run time, and the object gets a row of runtime->objects. With
// runtime->plan it is planned: it is created with the others of the table. `desc`, `name` and
// `shader` are constant.
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
bool mrt_sampler_of(struct mrt_runtime *runtime, const char *name, gpu_sampler *out);
// Rows of runtime->objects.constants: those of MRT_CONSTANT_…, and these.
enum { MRT_CONSTANT_ROW_VECTOR = MRT_CONSTANT_OUTDOORS + 1, MRT_CONSTANT_ROW_BACKS };
// constants: bits of these rows.
bool mrt_pipeline_of(struct mrt_runtime *runtime, const char *name, const struct gpu_shader *shader,
                     uint32_t constants, gpu_pipeline *out);

struct mrt_plan {
    struct host *host;
    char *data[GPU_MAX_OBJECTS]; // content of runtime->objects; NULL: zeros
    int item;                    // the next byte that mrt_plan_record copies
    size_t offset;
};

// Copies the next bytes of the content, at most `most`. Returns whether that was the rest.
bool mrt_plan_record(struct mrt_plan *plan, const struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                     size_t most);
void mrt_plan_finish(struct mrt_plan *plan); // accepts zero
