// Traversal of the voxels that the triangles of a draw touch. A triangle is traversed in columns
// along its dominant axis (Crassin & Green 2012; Hong 2015, sec. 2.5.3.1), where it is at most a
// few voxels deep. One invocation takes a small triangle; large ones are split into tiles of
// columns, which are queued for a workgroup each.
//
// Permutations: VCT_LARGE is 0 for small triangles and 1 for the queued tiles of large ones;
// VCT_RASTER takes the columns from the rasterizer (voxelize/raster.glsl), in its fragment stage
// with VCT_FRAGMENT; VCT_DEFERS leaves some voxels of large triangles to a second visit. The
// includer defines vct_begin_triangle(), vct_visit() and vct_visit_deferred() after the inclusion.
#include "frame/scene/scene_triangles.glsl"
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/voxelize/overlap.glsl"
#include "techniques/vct/voxelize/voxelize_shared.h"

#ifndef VCT_RASTER
// The indirect dispatch over tiles, and the number of tiles requested.
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
    int turn;        // 0…2: permutation of axes; columns run along (turn + 2) % 3
    vec3 u, v, w;    // a, b, c with permuted axes, the third along the columns
    vec3 normal;     // permuted; its length is twice the area in voxel faces
    ivec3 low, high; // permuted: voxels that its box touches
    ivec2 depths;    // first and last voxel of a column, also beyond this grid
};

void vct_begin_triangle(vct_triangle t); // before its voxels
void vct_visit(ivec3 voxel, vct_triangle t);
#ifdef VCT_DEFERS
// Rows of the tile in which vct_visit() has left voxels to vct_visit_deferred(), a bit each.
uint vct_deferred = 0u;
int vct_first_row;
void vct_visit_deferred(ivec3 voxel, vct_triangle t);
#endif

// Points on the border of the scene's grid, up to rounding, belong to its last voxel.
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

// Faces of the voxels of a triangle. That of its back is front ^ 1.
struct vct_triangle_faces {
    uint front;
    bool both; // the triangle is double-sided
};

vct_triangle_faces vct_faces_of(vct_triangle t)
{
    uint axis = uint(t.turn + 2) % 3u;
    bool negative = (t.normal.z < 0.0) != (push.mirrored != 0u);
    bool both = (scene_material_table[push.draw.material].flags & SCENE_DOUBLE_SIDED) != 0u;
    return vct_triangle_faces(2u * axis + (negative ? 1u : 0u), both);
}

vec3 permuted(vec3 v, int turn)
{
    return turn == 0 ? v : turn == 1 ? v.yzx : v.zxy;
}

ivec3 unpermuted(ivec3 v, int turn)
{
    return turn == 0 ? v : turn == 1 ? v.zxy : v.yzx;
}

// False where the triangle has no area, is not finite or is outside of this grid.
bool triangle_at(uint triangle, out vct_triangle t)
{
    t.vertices = scene_triangle(triangle);
    t.a = vertex_at(t.vertices.x);
    t.b = vertex_at(t.vertices.y);
    t.c = vertex_at(t.vertices.z);
    // A triangle that only touches a border from below is not in the voxel above; one that lies in
    // the border is in that voxel alone.
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

#ifdef VCT_DEFERS
void vct_defer(ivec3 voxel, vct_triangle t)
{
    vct_deferred |= 1u << uint(ivec3(permuted(vec3(voxel), t.turn)).y - vct_first_row);
}
#endif

bool touches(vct_triangle t, ivec3 voxel)
{
    precise vec3 middle = vec3(voxel) + 0.5;
    precise vec3 u = t.u - middle, v = t.v - middle, w = t.w - middle;
    return vct_overlaps(u, v, w, t.normal);
}

// Visits all voxels that the triangle touches in columns from `first` to `last`. The search has a
// loop of its own, so that the invocations of a subgroup visit voxels together.
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
    vct_begin_triangle(t);
    visit_columns(t, column, column);
}

#endif
#elif VCT_LARGE

// Extent of an edge along y between `left` and `right`; empty where it does not reach them.
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

// First and last column along y that the triangle may touch at x. The others of a tile are skipped.
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

// Deferred columns are distributed over all invocations of the workgroup: they lie along the edges
// of the triangle, and one invocation with a whole edge would stall the others.
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
#ifdef VCT_DEFERS
    vct_first_row = first.y;
#endif
    vct_begin_triangle(t);
    visit_columns(t, ivec2(x, rows.x), ivec2(x, rows.y));
#ifdef VCT_DEFERS
    visit_deferred_columns(t, first);
#endif
}

#else

// Queues as many tiles of a triangle as fit, and returns their number.
uint queue_tiles(uint triangle, uint count)
{
    uint first = atomicAdd(queue_asked, count);
    uint fitting = first < VCT_QUEUE ? min(count, VCT_QUEUE - first) : 0u;
    for (uint i = 0u; i < fitting; i++) queue[first + i] = uvec2(triangle, i);
    if (fitting > 0u) atomicMax(queue_groups[0], first + fitting);
    return fitting;
}

// A small triangle is one tile, which is traversed here, as are tiles that do not fit into the
// queue.
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
    vct_begin_triangle(t);
    for (uint i = queued; i < count; i++) {
        ivec2 corner = t.low.xy + ivec2(int(i) % tiles.x, int(i) / tiles.x) * tile;
        visit_columns(t, corner, min(corner + tile - 1, t.high.xy));
    }
}

#endif
