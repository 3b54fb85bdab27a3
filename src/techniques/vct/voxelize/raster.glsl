// Voxelization by the rasterizer: a triangle is projected along the dominant axis of its normal,
// and each pixel is a column of voxels (Hong 2015, sec. 2.5.3.1). Vertex pulling gives each vertex
// its triangle, which replaces the paper's geometry shader. Include after voxelize/voxelize.glsl
// with VCT_RASTER.
#ifndef AG_VCT_RASTER_GLSL
#define AG_VCT_RASTER_GLSL

// Rounding of positions by the rasterizer, in pixels, added to the half pixel of the enlargement.
const float VCT_RASTER_ROUNDING = 0.02;

vec3 edge_moved_out(vec2 from, vec2 to, float facing)
{
    vec2 inward = facing * vec2(from.y - to.y, to.x - from.x);
    return vec3(inward,
                (0.5 + VCT_RASTER_ROUNDING) * (abs(inward.x) + abs(inward.y)) - dot(inward, from));
}

// Conservative rasterization: corner k of a triangle that covers the centre of every pixel that t
// touches, by moving the edges outwards by half a pixel (Hasselgren, Akenine-Möller, Ohlsson 2005).
// A degenerate triangle is replaced by one around its bounding box.
vec2 vct_raster_corner(vct_triangle t, uint k)
{
    float facing = t.normal.z < 0.0 ? -1.0 : 1.0;
    vec3 edges[3] =
        vec3[3](edge_moved_out(t.w.xy, t.u.xy, facing), edge_moved_out(t.u.xy, t.v.xy, facing),
                edge_moved_out(t.v.xy, t.w.xy, facing));
    vec2 low = vec2(t.low.xy) - 1.0, size = vec2(t.high.xy - t.low.xy) + 3.0;
    vec2 corners[3];
    bool sound = true;
    for (uint i = 0u; i < 3u; i++) {
        vec3 at = cross(edges[i], edges[(i + 1u) % 3u]);
        corners[i] = at.xy / at.z;
        // Also false for values that are not finite.
        sound = sound && at.z > 0.0 && all(lessThan(abs(corners[i] - low), vec2(1e4)));
    }
    if (sound) return corners[k];
    return low + vec2(k == 1u ? 2.0 : 0.0, k == 2u ? 2.0 : 0.0) * size;
}

#endif
