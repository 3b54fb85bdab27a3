// Irradiance of each pixel from the accumulated intensity (Martin 2012, sec. 3.2.4, without the
// albedo of eq. 3.4).
//
// From intensity to irradiance. In one step, the flux I(ω) dω of a cell of side a travels the path
// w a, w = 2/3 with six neighbours and 1.203 with 26 (lpv_mean_path). Flux times path per volume is
// radiance: L(ω) = I(ω) (w a) / a³, and E = ∫ L(ω) (−n·ω)₊ dω. Hence irradiance_scale = w / a²; the
// tests compare it with form factors.
//
// Directional bands: lpv_irradiance.glsl. `window` scales them; 1 conserves energy.
//
// Damping. Light that arrives from elsewhere does not decrease along the normal; light that the
// surface itself sends, or that leaks through it, does. The decrease of irradiance over a cell
// along the normal, h ∂E/∂n < 0, is subtracted (the directional derivative of Martin 2012,
// sec. 3.2.4; the paper gives no formula).
//
// Reconstruction. Trilinear between cells, with visible kinks at strong gradients (sec. 6.4), or a
// cubic B-spline, smooth and wider.
//
// SPECULAR: also the radiance that the specular lobe reflects, by irradiance and vector irradiance
// as light maps have it (light_map/lookup.glsl).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#define FRAME_CONSTANTS_COPIED
#define LPV_GRID_COPIED
#if SPECULAR
#define GGX_ALBEDO_BINDING 7
#endif
#include "core/half.glsl"
#include "core/math.glsl"
#include "core/sh.glsl"
#include "frame/frame.glsl"
#if SPECULAR
#include "frame/brdf.glsl"
#include "techniques/common/light_map/lookup.glsl"
#endif
#include "frame/octahedral.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"
#include "techniques/lpv/lpv_irradiance.glsl"
#define LPV_WALLS_BINDING 6
#include "techniques/lpv/lpv_lookup.glsl"

// Constants, because drivers without branches would evaluate both.
layout(constant_id = LPV_CONSTANT_CUBIC) const bool LPV_CUBIC = false;
layout(constant_id = LPV_CONSTANT_DAMPED) const bool LPV_DAMPED = false;

layout(push_constant, scalar) uniform push_block
{
    lpv_apply_push push_of_all;
};
lpv_apply_push push; // a copy, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 2) uniform sampler2D depth;
#define COLUMNS_WIDTH LPV_APPLY_LOCAL
#define COLUMNS_ROWS  push.rows
#define COLUMNS_HAS   has_light_of_cascade
#include "techniques/common/light_map/columns.glsl"
layout(set = 0, binding = 3) uniform sampler2D normal;
layout(set = 0, binding = 4) uniform sampler3D light;
layout(set = 0, binding = 5, rgba16f) uniform image2D irradiance;
#if SPECULAR
layout(set = 0, binding = 8) uniform sampler2D albedo;
layout(set = 0, binding = 9) uniform sampler2D material;
layout(set = 0, binding = 10) uniform sampler2D dielectric; // FRAME_DIELECTRIC if `has_dielectric`
layout(set = 0, binding = 11, rgba16f) uniform image2D specular;
#include "techniques/common/reflected.glsl"
#endif

bool is_between(vec3 low, vec3 position, vec3 high)
{
    return all(lessThan(low, position)) && all(lessThan(position, high));
}

// Whether the cascade lights the pixel's surface, and finer ones do not light it alone.
bool has_light_of_cascade(ivec2 pixel, float z)
{
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
    return z > 0.0 && is_between(push.low_m, position, push.high_m) &&
           !is_between(push.finer_low_m, position, push.finer_high_m);
}

// Weight against the next coarser cascade: 1, falling to 0 before open sides.
float weight_at(vec3 position)
{
    vec3 inside = min(position - push.low_m, push.high_m - position) / lpv.cell_m;
    return smoothstep(0.0, LPV_TRANSITION, min(inside.x, min(inside.y, inside.z)));
}

vec3 linear_irradiance(vec3 at, vec3 n)
{
    return lpv_irradiance(lpv_sample(light, at), n);
}

// A cubic B-spline over 4³ cells in eight filtered lookups (Sigg & Hadwiger 2005): along an axis,
// two cells are one filtered lookup between them.
vec3 cubic_irradiance(vec3 at, vec3 n)
{
    vec3 first = floor(at - 0.5), f = at - 0.5 - first, g = 1.0 - f;
    vec3 w0 = g * g * g / 6.0, w1 = 2.0 / 3.0 - 0.5 * f * f * (1.0 + g), w3 = f * f * f / 6.0,
         w2 = 1.0 - w0 - w1 - w3;
    vec3 low = first - 0.5 + w1 / (w0 + w1), high = first + 1.5 + w3 / (w2 + w3);
    vec3 sum = vec3(0.0);
    for (int corner = 0; corner < 8; corner++) {
        bvec3 is_high = bvec3((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
        vec3 weight = mix(w0 + w1, w2 + w3, is_high);
        sum += weight.x * weight.y * weight.z * linear_irradiance(mix(low, high, is_high), n);
    }
    return sum;
}

// Sharp lobes leave negative values behind a bright wall.
vec3 irradiance_at(vec3 at, vec3 n)
{
    return max(LPV_CUBIC ? cubic_irradiance(at, n) : linear_irradiance(at, n), vec3(0.0));
}

vec3 damped_irradiance(vec3 at, vec3 n)
{
    vec3 here = irradiance_at(at, n);
    if (!LPV_DAMPED) return here;
    vec3 gain = irradiance_at(at + n, n) - here;
    return max(here + lpv.damping * min(gain, vec3(0.0)), vec3(0.0));
}

// Places of walls are known to 1/LPV_PLACES of a cell: beside a seam, a pixel could be behind the
// other wall, where no light is. The viewer sees it from the lit side.
const float LPV_TO_VIEWER = 2.0 / float(LPV_PLACES); // cells

// Position of a lookup for a surface, in cells.
vec3 lookup_of(vec3 position, vec3 n)
{
    vec3 surface = lpv_cells_from_world(position),
         at = lpv_cells_from_world(position + lpv.offset_m * n);
    vec3 to_viewer = frame_to_viewer(position) / lpv.cell_m;
    vec3 seen = surface + to_viewer * min(1.0 / length(to_viewer), 1.0);
    lpv_lookup lookup = lpv_lookup_at(at, surface, n, seen, lpv_cells());
    lookup.side += clamp(to_viewer, vec3(-LPV_TO_VIEWER), vec3(LPV_TO_VIEWER));
    return lpv_visible(lookup, lpv_cells());
}

vec3 surface_irradiance(vec3 at, vec3 n)
{
    return min(lpv.irradiance_scale * damped_irradiance(at, n), vec3(HALF_MAX));
}

#if SPECULAR
// Vector irradiance along the surface. At most 2/3 of the irradiance: radiance that is linear in
// its direction is then nowhere negative. Clamped colours would show as bands of another hue.
mat3 vector_along(lpv_light light, vec3 n, vec3 irradiance)
{
    mat3 vector = lpv.irradiance_scale * lpv_vector_irradiance(light);
    for (int c = 0; c < 3; c++) {
        vector[c] -= n * dot(n, vector[c]);
        float size2 = max(dot(vector[c], vector[c]), 1e-12);
        vector[c] *= min(irradiance[c] / 1.5 * inversesqrt(size2), 1.0);
    }
    return vector;
}

vec3 surface_reflected(ivec2 pixel, vec3 surface, vec3 n, vec3 at, vec3 irradiance)
{
    brdf_material m = pixel_material(pixel, push.has_dielectric != 0u);
    vec3 to_viewer = frame_to_viewer(surface);
    to_viewer *= inversesqrt(dot(to_viewer, to_viewer));
    mat3 vector = vector_along(lpv_sample(light, at), n, irradiance);
    light_map_lobe lobe = light_map_lobe_of(n, to_viewer, brdf_alpha(m.roughness));
    vec3 radiance = INV_PI * (irradiance + 1.5 * lobe.share * (lobe.along * vector));
    return pixel_reflected(m, n, to_viewer, radiance);
}
#endif

// Over the light of coarser cascades.
void store(ivec2 pixel, vec3 arriving, vec3 reflected, float weight)
{
    bool alone = push.coarsest != 0u || weight == 1.0;
    vec3 before = alone ? vec3(0.0) : imageLoad(irradiance, pixel).rgb;
    imageStore(irradiance, pixel, vec4(mix(before, arriving, weight), 1.0));
#if SPECULAR
    before = alone ? vec3(0.0) : imageLoad(specular, pixel).rgb;
    imageStore(specular, pixel, vec4(mix(before, reflected, weight), 1.0));
#endif
}

void shade(ivec2 pixel)
{
    vec3 surface = frame_world_position(frame_uv(uvec2(pixel)), texelFetch(depth, pixel, 0).r);
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    vec3 at = lookup_of(surface, n);
    vec3 arriving = surface_irradiance(at, n), reflected = vec3(0.0);
#if SPECULAR
    reflected = surface_reflected(pixel, surface, n, at, arriving);
#endif
    float weight = weight_at(surface);
    store(pixel, arriving, reflected, weight > 0.999999 ? 1.0 : weight);
}

// Dispatched from the coarsest cascade to the finest; each blends over the previous ones. Outside
// of the coarsest cascade there is no light: the host has cleared the images.
void main()
{
    frame = frame_block;
    lpv = lpv_block;
    push = push_of_all;
    shade_column(ivec2(frame.width, frame.height));
}
