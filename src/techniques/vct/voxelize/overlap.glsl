// Triangle and voxel overlap: separating axes of a box and a triangle (Akenine-Möller 2001).
// Touching counts. `precise`: the C twin gives exactly the same voxels.
#ifndef AG_VCT_OVERLAP_GLSL
#define AG_VCT_OVERLAP_GLSL

// Axes x, y and z crossed with an edge; p: the edge's start, q: the vertex across.
bool vct_edge_separates(vec3 edge, vec3 p, vec3 q)
{
    precise vec3 at_p = edge.yzx * p.zxy - edge.zxy * p.yzx;
    precise vec3 at_q = edge.yzx * q.zxy - edge.zxy * q.yzx;
    precise vec3 reach = 0.5 * (abs(edge.yzx) + abs(edge.zxy));
    return any(greaterThan(min(at_p, at_q), reach)) || any(lessThan(max(at_p, at_q), -reach));
}

// Vertices in voxels from the voxel's centre; normal = cross(b − a, c − b).
bool vct_overlaps(vec3 a, vec3 b, vec3 c, vec3 normal)
{
    vec3 low = min(min(a, b), c), high = max(max(a, b), c);
    if (any(greaterThan(low, vec3(0.5))) || any(lessThan(high, vec3(-0.5)))) return false;
    precise float height = normal.x * a.x + normal.y * a.y + normal.z * a.z;
    precise float reach = 0.5 * (abs(normal.x) + abs(normal.y) + abs(normal.z));
    if (abs(height) > reach) return false;
    precise vec3 ab = b - a, bc = c - b, ca = a - c;
    return !vct_edge_separates(ab, a, c) && !vct_edge_separates(bc, b, a) &&
           !vct_edge_separates(ca, c, b);
}

#endif
