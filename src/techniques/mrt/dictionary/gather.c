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

void mrt_add_radiosity(const struct mrt_hit *hit, float weight, const struct matrix_f32 *radiosity,
                       float *row)
{
    for (int k = 0; k < hit->texels; k++) {
        const float *from = radiosity->at + (size_t)hit->texel[k] * radiosity->stride;
        const float w = weight * hit->weight[k];
        for (size_t m = 0; m < radiosity->columns; m++) row[m] += w * from[m];
    }
}
