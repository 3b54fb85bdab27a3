// Radiance and opacity of a block of lit voxels of both sets along the axis directions,
// premultiplied with opacity. Include after vct_grid.glsl; takes the bindings 1 to 6.
//
// A voxel is a sheet: seen from its front it has the radiance of the front and the opacity of the
// sheet projected along the axis. The culled back of a single-sided surface has no opacity: a floor
// does not occlude cones that start on it, however coarse its texels are.
//
// The isotropic volume averages both sides and all voxels: figure 49, with leaks through thin
// walls.
#ifndef AG_VCT_PREFILTER_GLSL
#define AG_VCT_PREFILTER_GLSL

#include "core/half.glsl"
#include "frame/frame_shared.h"
#include "techniques/vct/vct_constants.h"
#include "techniques/vct/volume/over.glsl"
#include "techniques/vct/volume/lit_voxel.glsl"
#include "techniques/vct/volume/directions.glsl"
#define VCT_SLOTS(name)   static_##name
#define VCT_SLOTS_BINDING 1
#include "techniques/vct/voxelize/slots.glsl"
#define VCT_SLOTS(name)   dynamic_##name
#define VCT_SLOTS_BINDING 3
#include "techniques/vct/voxelize/slots.glsl"

layout(set = 0, binding = 5) uniform usampler2D static_lit_voxels;
layout(set = 0, binding = 6) uniform usampler2D dynamic_lit_voxels;

layout(constant_id = VCT_CONSTANT_HAS_DYNAMIC) const
    bool VCT_HAS_DYNAMIC = true; // false: the second set is empty

struct directional {
    vec4 along[6]; // +x −x +y −y +z −z: premultiplied radiance and opacity
};

void add_voxel(vct_lit_voxel r, inout directional s)
{
    vec3 slopes = abs(r.normal);
    float steepest = max(slopes.x, max(slopes.y, slopes.z));
    bool small_emitters = vct.small_emitters_shown != 0u;
    vec4 front = vec4(r.front + vct_emitted(r.emitted_front, small_emitters), 1.0) * r.opacity.x;
    vec4 back = vec4(r.back + vct_emitted(r.emitted_back, small_emitters), 1.0) * r.opacity.y;
    if (!VCT_ANISOTROPIC) {
        vec4 both = (front + back) * (max(front.a, back.a) / max(front.a + back.a, 1e-6));
        s.along[0] = both.a > s.along[0].a ? both : s.along[0];
        return;
    }
    vec4 middle = 0.5 * (front + back);
    for (int axis = 0; axis < 3; axis++) {
        float share = steepest > 0.0 ? slopes[axis] / steepest : 1.0;
        bool faces_front = r.normal[axis] < 0.0;
        vec4 up = share * (steepest == 0.0 ? middle : faces_front ? front : back);
        vec4 down = share * (steepest == 0.0 ? middle : faces_front ? back : front);
        // Of a static and a moving sheet the more opaque one counts.
        s.along[2 * axis] = up.a > s.along[2 * axis].a ? up : s.along[2 * axis];
        s.along[2 * axis + 1] = down.a > s.along[2 * axis + 1].a ? down : s.along[2 * axis + 1];
    }
}

void sample_voxels(uint static_at, uint dynamic_at, out directional s)
{
    for (int i = 0; i < 6; i++) s.along[i] = vec4(0.0);
    if (static_at != VCT_NO_SLOT) add_voxel(vct_lit_voxel_at(static_lit_voxels, static_at), s);
    if (VCT_HAS_DYNAMIC && dynamic_at != VCT_NO_SLOT)
        add_voxel(vct_lit_voxel_at(dynamic_lit_voxels, dynamic_at), s);
}

void gather_in_block(ivec3 from, ivec3 at, ivec3 size, out directional s)
{
    bool inside = all(lessThan(at, size)) && vct_inside(from + at);
    uint index = vct_index(inside ? from + at : ivec3(0));
    sample_voxels(inside ? static_slot(index) : VCT_NO_SLOT,
                  VCT_HAS_DYNAMIC && inside ? dynamic_slot(index) : VCT_NO_SLOT, s);
}

// Composites two voxels along an axis, the lower one first.
void pair(directional low, directional high, const int axis, float column, inout vec4 sum[6])
{
    sum[2 * axis] += column * vct_over(low.along[2 * axis], high.along[2 * axis]);
    sum[2 * axis + 1] += column * vct_over(high.along[2 * axis + 1], low.along[2 * axis + 1]);
}

// A block of at most 2 × 2 × 2 voxels as one texel: pairs along each axis are composited front to
// back, the four columns are averaged. Unrolled by hand: software drivers spill arrays of loops to
// memory.
void vct_prefilter_block(ivec3 from, ivec3 size, out vec4 sum[6])
{
    directional a, b, c, d, e, f, g, h;
    gather_in_block(from, ivec3(0, 0, 0), size, a);
    gather_in_block(from, ivec3(1, 0, 0), size, b);
    gather_in_block(from, ivec3(0, 1, 0), size, c);
    gather_in_block(from, ivec3(1, 1, 0), size, d);
    gather_in_block(from, ivec3(0, 0, 1), size, e);
    gather_in_block(from, ivec3(1, 0, 1), size, f);
    gather_in_block(from, ivec3(0, 1, 1), size, g);
    gather_in_block(from, ivec3(1, 1, 1), size, h);
    sum = vec4[6](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    float each = 1.0 / float(size.x * size.y * size.z);
    if (!VCT_ANISOTROPIC) {
        sum[0] = each * (a.along[0] + b.along[0] + c.along[0] + d.along[0] + e.along[0] +
                         f.along[0] + g.along[0] + h.along[0]);
        return;
    }
    vec3 column = each * vec3(size);
    pair(a, b, 0, column.x, sum);
    pair(c, d, 0, column.x, sum);
    pair(e, f, 0, column.x, sum);
    pair(g, h, 0, column.x, sum);
    pair(a, c, 1, column.y, sum);
    pair(b, d, 1, column.y, sum);
    pair(e, g, 1, column.y, sum);
    pair(f, h, 1, column.y, sum);
    pair(a, e, 2, column.z, sum);
    pair(b, f, 2, column.z, sum);
    pair(c, g, 2, column.z, sum);
    pair(d, h, 2, column.z, sum);
}

#endif
