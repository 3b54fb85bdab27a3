// A frame of the window: events, the image by one method or two, panels, the swap chain.
#pragma once

#include "state.h"

// seconds: since the frame before. False: the device is lost or gives no more images.
bool frame_step(struct viewer *v, float seconds);
