// Walking the triangles of a draw over the voxels that they touch. A triangle is walked in columns
// along the axis to which its plane is nearest to perpendicular (the dominant axis of Crassin &
// Green 2012; Hong 2015, sec. 2.5.3.1), where it is at most a few voxels deep. Small triangles take
// one invocation; large ones are cut into tiles of columns that wait in a queue for a workgroup
// each.
//
// Permutations: VCT_LARGE is 0 for small triangles and 1 for the queued tiles of large ones;
// VCT_RASTER takes the columns from the rasteriser (voxelize/raster.glsl), in its fragment stage
// with VCT_FRAGMENT. The includer defines vct_meet() and vct_visit() after the inclusion.
#include "frame/scene_triangles.glsl"
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/voxelize/overlap.glsl"
#include "techniques/vct/voxelize/voxelize_shared.h"

#ifndef VCT_RASTER
// x, y, z of an indirect dispatch; how many tiles were asked for.
layout(set = 0, binding = 14, scalar) buffer vct_queue_state
{
    uint queue_groups[3];
    uint queue_asked;
};
layout(set = 0, binding = 15, scalar) buffer vct_queue
{
    uvec2 queue[];
};

#if VCT_LARGE
layout(local_size_x = VCT_TILE) in;
#else
layout(local_size_x = SCENE_TRIANGLES_LOCAL) in;
#endif
#endif

struct vct_triangle {
    uvec3 vertices;
    vec3 a, b, c;    // in voxels from the grid's corner
    int turn;        // 0…2: the axis along which columns run is (turn + 2) % 3
    vec3 u, v, w;    // a, b, c with axes turned so that the third is the columns'
    vec3 normal;     // turned; not unit: its length is twice the area in faces of a voxel
    ivec3 low, high; // turned: voxels that its box touches
    ivec2 depths;    // the first and the last of them in a column, also beyond this grid
};

void vct_begin_triangle(vct_triangle t, ivec2 first); // before its voxels, from a column on
void vct_visit(ivec3 voxel, vct_triangle t);
#ifdef VCT_DEFERS
// Rows in which vct_visit() has left voxels to vct_visit_put_off(), a bit for each of the tile.
uint vct_deferred = 0u;
void vct_visit_deferred(ivec3 voxel, vct_triangle t);
#endif

// What lies on the border of the scene's grid but for rounding belongs to the last voxel, and is
// not lost.
vec3 kept_inside(vec3 at)
{
    vec3 inside = clamp(at, vct.scene_low, vct.scene_high);
    return mix(at, inside, lessThan(abs(at - inside), vec3(0.01)));
}

vec3 vertex_at(uint vertex)
{
    precise vec3 world = (scene_world_from_instance() * vec4(scene_position(vertex), 1.0)).xyz;
    precise vec3 at = (world - vct.origin_m) * vct.cells_per_m;
    return kept_inside(at);
}

vec3 permuted(vec3 v, int turn)
{
    return turn == 0 ? v : turn == 1 ? v.yzx : v.zxy;
}

ivec3 unpermuted(ivec3 v, int turn)
{
    return turn == 0 ? v : turn == 1 ? v.zxy : v.yzx;
}

// False where it has no area, is not finite or not in this grid.
bool triangle_at(uint triangle, out vct_triangle t)
{
    t.vertices = scene_triangle(triangle);
    t.a = vertex_at(t.vertices.x);
    t.b = vertex_at(t.vertices.y);
    t.c = vertex_at(t.vertices.z);
    // What only touches a border from below is not in the voxel above; what lies in the border is
    // in that one alone.
    vec3 low = floor(min(min(t.a, t.b), t.c)), high = max(ceil(max(max(t.a, t.b), t.c)) - 1.0, low);
    if (!all(lessThan(max(abs(low), abs(high)), vec3(1e6)))) return false;
    low = clamp(low, vct.scene_low, vct.scene_high - 1.0);
    high = clamp(high, vct.scene_low, vct.scene_high - 1.0);
    vec3 end = vec3(vct_cells()) - 1.0;
    if (any(greaterThan(low, end)) || any(lessThan(high, vec3(0.0)))) return false;
    precise vec3 p = t.b - t.a, q = t.c - t.b;
    precise vec3 n = p.yzx * q.zxy - p.zxy * q.yzx;
    vec3 length = abs(n);
    t.turn = length.z >= length.x && length.z >= length.y ? 0 : length.x >= length.y ? 1 : 2;
    t.normal = permuted(n, t.turn);
    t.u = permuted(t.a, t.turn);
    t.v = permuted(t.b, t.turn);
    t.w = permuted(t.c, t.turn);
    t.low = ivec3(permuted(max(low, vec3(0.0)), t.turn));
    t.high = ivec3(permuted(min(high, end), t.turn));
    t.depths = ivec2(permuted(low, t.turn).z, permuted(high, t.turn).z);
    return abs(t.normal.z) > 0.0;
}

// First and last voxel of a column that the triangle may touch. Its plane is within half a voxel in
// both directions of the height at the column's centre, as the slopes along the dominant axis are
// at most 1.
ivec2 depths_of(vct_triangle t, ivec2 column)
{
    vec2 centre = vec2(column) + 0.5;
    float height = t.u.z - dot(t.normal.xy, centre - t.u.xy) / t.normal.z;
    float reach = 0.5 * (abs(t.normal.x) + abs(t.normal.y)) / abs(t.normal.z) + 0.01;
    float low = clamp(height - reach, -1.0, float(vct.dim)),
          high = clamp(height + reach, -1.0, float(vct.dim));
    return ivec2(max(int(floor(low)), t.low.z), min(int(floor(high)), t.high.z));
}

bool touches(vct_triangle t, ivec3 voxel)
{
    precise vec3 middle = vec3(voxel) + 0.5;
    precise vec3 u = t.u - middle, v = t.v - middle, w = t.w - middle;
    return vct_overlaps(u, v, w, t.normal);
}

// All voxels that the triangle touches in columns from `first` to `last`. What is touched is looked
// for in a loop of its own: invocations of a group that have found something wait there for the
// others, and then visit together.
void visit_columns(vct_triangle t, ivec2 first, ivec2 last)
{
    ivec2 column = first, depths = depths_of(t, first);
    for (;;) {
        ivec3 voxel = ivec3(0);
        bool found = false;
        while (!found && column.y <= last.y) {
            voxel = ivec3(column, depths.x);
            found = depths.x <= depths.y && touches(t, voxel);
            depths.x++;
            if (depths.x <= depths.y) continue;
            column.x++;
            if (column.x > last.x) column = ivec2(first.x, column.y + 1);
            depths = depths_of(t, column);
        }
        if (!found) return;
        vct_visit(unpermuted(voxel, t.turn), t);
    }
}

#ifdef VCT_RASTER
#ifdef VCT_FRAGMENT

layout(location = 0) flat in uint vary_triangle;

void main()
{
    vct_triangle t;
    ivec2 column = ivec2(gl_FragCoord.xy);
    if (!triangle_at(vary_triangle, t) || any(lessThan(column, t.low.xy)) ||
        any(greaterThan(column, t.high.xy)))
        return;
    vct_begin_triangle(t, column);
    visit_columns(t, column, column);
}

#endif
#elif VCT_LARGE

// How far an edge reaches up and down between two places along x; nothing where it does not come
// there.
vec2 reach_of(vec2 from, vec2 to, float left, float right)
{
    vec2 a = from.x <= to.x ? from : to, b = from.x <= to.x ? to : from;
    if (b.x < left || a.x > right) return vec2(1e6, -1e6);
    float slope = (b.y - a.y) / max(b.x - a.x, 1e-6);
    float first =
        a.x < left ? clamp(a.y + slope * (left - a.x), min(a.y, b.y), max(a.y, b.y)) : a.y;
    float last =
        b.x > right ? clamp(b.y + slope * (right - b.x), min(a.y, b.y), max(a.y, b.y)) : b.y;
    return vec2(min(first, last), max(first, last));
}

// First and last of the columns along y that the triangle may touch at x: the others of a tile are
// not looked at.
ivec2 rows_of(vct_triangle t, int x)
{
    float left = float(x) - 0.01, right = float(x) + 1.01;
    vec2 a = reach_of(t.u.xy, t.v.xy, left, right), b = reach_of(t.v.xy, t.w.xy, left, right),
         c = reach_of(t.w.xy, t.u.xy, left, right);
    float low = min(a.x, min(b.x, c.x)) - 0.01, high = max(a.y, max(b.y, c.y)) + 0.01;
    return ivec2(max(int(floor(low)), t.low.y), min(int(floor(high)), t.high.y));
}

#ifdef VCT_DEFERS
shared uint deferred_count, deferred_columns[VCT_TILE * VCT_TILE];

// What invocations have left is shared out among all of them: there is little of it, in lines along
// the triangle's sides, and one that has a whole line would keep the others waiting.
void visit_deferred_columns(vct_triangle t, ivec2 first)
{
    if (gl_LocalInvocationID.x == 0u) deferred_count = 0u;
    barrier();
    uint to = atomicAdd(deferred_count, uint(bitCount(vct_deferred)));
    for (; vct_deferred != 0u; vct_deferred &= vct_deferred - 1u)
        deferred_columns[to++] = gl_LocalInvocationID.x | uint(findLSB(vct_deferred)) << 16;
    barrier();
    uint i = gl_LocalInvocationID.x;
    ivec2 column = ivec2(0), depths = ivec2(0, -1);
    for (;;) {
        ivec3 voxel = ivec3(0);
        bool found = false;
        while (!found && (depths.x <= depths.y || i < deferred_count)) {
            if (depths.x > depths.y) {
                column = first + ivec2(deferred_columns[i] & 0xffffu, deferred_columns[i] >> 16);
                depths = depths_of(t, column);
                i += VCT_TILE;
            }
            voxel = ivec3(column, depths.x);
            found = depths.x <= depths.y && touches(t, voxel);
            depths.x++;
        }
        if (!found) return;
        vct_visit_deferred(unpermuted(voxel, t.turn), t);
    }
}
#endif

void main()
{
    uvec2 job = queue[gl_WorkGroupID.x];
    vct_triangle t;
    if (!triangle_at(job.x, t)) return;
    uint across = uint(t.high.x - t.low.x) / VCT_TILE + 1u;
    ivec2 tile = ivec2(job.y % across, job.y / across);
    ivec2 first = t.low.xy + tile * VCT_TILE, last = min(first + VCT_TILE - 1, t.high.xy);
    int x = first.x + int(gl_LocalInvocationID.x);
    ivec2 rows = rows_of(t, x);
    rows = ivec2(max(first.y, rows.x), x > last.x ? first.y - 1 : min(last.y, rows.y));
    vct_begin_triangle(t, first);
    visit_columns(t, ivec2(x, rows.x), ivec2(x, rows.y));
#ifdef VCT_DEFERS
    visit_deferred_columns(t, first);
#endif
}

#else

// Puts tiles of a triangle into the queue, as many as there is room for, and returns how many.
uint queue_tiles(uint triangle, uint count)
{
    uint first = atomicAdd(queue_asked, count);
    uint fitting = first < VCT_QUEUE ? min(count, VCT_QUEUE - first) : 0u;
    for (uint i = 0u; i < fitting; i++) queue[first + i] = uvec2(triangle, i);
    if (fitting > 0u) atomicMax(queue_groups[0], first + fitting);
    return fitting;
}

// A small triangle is one tile, and walked here; so are tiles of large ones for which the queue has
// no room.
void main()
{
    uint triangle = gl_GlobalInvocationID.x;
    vct_triangle t;
    if (triangle >= push.triangle_count || !triangle_at(triangle, t)) return;
    ivec2 size = t.high.xy - t.low.xy + 1;
    bool small = size.x * size.y <= VCT_SMALL_COLUMNS;
    ivec2 tile = small ? size : ivec2(VCT_TILE), tiles = (size - 1) / tile + 1;
    uint count = uint(tiles.x * tiles.y), queued = 0u;
    if (!small) queued = queue_tiles(triangle, count);
    vct_begin_triangle(t, t.low.xy);
    for (uint i = queued; i < count; i++) {
        ivec2 corner = t.low.xy + ivec2(int(i) % tiles.x, int(i) / tiles.x) * tile;
        visit_columns(t, corner, min(corner + tile - 1, t.high.xy));
    }
}

#endif
