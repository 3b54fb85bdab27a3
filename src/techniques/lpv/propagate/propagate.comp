// One propagation step: each cell gathers light from its 6 or 26 neighbours (Martin 2012,
// sec. 3.2.3, 3.3 and 4.2).
//
// The light accumulated over all steps is A = S + TS + T²S + …, S the injected light, T the step. T
// is linear (nothing is clamped), so accumulation needs neither a pass nor a third grid: A' = S +
// TA.
//
// T sends the flux Φ = Ω I(ω) through each face of a neighbour, of direction ω and solid angle Ω,
// and re-projects it as a lobe around an axis n: the coefficients of a lobe are the polynomials of
// the bands at n. A receiver sums Φ, Φ n and the products Φ n nᵀ (struct sums); one factor per
// coefficient converts these sums. Directions are (p, q, q) in the order of a neighbour's axes, up
// to signs; common terms of the faces of a neighbour are factored out. lpv.twin compares this
// with the plain sum over faces.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"
#include "techniques/lpv/lpv_closure.glsl"
#include "techniques/lpv/lpv_product.glsl"
#define LPV_TRANSMITTANCE_BINDING 4
#define LPV_TRANSMITTANCE_ACCESS  readonly
#include "techniques/lpv/geometry/geometry_transmittance.glsl"

layout(local_size_x = LPV_CELLS_LOCAL) in;

layout(constant_id = LPV_CONSTANT_GEOMETRY) const int LPV_GEOMETRY = LPV_GEOMETRY_OFF;

layout(set = 0, binding = 1) uniform sampler3D injected;
layout(set = 0, binding = 2) uniform sampler3D before;
layout(set = 0, binding = 3) uniform writeonly image3D after;

struct sums {
    vec3 flux;
    vec3 along[3];
    vec3 square[3];
    vec3 product[3];
};

sums empty_sums()
{
    vec3 none[3] = vec3[3](vec3(0.0), vec3(0.0), vec3(0.0));
    return sums(vec3(0.0), none, none, none);
}

// Transmittance of the light of `cell` to four neighbours (geometry_transmittance.glsl). Light from
// outside of the grid is never occluded.
vec4 transmittance_of(ivec3 cell, int word)
{
    if (LPV_GEOMETRY == LPV_GEOMETRY_OFF || !lpv_inside(cell)) return vec4(1.0);
    return unpackUnorm4x8(transmittance_words[LPV_TRANSMITTANCE_WORDS * lpv_index(cell) + word]);
}

// The neighbour along axis a: its far face (±1, 0, 0).
void send_far(inout sums to, lpv_light light, int a, float side, float transmittance)
{
    lpv_reprojection face = lpv.far_face;
    vec3 flux = transmittance * (face.flux_0 * light.mean + side * face.flux_p * light.along[a] +
                                 face.flux_pp * light.square[a]);
    to.flux += flux;
    to.along[a] += side * flux;
    to.square[a] += flux;
}

// Its far face and its four side faces (±p, ±q, 0) and (±p, 0, ±q): two pairs, of which only sums
// and differences are needed.
void send_to_face_neighbour(inout sums to, lpv_light light, int a, float side, float transmittance)
{
    int b = (a + 1) % 3, c = (a + 2) % 3;
    lpv_reprojection face = lpv.side_face;
    float p = side * face.lobe_p, q = face.lobe_q;
    send_far(to, light, a, side, transmittance);
    vec3 even = face.flux_0 * light.mean + side * face.flux_p * light.along[a] +
                face.flux_pp * light.square[a];
    vec3 sum_b = 2.0 * transmittance * (even + face.flux_qq * light.square[b]);
    vec3 sum_c = 2.0 * transmittance * (even + face.flux_qq * light.square[c]);
    vec3 difference_b =
        2.0 * transmittance *
        (face.flux_q * light.along[b] + side * face.flux_product_pq * light.product[c]);
    vec3 difference_c =
        2.0 * transmittance *
        (face.flux_q * light.along[c] + side * face.flux_product_pq * light.product[b]);
    vec3 all = sum_b + sum_c;
    to.flux += all;
    to.along[a] += p * all;
    to.along[b] += q * difference_b;
    to.along[c] += q * difference_c;
    to.square[a] += p * p * all;
    to.square[b] += q * q * sum_b;
    to.square[c] += q * q * sum_c;
    to.product[c] += p * q * difference_b;
    to.product[b] += p * q * difference_c;
}

// Two bands: across the side of the cell, from the closed distribution (lpv_closure.glsl). A ray of
// direction ω crosses the side +x with the share |ω_x| / (|ω_x| + |ω_y| + |ω_z|) of its flux. The
// moments of isotropic light across a side are 1/6 and 1/9. A hemisphere around an axis, of the
// first moment J, adds J/3 and 2/9 J (across) and 5/36 J (along), so that light which fills a
// hemisphere everywhere is preserved. Around another direction less moment goes along a side that
// it crosses: the factor 1 - 3/5 n_a^2 is within 2 % of the flux. The light of a disk fills a cone;
// its pressure on the sides along it is up to 3/2 of the hemisphere's.
void send_closed(inout sums to, lpv_closure light, int a, float side, float transmittance)
{
    vec3 beam = light.beam * max(side * light.direction[a], vec3(0.0)) / light.steps;
    vec3 sine2 = 1.0 - light.direction[a] * light.direction[a];
    vec3 pressure = 1.0 + light.widening * sine2;
    to.flux += transmittance * (light.wide / 6.0 + side / 3.0 * light.wide_along[a] + beam);
    vec3 along = (2.0 + 3.0 * sine2) / 36.0, across = (8.0 + 3.0 * sine2) / 36.0 - along;
    for (int i = 0; i < 3; i++)
        to.along[i] += transmittance * (along * light.wide_along[i] + beam * light.direction[i]);
    to.along[a] +=
        transmittance * (across * light.wide_along[a] + side / 9.0 * pressure * light.wide);
}

// The neighbour across the edge along axis c: its two outer faces (±p, ±q, 0) and (±q, ±p, 0).
void send_over_edge(inout sums to, lpv_light light, int c, float side_a, float side_b,
                    float transmittance)
{
    int a = (c + 1) % 3, b = (c + 2) % 3;
    lpv_reprojection face = lpv.side_face;
    float p = face.lobe_p, q = face.lobe_q, sides = side_a * side_b;
    vec3 shared_part = face.flux_0 * light.mean + sides * face.flux_product_pq * light.product[c];
    vec3 flux_a = transmittance * (shared_part + side_a * face.flux_p * light.along[a] +
                                   side_b * face.flux_q * light.along[b] +
                                   face.flux_pp * light.square[a] + face.flux_qq * light.square[b]);
    vec3 flux_b = transmittance * (shared_part + side_a * face.flux_q * light.along[a] +
                                   side_b * face.flux_p * light.along[b] +
                                   face.flux_qq * light.square[a] + face.flux_pp * light.square[b]);
    to.flux += flux_a + flux_b;
    to.along[a] += side_a * (p * flux_a + q * flux_b);
    to.along[b] += side_b * (q * flux_a + p * flux_b);
    to.square[a] += p * p * flux_a + q * q * flux_b;
    to.square[b] += q * q * flux_a + p * p * flux_b;
    to.product[c] += sides * p * q * (flux_a + flux_b);
}

// The neighbour across a corner: its three outer faces (±p, ±q, ±q), …. Terms of `square` that are
// equal for all axes may be omitted.
void send_over_corner(inout sums to, lpv_light light, vec3 side, float transmittance)
{
    lpv_reprojection face = lpv.corner_face;
    float p = face.lobe_p, q = face.lobe_q;
    vec3 sides = side.yzx * side.zxy; // of the products
    vec3 shared_part = face.flux_0 * light.mean;
    for (int a = 0; a < 3; a++)
        shared_part += side[a] * face.flux_q * light.along[a] +
                       sides[a] * face.flux_product_pq * light.product[a];
    vec3 all = vec3(0.0), flux[3];
    for (int a = 0; a < 3; a++) {
        flux[a] = transmittance *
                  (shared_part + side[a] * (face.flux_p - face.flux_q) * light.along[a] +
                   sides[a] * (face.flux_product_qq - face.flux_product_pq) * light.product[a] +
                   (face.flux_pp - face.flux_qq) * light.square[a]);
        all += flux[a];
    }
    to.flux += all;
    for (int a = 0; a < 3; a++) {
        to.along[a] += side[a] * (q * all + (p - q) * flux[a]);
        to.square[a] += (p * p - q * q) * flux[a];
        to.product[a] += sides[a] * (p * q * all + (q * q - p * q) * flux[a]);
    }
}

// Writes received plus injected light. On boundary sides of a cascade the outermost cells keep the
// light of the next coarser one.
void store(ivec3 cell, sums sum)
{
    vec4 slabs[7];
    if (lpv.boundary != 0u && lpv_outermost(cell, lpv.boundary)) {
        lpv_fetch_slabs(before, cell, slabs);
        lpv_store_slabs(after, cell, slabs);
        return;
    }
    lpv_fetch_slabs(injected, cell, slabs);
    float one = SH_Y1 * lpv.lobe_along, two = SH_Y2_XY * lpv.lobe_product;
    vec3 mean = SH_Y0 * sum.flux;
    vec3 x = one * sum.along[0], y = one * sum.along[1], z = one * sum.along[2];
    vec3 yz = two * sum.product[0], xz = two * sum.product[1], xy = two * sum.product[2];
    vec3 zz = lpv.lobe_square * SH_Y2_ZZ * (2.0 * sum.square[2] - sum.square[0] - sum.square[1]);
    vec3 xx_yy = lpv.lobe_square * SH_Y2_XX_YY * (sum.square[0] - sum.square[1]);
    slabs[0] += vec4(mean, y.r);
    slabs[1] += vec4(y.gb, z.rg);
    slabs[2] += vec4(z.b, x);
    slabs[3] += vec4(xy, yz.r);
    slabs[4] += vec4(yz.gb, zz.rg);
    slabs[5] += vec4(zz.b, xz);
    slabs[6] += vec4(xx_yy, 0.0);
    lpv_store_slabs(after, cell, slabs);
}

// Outside of the grid: the environment.
lpv_light environment_light()
{
    lpv_light light;
    light.mean = lpv.sky[0];
    light.along = vec3[3](lpv.sky[3], lpv.sky[1], lpv.sky[2]);
    light.product = vec3[3](lpv.sky[5], lpv.sky[7], lpv.sky[4]);
    lpv_set_squares(light, lpv.sky[6], lpv.sky[8]);
    return light;
}

lpv_light light_of(ivec3 cell)
{
    return lpv_inside(cell) ? lpv_fetch(before, cell) : environment_light();
}

void from_face(inout sums to, ivec3 cell, int axis, int side)
{
    ivec3 offset = ivec3(0);
    offset[axis] = side;
    float transmittance = transmittance_of(cell - offset, axis)[side > 0 ? 1 : 0];
    lpv_light light = light_of(cell - offset);
    if (LPV_CLOSED)
        send_closed(to, lpv_closure_of(light), axis, float(side), transmittance);
    else
        send_to_face_neighbour(to, light, axis, float(side), transmittance);
}

void gather_six(ivec3 cell)
{
    sums sum = empty_sums();
    for (int axis = 0; axis < 3; axis++) {
        from_face(sum, cell, axis, 1);
        from_face(sum, cell, axis, -1);
    }
    store(cell, sum);
}

// ---- 26 neighbours: an invocation iterates along z and fetches each source once, for the
// receivers below, level with and above it.

struct receivers {
    sums below, level, above;
};

void from_bands(inout receivers to, lpv_light light, ivec2 step, vec3 transmittance)
{
    float x = float(step.x), y = float(step.y);
    float below = transmittance[0], level = transmittance[1], above = transmittance[2];
    if (step.x != 0 && step.y != 0) {
        send_over_corner(to.below, light, vec3(x, y, -1.0), below);
        send_over_edge(to.level, light, 2, x, y, level);
        send_over_corner(to.above, light, vec3(x, y, 1.0), above);
    } else if (step.x != 0) {
        send_over_edge(to.below, light, 1, -1.0, x, below);
        send_far(to.level, light, 0, x, level);
        send_over_edge(to.above, light, 1, 1.0, x, above);
    } else if (step.y != 0) {
        send_over_edge(to.below, light, 0, y, -1.0, below);
        send_far(to.level, light, 1, y, level);
        send_over_edge(to.above, light, 0, y, 1.0, above);
    } else {
        send_far(to.below, light, 2, -1.0, below);
        send_far(to.above, light, 2, 1.0, above);
    }
}

// The light of a source that moves by a step along x and y: its moments, and those of the part that
// does not move along z.
struct column {
    vec3 flux, along_x, along_y, along_z, square_x, square_y, square_z, product_xy;
    vec3 half_along_x, half_along_y;
};

// Light whose ω_a² differs from the mean of its cell differs along the other axes: all squares sum
// to the flux.
column column_of(lpv_product light, ivec2 step)
{
    lpv_moved x = lpv_moved_by(light.axes[0], step.x), y = lpv_moved_by(light.axes[1], step.y);
    vec3 flux_x = light.flux * x.flux, flux_y = light.flux * y.flux;
    vec3 across_x = flux_y * x.across, across_y = flux_x * y.across;
    column c;
    c.flux = flux_x * y.flux;
    c.half_along_x = 0.5 * flux_y * x.mean;
    c.half_along_y = 0.5 * flux_x * y.mean;
    c.along_x = 2.0 * c.half_along_x + 0.5 * light.flux * x.mean * y.across;
    c.along_y = 2.0 * c.half_along_y + 0.5 * light.flux * y.mean * x.across;
    c.along_z = c.flux + 0.5 * (across_x + across_y);
    c.square_x = flux_y * x.square + light.axes[0].square * across_y;
    c.square_y = flux_x * y.square + light.axes[1].square * across_x;
    c.square_z = light.axes[2].square * (across_x + across_y);
    c.product_xy = light.flux * x.mean * y.mean + c.flux * light.covariance[2];
    return c;
}

void send_column(inout sums to, column c, lpv_product light, int step_z, float transmittance)
{
    lpv_moved z = lpv_moved_by(light.axes[2], step_z);
    vec3 share = transmittance * z.flux, mean = transmittance * z.mean;
    vec3 across = transmittance * z.across, across_z = c.flux * across;
    vec3 flux = c.flux * share;
    to.flux += flux;
    to.along[0] += c.along_x * share + c.half_along_x * across;
    to.along[1] += c.along_y * share + c.half_along_y * across;
    to.along[2] += c.along_z * mean;
    to.square[0] += c.square_x * share + light.axes[0].square * across_z;
    to.square[1] += c.square_y * share + light.axes[1].square * across_z;
    to.square[2] += c.square_z * share + c.flux * (transmittance * z.square);
    to.product[0] += 2.0 * c.half_along_y * mean + flux * light.covariance[0];
    to.product[1] += 2.0 * c.half_along_x * mean + flux * light.covariance[1];
    to.product[2] += c.product_xy * share;
}

// Sends the light that moves by `step` along x and y; a part of it moves along z.
void from_product(inout receivers to, lpv_product light, ivec2 step, vec3 transmittance)
{
    column c = column_of(light, step);
    float level = step == ivec2(0) ? 1.0 : transmittance[1];
    send_column(to.below, c, light, -1, transmittance[0]);
    send_column(to.level, c, light, 0, level);
    send_column(to.above, c, light, 1, transmittance[2]);
}

// From the source at (−step.x, −step.y) relative to the receivers' column.
void from_column(inout receivers to, ivec3 cell, ivec2 step)
{
    vec3 transmittance = transmittance_of(cell, 3 * (step.y + 1) + step.x + 1).xyz;
    if (LPV_CLOSURE == LPV_PRODUCT_CLOSURE)
        from_product(to, lpv_product_of(light_of(cell)), step, transmittance);
    else
        from_bands(to, light_of(cell), step, transmittance);
}

void gather_twenty_six(ivec3 first)
{
    receivers to = receivers(empty_sums(), empty_sums(), empty_sums());
    for (int z = first.z - 1; z <= first.z + LPV_RUN; z++) {
        [[unroll]] for (int y = -1; y <= 1; y++) [[unroll]] for (int x = -1; x <= 1; x++)
            from_column(to, ivec3(first.xy - ivec2(x, y), z), ivec2(x, y));
        if (z > first.z && z - 1 < lpv.cells_z) store(ivec3(first.xy, z - 1), to.below);
        to = receivers(to.level, to.above, empty_sums());
    }
}

void main()
{
    ivec3 cell = lpv_cell_of_invocation(LPV_NEIGHBOURS == 26 ? LPV_RUN : 1);
    if (!lpv_inside(cell)) return;
    if (LPV_NEIGHBOURS == 26)
        gather_twenty_six(cell);
    else
        gather_six(cell);
}
