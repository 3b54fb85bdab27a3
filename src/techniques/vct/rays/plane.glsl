// The plane of a voxel's face for rays, packed into two words: normal 8 + 8 bits, distance 10,
// opacity 6; first and last column and row of its extent, 4 bits each.
#ifndef AG_VCT_PLANE_GLSL
#define AG_VCT_PLANE_GLSL

struct vct_plane {
    vec3 normal;    // of length 1 in the 1-norm: octahedral
    float distance; // along `normal`, from the voxel's centre, in voxels
    float opacity;  // of the part of the plane within the voxel and its extent
    // Rectangle across the face's axis, from the voxel's corner; beyond the voxel where the
    // surfaces reach its border. Axes follow the face's in the order x, y, z.
    vec2 low, high;
};

// Columns and rows of an extent: voxelize/line_places.glsl.
const float VCT_EXTENT_ONE = 16.0;

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

// An edge of the surfaces is half a column off at most: extents contain it.
vct_plane vct_unpack_plane(uvec2 bits)
{
    uvec2 first = uvec2(bits.y) >> uvec2(0u, 4u) & 15u,
          last = uvec2(bits.y) >> uvec2(8u, 12u) & 15u;
    vec2 low = (vec2(first) - 0.5) / VCT_EXTENT_ONE, high = (vec2(last) + 1.5) / VCT_EXTENT_ONE;
    return vct_plane(vct_octahedron(uvec2(bits.x, bits.x >> 8) & 255u),
                     float(bits.x >> 16 & 1023u) / 511.0 - 1.0, float(bits.x >> 26) / 63.0,
                     mix(low, vec2(-1.0), equal(first, uvec2(0u))),
                     mix(high, vec2(2.0), equal(last, uvec2(15u))));
}

// The two coordinates across the axis of a face.
vec2 vct_across(vec3 v, uint face)
{
    uint axis = face % 6u / 2u;
    return axis == 0u ? v.yz : axis == 1u ? v.zx : v.xy;
}

bool vct_plane_aligned(vec3 normal)
{
    vec3 size = abs(normal);
    float most = max(size.x, max(size.y, size.z));
    return 1.0 - most <= VCT_ALIGNED_SLOPE * most;
}

#endif
