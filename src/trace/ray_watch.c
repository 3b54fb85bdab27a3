#include "trace/ray_watch.h"

#include <math.h>

// A share of the size of a box and of its distance from the origin. Errors of hits are far below.
static const float MARGIN = 1e-4f;
// Components of a direction below it are 0: their inverse is no number.
static const float LEAST_COMPONENT = 1e-20f;

static float margin_of(const struct box3 *box)
{
    const vec3s far = glms_vec3_maxv(glms_vec3_abs(box->min), glms_vec3_abs(box->max));
    return MARGIN * (glms_vec3_max(box3_size(*box)) + glms_vec3_max(far));
}

static bool meets(const struct box3 *box, vec3s origin, vec3s direction, float far)
{
    const float margin = margin_of(box);
    float near = 0.0f;
    for (int k = 0; k < 3; k++) {
        const float low = box->min.raw[k] - margin - origin.raw[k],
                    high = box->max.raw[k] + margin - origin.raw[k];
        if (fabsf(direction.raw[k]) < LEAST_COMPONENT) {
            if (low > 0.0f || high < 0.0f) return false;
            continue;
        }
        const float a = low / direction.raw[k], b = high / direction.raw[k];
        near = fmaxf(near, fminf(a, b));
        far = fminf(far, fmaxf(a, b));
    }
    return near <= far;
}

void ray_watch_segment(struct ray_watch *watch, vec3s origin, vec3s direction, float far)
{
    for (uint32_t i = 0; !watch->met && i < watch->count; i++)
        watch->met = meets(&watch->boxes[i], origin, direction, far);
}
