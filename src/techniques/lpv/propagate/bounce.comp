// A bounce: surfaces reflect the accumulated light, which joins the injected light. A cell has six
// surfaces, one for each direction ±a, with the reflecting area of surfaces.comp; each receives
// E(±a) and sends it as a clamped cosine around ±a.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"
#include "techniques/lpv/lpv_irradiance.glsl"
#define LPV_WALLS_BINDING 5
#include "techniques/lpv/lpv_lookup.glsl"

layout(local_size_x = LPV_CELLS_LOCAL) in;

layout(set = 0, binding = 1, scalar) readonly buffer lpv_surfaces
{
    uvec4 surfaces[]; // [cell][direction]
};
layout(set = 0, binding = 2) uniform sampler3D injected;     // from lights and emissive surfaces
layout(set = 0, binding = 3) uniform sampler3D arrived;      // accumulated so far
layout(set = 0, binding = 4) uniform writeonly image3D sent; // injected + reflected

// Bit d: the cell has a surface of direction d.
uint sides_of(ivec3 cell)
{
    uint sides = 0u;
    for (int side = 0; side < 6; side++)
        if (surfaces[6 * lpv_index(cell) + side].a != 0u) sides |= 1u << side;
    return sides;
}

// The position of a lookup for the surface of a cell, which is half a cell behind its centre. It
// does not pass the wall before the next centre.
vec3 lookup_of(ivec3 cell, int axis, vec3 n)
{
    vec3 centre = vec3(cell) + 0.5;
    bool is_up = n[axis] > 0.0;
    ivec3 next = cell;
    next[axis] += is_up ? 1 : 0;
    float open = 1.0;
    if (LPV_GEOMETRY == LPV_GEOMETRY_SCENE && next[axis] > 0 && next[axis] < lpv_cells()[axis]) {
        lpv_wall wall = lpv_wall_below(next, lpv_cells(), axis);
        open -= is_up ? wall.from_below : wall.from_above;
    }
    float offset = min(lpv.bounce_offset, 1.0) + open * max(lpv.bounce_offset - 1.0, 0.0);
    vec3 surface = centre - 0.25 * n, at = centre + (offset - 0.5) * n;
    lpv_lookup lookup = lpv_lookup_at(at, surface, n, centre, lpv_cells());
    lookup.reach = 0.45; // a slope's own places may be in front of the centre
    return lpv_visible(lookup, lpv_cells());
}

// The light that the surfaces of one direction receive and reflect.
struct received {
    vec3 share;     // of the cell's light, in a step
    vec3 reflected; // flux
};

// Irradiance is w / a² times the integral, area a² times `area`. All surfaces of one direction
// receive at most the light through one side of the cell.
received receive(ivec3 cell, int side, vec3 n)
{
    vec4 area = vec4(surfaces[6 * lpv_index(cell) + side]) / LPV_SURFACE_UNIT;
    float limit = max(area.a, 1.0);
    lpv_light light = lpv_sample(arrived, lookup_of(cell, side / 2, n));
    vec3 through = lpv.mean_path * lpv_irradiance(light, n);
    return received(area.a / limit * through / max(lpv_flux_of(light), vec3(1e-15)),
                    area.rgb / limit * through);
}

// With three closed bands light moves along several axes in a step. In edges and corners of a room
// surfaces of several axes receive the same light, which the step loses once.
vec3 received_once(vec3 share[3])
{
    vec3 sum = share[0] + share[1] + share[2];
    vec3 lost = 1.0 - (1.0 - min(share[0], vec3(1.0))) * (1.0 - min(share[1], vec3(1.0))) *
                          (1.0 - min(share[2], vec3(1.0)));
    return mix(vec3(1.0), lost / max(sum, vec3(1e-6)), greaterThan(sum, vec3(1e-6)));
}

void add_lobe(inout vec4 slabs[7], vec3 flux, vec3 n)
{
    float lobe[9];
    sh9_eval(n, lobe);
    for (int i = 1; i < 9; i++) lobe[i] *= i < 4 ? lpv.injected_1 : 0.25;
    for (int i = 0; i < LPV_BANDS * LPV_BANDS; i++)
        for (int colour = 0; colour < 3; colour++) {
            int value = 3 * i + colour;
            slabs[value / 4][value % 4] += flux[colour] * lobe[i];
        }
}

void main()
{
    ivec3 cell = lpv_cell_of_invocation(1);
    if (!lpv_inside(cell)) return;
    vec4 before[7], slabs[7] = vec4[7](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0),
                                       vec4(0.0), vec4(0.0));
    vec3 share[3] = vec3[3](vec3(0.0), vec3(0.0), vec3(0.0));
    uint sides = sides_of(cell);
    while (sides != 0u) {
        int side = findLSB(sides);
        sides &= sides - 1u;
        vec3 n = vec3(0.0);
        n[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
        received light = receive(cell, side, n);
        share[side / 2] += light.share;
        add_lobe(slabs, light.reflected, n);
    }
    lpv_fetch_slabs(injected, cell, before);
    vec3 once = LPV_CLOSURE == LPV_PRODUCT_CLOSURE ? received_once(share) : vec3(1.0);
    for (int value = 0; value < LPV_VALUES; value++) slabs[value / 4][value % 4] *= once[value % 3];
    for (int i = 0; i < LPV_SLABS; i++) slabs[i] += before[i];
    lpv_store_slabs(sent, cell, slabs);
}
