#include "light_renderer.h"

enum { FRAME_SIDE = 16, FRAMES = 2 };

static enum ag_result create(struct light_renderer *r, const struct session *session,
                             const char *gi)
{
    struct ag_device_desc device;
    struct ag_renderer_desc desc;
    ag_device_desc_default(&device);
    device.device = session->arguments->device;
    const enum ag_result result = ag_device_create(session->context, &device, &r->device);
    if (result != AG_OK) return result;
    ag_renderer_desc_default(&desc);
    desc.width = desc.height = FRAME_SIDE;
    desc.gi = gi;
    desc.bakes = r->bakes.bakes;
    desc.bake_count = r->bakes.count;
    return ag_renderer_create(r->device, session->scene, &desc, &r->renderer);
}

static enum ag_result render(struct light_renderer *r, const struct ag_camera *camera)
{
    enum ag_result result = AG_OK;
    struct ag_frame_desc frame;
    ag_frame_desc_default(&frame);
    frame.camera = *camera;
    for (int i = 0; i < FRAMES && result == AG_OK; i++)
        result = ag_renderer_render(r->renderer, &frame);
    return result;
}

enum status light_renderer_begin(struct light_renderer *r, struct session *session, const char *gi)
{
    struct ag_camera camera;
    enum status status = session_camera(session, 0.0, &camera);
    if (status != DONE) return status;
    session_say(session);
    status = bakes_prepare(&r->bakes, session, gi);
    if (status != DONE || baking_is_followed(session->arguments)) return status;
    enum ag_result result = create(r, session, gi);
    if (result == AG_OK) result = render(r, &camera);
    if (result == AG_OK) return DONE;
    fail_library(session->context, result);
    return FAILED;
}

void light_renderer_end(struct light_renderer *r)
{
    ag_renderer_destroy(r->renderer);
    ag_device_destroy(r->device);
    bakes_finish(&r->bakes);
    *r = (struct light_renderer){ 0 };
}
