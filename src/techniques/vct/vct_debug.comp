// Debug views: the first occupied voxel along the view ray. Each level of the clip map is marched
// where cones sample it: before and behind the box of the next finer level.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 9
#include "frame/frame.glsl"
#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/clipmap/clipmap.glsl"
#include "techniques/vct/volume/lit_face.glsl"
#include "techniques/vct/voxelize/surface.glsl"
#define VCT_SLOTS(name)   static_##name
#define VCT_SLOTS_BINDING 1
#include "techniques/vct/voxelize/slots.glsl"
#define VCT_SLOTS(name)   dynamic_##name
#define VCT_SLOTS_BINDING 3
#include "techniques/vct/voxelize/slots.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform push_block
{
    vct_view_push push;
};
layout(set = 0, binding = 5) uniform usampler2D static_lit_voxels;
layout(set = 0, binding = 6) uniform usampler2D dynamic_lit_voxels;
layout(set = 0, binding = 10) uniform usampler2D static_surfaces;
layout(set = 0, binding = 11) uniform usampler2D dynamic_surfaces;
layout(set = 0, binding = 7, rgba16f) uniform image2D result_image; // alpha: the pixel is done

#if VCT_SVO
layout(set = 0, binding = 8, scalar) readonly buffer vct_svo_nodes
{
    uint nodes[];
};
#include "techniques/vct/octree/octree.glsl"
#endif

// Whether a voxel is occupied. stored: it is within the capacity and has light.
bool occupied(ivec3 voxel, out bool stored)
{
    uint index = vct_index(voxel), of_static = static_faces(index),
         of_dynamic = dynamic_faces(index);
    bool is_static = of_static != 0u, is_dynamic = of_dynamic != 0u;
    stored = (!is_static || static_slot(8u * index + uint(findMSB(of_static))) != VCT_NO_SLOT) &&
             (!is_dynamic || dynamic_slot(8u * index + uint(findMSB(of_dynamic))) != VCT_NO_SLOT);
#if VCT_SVO
    ivec3 leaf = min((voxel + 1) >> 2, svo_nodes_in_use(0) - 1);
    stored = stored && svo_find(leaf, svo.depths - 1u) != SVO_NONE;
#endif
    return is_static || is_dynamic;
}

struct viewed_face {
    vct_lit_face lit;
    vec3 reflectance;
};

vec3 surface_colour(viewed_face f, vec3 direction)
{
    if (push.view == VCT_VIEW_REFLECTANCE) return f.reflectance * push.reflectance_scale;
    if (push.view == VCT_VIEW_NORMAL) return (f.lit.normal * 0.5 + 0.5) * push.reflectance_scale;
    return dot(f.lit.normal, direction) < 0.0 ? f.lit.reflected + vct_emitted(f.lit.emitted, true)
                                              : vec3(0.0);
}

// The face of a voxel that faces the camera most, of moving draws if they have any.
bool face_at(ivec3 voxel, vec3 direction, out viewed_face found)
{
    float most = -2.0;
    for (uint face = 0u; face < VCT_FACES; face++) {
        uint index = vct_face_index(voxel, face), slot = dynamic_slot(index);
        bool moving = slot != VCT_NO_SLOT;
        if (!moving) slot = static_slot(index);
        if (slot == VCT_NO_SLOT) continue;
        viewed_face f;
        if (moving)
            f.lit = vct_lit_face_at(dynamic_lit_voxels, vct.face_first + slot);
        else
            f.lit = vct_lit_face_at(static_lit_voxels, vct.face_first + slot);
        float towards = -dot(f.lit.normal, direction);
        if (towards <= most) continue;
        most = towards;
        uvec4 surface = moving ? texelFetch(dynamic_surfaces, vct_surface_texel(slot), 0)
                               : texelFetch(static_surfaces, vct_surface_texel(slot), 0);
        f.reflectance = vct_unpack_surface(surface).reflectance;
        found = f;
    }
    return most > -2.0;
}

vec3 overflow_colour(ivec3 voxel, vec3 direction, bool stored)
{
    viewed_face f;
    float grey =
        face_at(voxel, direction, f) ? 0.2 * dot(f.reflectance, vec3(0.2126, 0.7152, 0.0722)) : 0.0;
    return (stored ? vec3(grey) : vec3(0.3, 0.0, 0.0)) * push.reflectance_scale;
}

vec3 level_colour(vct_lit_face r, vec3 direction)
{
    const vec3 colours[VCT_MAX_CLIPS] =
        vec3[](vec3(0.9, 0.2, 0.15), vec3(0.9, 0.6, 0.1), vec3(0.4, 0.75, 0.2),
               vec3(0.1, 0.65, 0.8), vec3(0.25, 0.35, 0.9), vec3(0.7, 0.3, 0.8));
    return colours[vct.level] *
           ((0.3 + 0.7 * abs(dot(r.normal, direction))) * push.reflectance_scale);
}

// Colour of a voxel in the view. False: empty.
bool colour_of(ivec3 voxel, vec3 direction, out vec3 colour)
{
    viewed_face f;
    bool stored;
    if (push.view == VCT_VIEW_OVERFLOW) {
        if (!occupied(voxel, stored)) return false;
        colour = overflow_colour(voxel, direction, stored);
        return true;
    }
    if (!face_at(voxel, direction, f)) return false;
    colour = push.view == VCT_VIEW_LEVELS ? level_colour(f.lit, direction)
                                          : surface_colour(f, direction);
    return true;
}

// Distances at which a ray enters and leaves a box.
vec2 intersect_box(vec3 low, vec3 high, vec3 from, vec3 inverse)
{
    vec3 a = (low - from) * inverse, b = (high - from) * inverse, near = min(a, b), far = max(a, b);
    return vec2(max(max(near.x, max(near.y, near.z)), 0.0), min(far.x, min(far.y, far.z)));
}

// Intersects the cone box of a level, in voxels of this one. The coarsest level is sampled
// everywhere.
vec2 intersect_level(int level, vec3 from, vec3 inverse)
{
    if (level == VCT_CLIPS - 1) return intersect_box(vec3(0.0), vec3(vct_cells()), from, inverse);
    float voxels = 2.0 / float(1 << vct.level);
    return intersect_box(clips.levels[level].low * voxels + vct.scene_low,
                         clips.levels[level].high * voxels + vct.scene_low, from, inverse);
}

// Segment of the ray in this level: before or behind the next finer one.
vec2 segment_of(vec3 from, vec3 inverse)
{
    vec2 own = intersect_level(vct.level, from, inverse), finer = vec2(0.0);
    own = vec2(max(own.x, intersect_box(vec3(0.0), vec3(vct_cells()), from, inverse).x), own.y);
    if (vct.level == 0) return own;
    finer = intersect_level(vct.level - 1, from, inverse);
    bool crosses = finer.x < finer.y;
    if ((push.march & VCT_MARCH_INTO) != 0u)
        return vec2(own.x, crosses ? min(own.y, finer.x) : own.y);
    return vec2(max(own.x, finer.y), crosses ? own.y : 0.0);
}

// Voxel traversal (Amanatides & Woo 1987).
bool march(vec3 from, vec3 direction, out vec3 colour)
{
    vec3 inverse = 1.0 / mix(direction, vec3(1e-12), lessThan(abs(direction), vec3(1e-12)));
    vec2 segment = segment_of(from, inverse);
    float start = segment.x + 1e-3;
    vec3 at = from + direction * start;
    ivec3 voxel = ivec3(floor(at)), step = ivec3(sign(direction));
    vec3 next = (vec3(voxel) + max(vec3(step), vec3(0.0)) - at) * inverse;
    for (int i = 0; i < 3 * vct.dim && vct_inside(voxel); i++) {
        if (colour_of(voxel, direction, colour)) return true;
        float nearest = min(next.x, min(next.y, next.z));
        if (VCT_CLIPS > 1 && start + nearest >= segment.y) return false;
        if (next.x <= next.y && next.x <= next.z) {
            voxel.x += step.x;
            next.x += abs(inverse.x);
        } else if (next.y <= next.z) {
            voxel.y += step.y;
            next.y += abs(inverse.y);
        } else {
            voxel.z += step.z;
            next.z += abs(inverse.z);
        }
    }
    return false;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    vec4 before = (push.march & VCT_MARCH_FIRST) != 0u ? vec4(0.0) : imageLoad(result_image, pixel);
    if (before.a > 0.0) return;
    vec2 uv = frame_uv(uvec2(pixel));
    vec3 colour = vec3(0.0);
    bool hit =
        march(vct_voxels_from_world(frame_ray_origin(uv)), normalize(frame_view_ray(uv)), colour);
    bool done = hit || (push.march & VCT_MARCH_LAST) != 0u;
    imageStore(result_image, pixel,
               vec4(hit ? clamp(colour, 0.0, HALF_MAX) : vec3(0.0), done ? 1.0 : 0.0));
}
