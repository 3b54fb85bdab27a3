// Preparations: pipelines of another GI spec, compiled beside frames.
#include "api/renderer/state.h"

#include "gpu/gpu.h"
#include "techniques/gi.h"
#include "techniques/gi_spec.h"

struct ag_preparation {
    struct ag_device *device;
    struct gi_spec spec;
    struct frame_pipelines frame;
    struct gpu *compiler;
};

static struct frame_input wants_of(const struct ag_renderer *r)
{
    static const struct gbuffer_encoding any;
    static const struct frame_gbuffer in_place, converted = { .encoding = &any };
    return (struct frame_input){ .want_indirect_layer = r->main.indirect_layer,
                                 .want_motion_layer = r->main.motion_layer,
                                 .want_id_layer = r->main.id_layer,
                                 .want_display = r->main.display_layer,
                                 .shown = &r->main.shown,
                                 .gbuffer = !r->main.host_gbuffer ? NULL
                                            : r->main.has_layout  ? &converted
                                                                  : &in_place };
}

enum ag_result ag_preparation_create(struct ag_renderer *r, const char *gi,
                                     struct ag_preparation **out)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, r, "renderer is NULL");
    AG_REQUIRE_POINTER(context, gi);
    struct host *host = renderer_host(r);
    struct ag_preparation *p = host_alloc(host, 1, sizeof *p);
    if (!p) return api_done(context, false);
    p->device = r->device;
    lifetime_use(&r->device->life);
    const struct frame_input wants = wants_of(r);
    const bool ok = gi_spec_parse(&p->spec, host, gi) &&
                    (p->compiler = gpu_compiler_create(r->device->gpu, host)) != NULL;
    if (ok) gi_spec_fit_pose(&p->spec, &r->pose);
    if (ok) p->frame = frame_pipelines_of(r->main.frame, &wants, gi_spec_needs(&p->spec));
    const enum ag_result result = api_done(context, ok);
    if (ok)
        *out = p;
    else
        ag_preparation_destroy(p);
    return result;
}

static bool fail_cancelled(struct host *host)
{
    return host_fail(host, FAIL_CANCELLED, "the preparation was cancelled");
}

enum ag_result ag_preparation_run(struct ag_preparation *p, struct ag_context *context,
                                  bool (*progress)(void *user, double done), void *user)
{
    if (!context && p) context = p->device->context;
    AG_REQUIRE(context, p, "preparation is NULL");
    AG_REQUIRE(context, api_same_memory(context, p->device->context),
               "the context and the renderer's have different allocators");
    struct host *host = &context->host;
    gpu_compiler_set_host(p->compiler, host);
    bool ok = frame_pipelines_compile(&p->frame, p->compiler);
    for (int i = 0; ok && i < p->spec.count; i++) {
        if (progress && !progress(user, (double)(i + 1) / (p->spec.count + 2)))
            return api_done(context, fail_cancelled(host));
        ok = technique_compile(p->spec.technique[i], p->spec.options[i], p->compiler);
    }
    if (ok && progress) progress(user, 1.0);
    return api_done(context, ok);
}

int ag_preparation_pipelines(const struct ag_preparation *p)
{
    return p ? (int)gpu_compiler_count(p->compiler) : 0;
}

void ag_preparation_destroy(struct ag_preparation *p)
{
    if (!p) return;
    struct ag_device *device = p->device;
    gpu_compiler_destroy(p->compiler, device->gpu);
    gi_spec_finish(&p->spec);
    host_free(&device->context->host, p);
    api_device_release(device);
}
