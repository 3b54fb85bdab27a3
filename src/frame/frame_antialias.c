// Temporal antialiasing of a view: the jitter, and what of its history holds.
#include "frame/frame_state.h"

#include "core/sampling.h"
#include "image/tonemap.h"

// Weights of the history in samples, at most, while geometry or the camera move, and while light
// changes, which its clipping alone follows.
enum { MOST_MOVING = 8, MOST_LIT_ANEW = 1 };
// Frames until techniques have followed a change: bounces of vct, objects of drt.
enum { SETTLING_FRAMES = 16 };

uint32_t frame_antialias_needs(const struct frame_options *options)
{
    return options->antialias ? FRAME_ANTIALIASES | FRAME_NEEDS_MOTION : 0;
}

// Bits of antialias_variant for the display image.
static uint32_t display_bits(const struct frame *f, bool displays)
{
    static const uint32_t curves[TONEMAP_COUNT] = { 0, ANTIALIAS_AGX, ANTIALIAS_LINEAR };
    return displays ? ANTIALIAS_DISPLAY | curves[f->common->options.tonemap] : 0;
}

bool frame_prepare_antialias(struct frame *f, bool displays)
{
    struct antialias *a = &f->common->antialias;
    const uint32_t display = display_bits(f, displays);
    if (f->needs & FRAME_ANTIALIASES)
        return antialias_prepare(a, f->gpu, display) &&
               antialias_prepare(a, f->gpu, ANTIALIAS_MOVES | display) &&
               antialias_history_prepare(&f->antialias, f->gpu, f->width, f->height);
    antialias_history_finish(&f->antialias, f->gpu);
    return true;
}

// A program's own G-buffer has its jitter already. Any 64 frames in a row have all points.
vec2s frame_jitter(const struct frame *f, const struct frame_input *input)
{
    const bool centred = input->jitter.x == 0.0f && input->jitter.y == 0.0f;
    if (!(f->needs & FRAME_ANTIALIASES) || !centred || input->gbuffer) return input->jitter;
    return sample_jitter((int)(f->index % ANTIALIAS_SAMPLES), ANTIALIAS_SAMPLES);
}

// Updates the history's record of what the image depends on.
void frame_follow_antialias(struct frame *f)
{
    if (!(f->needs & FRAME_ANTIALIASES)) return;
    struct antialias_history *h = &f->antialias;
    const struct frame_common *c = f->common;
    const uint64_t light_hash = c->views[0]->light_hash;
    const bool first = !h->known || f->camera_cut;
    const bool lit_anew =
        light_hash != h->light_hash || c->revision != h->revision || c->scene.recolored;
    const bool moved = !f->camera_still || c->scene.moved || c->scene.draw_list != h->draw_list;
    const int settling = f->needs & FRAME_LIGHT_EVOLVES ? SETTLING_FRAMES : 0;
    h->settles = first || lit_anew || moved ? settling : h->settles > 0 ? h->settles - 1 : 0;
    h->known = true;
    h->light_hash = light_hash;
    h->draw_list = c->scene.draw_list;
    h->revision = c->revision;
    h->moves = !first && (lit_anew || moved || h->settles > 0);
    h->still = first || h->moves ? 0 : h->still + 1;
    h->most = first ? 0 : lit_anew ? MOST_LIT_ANEW : h->moves ? MOST_MOVING : ANTIALIAS_SAMPLES - 1;
}

float frame_exposure_share(struct frame *f, bool is_automatic)
{
    struct antialias_history *h = &f->antialias;
    const bool averages = f->needs & FRAME_ANTIALIASES && h->still > 0;
    h->metered = !is_automatic                    ? 0
                 : !averages                      ? 1
                 : h->metered < ANTIALIAS_SAMPLES ? h->metered + 1
                                                  : ANTIALIAS_SAMPLES;
    return 1.0f / (float)(h->metered > 0 ? h->metered : 1);
}

void frame_record_antialias(struct frame *f, struct gpu_cmd *cmd, bool displays)
{
    if (!(f->needs & FRAME_ANTIALIASES)) return;
    const struct antialias_images images = {
        .radiance = f->layers[FRAME_RADIANCE],
        .depth = f->layers[FRAME_DEPTH],
        .motion = f->layers[FRAME_MOTION],
        .color = f->layers[FRAME_COLOR],
        .display = f->layers[FRAME_DISPLAY],
    };
    const struct gpu_binding bindings[2] = {
        f->constants_binding,
        { "exposure_state", .buffer = f->exposure.state },
    };
    gpu_scope_begin(cmd, "antialias");
    antialias_record(&f->common->antialias, cmd,
                     (f->antialias.moves ? ANTIALIAS_MOVES : 0) | display_bits(f, displays),
                     &f->antialias, f->antialias.most, &images, bindings, f->width, f->height);
    gpu_scope_end(cmd);
}
