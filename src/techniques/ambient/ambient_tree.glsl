// The sum over a workgroup in a fixed order: a binary tree in shared memory, the same for every
// subgroup size.
#ifndef AG_AMBIENT_TREE_GLSL
#define AG_AMBIENT_TREE_GLSL

#include "techniques/ambient/ambient_shared.h"

shared vec3 tree[AMBIENT_LOCAL];

// Call from all invocations; all of them get the total.
vec3 workgroup_sum(vec3 value)
{
    uint me = gl_LocalInvocationIndex;
    tree[me] = value;
    barrier();
    for (uint width = AMBIENT_LOCAL / 2u; width > 0u; width /= 2u) {
        if (me < width) tree[me] += tree[me + width];
        barrier();
    }
    return tree[0];
}

#endif
