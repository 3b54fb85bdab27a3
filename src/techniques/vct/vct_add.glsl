// Second walk: what the surfaces in each voxel are, as sums of whole numbers weighted with the triangle's size. Define
// VCT_LARGE.
//
// A voxel is taken for a sheet with two sides. Which side of a triangle is the voxel's front follows from its plane
// alone, so that the two faces of a thin wall, which turn opposite ways, agree on the sheet and do not cancel.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/vct_voxelise.glsl"
#define VCT_SLOTS(name) vct_##name
#define VCT_SLOTS_BINDING 16
#include "techniques/vct/vct_slots.glsl"

layout(set = 0, binding = 9) uniform sampler2D metallic_roughness_map;
layout(set = 0, binding = 11) uniform sampler2D emissive_map;
layout(set = 0, binding = 18, scalar) buffer vct_sums { uint sums[]; };

// Barycentric coordinates of the point of a triangle that is nearest to the origin (Ericson 2005, sec. 5.1.5).
vec3 nearest_point(vec3 a, vec3 b, vec3 c)
{
    vec3 ab = b - a, ac = c - a;
    float d1 = -dot(ab, a), d2 = -dot(ac, a), d3 = -dot(ab, b), d4 = -dot(ac, b), d5 = -dot(ab, c), d6 = -dot(ac, c);
    if (d1 <= 0.0 && d2 <= 0.0) return vec3(1, 0, 0);
    if (d3 >= 0.0 && d4 <= d3) return vec3(0, 1, 0);
    if (d6 >= 0.0 && d5 <= d6) return vec3(0, 0, 1);
    float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return vec3(0, 1, 0) * (d1 / (d1 - d3)) + vec3(1, 0, 0) * (d3 / (d3 - d1));
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return vec3(0, 0, 1) * (d2 / (d2 - d6)) + vec3(1, 0, 0) * (d6 / (d6 - d2));
    float along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    if (va <= 0.0 && along >= 0.0 && along <= 1.0) return vec3(0, 1.0 - along, along);
    float sum = va + vb + vc;
    return sum > 0.0 ? vec3(va, vb, vc) / sum : vec3(1, 0, 0);
}

struct surface_point
{
    vec4 color;       // opacity in w
    vec3 reflectance; // diffuse
    vec3 emission;    // cd/m²
};

vec2 uv_of(uint map, scene_surface a, scene_surface b, scene_surface c, vec3 at)
{
    return scene_map_uv(map, a) * at.x + scene_map_uv(map, b) * at.y + scene_map_uv(map, c) * at.z;
}

// The mip whose texels are as large as a voxel on the triangle.
float voxel_lod(sampler2D map, vec2 a, vec2 b, vec2 c, float faces)
{
    vec2 size = vec2(textureSize(map, 0)), p = (b - a) * size, q = (c - a) * size;
    float texels = abs(p.x * q.y - p.y * q.x);
    return 0.5 * log2(max(texels, 1e-6) / max(faces, 1e-6));
}

// faces: twice the area of the triangle in faces of a voxel.
surface_point surface_at(uvec3 vertices, vec3 at, float faces)
{
    uint m = push.draw.material;
    scene_surface a = scene_surface_of(vertices.x), b = scene_surface_of(vertices.y), c = scene_surface_of(vertices.z);
    surface_point s;
    s.color = scene_material_table[m].base_color *
              (unpackUnorm4x8(a.color) * at.x + unpackUnorm4x8(b.color) * at.y + unpackUnorm4x8(c.color) * at.z);
    float metallic = scene_material_table[m].metallic;
    s.emission = scene_material_table[m].emissive;
    if (HAS_BASE_COLOR_MAP) {
        vec2 uva = scene_map_uv(SCENE_MAP_BASE_COLOR, a), uvb = scene_map_uv(SCENE_MAP_BASE_COLOR, b),
             uvc = scene_map_uv(SCENE_MAP_BASE_COLOR, c);
        s.color *= textureLod(base_color_map, uva * at.x + uvb * at.y + uvc * at.z,
                              voxel_lod(base_color_map, uva, uvb, uvc, faces));
        metallic *= textureLod(metallic_roughness_map, uv_of(SCENE_MAP_METALLIC_ROUGHNESS, a, b, c, at), 4.0).b;
        vec2 ea = scene_map_uv(SCENE_MAP_EMISSIVE, a), eb = scene_map_uv(SCENE_MAP_EMISSIVE, b),
             ec = scene_map_uv(SCENE_MAP_EMISSIVE, c);
        s.emission *= textureLod(emissive_map, ea * at.x + eb * at.y + ec * at.z,
                                 voxel_lod(emissive_map, ea, eb, ec, faces)).rgb;
    }
    if ((scene_material_table[m].flags & SCENE_UNLIT) != 0u) metallic = 0.0;
    s.reflectance = s.color.rgb * (1.0 - metallic);
    return s;
}

void add(uint at, vec3 value, float one)
{
    ivec3 whole = ivec3(roundEven(value * one));
    if (whole.x != 0) atomicAdd(sums[at], uint(whole.x));
    if (whole.y != 0) atomicAdd(sums[at + 1u], uint(whole.y));
    if (whole.z != 0) atomicAdd(sums[at + 2u], uint(whole.z));
}

// Planes whose normal is all but perpendicular to this are those whose sides cannot be told apart; no usual wall is.
const vec3 FRONT = vec3(0.4743, 0.8165, 0.3294);

// How much of a voxel's face the triangle covers in it, seen along its dominant axis, in sixteenths: of as many lines
// along that axis those that cross it there. Lines cross a closed surface in one voxel of their column: what the voxels
// of a slanted wall cover adds up to all.
uint covered_lines(ivec3 voxel, vct_triangle t)
{
    ivec3 cell = ivec3(turned(vec3(voxel), t.turn));
    float facing = t.normal.z < 0.0 ? -1.0 : 1.0;
    vec2 ab = facing * (t.v.xy - t.u.xy), bc = facing * (t.w.xy - t.v.xy), ca = facing * (t.u.xy - t.w.xy);
    uint lines = 0u;
    for (uint i = 0u; i < VCT_LINES; i++) {
        vec2 at = vec2(cell.xy) + (vec2(i, (i * 7u + 3u) % VCT_LINES) + 0.5) / float(VCT_LINES);
        vec2 u = at - t.u.xy, v = at - t.v.xy, w = at - t.w.xy;
        bool inside = ab.x * u.y >= ab.y * u.x && bc.x * v.y >= bc.y * v.x && ca.x * w.y >= ca.y * w.x;
        int depth = int(floor(t.u.z - dot(t.normal.xy, u) / t.normal.z));
        if (inside && clamp(depth, t.low.z, t.high.z) == cell.z) lines++;
    }
    return lines;
}

void vct_visit(ivec3 voxel, vct_triangle t)
{
    uint slot = vct_slot(vct_index(voxel));
    if (slot == VCT_NO_SLOT) return;
    vec3 centre = vec3(voxel) + 0.5;
    vec3 a = t.a - centre, b = t.b - centre, c = t.c - centre;
    vec3 at = nearest_point(a, b, c);
    vec3 position = a * at.x + b * at.y + c * at.z;
    vec3 normal = cross(t.b - t.a, t.c - t.b);
    float faces = length(normal);
    surface_point s = surface_at(t.vertices, at, faces);
    if (IS_MASKED) s.color.a = s.color.a >= scene_material_table[push.draw.material].alpha_cutoff ? 1.0 : 0.0;
    else s.color.a = 1.0;

    normal /= faces;
    bool turned_over = dot(normal, FRONT) < 0.0;
    bool front = turned_over == (push.mirrored != 0u); // whether the triangle's front is the sheet's
    uint lines = covered_lines(voxel, t);
    float weight = max(float(lines) * VCT_WEIGHT_LINE, 1.0);
    float opaque = weight * s.color.a;
    uint covered = uint(roundEven(float(lines) * VCT_WEIGHT_LINE * s.color.a));
    uint to = slot * VCT_SUM_WORDS;
    atomicAdd(sums[to + VCT_SUM_WEIGHT], uint(weight));
    atomicAdd(sums[to + VCT_SUM_OPACITY], uint(roundEven(opaque)));
    add(to + VCT_SUM_REFLECTANCE, clamp(s.reflectance, 0.0, 1.0) * opaque, VCT_COLOUR_ONE);
    add(to + VCT_SUM_NORMAL, (turned_over ? -normal : normal) * weight, VCT_NORMAL_ONE);
    add(to + VCT_SUM_POSITION, clamp(position, -1.0, 1.0) * weight, VCT_POSITION_ONE);
    bool both = (scene_material_table[push.draw.material].flags & SCENE_DOUBLE_SIDED) != 0u;
    if (front || both) atomicAdd(sums[to + VCT_SUM_FRONTS], covered);
    if (!front || both) atomicAdd(sums[to + VCT_SUM_BACKS], covered);
    vec3 emission = s.emission * vct.emission_fixed * opaque;
    if (!any(greaterThan(emission, vec3(0.0)))) return;
    if (front || both) add(to + VCT_SUM_FRONT, emission, 1.0);
    if (!front || both) add(to + VCT_SUM_BACK, emission, 1.0);
}
