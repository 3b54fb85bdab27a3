// A renderer of a technique's light, without an image that anybody looks at: two small frames.
#pragma once

#include "baking.h"

struct light_renderer {
    struct bakes bakes; // of the technique
    struct ag_device *device;
    struct ag_renderer *renderer;
};
// Prepares the bakes and renders; the notes of the session come first. A rank that follows another
// helps with the bakes and has no renderer. End it also after a failure.
enum status light_renderer_begin(struct light_renderer *r, struct session *session, const char *gi);
void light_renderer_end(struct light_renderer *r); // accepts zero
