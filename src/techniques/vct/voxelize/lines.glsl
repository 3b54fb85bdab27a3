// Sample lines through a voxel along a triangle's dominant axis. The lines that cross a triangle
// are its coverage of the voxel's face. Its heights on them tell which of several surfaces on one
// face hides the others: a depth buffer of VCT_LINES samples. Include line_places.glsl before.
#ifndef AG_VCT_LINES_GLSL
#define AG_VCT_LINES_GLSL

const uint VCT_CROSSED = 0x80808080u; // a bit for each of four lines

// Four lines to a word, a byte each: 128 where the line crosses the triangle, plus the height there
// above the voxel's opposite face in units of 1/128 voxel.
//
// A line crosses a surface in one voxel of its column, so that the coverage of a slanted wall adds
// up to 1. precise: all passes find the same heights.
uvec4 vct_lines_through(ivec3 voxel, vct_triangle t, uint face)
{
    ivec3 cell = ivec3(permuted(vec3(voxel), t.turn));
    float facing = t.normal.z < 0.0 ? -1.0 : 1.0;
    vec2 ab = facing * (t.v.xy - t.u.xy), bc = facing * (t.w.xy - t.v.xy),
         ca = facing * (t.u.xy - t.w.xy);
    precise vec2 slope = t.normal.xy / t.normal.z;
    uint flip = (face & 1u) != 0u ? 127u : 0u;
    uvec4 lines = uvec4(0u);
    for (uint i = 0u; i < VCT_LINES; i++) {
        precise vec2 at = vec2(cell.xy) + (vec2(vct_line_place(i)) + 0.5) / float(VCT_LINES);
        precise vec2 u = at - t.u.xy;
        vec2 v = at - t.v.xy, w = at - t.w.xy;
        bool inside =
            ab.x * u.y >= ab.y * u.x && bc.x * v.y >= bc.y * v.x && ca.x * w.y >= ca.y * w.x;
        precise float height = t.u.z - (slope.x * u.x + slope.y * u.y);
        float depth = clamp(floor(height), float(t.depths.x), float(t.depths.y));
        bool crossed = inside && depth == float(cell.z);
        uint level = uint(clamp((height - float(cell.z)) * 128.0, 0.0, 127.0));
        lines[i / 4u] |= crossed ? (128u | level ^ flip) << (8u * (i % 4u)) : 0u;
    }
    return lines;
}

// 127 in the bytes whose highest bit is given.
uvec4 vct_bytes_of(uvec4 highest_bits)
{
    return highest_bits - (highest_bits >> 7);
}

// The same lines for the face of the triangle's back.
uvec4 vct_lines_behind(uvec4 lines)
{
    return lines ^ vct_bytes_of(lines & VCT_CROSSED);
}

// The lines on which the triangle is not hidden, a bit each. outermost: heights of the face's
// outermost surfaces.
uint vct_visible_lines(uvec4 lines, uvec4 outermost)
{
    uvec4 bits = (((lines | VCT_CROSSED) - outermost) & lines & VCT_CROSSED) >> 7u;
    bits = (bits | bits >> 7u | bits >> 14u | bits >> 21u) & 15u;
    return bits.x | bits.y << 4 | bits.z << 8 | bits.w << 12;
}

// The outermost heights with those of another triangle.
uvec4 vct_outermost_of(uvec4 outermost, uvec4 lines)
{
    uvec4 heights = lines & vct_bytes_of(lines & VCT_CROSSED);
    uvec4 kept = vct_bytes_of(((outermost | VCT_CROSSED) - heights) & VCT_CROSSED);
    return outermost & kept | heights & ~kept;
}

#endif
