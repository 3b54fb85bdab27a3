// What the lit voxels of both sets send and hide along the ways of the light volume. Premultiplied with opacity. Include
// after vct_grid.glsl; takes the bindings 1 to 6.
//
// A voxel is a sheet: on a way that meets its front it shows what the front sends out and hides what is behind, as
// much of it as the sheet covers when it is seen along the axis. A side that is the back of a surface of one side
// neither shows nor hides anything: what is looked for from a floor is not hidden by the floor, however coarse its
// texels are.
//
// One volume for all ways has the mean of what both sides send out, and of the voxels: the isotropic pyramid of figure
// 49, through whose thin walls light leaks.
#ifndef AG_VCT_SEEN_GLSL
#define AG_VCT_SEEN_GLSL

#include "core/half.glsl"
#include "frame/frame_shared.h"
#include "techniques/vct/vct_over.glsl"
#include "techniques/vct/vct_record.glsl"
#include "techniques/vct/vct_ways.glsl"
#define VCT_SLOTS(name) static_##name
#define VCT_SLOTS_BINDING 1
#include "techniques/vct/vct_slots.glsl"
#define VCT_SLOTS(name) dynamic_##name
#define VCT_SLOTS_BINDING 3
#include "techniques/vct/vct_slots.glsl"

layout(set = 0, binding = 5, scalar) readonly buffer static_records { uint static_record_words[]; };
layout(set = 0, binding = 6, scalar) readonly buffer dynamic_records { uint dynamic_record_words[]; };

struct seen
{
    vec4 along[6]; // +x −x +y −y +z −z: premultiplied radiance and opacity
};

void look_at(vct_record r, inout seen s)
{
    vec3 slopes = abs(r.normal);
    float steepest = max(slopes.x, max(slopes.y, slopes.z));
    vec4 front = vec4(r.front + r.emitted_front, 1.0) * r.opacity.x;
    vec4 back = vec4(r.back + r.emitted_back, 1.0) * r.opacity.y;
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

void look(ivec3 voxel, out seen s)
{
    for (int i = 0; i < 6; i++) s.along[i] = vec4(0.0);
    if (!vct_inside(voxel)) return;
    uint index = vct_index(voxel);
    uint slot = static_slot(index);
    uint words[VCT_RECORD_WORDS];
    if (slot != VCT_NO_SLOT) {
        for (uint k = 0u; k < VCT_RECORD_WORDS; k++) words[k] = static_record_words[slot * VCT_RECORD_WORDS + k];
        look_at(vct_unpack(words), s);
    }
    slot = dynamic_slot(index);
    if (slot != VCT_NO_SLOT) {
        for (uint k = 0u; k < VCT_RECORD_WORDS; k++) words[k] = dynamic_record_words[slot * VCT_RECORD_WORDS + k];
        look_at(vct_unpack(words), s);
    }
}

// A block of at most 2 × 2 × 2 voxels as one texel: along each axis the nearer of two covers the farther, and columns
// are averaged.
void vct_see(ivec3 from, ivec3 size, out vec4 sum[6])
{
    seen child[8];
    for (int i = 0; i < 8; i++) {
        ivec3 at = ivec3(i & 1, i >> 1 & 1, i >> 2);
        if (all(lessThan(at, size))) look(from + at, child[i]);
        else child[i].along = vec4[6](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    }
    sum = vec4[6](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    float each = 1.0 / float(size.x * size.y * size.z);
    for (int i = 0; i < 8 && !VCT_ANISOTROPIC; i++) sum[0] += each * child[i].along[0];
    for (int axis = 0; axis < 3 && VCT_ANISOTROPIC; axis++) {
        int step = 1 << axis;
        float column = each * float(size[axis]);
        for (int i = 0; i < 4; i++) {
            int low = axis == 0 ? 2 * i : axis == 1 ? (i & 1) + 4 * (i >> 1) : i;
            sum[2 * axis] += column * vct_over(child[low].along[2 * axis], child[low + step].along[2 * axis]);
            sum[2 * axis + 1] += column * vct_over(child[low + step].along[2 * axis + 1], child[low].along[2 * axis + 1]);
        }
    }
}

#endif
