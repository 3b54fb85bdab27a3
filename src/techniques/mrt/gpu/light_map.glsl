// Irradiance of a surface from the light map: of the wall that stands for it, or of several.
// Needs locate.glsl, bricks.glsl, outdoors.glsl, MRT_TILES_BINDING, core/sh.glsl.
#ifndef AG_MRT_LIGHT_MAP_GLSL
#define AG_MRT_LIGHT_MAP_GLSL

layout(set = 0, binding = MRT_LIGHT_MAP_BINDING) uniform sampler2DArray light_map;
layout(set = 0, binding = MRT_VECTOR_MAP_BINDING) uniform sampler2DArray vector_map;

layout(constant_id = MRT_CONSTANT_VALUES) const uint VALUES = 1; // 4: by normal
layout(constant_id = MRT_CONSTANT_PROBES) const bool PROBES = false;

// A surface near to a wall that it faces is that wall: entirely up to the first distance (edges of
// the cell) and from the second cosine, not at all beyond the others.
const vec2 MRT_WALL_DISTANCE = vec2(0.1, 0.15);
const vec2 MRT_WALL_COSINE = vec2(0.35, 0.65);
// Normals in the half floats of the frame differ this little from the wall's.
const float MRT_ALONG_WALL = 1.0 - 1e-6;

vec3 light_map_uv(int tile, vec2 st)
{
    vec2 at = vec2(tile_table[tile].x, tile_table[tile].y) + st * float(level.resolution);
    return vec3(at / vec2(level.map_width, level.map_height), 0.0);
}

// The change of irradiance from the wall's normal to another (Loos 2015, section 3.5.4), in the
// frame of struct mrt_point.
vec3 change_by_normal(vec3 uv, vec3 normal)
{
    vec4 change = sh4_eval(normal) - sh4_eval(vec3(0.0, 0.0, 1.0));
    vec3 sum;
    for (int c = 0; c < 3; c++)
        sum[c] = dot(textureLod(vector_map, vec3(uv.xy, float(c)), 0.0), change);
    return sum;
}

// Reduced bases leave small negative values beside bright texels. Up to here light is linear.
// `normal` is in the frame of struct mrt_point.
vec3 tile_irradiance(int tile, vec2 st, vec3 normal)
{
    vec3 uv = light_map_uv(tile, clamp(st, 0.0, 1.0));
    vec3 irradiance = textureLod(light_map, uv, 0.0).rgb;
    if (VALUES == 4u && normal.z < MRT_ALONG_WALL) irradiance += change_by_normal(uv, normal);
    return max(irradiance, vec3(0.0));
}

vec3 wall_irradiance(int tile, int face, vec3 cell, vec3 normal)
{
    mat3 frame = cube_from_face(face);
    return tile_irradiance(
        tile, 0.5 + vec2(dot(frame[0], cell), dot(frame[1], cell)),
        vec3(-dot(frame[0], normal), dot(frame[1], normal), -dot(frame[2], normal)));
}

struct mrt_wall {
    int face;
    float share; // 0: the surface lies on no wall
};

// How much a surface is the wall at this distance that it faces by this cosine.
float share_of_wall(float distance, float cosine)
{
    return smoothstep(MRT_WALL_COSINE[0], MRT_WALL_COSINE[1], cosine) *
           (1.0 - smoothstep(MRT_WALL_DISTANCE[0], MRT_WALL_DISTANCE[1], distance));
}

mrt_wall wall_of(mrt_place place, vec3 normal)
{
    mrt_wall best = mrt_wall(-1, 0.0);
    for (int f = 0; f < 6; f++) {
        if (block_table[place.block].tile[f] < 0) continue;
        float side = (f & 1) != 0 ? 1.0 : -1.0;
        float distance = 0.5 - side * place.cell[f / 2];
        float share = share_of_wall(distance, -side * normal[f / 2]);
        if (share > best.share) best = mrt_wall(f, share);
    }
    return best;
}

// Inside a block a surface is projected onto the walls that face its way, weighed by squared
// cosines, which sum to 1. Where these are openings, a little of all walls remains.
const float MRT_LEAST_WEIGHT = 0.01;

vec3 walls_irradiance(mrt_place place, vec3 normal)
{
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int face = 0; face < 6; face++) {
        int tile = block_table[place.block].tile[face];
        if (tile < 0) continue;
        vec3 inner = -cube_from_face(face)[2];
        float cosine = max(dot(inner, normal), 0.0), weight = cosine * cosine + MRT_LEAST_WEIGHT;
        sum += weight * wall_irradiance(tile, face, place.cell, inner);
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : vec3(0.0);
}

const float MRT_AWAY_COSINE = 0.5;

// The way along the normal to a wall nearby that the surface faces, in metres; 0: there is none.
float way_to_wall(mrt_place place, vec3 normal)
{
    vec3 to = inverse(world_from_cell(place)) * normal;
    float shortest = 0.0;
    for (int f = 0; f < 6; f++) {
        float side = (f & 1) != 0 ? 1.0 : -1.0, towards = side * to[f / 2];
        float distance = 0.5 - side * place.cell[f / 2];
        if (block_table[place.block].tile[f] < 0 || distance > MRT_WALL_DISTANCE[0]) continue;
        if (towards < MRT_AWAY_COSINE * length(to)) continue;
        shortest = max(distance / towards, 0.0) + level.offset_m;
    }
    return shortest;
}

// The block of a surface. Light comes to a surface from the side of its normal: where that faces a
// wall nearby, such as the folds of a curtain between two rooms, from the block beyond.
mrt_place locate_surface(vec3 position, vec3 normal)
{
    vec3 at = position + level.offset_m * normal;
    mrt_place place = locate(at);
    float way = place.block < 0 ? 0.0 : way_to_wall(place, normal);
    if (way == 0.0) return place;
    mrt_place beyond = locate(at + way * normal);
    return beyond.block >= 0 && beyond.outside == 0.0 ? beyond : place;
}

// A wall may end a little beyond the border of its block, by half the thickness of another wall.
// Moves to the neighbour beyond the nearest opening that the surface meets at an angle.
mrt_wall wall_beyond(vec3 world, vec3 normal, inout mrt_place place, inout vec3 n)
{
    mrt_wall none;
    none.face = -1;
    none.share = 0.0;
    int opening = -1;
    float least = MRT_WALL_DISTANCE.x;
    for (int a = 0; a < 3; a++) {
        int f = 2 * a + (place.cell[a] > 0.0 ? 1 : 0);
        float distance = 0.5 - abs(place.cell[a]);
        bool beside = abs(n[a]) < MRT_WALL_COSINE.x && block_table[place.block].neighbor[f] >= 0;
        if (!beside || distance > least) continue;
        least = distance;
        opening = f;
    }
    mrt_place next;
    if (opening < 0 || !place_in(uint(block_table[place.block].neighbor[opening]), world, next) ||
        next.outside > MRT_WALL_DISTANCE.x)
        return none;
    vec3 rotated = normal_in_cell(next, normal);
    mrt_wall wall = wall_of(next, rotated);
    if (wall.share == 0.0) return none;
    place = next;
    n = rotated;
    return wall;
}

// In a tube a surface inside is projected onto the wall away from the axis.
vec3 tube_irradiance(mrt_place place, vec3 normal)
{
    mrt_tube_place at = tube_place(place.block, place.cell);
    int tile = block_table[place.block].tile[0];
    vec2 st = vec2(at.around, at.along);
    vec3 n = normal_in_cell(place, normal) * at.frame;
    float share = share_of_wall(MRT_TUBE_RADIUS - length(at.off), n.z);
    vec3 on_wall = vec3(0.0), inside = vec3(0.0);
    if (share > 0.0) on_wall = tile_irradiance(tile, st, n);
    if (share < 1.0)
        inside = PROBES ? bricks_irradiance(place, normal)
                        : tile_irradiance(tile, st, vec3(0.0, 0.0, 1.0));
    return mix(inside, on_wall, share);
}

vec3 room_irradiance(vec3 position, vec3 normal, mrt_place place)
{
    if (TUBES) return tube_irradiance(place, normal);
    vec3 n = normal_in_cell(place, normal);
    mrt_wall wall = wall_of(place, n);
    if (wall.share == 0.0) wall = wall_beyond(position + level.offset_m * normal, normal, place, n);
    vec3 on_wall = vec3(0.0), inside = vec3(0.0);
    if (wall.share > 0.0)
        on_wall =
            wall_irradiance(block_table[place.block].tile[wall.face], wall.face, place.cell, n);
    if (wall.share < 1.0)
        inside = PROBES ? bricks_irradiance(place, normal) : walls_irradiance(place, n);
    return mix(inside, on_wall, wall.share);
}

// Edges beyond its block over which a surface outdoors blends out of the light of the room.
const float MRT_LEAVING = 0.25;

// Beyond its block an enclosed surface, such as that of a niche, has the light of the room.
vec3 level_irradiance(vec3 position, vec3 normal)
{
    mrt_place place =
        TUBES ? locate(position + level.offset_m * normal) : locate_surface(position, normal);
    vec4 outdoors = vec4(0.0);
    if (place.block < 0 || place.outside > 0.0) outdoors = outdoor_irradiance(position, normal);
    if (place.block < 0) return outdoors.a * outdoors.rgb;
    float share = outdoors.a * smoothstep(0.0, MRT_LEAVING, place.outside);
    if (share == 1.0) return outdoors.rgb;
    return mix(room_irradiance(position, normal, place), outdoors.rgb, share);
}

#endif
