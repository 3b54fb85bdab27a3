// The pipelines that a frame will need with other techniques, for another thread to compile.
#pragma once

#include "frame/frame.h"

struct frame_pipelines {
    uint32_t scene_variants; // of the scene's materials
    uint32_t gbuffer_layers; // gbuffer_layers
    bool own_gbuffer, rsm;
    uint32_t composite[2];     // variants: of the image, and of the exposure meter
    uint32_t direct, cascades; // direct: 0, the frame has not been prepared
};

// On the frame's thread. wants: as for the last frame; needs: of the techniques to come.
struct frame_pipelines frame_pipelines_of(const struct frame *frame,
                                          const struct frame_input *wants, uint32_t needs);
bool frame_pipelines_compile(const struct frame_pipelines *pipelines, struct gpu *compiler);
