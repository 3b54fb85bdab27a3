// A frame in flight of a program: its command buffer, and the fence that tells its end.
#ifndef HOST_FRAME_H
#define HOST_FRAME_H

#include "host_device.h"

struct host_frame {
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence;
};
void host_frame_create(const struct host_device *host, struct host_frame *out);
void host_frame_destroy(const struct host_device *host, const struct host_frame *frame);
void host_frame_begin(const struct host_frame *frame);
// Ends the command buffer and submits it.
void host_frame_submit(const struct host_device *host, const struct host_frame *frame);
// Waits until the GPU has executed what was submitted.
void host_frame_wait(const struct host_device *host, const struct host_frame *frame);

#endif
