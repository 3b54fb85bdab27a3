// Times of the newest completed frame, of the device or of one client.
#include "gpu/vk.h"

#include <string.h>

static int copy_times(const struct frame_times *times, struct gpu_timing *out, int capacity)
{
    int count = times->count < capacity ? times->count : capacity;
    if (count > 0) memcpy(out, times->list, (size_t)count * sizeof *out);
    return count > 0 ? count : 0;
}

int gpu_frame_timings(const struct gpu *gpu, struct gpu_timing *out, int capacity)
{
    return copy_times(&gpu->times, out, capacity);
}

int gpu_client_timings(struct gpu *gpu, uint32_t number, struct gpu_timing *out, int capacity)
{
    timeline_completed_serial(gpu); // collects the times of completed frames
    const struct client *client = client_find(gpu, number);
    return client ? copy_times(&client->times, out, capacity) : 0;
}
