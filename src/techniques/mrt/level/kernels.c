// Vectors of the compiler: it splits them into those of the processor.
#include "kernels.h"

typedef float lanes __attribute__((vector_size(4 * MRT_LANES), aligned(4), may_alias));

static inline float sum_of(const lanes *v)
{
    // A fixed order, whatever the width of the processor's vectors.
    return (((*v)[0] + (*v)[4]) + ((*v)[1] + (*v)[5])) +
           (((*v)[2] + (*v)[6]) + ((*v)[3] + (*v)[7]));
}

// Two rows share the loads of the values.
static void project_two(const float *m, const float *n, int length, const float *const values[3],
                        float *out_m, float *out_n)
{
    lanes a[3] = { { 0 } }, b[3] = { { 0 } };
    for (int i = 0; i < length; i += MRT_LANES) {
        lanes x = *(const lanes *)(m + i), y = *(const lanes *)(n + i);
        for (int c = 0; c < 3; c++) {
            lanes v = *(const lanes *)(values[c] + i);
            a[c] += x * v;
            b[c] += y * v;
        }
    }
    for (int c = 0; c < 3; c++) {
        out_m[c] = sum_of(&a[c]);
        out_n[c] = sum_of(&b[c]);
    }
}

void mrt_kernel_project(const float *m, int stride, int rows, int length,
                        const float *const values[3], float *out)
{
    for (int r = 0; r < rows; r += 2) {
        int s = r + 1 < rows ? r + 1 : r;
        project_two(m + (long)r * stride, m + (long)s * stride, length, values, out + 3 * r,
                    out + 3 * s);
    }
}

void mrt_kernel_expand(const float *m, int stride, int rows, int length, const float *values,
                       float *const out[3])
{
    for (int i = 0; i < length; i += MRT_LANES) {
        lanes sum[3];
        for (int c = 0; c < 3; c++) sum[c] = *(const lanes *)(out[c] + i);
        for (int r = 0; r < rows; r++) {
            lanes x = *(const lanes *)(m + (long)r * stride + i);
            for (int c = 0; c < 3; c++) sum[c] += x * values[3 * r + c];
        }
        for (int c = 0; c < 3; c++) *(lanes *)(out[c] + i) = sum[c];
    }
}
