// Reflecting surfaces by cell: Σ ρ A n_a² and Σ A n_a² over the surfaces that inject into the cell,
// for each of six directions ±a by the sign of their normals n. ρ is diffuse reflectance in RGB, A
// area in cells². The three n_a² sum to 1: a surface of normal n counts as three along the axes,
// scaled to the light of a slope.
//
// A triangle is sampled where lines along its largest axis cross it, LPV_SURFACE_LINES² per face of
// a cell. Sums are integers: the order of triangles does not change a bit. One invocation takes one
// triangle; the whole workgroup shares a large one.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/scene/scene_triangles.glsl"
#include "frame/scene/scene_reflectance.glsl"
#include "techniques/lpv/lpv_grid.glsl"

layout(local_size_x = SCENE_TRIANGLES_LOCAL) in;

layout(set = 0, binding = 9) uniform sampler2D metallic_roughness_map;
layout(set = 0, binding = 12, scalar) buffer lpv_surfaces
{
    // [cell][direction +x −x +y −y +z −z][red, green, blue, area], 1/LPV_SURFACE_UNIT cells²
    uint surfaces[];
};

layout(constant_id = LPV_CONSTANT_CLOSURE) const int LPV_CLOSURE = LPV_NO_CLOSURE;
const int LINES = LPV_SURFACE_LINES;
const int MAX_LINES = 64; // that one invocation tests alone

shared uint large[SCENE_TRIANGLES_LOCAL];
shared uint large_count;

struct triangle {
    uvec3 vertices;
    mat3 corners;       // in cells from the grid's corner
    vec3 normal;        // of the front side
    int axis;           // nearest to the normal
    ivec2 first, count; // lines that cross its bounding box
    float lod;          // of the base colour map, for the spacing of lines
};

vec2 projected(vec3 v, int axis)
{
    return vec2(v[(axis + 1) % 3], v[(axis + 2) % 3]);
}

// Its sign flips exactly where a and b are swapped, so that triangles with a common edge leave no
// gap.
float cross_2d(vec2 a, vec2 b)
{
    precise float left = a.x * b.y, right = a.y * b.x;
    precise float result = left - right;
    return result;
}

vec2 map_uv(uint map, uint vertex)
{
    return scene_map_uv(map, scene_surface_of(vertex));
}

float lod_of(uvec3 vertices, float area)
{
    vec2 size = vec2(textureSize(base_color_map, 0));
    vec2 a = map_uv(SCENE_MAP_BASE_COLOR, vertices.x) * size,
         b = map_uv(SCENE_MAP_BASE_COLOR, vertices.y) * size;
    vec2 c = map_uv(SCENE_MAP_BASE_COLOR, vertices.z) * size;
    float texels =
        0.5 * abs(cross_2d(b - a, c - a)) / max(area * float(LINES * LINES), 1e-12); // per sample
    return 0.5 * log2(max(texels, 1.0));
}

bool triangle_of(uint i, out triangle t)
{
    t.vertices = scene_triangle(i);
    mat3 world = scene_triangle_positions(t.vertices);
    for (int k = 0; k < 3; k++) {
        t.corners[k] = lpv_cells_from_world(world[k]);
        if (!all(lessThan(abs(t.corners[k]), vec3(1e6)))) return false;
    }
    vec3 twice = cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
    float area = 0.5 * length(twice);
    if (area < 1e-12) return false;
    t.normal = twice / (2.0 * area);
    if (determinant(mat3(scene_world_from_instance())) < 0.0) t.normal = -t.normal;
    vec3 size = abs(t.normal);
    t.axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    vec2 a = projected(t.corners[0], t.axis), b = projected(t.corners[1], t.axis),
         c = projected(t.corners[2], t.axis);
    // Line i is at (i + 1/2) / LINES cells.
    vec2 low = min(a, min(b, c)) * float(LINES) - 0.5,
         high = max(a, max(b, c)) * float(LINES) - 0.5;
    ivec2 end = ivec2(lpv_cells()[(t.axis + 1) % 3], lpv_cells()[(t.axis + 2) % 3]) * LINES - 1;
    t.first = max(ivec2(ceil(low)), ivec2(0));
    t.count = max(min(ivec2(floor(high)), end) - t.first + 1, ivec2(0));
    t.lod = lod_of(t.vertices, area);
    return true;
}

// Diffuse reflectance as in reflective shadow maps.
vec3 reflectance_at(triangle t, vec3 weight)
{
    uint m = push.draw.material;
    vec2 uv = vec2(0.0), metallic_uv = vec2(0.0);
    vec3 colour = vec3(0.0);
    for (int k = 0; k < 3; k++) {
        uv += weight[k] * map_uv(SCENE_MAP_BASE_COLOR, t.vertices[k]);
        metallic_uv += weight[k] * map_uv(SCENE_MAP_METALLIC_ROUGHNESS, t.vertices[k]);
        colour += weight[k] * unpackUnorm4x8(scene_surface_of(t.vertices[k]).color).rgb;
    }
    colour *= scene_material_table[m].base_color.rgb * textureLod(base_color_map, uv, t.lod).rgb;
    vec2 roughness_metallic =
        vec2(scene_material_table[m].roughness, scene_material_table[m].metallic) *
        textureLod(metallic_roughness_map, metallic_uv, t.lod).gb;
    return scene_reflectance(m, colour, roughness_metallic);
}

// Area and reflectance of a slope over those of its sides, in light that fills its hemisphere: the
// side of axis a receives (1 + |n_a|)/2 of E(n), and as much of the cosine around a leaves the
// slope. With three closed bands the rest returns to lookups at the slope.
vec4 slope_over_sides(vec3 normal)
{
    float factor = 2.0 / (1.0 + dot(normal * normal, abs(normal)));
    return LPV_CLOSURE == LPV_PRODUCT_CLOSURE ? vec4(1.0) : vec4(vec3(factor * factor), factor);
}

void add_side(vec3 position, vec3 normal, vec4 amount)
{
    ivec3 cell = ivec3(floor(position + 0.5 * normal));
    if (!lpv_inside(cell)) return;
    amount *= slope_over_sides(normal);
    for (int axis = 0; axis < 3; axis++) {
        int at = 24 * lpv_index(cell) + 4 * (2 * axis + (normal[axis] < 0.0 ? 1 : 0));
        uvec4 fixed_amount = uvec4(round(amount * normal[axis] * normal[axis] * LPV_SURFACE_UNIT));
        for (int c = 0; c < 4; c++)
            if (fixed_amount[c] > 0u) atomicAdd(surfaces[at + c], fixed_amount[c]);
    }
}

void add_line(triangle t, ivec2 line)
{
    vec2 p = (vec2(line) + 0.5) / float(LINES);
    vec2 a = projected(t.corners[0], t.axis) - p, b = projected(t.corners[1], t.axis) - p,
         c = projected(t.corners[2], t.axis) - p;
    vec3 weight = vec3(cross_2d(b, c), cross_2d(c, a), cross_2d(a, b));
    if (!all(greaterThanEqual(weight, vec3(0.0))) && !all(lessThanEqual(weight, vec3(0.0)))) return;
    float area = weight.x + weight.y + weight.z;
    if (area == 0.0) return; // parallel to the line
    weight /= area;
    vec3 position = t.corners * weight;
    if (!scene_triangle_solid(t.vertices, weight)) return; // alpha mask
    vec4 amount =
        vec4(reflectance_at(t, weight), 1.0) / (float(LINES * LINES) * abs(t.normal[t.axis]));
    add_side(position, t.normal, amount);
    if ((scene_material_table[push.draw.material].flags & SCENE_DOUBLE_SIDED) != 0u)
        add_side(position, -t.normal, amount);
}

// Every `stride`th line from index `first`.
void add_lines(triangle t, int first, int stride)
{
    for (int i = first; i < t.count.x * t.count.y; i += stride)
        add_line(t, t.first + ivec2(i % t.count.x, i / t.count.x));
}

void main()
{
    triangle t;
    uint i = gl_GlobalInvocationID.x;
    if (gl_LocalInvocationIndex == 0u) large_count = 0u;
    barrier();
    if (i < push.triangle_count && triangle_of(i, t)) {
        if (t.count.x * t.count.y <= MAX_LINES)
            add_lines(t, 0, 1);
        else
            large[atomicAdd(large_count, 1u)] = i;
    }
    barrier();
    for (uint k = 0u; k < large_count; k++)
        if (triangle_of(large[k], t))
            add_lines(t, int(gl_LocalInvocationIndex), SCENE_TRIANGLES_LOCAL);
}
