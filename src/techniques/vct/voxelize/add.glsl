// Third pass: surface attributes of each face of a voxel, weighted with the area that is covered
// and not hidden by other surfaces of the face. The attributes of a face with a single large
// triangle are written at once; others are summed up in fixed point, from which surfaces.comp makes
// the same attributes.
//
// A side of a triangle belongs to the face that is nearest to its normal. The sides of a thin wall,
// and the walls that meet in an edge, thus keep normals, positions and light of their own.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/vct_constants.h"
#include "techniques/vct/voxelize/voxelize.glsl"
#include "techniques/vct/voxelize/surface.glsl"
#include "techniques/vct/voxelize/material.glsl"
#include "techniques/vct/voxelize/line_places.glsl"
#include "techniques/vct/voxelize/lines.glsl"
#include "techniques/vct/voxelize/sum_words.glsl"

#ifdef VCT_DEFERS
layout(set = 0, binding = 20, rgba32ui) uniform writeonly uimage2D vct_surfaces;
#endif

// Emission of small emitters is stored negated: diffuse cones ignore it, as shadow cones sample it
// (cones/small_emitters.glsl).
layout(constant_id = VCT_CONSTANT_SMALL_EMITTERS) const bool IS_SMALL_EMITTER = false;
layout(constant_id = VCT_CONSTANT_EMISSIVE) const
    bool EMISSIVE = true; // false: no surface of the draw emits

vec3 front_normal; // unit
vct_triangle_faces faces;

void vct_begin_triangle(vct_triangle t)
{
    vec3 normal = cross(t.b - t.a, t.c - t.b);
    normal /= length(normal);
    front_normal = push.mirrored != 0u ? -normal : normal;
    faces = vct_faces_of(t);
    vct_begin_material(t);
}

ivec3 whole(vec3 value, float one)
{
    return ivec3(roundEven(value * one));
}

// Contribution of a triangle to the sums of a voxel's face. lines: those on which it is visible, as
// bits.
vct_sums part_of(vct_surface_point s, vec3 normal, uint lines)
{
    float covered = float(bitCount(lines)) * VCT_WEIGHT_LINE, weight = max(covered, 1.0);
    float opaque = weight * s.opacity;
    uvec3 emission =
        EMISSIVE ? uvec3(whole(s.emission * vct.emission_fixed * opaque, 1.0)) : uvec3(0u);
    if (IS_SMALL_EMITTER) emission = uvec3(-ivec3(emission));
    vct_sums part;
    part.weight = uint(weight);
    part.opacity = uint(opaque);
    part.reflectance = uvec3(whole(clamp(s.reflectance, 0.0, 1.0) * opaque, VCT_COLOUR_ONE));
    part.normal = whole(normal * weight, VCT_NORMAL_ONE);
    part.position = whole(clamp(s.position, -1.0, 1.0) * weight, VCT_POSITION_ONE);
    part.emission = emission;
    part.covered = uint(covered * s.opacity);
    part.lines = part.covered > 0u ? lines : 0u;
    return part;
}

void add(uint at, uvec3 value)
{
    if (value.x != 0u) atomicAdd(sums[at], value.x);
    if (value.y != 0u) atomicAdd(sums[at + 1u], value.y);
    if (value.z != 0u) atomicAdd(sums[at + 2u], value.z);
}

void add_part(uint to, vct_sums part)
{
    atomicAdd(sums[to + VCT_SUM_WEIGHT], part.weight);
    atomicAdd(sums[to + VCT_SUM_OPACITY], part.opacity);
    add(to + VCT_SUM_REFLECTANCE, part.reflectance);
    add(to + VCT_SUM_NORMAL, uvec3(part.normal));
    add(to + VCT_SUM_POSITION, uvec3(part.position));
    if (part.covered != 0u) atomicAdd(sums[to + VCT_SUM_COVERED], part.covered);
    if (part.lines != 0u) atomicOr(sums[to + VCT_SUM_LINES], part.lines);
    if (EMISSIVE && part.emission != uvec3(0u)) add(to + VCT_SUM_EMISSION, part.emission);
}

// A triangle that no line crosses, or a hidden one, counts only where no line crosses any.
void sum_up(uint index, vct_surface_point s, vec3 normal, uvec4 lines)
{
    uint first;
    if (!vct_sum_words_of(index, first)) return;
    uint at = first + VCT_SUM_OUTERMOST;
    uvec4 outermost = uvec4(sums[at], sums[at + 1u], sums[at + 2u], sums[at + 3u]);
    uint visible = vct_visible_lines(lines, outermost);
    if (visible != 0u || outermost == uvec4(0u)) add_part(first, part_of(s, normal, visible));
}

void sum_up_faces(ivec3 voxel, vct_triangle t)
{
    vct_surface_point s = vct_surface_point_in(voxel, t);
    uvec4 lines = vct_lines_through(voxel, t, faces.front);
    sum_up(vct_face_index(voxel, faces.front), s, front_normal, lines);
    if (faces.both)
        sum_up(vct_face_index(voxel, faces.front ^ 1u), s, -front_normal, vct_lines_behind(lines));
}

#ifdef VCT_DEFERS

void write(uint index, vct_surface_point s, vec3 normal, uint lines)
{
    uint slot = is_accumulated(index) ? VCT_NO_SLOT : vct_slot(index);
    if (slot == VCT_NO_SLOT) return;
    uvec4 first, second;
    vct_pack_sums(part_of(s, normal, lines), first, second);
    ivec2 to = vct_surface_texel(slot);
    imageStore(vct_surfaces, to, first);
    if (EMISSIVE) imageStore(vct_surfaces, to + ivec2(1, 0), second);
}

void vct_visit(ivec3 voxel, vct_triangle t)
{
    uint front = vct_face_index(voxel, faces.front), back = vct_face_index(voxel, faces.front ^ 1u);
    bool front_summed = is_accumulated(front), back_summed = faces.both && is_accumulated(back);
    if (front_summed || back_summed) vct_defer(voxel, t);
    if (front_summed && (back_summed || !faces.both)) return;
    vct_surface_point s = vct_surface_point_in(voxel, t);
    uint lines = vct_visible_lines(vct_lines_through(voxel, t, faces.front), uvec4(0u));
    write(front, s, front_normal, lines);
    if (faces.both) write(back, s, -front_normal, lines);
}

void vct_visit_deferred(ivec3 voxel, vct_triangle t)
{
    sum_up_faces(voxel, t);
}

#else

void vct_visit(ivec3 voxel, vct_triangle t)
{
    sum_up_faces(voxel, t);
}

#endif
