// Radiance and opacity of a block of lit voxels of both sets along the axis directions,
// premultiplied with opacity. Include after vct_grid.glsl; takes the bindings 1 to 6.
//
// A face of a voxel has its radiance in the directions against its normal, and the opacity of its
// surfaces projected along the axis. The culled back of a single-sided surface has none: a floor
// does not occlude cones that start on it, however coarse its texels are.
//
// The isotropic volume averages all faces and voxels: figure 49, with leaks through thin
// walls.
#ifndef AG_VCT_PREFILTER_GLSL
#define AG_VCT_PREFILTER_GLSL

#include "core/half.glsl"
#include "frame/frame_shared.h"
#include "techniques/vct/vct_constants.h"
#include "techniques/vct/volume/over.glsl"
#include "techniques/vct/volume/lit_face.glsl"
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

void add_face(vct_lit_face r, inout directional s)
{
    vec3 slopes = abs(r.normal);
    float steepest = max(slopes.x, max(slopes.y, slopes.z));
    vec4 face =
        vec4(r.reflected + vct_emitted(r.emitted, vct.has_small_emitters != 0u), 1.0) * r.opacity;
    if (!VCT_ANISOTROPIC) {
        s.along[0] += face;
        s.along[1].a = max(s.along[1].a, face.a);
        return;
    }
    for (int axis = 0; axis < 3; axis++) {
        // Opaque faces stay so where a division is not exact.
        vec4 part = slopes[axis] == steepest ? face : slopes[axis] / steepest * face;
        s.along[2 * axis] += r.normal[axis] < 0.0 ? part : vec4(0.0);
        s.along[2 * axis + 1] += r.normal[axis] < 0.0 ? vec4(0.0) : part;
    }
}

// Adjacent surfaces cover disjoint parts of a voxel: their opacities add up, to 1 at most.
void limit_opacity(inout directional s)
{
    if (!VCT_ANISOTROPIC) {
        s.along[0] *= s.along[1].a / max(s.along[0].a, 1e-6);
        return;
    }
    for (int i = 0; i < 6; i++)
        if (s.along[i].a > 1.0) s.along[i] = vec4(s.along[i].rgb / s.along[i].a, 1.0);
}

void gather_in_block(ivec3 from, ivec3 at, ivec3 size, out directional s)
{
    bool inside = all(lessThan(at, size)) && vct_inside(from + at);
    uint voxel = vct_index(inside ? from + at : ivec3(0)), first = 8u * voxel;
    for (int i = 0; i < 6; i++) s.along[i] = vec4(0.0);
    // The faces of a voxel have consecutive slots.
    uint faces = inside ? static_faces(voxel) : 0u;
    uint slot = faces != 0u ? static_slot(first + uint(findLSB(faces))) : VCT_NO_SLOT;
    uint end = slot == VCT_NO_SLOT ? slot : min(slot + uint(bitCount(faces)), vct.capacity);
    for (; slot < end; slot++)
        add_face(vct_lit_face_at(static_lit_voxels, vct.face_first + slot), s);
    if (VCT_HAS_DYNAMIC) {
        faces = inside ? dynamic_faces(voxel) : 0u;
        slot = faces != 0u ? dynamic_slot(first + uint(findLSB(faces))) : VCT_NO_SLOT;
        end = slot == VCT_NO_SLOT ? slot : min(slot + uint(bitCount(faces)), vct.capacity);
        for (; slot < end; slot++)
            add_face(vct_lit_face_at(dynamic_lit_voxels, vct.face_first + slot), s);
    }
    limit_opacity(s);
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
