// Sum over a work group, in an order that does not depend on the device.
shared vec2 partial_sums[EXPOSURE_THREADS];

vec2 sum_of_group(vec2 own)
{
    uint thread = gl_LocalInvocationID.x;
    partial_sums[thread] = own;
    for (uint half_size = EXPOSURE_THREADS / 2; half_size > 0; half_size /= 2) {
        barrier();
        if (thread < half_size) partial_sums[thread] += partial_sums[thread + half_size];
    }
    return partial_sums[0]; // valid in thread 0 only
}
