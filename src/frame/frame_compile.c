// Pipelines of a frame for a compiler: see gpu/compiler.c.
#include "frame/frame_state.h"

// A frame that has not been prepared compiles its own pass of direct light.
static uint32_t direct_of(const struct frame *f, uint32_t needs)
{
    if (!f->prepared) return 0;
    const uint32_t irradiance = needs & FRAME_NEEDS_DIRECT_IRRADIANCE ? DIRECT_IRRADIANCE : 0;
    return (f->direct_variant & ~(uint32_t)DIRECT_IRRADIANCE) | irradiance;
}

struct frame_pipelines frame_pipelines_of(const struct frame *f, const struct frame_input *wants,
                                          uint32_t needs)
{
    const struct frame_common *c = f->common;
    needs |= frame_antialias_needs(&c->options);
    if (needs & FRAME_WRITES_SPECULAR_OF_MAP && c->environment.map) needs |= FRAME_WRITES_SPECULAR;
    const bool motion = needs & FRAME_NEEDS_MOTION || wants->want_motion_layer;
    const bool ids = needs & FRAME_NEEDS_ID || wants->want_id_layer;
    const uint32_t variant = frame_composite_variant(&c->options, wants, needs);
    return (struct frame_pipelines){
        .scene_variants = c->scene.variants_used,
        .gbuffer_layers = (motion ? GBUFFER_MOTION : 0) | (ids ? GBUFFER_ID : 0) |
                          (c->scene.has_dielectrics ? GBUFFER_DIELECTRIC : 0),
        .own_gbuffer = !wants->gbuffer,
        .converts = wants->gbuffer && wants->gbuffer->encoding,
        .convert_layers = (motion ? GBUFFER_MOTION : 0) |
                          (f->layers[FRAME_DIELECTRIC].id ? GBUFFER_DIELECTRIC : 0),
        .rsm = needs & FRAME_NEEDS_RSM,
        .composite = { variant, frame_meter_variant(variant) },
        .direct = direct_of(f, needs),
        .cascades = c->direct.cascades,
    };
}

bool frame_pipelines_compile(const struct frame_pipelines *p, struct gpu *compiler)
{
    struct gbuffer gbuffer = { 0 };
    struct gbuffer_convert convert = { 0 };
    struct composite composite = { .gpu = compiler };
    return (!p->own_gbuffer ||
            gbuffer_prepare(&gbuffer, compiler, p->scene_variants, p->gbuffer_layers)) &&
           (!p->converts || gbuffer_convert_prepare(&convert, compiler, p->convert_layers)) &&
           composite_prepare(&composite, p->composite[0]) &&
           composite_prepare(&composite, p->composite[1]) &&
           (!p->rsm || rsm_compile(compiler, p->scene_variants)) &&
           (!p->direct || direct_compile(compiler, p->direct, p->cascades));
}
