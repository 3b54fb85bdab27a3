// What the lit voxels of both sets send and hide along the ways of the light volume. Premultiplied
// with opacity. Include after vct_grid.glsl; takes the bindings 1 to 6.
//
// A voxel is a sheet: on a way that meets its front it shows what the front sends out and hides
// what is behind, as much of it as the sheet covers when it is seen along the axis. A side that is
// the back of a surface of one side neither shows nor hides anything: what is looked for from a
// floor is not hidden by the floor, however coarse its texels are.
//
// One volume for all ways has the mean of what both sides send out, and of the voxels: the
// isotropic pyramid of figure 49, through whose thin walls light leaks.
#ifndef AG_VCT_SEEN_GLSL
#define AG_VCT_SEEN_GLSL

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

struct seen {
    vec4 along[6]; // +x −x +y −y +z −z: premultiplied radiance and opacity
};

void add_voxel(vct_lit_voxel r, inout seen s)
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
        bool meets_front = r.normal[axis] < 0.0;
        vec4 up = share * (steepest == 0.0 ? middle : meets_front ? front : back);
        vec4 down = share * (steepest == 0.0 ? middle : meets_front ? back : front);
        // Of two sheets in a voxel the one that hides more is seen.
        s.along[2 * axis] = up.a > s.along[2 * axis].a ? up : s.along[2 * axis];
        s.along[2 * axis + 1] = down.a > s.along[2 * axis + 1].a ? down : s.along[2 * axis + 1];
    }
}

void look(uint static_at, uint dynamic_at, out seen s)
{
    for (int i = 0; i < 6; i++) s.along[i] = vec4(0.0);
    if (static_at != VCT_NO_SLOT) add_voxel(vct_lit_voxel_at(static_lit_voxels, static_at), s);
    if (VCT_HAS_DYNAMIC && dynamic_at != VCT_NO_SLOT)
        add_voxel(vct_lit_voxel_at(dynamic_lit_voxels, dynamic_at), s);
}

void gather_in_block(ivec3 from, ivec3 at, ivec3 size, out seen s)
{
    bool inside = all(lessThan(at, size)) && vct_inside(from + at);
    uint index = vct_index(inside ? from + at : ivec3(0));
    look(inside ? static_slot(index) : VCT_NO_SLOT,
         VCT_HAS_DYNAMIC && inside ? dynamic_slot(index) : VCT_NO_SLOT, s);
}

// Two voxels behind each other along an axis, the lower one first.
void pair(seen low, seen high, const int axis, float column, inout vec4 sum[6])
{
    sum[2 * axis] += column * vct_over(low.along[2 * axis], high.along[2 * axis]);
    sum[2 * axis + 1] += column * vct_over(high.along[2 * axis + 1], low.along[2 * axis + 1]);
}

// A block of at most 2 × 2 × 2 voxels as one texel: along each axis the nearer of two covers the
// farther, and columns are averaged. Written out, as drivers keep in memory what loops that they do
// not unroll have in arrays.
void vct_prefilter_block(ivec3 from, ivec3 size, out vec4 sum[6])
{
    seen a, b, c, d, e, f, g, h;
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
