// Second pass: surface attributes of each face of a voxel, weighted with the covered area. The
// attributes of a face with a single large triangle are written at once; others are summed up in
// fixed point, from which surfaces.comp makes the same attributes.
//
// A side of a triangle belongs to the face that is nearest to its normal. The sides of a thin wall,
// and the walls that meet in an edge, thus keep normals, positions and light of their own.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#ifndef VCT_RASTER
#if VCT_LARGE
#define VCT_DEFERS
#endif
#endif
#include "techniques/vct/vct_constants.h"
#include "techniques/vct/voxelize/voxelize.glsl"
#include "frame/scene_reflectance.glsl"
#include "techniques/vct/voxelize/surface.glsl"
#define VCT_SLOTS(name)   vct_##name
#define VCT_SLOTS_BINDING 16
#include "techniques/vct/voxelize/slots.glsl"

layout(set = 0, binding = 9) uniform sampler2D metallic_roughness_map;
layout(set = 0, binding = 11) uniform sampler2D emissive_map;
layout(set = 0, binding = 18, scalar) buffer vct_sum_words
{
    uint sums[];
};
#ifdef VCT_DEFERS
layout(set = 0, binding = 19, scalar) readonly buffer vct_accumulated
{
    uint accumulated[];
};
layout(set = 0, binding = 20, rgba32ui) uniform writeonly uimage2D vct_surfaces;
#endif

// Emission of small emitters is stored negated: diffuse cones ignore it, as shadow cones sample it
// (cones/small_emitters.glsl).
layout(constant_id = VCT_CONSTANT_SMALL_EMITTERS) const bool IS_SMALL_EMITTER = false;
layout(constant_id = VCT_CONSTANT_EMISSIVE) const
    bool EMISSIVE = true; // false: no surface of the draw emits

// Barycentric coordinates of the point of a triangle that is nearest to the origin (Ericson 2005,
// sec. 5.1.5).
vec3 nearest_point(vec3 a, vec3 b, vec3 c)
{
    vec3 ab = b - a, ac = c - a;
    float d1 = -dot(ab, a), d2 = -dot(ac, a), d3 = -dot(ab, b), d4 = -dot(ac, b), d5 = -dot(ab, c),
          d6 = -dot(ac, c);
    if (d1 <= 0.0 && d2 <= 0.0) return vec3(1, 0, 0);
    if (d3 >= 0.0 && d4 <= d3) return vec3(0, 1, 0);
    if (d6 >= 0.0 && d5 <= d6) return vec3(0, 0, 1);
    float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0)
        return vec3(0, 1, 0) * (d1 / (d1 - d3)) + vec3(1, 0, 0) * (d3 / (d3 - d1));
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0)
        return vec3(0, 0, 1) * (d2 / (d2 - d6)) + vec3(1, 0, 0) * (d6 / (d6 - d2));
    float along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    if (va <= 0.0 && along >= 0.0 && along <= 1.0) return vec3(0, 1.0 - along, along);
    float sum = va + vb + vc;
    return sum > 0.0 ? vec3(va, vb, vc) / sum : vec3(1, 0, 0);
}

// Texture coordinates at the corners, and the mip whose texels are as large as a voxel.
struct map_coords {
    vec2 a, b, c;
    float lod;
};

vec2 map_at(map_coords map, vec3 at)
{
    return map.a * at.x + map.b * at.y + map.c * at.z;
}

map_coords map_coords_of(uint map, scene_surface a, scene_surface b, scene_surface c)
{
    return map_coords(scene_map_uv(map, a), scene_map_uv(map, b), scene_map_uv(map, c), 0.0);
}

// size_in_faces: twice the area of the triangle in voxel faces.
float voxel_lod(sampler2D map, map_coords place, float size_in_faces)
{
    vec2 size = vec2(textureSize(map, 0)), p = (place.b - place.a) * size,
         q = (place.c - place.a) * size;
    float texels = abs(p.x * q.y - p.y * q.x);
    return 0.5 * log2(max(texels, 1e-6) / max(size_in_faces, 1e-6));
}

// Constant over a triangle: fetched once, before its voxels.
vec4 corner_a, corner_b, corner_c; // colours
map_coords base_color_coords, metallic_coords, emissive_coords;
vec3 front_normal; // unit
int first_row;     // of the tile
vct_triangle_faces faces;

void vct_begin_triangle(vct_triangle t, ivec2 first)
{
    first_row = first.y;
    vec3 normal = cross(t.b - t.a, t.c - t.b);
    float size = length(normal); // twice the area of the triangle in voxel faces
    normal /= size;
    front_normal = push.mirrored != 0u ? -normal : normal;
    faces = vct_faces_of(t);
    scene_surface a = scene_surface_of(t.vertices.x), b = scene_surface_of(t.vertices.y),
                  c = scene_surface_of(t.vertices.z);
    corner_a = unpackUnorm4x8(a.color);
    corner_b = unpackUnorm4x8(b.color);
    corner_c = unpackUnorm4x8(c.color);
    if (!HAS_BASE_COLOR_MAP) return;
    base_color_coords = map_coords_of(SCENE_MAP_BASE_COLOR, a, b, c);
    base_color_coords.lod = voxel_lod(base_color_map, base_color_coords, size);
    metallic_coords = map_coords_of(SCENE_MAP_METALLIC_ROUGHNESS, a, b, c);
    emissive_coords = map_coords_of(SCENE_MAP_EMISSIVE, a, b, c);
    emissive_coords.lod = voxel_lod(emissive_map, emissive_coords, size);
}

struct surface_point {
    vec4 color;       // opacity in w
    vec3 reflectance; // diffuse
    vec3 emission;    // cd/m²
};

surface_point surface_at(vec3 at)
{
    uint m = push.draw.material;
    surface_point s;
    s.color =
        scene_material_table[m].base_color * (corner_a * at.x + corner_b * at.y + corner_c * at.z);
    vec2 material = vec2(scene_material_table[m].roughness, scene_material_table[m].metallic);
    s.emission = scene_material_table[m].emissive;
    if (HAS_BASE_COLOR_MAP) {
        s.color *= textureLod(base_color_map, map_at(base_color_coords, at), base_color_coords.lod);
        material *= textureLod(metallic_roughness_map, map_at(metallic_coords, at), 4.0).gb;
        s.emission *=
            textureLod(emissive_map, map_at(emissive_coords, at), emissive_coords.lod).rgb;
    }
    s.reflectance = scene_reflectance(m, s.color.rgb, material);
    return s;
}

// Coverage of a voxel's face along the triangle's dominant axis, in sixteenths: sample lines along
// that axis which cross the triangle in this voxel. A line crosses a surface in one voxel of its
// column, so that the coverage of a slanted wall adds up to 1.
uint covered_lines(ivec3 voxel, vct_triangle t)
{
    ivec3 cell = ivec3(permuted(vec3(voxel), t.turn));
    float facing = t.normal.z < 0.0 ? -1.0 : 1.0;
    vec2 ab = facing * (t.v.xy - t.u.xy), bc = facing * (t.w.xy - t.v.xy),
         ca = facing * (t.u.xy - t.w.xy);
    vec2 slope = t.normal.xy / t.normal.z;
    uint lines = 0u;
    for (uint i = 0u; i < VCT_LINES; i++) {
        vec2 at = vec2(cell.xy) + (vec2(i, (i * 7u + 3u) % VCT_LINES) + 0.5) / float(VCT_LINES);
        vec2 u = at - t.u.xy, v = at - t.v.xy, w = at - t.w.xy;
        bool inside =
            ab.x * u.y >= ab.y * u.x && bc.x * v.y >= bc.y * v.x && ca.x * w.y >= ca.y * w.x;
        float depth = clamp(floor(t.u.z - dot(slope, u)), float(t.depths.x), float(t.depths.y));
        lines += inside && depth == float(cell.z) ? 1u : 0u;
    }
    return lines;
}

ivec3 whole(vec3 value, float one)
{
    return ivec3(roundEven(value * one));
}

// Contribution of the triangle's front to the sums of a voxel's face.
vct_sums part_of(ivec3 voxel, vct_triangle t)
{
    vec3 centre = vec3(voxel) + 0.5;
    vec3 a = t.a - centre, b = t.b - centre, c = t.c - centre;
    vec3 at = nearest_point(a, b, c);
    vec3 position = a * at.x + b * at.y + c * at.z;
    surface_point s = surface_at(at);
    if (IS_MASKED)
        s.color.a = s.color.a >= scene_material_table[push.draw.material].alpha_cutoff ? 1.0 : 0.0;
    else
        s.color.a = 1.0;
    float covered = float(covered_lines(voxel, t)) * VCT_WEIGHT_LINE, weight = max(covered, 1.0);
    float opaque = weight * s.color.a;
    uvec3 emission =
        EMISSIVE ? uvec3(whole(s.emission * vct.emission_fixed * opaque, 1.0)) : uvec3(0u);
    if (IS_SMALL_EMITTER) emission = uvec3(-ivec3(emission));
    vct_sums sums;
    sums.weight = uint(weight);
    sums.opacity = uint(opaque);
    sums.reflectance = uvec3(whole(clamp(s.reflectance, 0.0, 1.0) * opaque, VCT_COLOUR_ONE));
    sums.normal = whole(front_normal * weight, VCT_NORMAL_ONE);
    sums.position = whole(clamp(position, -1.0, 1.0) * weight, VCT_POSITION_ONE);
    sums.emission = emission;
    sums.covered = uint(covered * s.color.a);
    return sums;
}

// That of its back.
vct_sums behind(vct_sums front)
{
    front.normal = -front.normal;
    return front;
}

void add(uint at, uvec3 value)
{
    if (value.x != 0u) atomicAdd(sums[at], value.x);
    if (value.y != 0u) atomicAdd(sums[at + 1u], value.y);
    if (value.z != 0u) atomicAdd(sums[at + 2u], value.z);
}

void add_part(uint slot, vct_sums part)
{
    uint to = slot * VCT_SUM_WORDS;
    atomicAdd(sums[to + VCT_SUM_WEIGHT], part.weight);
    atomicAdd(sums[to + VCT_SUM_OPACITY], part.opacity);
    add(to + VCT_SUM_REFLECTANCE, part.reflectance);
    add(to + VCT_SUM_NORMAL, uvec3(part.normal));
    add(to + VCT_SUM_POSITION, uvec3(part.position));
    if (part.covered != 0u) atomicAdd(sums[to + VCT_SUM_COVERED], part.covered);
    if (EMISSIVE && part.emission != uvec3(0u)) add(to + VCT_SUM_EMISSION, part.emission);
}

#ifdef VCT_DEFERS

bool is_accumulated(uint index)
{
    return (accumulated[index >> 5] >> (index & 31u) & 1u) != 0u;
}

void write(uint index, vct_sums part)
{
    uint slot = is_accumulated(index) ? VCT_NO_SLOT : vct_slot(index);
    if (slot == VCT_NO_SLOT) return;
    uvec4 first, second;
    vct_pack_sums(part, first, second);
    ivec2 to = vct_surface_texel(slot);
    imageStore(vct_surfaces, to, first);
    if (EMISSIVE) imageStore(vct_surfaces, to + ivec2(1, 0), second);
}

void vct_visit(ivec3 voxel, vct_triangle t)
{
    uint front = vct_face_index(voxel, faces.front), back = vct_face_index(voxel, faces.front ^ 1u);
    bool front_summed = is_accumulated(front), back_summed = faces.both && is_accumulated(back);
    if (front_summed || back_summed)
        vct_deferred |= 1u << uint(ivec3(permuted(vec3(voxel), t.turn)).y - first_row);
    if (front_summed && (back_summed || !faces.both)) return;
    vct_sums part = part_of(voxel, t);
    write(front, part);
    if (faces.both) write(back, behind(part));
}

void sum_up(uint index, vct_sums part)
{
    uint slot = is_accumulated(index) ? vct_slot(index) : VCT_NO_SLOT;
    if (slot != VCT_NO_SLOT) add_part(slot, part);
}

void vct_visit_deferred(ivec3 voxel, vct_triangle t)
{
    vct_sums part = part_of(voxel, t);
    sum_up(vct_face_index(voxel, faces.front), part);
    if (faces.both) sum_up(vct_face_index(voxel, faces.front ^ 1u), behind(part));
}

#else

void vct_visit(ivec3 voxel, vct_triangle t)
{
    vct_sums part = part_of(voxel, t);
    uint slot = vct_slot(vct_face_index(voxel, faces.front));
    if (slot != VCT_NO_SLOT) add_part(slot, part);
    slot = faces.both ? vct_slot(vct_face_index(voxel, faces.front ^ 1u)) : VCT_NO_SLOT;
    if (slot != VCT_NO_SLOT) add_part(slot, behind(part));
}

#endif
