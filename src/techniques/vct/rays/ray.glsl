// Rays through the faces of the voxels. A face stores the plane of its surfaces: a ray meets that
// plane within the voxel, at the true distance and on one side, so that nothing behind a thin
// partition is seen. Within blocks a ray passes from voxel to voxel (Amanatides & Woo 1987); empty
// space is skipped by the mips of occupancy. Faces that are covered in part accumulate as samples
// of cones do (volume/over.glsl). Where a ray leaves a level of the clip map it goes on in the next
// coarser one. Include after vct_grid.glsl and clipmap/clipmap.glsl.
#ifndef AG_VCT_RAY_GLSL
#define AG_VCT_RAY_GLSL

#include "techniques/vct/rays/plane.glsl"
#include "techniques/vct/rays/rays_shared.h"
#include "techniques/vct/vct_constants.h"
#include "techniques/vct/volume/directions.glsl"
#include "techniques/vct/volume/lit_face.glsl"
#include "techniques/vct/volume/over.glsl"

layout(set = 0, binding = 24) uniform usampler3D vct_blocks;
layout(set = 0, binding = 25) uniform usampler3D static_first_slots;
layout(set = 0, binding = 26) uniform usampler3D dynamic_first_slots;
layout(set = 0, binding = 27) uniform usampler2D static_planes;
layout(set = 0, binding = 28) uniform usampler2D dynamic_planes;
layout(set = 0, binding = 29) uniform usampler2D static_lit_voxels;
layout(set = 0, binding = 30) uniform usampler2D dynamic_lit_voxels;

layout(constant_id = VCT_CONSTANT_RAYS) const bool VCT_RAYS = false;
layout(constant_id = VCT_CONSTANT_HAS_DYNAMIC) const
    bool VCT_HAS_DYNAMIC = true;   // false: the second set is empty
const float VCT_RAY_LIFT = 0.1;    // of the start along the normal, voxels
const float VCT_RAY_OPAQUE = 0.98; // a ray of this opacity ends
// A ray meets a plane up to this far beyond the voxel, so that none passes between the planes of
// neighbours on a curved surface. In voxels along the ray.
const float VCT_RAY_SEAM = 0.1;
const float VCT_RAY_STEP = 1e-3; // voxels beyond a border: within the next voxel for certain
// Rounding of a plane, and the sagitta of a curved surface, in voxels: the back of the surface on
// which a ray starts is not an occluder.
const float VCT_RAY_LEAST = 0.01, VCT_RAY_OWN = 0.25;
const float VCT_RAY_COVERED = 0.1; // least opacity of a texel whose radiance is taken

struct vct_ray {
    vec3 from, direction, inverse; // in voxels of the level's grid
    vec3 normal;                   // of the surface at the start
    uint facing, facing_aligned;   // faces that may face the ray, a byte for each voxel
    float end;                     // distance at which it leaves the level or ends
    float most;                    // distance at which it ends in any level
    int level;                     // of the clip map, 0 is the finest
};

// Voxels of a level along a side of one of the finest level.
float vct_ray_scale(vct_ray ray)
{
    return VCT_CLIPS > 1 ? 1.0 / float(1 << ray.level) : 1.0;
}

// A place in texels of the finest level, in voxels of a level's grid.
vec3 vct_ray_place_in(vec3 at, int level)
{
    if (VCT_CLIPS == 1) return 2.0 * at;
    return (at - clips.levels[level].corner) * (2.0 / float(1 << level));
}

// Faces whose normals can be against the direction. slope: of their normals to the axis.
uint vct_facing(vec3 d, float slope)
{
    vec3 across = slope * vec3(abs(d.y) + abs(d.z), abs(d.x) + abs(d.z), abs(d.x) + abs(d.y));
    bvec3 front = lessThan(d, across), back = lessThan(-d, across);
    return (front.x ? 1u : 0u) | (back.x ? 2u : 0u) | (front.y ? 4u : 0u) | (back.y ? 8u : 0u) |
           (front.z ? 16u : 0u) | (back.z ? 32u : 0u);
}

// Distance to the exit from a box.
float vct_ray_exit(vct_ray ray, vec3 low, float size)
{
    vec3 ends = low + mix(vec3(0.0), vec3(size), greaterThan(ray.direction, vec3(0.0)));
    vec3 t = (ends - ray.from) * ray.inverse;
    return min(t.x, min(t.y, t.z));
}

float vct_ray_end(vct_ray ray)
{
    vec3 cells = VCT_CLIPS > 1 ? 2.0 * clips.levels[ray.level].size : vec3(vct_cells());
    if (any(lessThan(ray.from, vec3(0.0))) || any(greaterThanEqual(ray.from, cells))) return 0.0;
    vec3 low = vec3(0.0), high = cells;
    if (VCT_CLIPS > 1) {
        low = max(low, vct_ray_place_in(clips.levels[ray.level].low, ray.level));
        high = min(high, vct_ray_place_in(clips.levels[ray.level].high, ray.level));
    }
    vec3 ends = mix(low, high, greaterThan(ray.direction, vec3(0.0)));
    vec3 t = (ends - ray.from) * ray.inverse;
    return min(t.x, min(t.y, t.z)) - VCT_RAY_STEP;
}

// From a surface at a place in texels of the finest level, in that level.
vct_ray vct_ray_of(vec3 at, vec3 normal, vec3 direction, int level)
{
    vct_ray ray;
    ray.level = VCT_CLIPS > 1 ? level : 0;
    ray.most = 1e9;
    ray.from = vct_ray_place_in(at, ray.level) + VCT_RAY_LIFT * normal;
    ray.direction = direction;
    ray.normal = normal;
    vec3 sign = mix(vec3(1.0), vec3(-1.0), lessThan(direction, vec3(0.0)));
    ray.inverse = sign / max(abs(direction), vec3(1e-6));
    ray.facing = VCT_EACH_VOXEL * vct_facing(direction, 1.0);
    ray.facing_aligned = VCT_EACH_VOXEL * vct_facing(direction, VCT_ALIGNED_SLOPE);
    ray.end = vct_ray_end(ray);
    return ray;
}

// Whether there is more of a ray from a distance on.
bool vct_ray_goes_on(vct_ray ray, float distance)
{
    return distance < ray.end ||
           (VCT_CLIPS > 1 && ray.level < VCT_CLIPS - 1 && distance < ray.most);
}

// Into the next coarser level. distance: at which the ray leaves its own.
void vct_ray_leave(inout vct_ray ray, inout float distance)
{
    vec3 shift = clips.levels[ray.level].corner - clips.levels[ray.level + 1].corner;
    ray.level++;
    ray.from = 0.5 * ray.from + shift * (2.0 / float(1 << ray.level));
    ray.most *= 0.5;
    distance = 0.5 * max(min(distance, ray.end), 0.0); // empty blocks reach beyond the end
    ray.end = min(vct_ray_end(ray), ray.most);
}

// A voxel that a ray passes, and its faces that may meet the ray.
struct vct_ray_voxel {
    ivec3 at;
    float first, last; // distances
    uvec2 words;       // of the masks of both sets
    uvec2 slots;       // of the words' first faces
    uint faces;        // 6 bits of the static set, 6 of the other
};

uint vct_ray_shift(ivec3 voxel)
{
    return 8u * uint(voxel.x & 1 | (voxel.y & 1) << 1);
}

// Loops test at their end: on software drivers the body of one that tests at its start runs once
// more than it has iterations, for no invocation.

// The texel of a voxel's block.
ivec3 vct_ray_block(vct_ray ray, ivec3 voxel)
{
    ivec3 block = voxel >> 1;
    if (VCT_CLIPS > 1) block.z += (VCT_CLIPS - 1 - ray.level) * vct.volume_dim;
    return block;
}

// The next voxel with such a face from v.last on, if there is one.
void vct_ray_next(inout vct_ray ray, inout vct_ray_voxel v)
{
    uvec4 masks;
    do {
        if (VCT_CLIPS > 1 && v.last >= ray.end && ray.level < VCT_CLIPS - 1)
            vct_ray_leave(ray, v.last);
        v.first = v.last;
        v.at = ivec3(ray.from + ray.direction * (v.first + VCT_RAY_STEP));
        masks = texelFetch(vct_blocks, vct_ray_block(ray, v.at), 0);
        bool empty = (masks.x & VCT_BLOCK_EMPTY) != 0u;
        uvec4 aligned = masks >> 6u & VCT_EACH_VOXEL;
        aligned = (aligned << 6u) - aligned; // all faces of aligned voxels
        uvec4 facing = masks & (ray.facing ^ ((ray.facing ^ ray.facing_aligned) & aligned));
        if (!VCT_HAS_DYNAMIC) facing.zw = uvec2(0u);
        bool none = empty || facing == uvec4(0u);
        uvec2 faces = ((v.at.z & 1) != 0 ? facing.yw : facing.xz) >> vct_ray_shift(v.at) & 63u;
        v.faces = none || v.first >= ray.end ? 0u : faces.x | faces.y << 6;
        uint level = empty ? (masks.x & 7u) + 1u : none ? 1u : 0u;
        v.last = max(vct_ray_exit(ray, vec3(v.at >> level << level), float(1u << level)),
                     v.first + VCT_RAY_STEP);
    } while (v.faces == 0u && vct_ray_goes_on(ray, v.last));
    const uint all_faces = VCT_EACH_VOXEL * 63u;
    bool upper = (v.at.z & 1) != 0;
    v.words = (upper ? masks.yw : masks.xz) & all_faces;
    v.slots = upper ? uvec2(bitCount(masks.xz & all_faces)) : uvec2(0u);
    v.slots.x += texelFetch(static_first_slots, vct_ray_block(ray, v.at), 0).r;
    if (VCT_HAS_DYNAMIC)
        v.slots.y += texelFetch(dynamic_first_slots, vct_ray_block(ray, v.at), 0).r;
}

const uint VCT_RAY_DYNAMIC = 0x80000000u; // bit of a face's number

// Slot of a face, and the bit for the dynamic set.
uint vct_ray_face(vct_ray_voxel v, uint face)
{
    bool dynamic = VCT_HAS_DYNAMIC && face >= VCT_FACES;
    uint bit = 1u << (vct_ray_shift(v.at) + (dynamic ? face - VCT_FACES : face));
    uint before = uint(bitCount((dynamic ? v.words.y : v.words.x) & (bit - 1u)));
    return dynamic ? v.slots.y + before | VCT_RAY_DYNAMIC : v.slots.x + before;
}

vct_plane vct_ray_plane(vct_ray ray, uint face)
{
    uint slot = face & ~VCT_RAY_DYNAMIC;
    uint first = VCT_CLIPS > 1 ? uint(VCT_CLIPS - 1 - ray.level) * vct.level_faces : 0u;
    uvec2 packed = uvec2(0u);
    ivec2 at = vct_face_texel(slot);
    if (slot - first < vct.capacity) {
        if (VCT_HAS_DYNAMIC && face >= VCT_RAY_DYNAMIC)
            packed = texelFetch(dynamic_planes, at, 0).rg;
        else
            packed = texelFetch(static_planes, at, 0).rg;
    }
    return vct_unpack_plane(packed);
}

// Distance to a face's plane; negative where the ray does not meet its extent in the voxel.
float vct_ray_meets(vct_ray ray, vct_ray_voxel v, vct_plane plane, uint face)
{
    float approach = -dot(plane.normal, ray.direction);
    vec3 centre = vec3(v.at) + 0.5 - ray.from;
    float height = -dot(plane.normal, centre) - plane.distance; // of the start
    float least = dot(plane.normal, ray.normal) < -0.5 ? VCT_RAY_OWN : VCT_RAY_LEAST;
    float t = height / max(approach, 1e-4);
    vec2 at = vct_across(ray.from + t * ray.direction - vec3(v.at), face);
    bool meets = approach > 1e-4 && height > least && t >= v.first - VCT_RAY_SEAM &&
                 t <= min(v.last, ray.end) + VCT_RAY_SEAM && all(greaterThanEqual(at, plane.low)) &&
                 all(lessThanEqual(at, plane.high));
    return meets ? t : -1.0;
}

// Texel, face and level of the clip map.
uint vct_ray_place(vct_ray ray, ivec3 voxel, uint face)
{
    ivec3 at = voxel >> 1;
    uint place = uint(at.x | at.y << 8 | at.z << 16) | face % VCT_FACES << 24;
    return VCT_CLIPS > 1 ? place | uint(ray.level) << 27 : place;
}

int vct_ray_place_level(uint place)
{
    return VCT_CLIPS > 1 ? int(place >> 27) : 0;
}

#ifdef VCT_RAY_VOXELS_CHANGE
// Light of a texel of the previous frame's light volume, along one of its directions. middle: of a
// finer texel within, in texels of the finest level. Levels beyond the coarsest are its mips.
vec4 vct_ray_previous_texel(vec3 middle, int level, int volume)
{
    int grid = min(level, VCT_CLIPS - 1), mip = level - grid, tile = vct.volume_dim >> mip;
    vec3 within = (middle - clips.levels[grid].lit_corner) / float(1 << grid);
    bool inside =
        all(greaterThan(within, vec3(0.0))) && all(lessThan(within, clips.levels[grid].size));
    ivec3 texel = ivec3(within) >> mip;
    return inside ? texelFetch(light,
                               texel + ivec3(volume * tile, 0, (VCT_CLIPS - 1 - grid) * tile), mip)
                  : vec4(0.0);
}

// Radiance of a face of new voxels, whose records are not written yet: that of the previous frame's
// light volume. Where a moving surface has only just come, or the level has moved to, coarser
// texels hold its light. place: see vct_ray_place.
vec3 vct_ray_previous_light(uint place)
{
    ivec3 texel = ivec3(place & 255u, place >> 8 & 255u, place >> 16 & 255u);
    int volume = int(place >> 24 & 7u ^ 1u); // seen along a direction against the normal
    int level = vct_ray_place_level(place);
    vec3 middle = (vec3(texel) + 0.5) * float(1 << level) + clips.levels[level].corner;
    vec4 found = vec4(0.0);
    for (int i = 0; i < 3 && found.a < VCT_RAY_COVERED; i++)
        found = vct_ray_previous_texel(middle, level + i, volume);
    return found.rgb / max(found.a, 1e-3);
}
#endif

// Radiance of a face, from its own record.
vec3 vct_ray_light(uint face, uint place)
{
#ifdef VCT_RAY_VOXELS_CHANGE
    uint new_sets = set.new_sets >> (2 * vct_ray_place_level(place));
    if ((new_sets & (face >= VCT_RAY_DYNAMIC ? 2u : 1u)) != 0u)
        return vct_ray_previous_light(place);
#endif
    ivec2 at = vct_face_texel(face & ~VCT_RAY_DYNAMIC);
    uvec4 packed = uvec4(0u);
    if (VCT_HAS_DYNAMIC && face >= VCT_RAY_DYNAMIC)
        packed = texelFetch(dynamic_lit_voxels, at, 0);
    else
        packed = texelFetch(static_lit_voxels, at, 0);
    vct_lit_face lit = vct_unpack(packed);
    return lit.reflected + vct_emitted(lit.emitted, false);
}

// Accumulated light and opacity of a ray. The radiance of the last face is looked up at the end of
// the ray, or when another face is behind it: most rays end at the first.
struct vct_ray_sum {
    vec3 light; // premultiplied; occlusion: attenuated
    float opacity;
    float previous; // opacity of the last face; 0 where that is not next to what follows
    uint face, place;
    float visible;  // visible part of the last face, not yet in `light`
    float distance; // of the last face, in voxels of the finest level
};

// The nearest face of a voxel that a ray meets.
struct vct_ray_meeting {
    float distance, opacity;
    uint face, place; // vct_ray_face, vct_ray_place
};

// Leaves the faces behind it in v.faces.
vct_ray_meeting vct_ray_meet(vct_ray ray, inout vct_ray_voxel v)
{
    vct_ray_meeting m = vct_ray_meeting(1e6, 0.0, 0u, 0u);
    uint rest = v.faces, met = 0u, nearest = 0u;
    do {
        uint bit = uint(max(findLSB(rest), 0));
        uint face = vct_ray_face(v, bit);
        vct_plane plane = vct_ray_plane(ray, face);
        float t = vct_ray_meets(ray, v, plane, bit);
        bool meets = rest != 0u && t >= 0.0 && plane.opacity > 0.0;
        bool nearer = meets && t < m.distance;
        met |= meets ? 1u << bit : 0u;
        nearest = nearer ? 1u << bit : nearest;
        m.distance = nearer ? t : m.distance;
        m.opacity = nearer ? plane.opacity : m.opacity;
        m.face = nearer ? face : m.face;
        m.place = nearer ? vct_ray_place(ray, v.at, bit) : m.place;
        rest &= rest - 1u;
    } while (rest != 0u);
    v.faces = met & ~nearest;
    return m;
}

// The next face along a ray, if there is one. Returns whether others may follow.
bool vct_ray_next_face(inout vct_ray ray, inout vct_ray_voxel v, inout vct_ray_sum s)
{
    vct_ray_meeting m;
    bool more;
    do {
        float end = v.last / vct_ray_scale(ray);
        if (v.faces == 0u) vct_ray_next(ray, v);
        s.previous = v.first > end * vct_ray_scale(ray) + 1.0 ? 0.0 : s.previous;
        m = vct_ray_meet(ray, v);
        more = v.faces != 0u || vct_ray_goes_on(ray, v.last);
    } while (m.opacity == 0.0 && more);
    s.visible = m.opacity > 0.0 ? vct_visible_alpha(1.0 - s.opacity, m.opacity,
                                                    min(s.previous + m.opacity, 1.0))
                                : 0.0;
    s.face = m.face;
    s.place = m.place;
    s.opacity += s.visible;
    s.previous = m.opacity;
    s.distance = m.distance / vct_ray_scale(ray);
    return more && s.opacity < VCT_RAY_OPAQUE;
}

// Faces along a ray, without the light of the last one. decay: of occlusion per voxel of the finest
// level.
vct_ray_sum vct_ray_faces(vct_ray ray, float decay)
{
    vct_ray_voxel v;
    v.last = 0.0;
    v.faces = 0u;
    vct_ray_sum s = vct_ray_sum(vec3(0.0), 0.0, 0.0, 0u, 0u, 0.0, 0.0);
    bool more;
    do {
        if (s.visible > 0.0) s.light += s.visible * vct_ray_light(s.face, s.place);
        more = vct_ray_next_face(ray, v, s);
        if (VCT_OCCLUSION) {
            s.light += vec3(s.visible / (1.0 + decay * s.distance));
            s.visible = 0.0;
        }
    } while (more);
    return s;
}

// Premultiplied radiance and opacity; last: radiance of the last face.
vec4 vct_ray_total(vct_ray_sum s, vec3 last)
{
    vec3 sum = s.light + s.visible * last;
    return s.opacity > VCT_RAY_OPAQUE ? vec4(sum / s.opacity, 1.0) : vec4(sum, s.opacity);
}

// From a surface of that normal: see vct_ray_of.
vec4 vct_trace_ray(vec3 at, vec3 normal, vec3 direction, float decay, int level)
{
    vct_ray_sum s = vct_ray_faces(vct_ray_of(at, normal, direction, level), decay);
    vec3 last = vec3(0.0);
    if (s.visible > 0.0) last = vct_ray_light(s.face, s.place);
    return vct_ray_total(s, last);
}

// Visibility between a surface of that normal and a place, up to `near` voxels before it. Both in
// texels of the finest level.
float vct_ray_visibility(vec3 at, vec3 normal, vec3 to, float near, int level)
{
    vec3 from = vct_ray_place_in(at, level) + VCT_RAY_LIFT * normal;
    vec3 path = vct_ray_place_in(to, level) - from;
    float distance = length(path);
    vct_ray ray = vct_ray_of(at, normal, path / max(distance, 1e-6), level);
    // The level at the end of the ray may have larger voxels.
    if (VCT_CLIPS > 1) near *= max(vct_texel_at(to) * vct_ray_scale(ray), 1.0);
    ray.most = distance - near - VCT_RAY_SEAM;
    ray.end = min(ray.end, ray.most);
    float opacity = vct_ray_faces(ray, 0.0).opacity;
    return opacity > VCT_RAY_OPAQUE ? 0.0 : 1.0 - opacity;
}

#endif
