// Numbers of finished frames: exposure, times, memory.
#include "api/renderer_state.h"

#include "gpu/gpu.h"

#include <string.h>

enum { MAX_PASSES = 128, MAX_OWNERS = 128 };

enum ag_result ag_renderer_exposure(struct ag_renderer *r, float *ev)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    AG_REQUIRE_POINTER(context, ev);
    *ev = 0.0f;
    AG_REQUIRE(context, r->rendered, "no frame has been rendered");
    enum ag_result waited = ag_renderer_wait(r);
    if (waited != AG_OK) return waited;
    return api_done(context, frame_exposure(r->frame, ev));
}

static int finished_timings(const struct ag_renderer *r, struct ag_timing *out, int capacity)
{
    struct gpu_timing timings[MAX_PASSES];
    int count = gpu_client_timings(r->device->gpu, r->client, timings, MAX_PASSES);
    _Static_assert(sizeof out->name == sizeof timings->name, "names are copied whole");
    for (int i = 0; i < count && i < capacity; i++) {
        memcpy(out[i].name, timings[i].name, sizeof out[i].name);
        out[i].ms = timings[i].ms;
    }
    return count;
}

int ag_renderer_timings(struct ag_renderer *r, struct ag_timing *out, int capacity)
{
    if (!r || capacity < 0 || (!out && capacity > 0)) return 0;
    if (!r->rendered || ag_renderer_wait(r) != AG_OK) return 0;
    return finished_timings(r, out, capacity);
}

int ag_renderer_finished_timings(struct ag_renderer *r, struct ag_timing *out, int capacity)
{
    if (!r || capacity < 0 || (!out && capacity > 0)) return 0;
    return finished_timings(r, out, capacity);
}

static int copy_owners(const struct gpu_memory *owners, int count, struct ag_memory *out,
                       int capacity)
{
    _Static_assert(sizeof out->owner == sizeof owners->owner, "names are copied whole");
    for (int i = 0; i < count && i < capacity; i++) {
        memcpy(out[i].owner, owners[i].owner, sizeof out[i].owner);
        out[i].bytes = owners[i].bytes;
    }
    return count;
}

int ag_renderer_memory(struct ag_renderer *r, struct ag_memory *out, int capacity)
{
    if (!r || capacity < 0 || (!out && capacity > 0)) return 0;
    struct gpu_memory owners[MAX_OWNERS];
    const int count = gpu_client_memory(r->device->gpu, r->client, owners, MAX_OWNERS);
    return copy_owners(owners, count, out, capacity);
}

int ag_device_memory(struct ag_device *device, struct ag_memory *out, int capacity)
{
    if (!device || capacity < 0 || (!out && capacity > 0)) return 0;
    struct gpu_memory owners[MAX_OWNERS];
    const int count = gpu_memory_by_owner(device->gpu, owners, MAX_OWNERS);
    return copy_owners(owners, count, out, capacity);
}

enum ag_result ag_renderer_picked(struct ag_renderer *r, struct ag_pick *out)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_POINTER(context, out);
    *out = (struct ag_pick){ .instance = -1, .triangle = -1 };
    AG_REQUIRE(context, r, "renderer is NULL");
    struct frame_pick pick;
    if (!frame_newest_pick(r->frame, &pick)) return api_done(context, true);
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
    if (!frame_newest_report(r->frame, &report)) return api_done(context, true);
    out->frame = report.number;
    out->exposure_ev = report.exposure_ev;
    out->scale = report.radiance_scale;
    return api_done(context, true);
}
