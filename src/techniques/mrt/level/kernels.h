// Products of the solver: a matrix with three colours at once, eight elements at a time.
#pragma once

enum { MRT_LANES = 8 }; // lengths and strides are multiples of it

// out[r · 3 + c] = Σ_i m[r · stride + i] · values[c][i] for `rows` rows of `length` elements.
void mrt_kernel_project(const float *m, int stride, int rows, int length,
                        const float *const values[3], float *out);
// out[c][i] += Σ_r m[r · stride + i] · values[r · 3 + c].
void mrt_kernel_expand(const float *m, int stride, int rows, int length, const float *values,
                       float *const out[3]);
