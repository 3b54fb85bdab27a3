// Σ over a workgroup's items of four coefficients × three colours. Invocation (stripe, quad) adds
// items stripe, stripe + STRIPES, …; one invocation for each quad and colour adds the stripes, in
// order: the same sum whatever the device's subgroups.
#ifndef AG_MRT_REDUCE_GLSL
#define AG_MRT_REDUCE_GLSL

#ifndef MRT_LANES
#define MRT_LANES MRT_REDUCE_LOCAL
#endif

shared vec4 partial_sums[3][MRT_LANES];

vec4 sum_of_stripes(uint colour, uint quad, uint quads)
{
    vec4 sum = vec4(0.0);
    for (uint i = quad; i < MRT_LANES / quads * quads; i += quads) sum += partial_sums[colour][i];
    return sum;
}

#endif
