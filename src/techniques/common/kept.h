// Whether the light of a technique's last frame can be reused. Techniques keep one struct for each
// thing that they update: shared light, the history of a view.
#pragma once

#include "frame/frame.h"

struct kept {        // zero: no frame before
    bool known, lit; // there is a last frame; its light is not to be computed again
    uint64_t index, light;
    // The frame being recorded, after kept_update:
    bool follows;   // the last one was the frame before
    bool still;     // and no geometry has moved since
    bool same;      // nor has light changed
    uint64_t since; // index of the first frame that is the same
};

// Called once for each recorded frame. light: hash of the inputs of light, frame_view.light_hash
// and those that the technique adds.
void kept_update(struct kept *kept, const struct frame_view *view, uint64_t light);
