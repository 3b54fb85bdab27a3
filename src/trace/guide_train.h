// Training of guides by paths of their own, whose light is not part of any image.
#pragma once

#include "trace/path.h"

struct guide_training {
    struct host *host;
    struct path_settings settings; // without a guide
    int width, height;             // of the image, pixels
    // The primary hit at an image point in pixels.
    struct path_start (*start)(const void *user, float x, float y, uint64_t *rays);
    const void *user;
};
// A function of its arguments alone, not of the number of threads. *guide is NULL where guiding
// does not reduce the variance. False on failure.
bool guide_train(const struct guide_training *training, struct guide **guide, uint64_t *rays);
