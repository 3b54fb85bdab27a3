// Traverses the grid of spheres along each pixel's view ray (Amanatides & Woo 1987), up to the
// surface.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "frame/probes.glsl"
#include "techniques/common/probes/lookup.glsl"
#include "techniques/common/probes/view_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform push_block
{
    probe_view_push push;
};
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3) uniform sampler2D albedo;
layout(set = 0, binding = 4) uniform sampler3D probes;
layout(set = 0, binding = 5) uniform sampler2D probe_depths; // or any image
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D target;

const float RADIUS = 0.12, DIM = 0.3;

// Intersection with the sphere of radius RADIUS around `center`; false: the ray misses it.
bool intersect_sphere(vec3 from, vec3 direction, vec3 center, out float distance)
{
    vec3 to = from - center;
    float b = dot(to, direction), c = dot(to, to) - RADIUS * RADIUS, d = b * b - c;
    distance = -b - sqrt(max(d, 0.0));
    return d >= 0.0 && distance > 0.0;
}

// Radiance of the first sphere before `limit`; less than 0: none. One unit is the spacing of the
// spheres, which lie at the centers of unit cells.
vec3 trace_spheres(vec3 from, vec3 direction, float limit, ivec3 spheres)
{
    vec3 inverse = 1.0 / direction;
    vec3 low = -from * inverse, high = (vec3(spheres) - from) * inverse;
    vec3 near = min(low, high), far = max(low, high);
    float begin = max(max(near.x, near.y), max(near.z, 0.0)),
          end = min(min(far.x, far.y), min(far.z, limit));
    if (begin >= end) return vec3(-1.0);
    ivec3 cell = clamp(ivec3(floor(from + direction * begin)), ivec3(0), spheres - 1);
    ivec3 one = ivec3(sign(direction));
    vec3 step_length = abs(inverse),
         next = (vec3(cell) + vec3(greaterThan(one, ivec3(0))) - from) * inverse;
    while (begin < end && all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, spheres))) {
        float distance;
        vec3 center = vec3(cell) + 0.5;
        if (intersect_sphere(from, direction, center, distance) && distance < end) {
            vec3 n = normalize(from + direction * distance - center);
            vec3 probe = push.grid.first_m + float(push.every) * push.grid.spacing_m * vec3(cell);
            return probes_irradiance(probes, push.grid, probe, n) / PI;
        }
        int axis = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : (next.y <= next.z ? 1 : 2);
        begin = next[axis];
        next[axis] += step_length[axis];
        cell[axis] += one[axis];
    }
    return vec3(-1.0);
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    float z = texelFetch(depth, ivec2(pixel), 0).r;
    // A view ray without a surface ends far away. No component of its direction may be exactly 0.
    vec3 position = frame_world_position(frame_uv(pixel), max(z, 1e-6));
    vec3 colour = vec3(0.0);
    if (z > 0.0) {
        vec3 n = octahedral_decode(texelFetch(normal, ivec2(pixel), 0).rg);
        vec3 reflected = texelFetch(albedo, ivec2(pixel), 0).rgb / PI;
        vec3 before = position + 0.5 * push.grid.spacing_m * n;
        colour = DIM * reflected *
                 probes_published_irradiance(probes, probe_depths, push.grid, push.visibility,
                                             before, n);
    }
    float unit = float(push.every) * push.grid.spacing_m;
    vec3 from = (frame_ray_origin(frame_uv(pixel)) - push.grid.first_m) / unit + 0.5,
         to = (position - push.grid.first_m) / unit + 0.5;
    ivec3 spheres =
        (ivec3(push.grid.count_x, push.grid.count_y, push.grid.count_z) + push.every - 1) /
        push.every;
    float limit = distance(from, to);
    vec3 direction = (to - from) / limit;
    direction = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    vec3 sphere = trace_spheres(from, direction, limit, spheres);
    if (sphere.r >= 0.0) colour = sphere;
    imageStore(target, ivec2(pixel), vec4(min(colour, HALF_MAX), 1.0));
}
