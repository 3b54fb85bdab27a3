// Numbers of finished frames: exposure, times, memory.
#include "api/renderer/state.h"

#include "gpu/gpu.h"

#include <string.h>

enum { MAX_PASSES = 128, MAX_OWNERS = 128 };

enum ag_result ag_renderer_exposure(struct ag_renderer *r, float *ev)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    AG_REQUIRE_POINTER(context, ev);
    *ev = 0.0f;
    AG_REQUIRE(context, r->main.rendered, "no frame has been rendered");
    enum ag_result waited = ag_renderer_wait(r);
    if (waited != AG_OK) return waited;
    return api_done(context, frame_exposure(r->main.frame, ev));
}

// The first entries of a list of the layer below, whose structs have the layout of the public ones.
#define SAME_LAYOUT(ours, theirs, name, value)                                                     \
    _Static_assert(sizeof(struct ours) == sizeof(struct theirs) &&                                 \
                       offsetof(struct ours, name) == offsetof(struct theirs, name) &&             \
                       offsetof(struct ours, value) == offsetof(struct theirs, value),             \
                   "entries are copied whole")
SAME_LAYOUT(ag_timing, gpu_timing, name, ms);
SAME_LAYOUT(ag_memory, gpu_memory, owner, bytes);

static int copy_entries(void *out, int capacity, const void *entries, int count, size_t entry_bytes)
{
    const int copied = count < capacity ? count : capacity;
    if (copied > 0) memcpy(out, entries, (size_t)copied * entry_bytes);
    return count;
}

static int finished_timings(const struct ag_renderer *r, struct ag_timing *out, int capacity)
{
    struct gpu_timing timings[MAX_PASSES];
    const int count = gpu_client_timings(r->device->gpu, r->client, timings, MAX_PASSES);
    return copy_entries(out, capacity, timings, count, sizeof *out);
}

int ag_renderer_timings(struct ag_renderer *r, struct ag_timing *out, int capacity)
{
    if (!r || capacity < 0 || (!out && capacity > 0)) return 0;
    if (!r->main.rendered || ag_renderer_wait(r) != AG_OK) return 0;
    return finished_timings(r, out, capacity);
}

int ag_renderer_finished_timings(struct ag_renderer *r, struct ag_timing *out, int capacity)
{
    if (!r || capacity < 0 || (!out && capacity > 0)) return 0;
    return finished_timings(r, out, capacity);
}

int ag_renderer_memory(struct ag_renderer *r, struct ag_memory *out, int capacity)
{
    if (!r || capacity < 0 || (!out && capacity > 0)) return 0;
    struct gpu_memory owners[MAX_OWNERS];
    const int count = gpu_client_memory(r->device->gpu, r->client, owners, MAX_OWNERS);
    return copy_entries(out, capacity, owners, count, sizeof *out);
}

int ag_device_memory(struct ag_device *device, struct ag_memory *out, int capacity)
{
    if (!device || capacity < 0 || (!out && capacity > 0)) return 0;
    struct gpu_memory owners[MAX_OWNERS];
    const int count = gpu_memory_by_owner(device->gpu, owners, MAX_OWNERS);
    return copy_entries(out, capacity, owners, count, sizeof *out);
}

enum ag_result ag_renderer_picked(struct ag_renderer *r, struct ag_pick *out)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_POINTER(context, out);
    *out = (struct ag_pick){ .instance = -1, .triangle = -1 };
    AG_REQUIRE(context, r, "renderer is NULL");
    struct frame_pick pick;
    if (!frame_newest_pick(r->main.frame, &pick)) return api_done(context, true);
    out->frame = pick.number;
    out->x = (int)pick.x;
    out->y = (int)pick.y;
    out->instance = (int)pick.instance - 1;
    out->triangle = (int)pick.triangle - 1;
    return api_done(context, true);
}

enum ag_result ag_renderer_finished(struct ag_renderer *r, struct ag_finished_frame *out)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_POINTER(context, out);
    *out = (struct ag_finished_frame){ 0 };
    AG_REQUIRE(context, r, "renderer is NULL");
    struct frame_report report;
    if (!frame_newest_report(r->main.frame, &report)) return api_done(context, true);
    out->frame = report.number;
    out->exposure_ev = report.exposure_ev;
    out->scale = report.radiance_scale;
    return api_done(context, true);
}
