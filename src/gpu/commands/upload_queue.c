// The upload queue: a caller's second queue, for uploads that do not wait for frames in flight.
//
// It takes objects that no recording for the main queue has used, so nothing in flight accesses
// them. Memory that they reuse was freed after the host knew that the GPU had completed its last
// use, and the completion made all writes available. Excluded are images whose memory or content
// others may be using: those with an alias, and those that the caller shares.
//
// The main queue waits for the timeline semaphore of the uploads before the next commands. The host
// has waited for it too, but only the wait of the queue makes the writes visible to its commands.
// The wait covers all stages: a later barrier after the upload's stage (hazard.c) continues the
// dependency. Both queues are of one family, so images keep layout and content without a transfer
// of ownership.
#include "gpu/vk.h"

bool upload_queue_takes_image(const struct gpu *gpu, const struct image *image)
{
    return gpu->upload_queue.handle && !image->used && !image->shared && !image->alias;
}

bool upload_queue_takes_buffer(const struct gpu *gpu, const struct buffer *buffer)
{
    return gpu->upload_queue.handle && !buffer->used;
}

bool upload_queue_is_ahead(const struct gpu *gpu)
{
    return gpu->upload_queue.submitted > gpu->joined;
}
