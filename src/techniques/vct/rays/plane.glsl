// The plane of a voxel's face for rays, packed into a word: normal 8 + 8 bits, distance 10, opacity
// 6.
#ifndef AG_VCT_PLANE_GLSL
#define AG_VCT_PLANE_GLSL

struct vct_plane {
    vec3 normal;    // of length 1 in the 1-norm: octahedral
    float distance; // along `normal`, from the voxel's centre, in voxels
    float opacity;  // of the part of the plane within the voxel
};

// Greatest slope to its axis of the normals of an aligned voxel.
const float VCT_ALIGNED_SLOPE = 0.1;

vec3 vct_octahedron(uvec2 code)
{
    vec2 p = vec2(code) / 127.0 - 1.0;
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float below = max(-n.z, 0.0);
    n.xy -= mix(vec2(below), vec2(-below), lessThan(n.xy, vec2(0.0)));
    return n;
}

vct_plane vct_unpack_plane(uint bits)
{
    return vct_plane(vct_octahedron(uvec2(bits, bits >> 8) & 255u),
                     float(bits >> 16 & 1023u) / 511.0 - 1.0, float(bits >> 26) / 63.0);
}

bool vct_plane_aligned(vec3 normal)
{
    vec3 size = abs(normal);
    float most = max(size.x, max(size.y, size.z));
    return 1.0 - most <= VCT_ALIGNED_SLOPE * most;
}

#endif
