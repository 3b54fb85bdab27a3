// The material of a triangle in a voxel: opacity, diffuse reflectance and emission. Include after
// voxelize/voxelize.glsl.
#ifndef AG_VCT_MATERIAL_GLSL
#define AG_VCT_MATERIAL_GLSL

#include "frame/scene/scene_reflectance.glsl"

layout(set = 0, binding = 9) uniform sampler2D metallic_roughness_map;
layout(set = 0, binding = 11) uniform sampler2D emissive_map;

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

void vct_begin_material(vct_triangle t)
{
    float size = length(cross(t.b - t.a, t.c - t.b)); // twice the area in voxel faces
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

// The point of a triangle nearest to a voxel's centre.
struct vct_surface_point {
    vec3 position;    // from the voxel's centre, in voxels
    float opacity;    // 0 or 1
    vec3 reflectance; // diffuse
    vec3 emission;    // cd/m²
};

vct_surface_point vct_surface_point_in(ivec3 voxel, vct_triangle t)
{
    vec3 centre = vec3(voxel) + 0.5;
    vec3 a = t.a - centre, b = t.b - centre, c = t.c - centre;
    vec3 at = nearest_point(a, b, c);
    uint m = push.draw.material;
    vec4 color =
        scene_material_table[m].base_color * (corner_a * at.x + corner_b * at.y + corner_c * at.z);
    vec2 material = vec2(scene_material_table[m].roughness, scene_material_table[m].metallic);
    vct_surface_point s;
    s.position = a * at.x + b * at.y + c * at.z;
    s.emission = scene_material_table[m].emissive;
    if (HAS_BASE_COLOR_MAP) {
        color *= textureLod(base_color_map, map_at(base_color_coords, at), base_color_coords.lod);
        material *= textureLod(metallic_roughness_map, map_at(metallic_coords, at), 4.0).gb;
        s.emission *=
            textureLod(emissive_map, map_at(emissive_coords, at), emissive_coords.lod).rgb;
    }
    s.reflectance = scene_reflectance(m, color.rgb, material);
    s.opacity = IS_MASKED && color.a < scene_material_table[m].alpha_cutoff ? 0.0 : 1.0;
    return s;
}

#endif
