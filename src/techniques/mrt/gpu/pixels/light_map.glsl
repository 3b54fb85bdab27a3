// Light of a surface from the light map: of the wall that stands for it, or of several.
// Needs locate.glsl, block_rows.glsl, bricks.glsl, outdoors.glsl and lobe.glsl.
#ifndef AG_MRT_LIGHT_MAP_GLSL
#define AG_MRT_LIGHT_MAP_GLSL

layout(set = 0, binding = MRT_LIGHT_MAP_BINDING) uniform sampler2DArray light_map;

layout(constant_id = MRT_CONSTANT_VALUES) const uint VALUES = 1; // 4: by normal
layout(constant_id = MRT_CONSTANT_PROBES) const bool PROBES = false;

// A surface near to a wall that it faces is that wall: entirely up to the first distance (edges of
// the cell) and from the second cosine, not at all beyond the others.
const vec2 MRT_WALL_DISTANCE = vec2(0.1, 0.15);
const vec2 MRT_WALL_COSINE = vec2(0.35, 0.65);

// One of the two faces of an axis.
int face_of(int axis, bool high)
{
    return 2 * axis + (high ? 1 : 0);
}

// place: in texels. Irradiance changes from the wall's normal to another (Loos 2015,
// section 3.5.4); its slopes are those of a fit.
light_map_light light_at(vec2 place, vec3 normal)
{
    vec2 per_size = 1.0 / vec2(level.map_width, level.map_height);
    if (VALUES == 1u)
        return light_map_light(textureLod(light_map, vec3(place * per_size, 0.0), 0.0).rgb,
                               mat3(0.0));
    light_map_light light = light_map_lookup(light_map, per_size, vec3(place, 0.0), normal);
    for (int c = 0; c < 3; c++) light.vector[c].xy *= 0.5 * MRT_VECTOR_OF_SLOPE;
    return light;
}

// Reduced bases leave small negative values beside bright texels. Up to here light is linear.
// `normal` and `lobe` are in the frame of struct mrt_point.
mrt_light tile_light(vec2 first, vec2 st, vec3 normal, light_map_lobe lobe)
{
    vec2 place = first + clamp(st, 0.0, 1.0) * float(level.resolution);
    light_map_light light = light_at(place, normal);
    light.irradiance = max(light.irradiance, vec3(0.0));
    return mrt_light(light.irradiance, light_map_radiance_of(light, normal, lobe));
}

// From the cell to the frame of mrt_point of a wall.
vec3 before_wall(mat3 frame, vec3 direction)
{
    return (direction * frame) * vec3(-1.0, 1.0, -1.0);
}

mrt_light wall_light(vec2 first, int face, vec3 cell, vec3 normal, light_map_lobe lobe)
{
    mat3 frame = cube_from_face(face);
    lobe.along = before_wall(frame, lobe.along);
    return tile_light(first, 0.5 + vec2(dot(frame[0], cell), dot(frame[1], cell)),
                      before_wall(frame, normal), lobe);
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

// A surface faces one of two opposite walls. `normal` is in the cell.
mrt_wall wall_of(uvec2 faces, vec3 cell, vec3 normal)
{
    mrt_wall best = mrt_wall(-1, 0.0);
    for (int a = 0; a < 3; a++) {
        bool high = normal[a] < 0.0;
        float distance = 0.5 - (high ? cell[a] : -cell[a]);
        float share = share_of_wall(distance, abs(normal[a]));
        if (share > best.share && is_wall(faces, face_of(a, high)))
            best = mrt_wall(face_of(a, high), share);
    }
    return best;
}

// Inside a block a surface is projected onto the walls that face its way, weighed by squared
// cosines, which sum to 1. Where these are openings, a little of all walls remains.
const float MRT_LEAST_WEIGHT = 0.01;

vec3 walls_irradiance(mrt_place place, vec3 direction)
{
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    uvec2 faces = faces_by_rows(uint(place.block));
    for (int face = 0; face < 6; face++) {
        if (!is_wall(faces, face)) continue;
        vec3 inner = -cube_from_face(face)[2];
        float cosine = max(dot(inner, direction), 0.0), weight = cosine * cosine + MRT_LEAST_WEIGHT;
        mrt_light light =
            wall_light(tile_of(faces, face), face, place.cell, inner, MRT_NO_LOBE.surface);
        sum += weight * light.irradiance;
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : vec3(0.0);
}

mrt_light walls_light(mrt_place place, vec3 normal, mrt_lobe lobe)
{
    mrt_light light = mrt_light(walls_irradiance(place, normal), vec3(0.0));
#if SPECULAR
    light.radiance = INV_PI * walls_irradiance(place, direction_in_cell(place, lobe.mean));
#endif
    return light;
}

// Between probes, past clutter.
mrt_light bricks_light(mrt_place place, vec3 normal, mrt_lobe lobe)
{
    int slab = int(level.probes) + 2;
    mrt_visible_probes visible = visible_probes_at(place, normal_in_cell(place, normal));
    if (SIGHT == 0) return probe_light_at(bricks, slab, visible.texel, normal, lobe);
    mrt_light sum = MRT_DARK;
    for (int i = 0; i < visible.lookups; i++) {
        float weight;
        vec3 texel = lookup_of(visible, i, weight);
        mrt_light light = probe_light_at(bricks, slab, texel, normal, lobe);
        sum = sum_of_lights(sum, scaled_light(light, weight));
    }
    return sum;
}

const float MRT_AWAY_COSINE = 0.5;

// The way along the normal to a wall nearby that the surface faces, in metres; 0: there is none.
float way_to_wall(mrt_place place, vec3 normal)
{
    vec3 to = inverse(world_from_cell(place)) * normal;
    uvec2 faces = faces_by_rows(uint(place.block));
    float shortest = 0.0;
    for (int f = 0; f < 6; f++) {
        float side = (f & 1) != 0 ? 1.0 : -1.0, towards = side * to[f / 2];
        float distance = 0.5 - side * place.cell[f / 2];
        if (!is_wall(faces, f) || distance > MRT_WALL_DISTANCE[0]) continue;
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
    uvec2 faces = faces_by_rows(uint(place.block));
    float least = MRT_WALL_DISTANCE.x;
    for (int a = 0; a < 3; a++) {
        int f = face_of(a, place.cell[a] > 0.0);
        float distance = 0.5 - abs(place.cell[a]);
        bool beside = abs(n[a]) < MRT_WALL_COSINE.x && is_opening(faces, f);
        if (!beside || distance > least) continue;
        least = distance;
        opening = f;
    }
    mrt_place next;
    if (opening < 0 || !place_in(uint(block_table[place.block].neighbor[opening]), world, next) ||
        next.outside > MRT_WALL_DISTANCE.x)
        return none;
    vec3 rotated = normal_in_cell(next, normal);
    mrt_wall wall = wall_of(faces_by_rows(uint(next.block)), next.cell, rotated);
    if (wall.share == 0.0) return none;
    place = next;
    n = rotated;
    return wall;
}

// In a tube a surface inside is projected onto the wall away from the axis.
mrt_light tube_light(mrt_place place, vec3 normal, mrt_lobe lobe)
{
    mrt_tube_place at = tube_place(place.block, place.cell);
    vec2 first = tile_of(faces_by_rows(uint(place.block)), 0);
    vec2 st = vec2(at.around, at.along);
    vec3 n = normal_in_cell(place, normal) * at.frame;
    float share = share_of_wall(MRT_TUBE_RADIUS - length(at.off), n.z);
    mrt_light on_wall = MRT_DARK, inside = MRT_DARK;
    if (share > 0.0)
        on_wall = tile_light(first, st, n,
                             light_map_lobe(direction_in_cell(place, lobe.surface.along) * at.frame,
                                            lobe.surface.share));
    if (share < 1.0)
        inside = PROBES ? bricks_light(place, normal, lobe)
                        : tile_light(first, st, vec3(0.0, 0.0, 1.0), MRT_NO_LOBE.surface);
    return mix_light(inside, on_wall, share);
}

mrt_light room_light(vec3 position, vec3 normal, mrt_lobe lobe, mrt_place place)
{
    if (TUBES) return tube_light(place, normal, lobe);
    vec3 n = normal_in_cell(place, normal);
    mrt_wall wall = wall_of(faces_by_rows(uint(place.block)), place.cell, n);
    if (wall.share == 0.0) wall = wall_beyond(position + level.offset_m * normal, normal, place, n);
    mrt_light on_wall = MRT_DARK, inside = MRT_DARK;
    if (wall.share > 0.0)
        on_wall = wall_light(
            tile_of(faces_by_rows(uint(place.block)), wall.face), wall.face, place.cell, n,
            light_map_lobe(direction_in_cell(place, lobe.surface.along), lobe.surface.share));
    if (wall.share < 1.0)
        inside = PROBES ? bricks_light(place, normal, lobe) : walls_light(place, n, lobe);
    return mix_light(inside, on_wall, wall.share);
}

// How much a surface faces away from its block along an axis across which it is beyond: the outer
// side of a wall does, the reveals and the back of a niche do not.
float facing_away(mrt_place place, vec3 normal)
{
    vec3 away = sign(place.cell) * normal_in_cell(place, normal);
    vec3 beyond = mix(vec3(0.0), away, greaterThan(abs(place.cell), vec3(0.5)));
    float cosine = max(max(beyond.x, beyond.y), beyond.z);
    return smoothstep(MRT_WALL_COSINE[0], MRT_WALL_COSINE[1], cosine);
}

// Beyond its block an enclosed surface, such as that of a niche, has the light of the room; so has
// one nearby that does not face away from the block.
mrt_light level_light(vec3 position, vec3 normal, mrt_lobe lobe)
{
    mrt_place place =
        TUBES ? locate(position + level.offset_m * normal) : locate_surface(position, normal);
    mrt_light outdoors = MRT_DARK;
    float open = 0.0;
    if (place.block < 0 || place.outside > 0.0)
        outdoors = outdoor_light(position, normal, lobe, open);
    if (place.block < 0) return scaled_light(outdoors, open);
    float left = smoothstep(0.0, MRT_LEAVING, place.outside);
    float share = open * max(left, facing_away(place, normal));
    if (share == 1.0) return outdoors;
    return mix_light(room_light(position, normal, lobe, place), outdoors, share);
}

#endif
