// Gathering over the surface of a shape.
#include "gather.h"

static void add_hit(const struct mrt_hit *hit, const float *weight, int values, float *rows,
                    size_t stride)
{
    for (int q = 0; q < values; q++)
        for (int k = 0; k < hit->texels; k++)
            rows[(size_t)q * stride + (size_t)hit->texel[k]] += weight[q] * hit->weight[k];
}

void mrt_gather(const struct mrt_shape *shape, struct mrt_point point, const struct mrt_rays *rays,
                float *rows, size_t stride)
{
    struct mrt_hit hit;
    for (int i = 0; i < rays->count; i++) {
        mrt_shape_trace(shape, point.position, glms_mat3_mulv(point.frame, rays->direction[i]),
                        &hit);
        add_hit(&hit, rays->weight + (size_t)i * (size_t)rays->values, rays->values, rows, stride);
    }
}
