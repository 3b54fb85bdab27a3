// A ray through the depth pyramid (Uludag 2014, "Hi-Z Screen-Space Cone-Traced Reflections", GPU
// Pro 5, with one pyramid: the nearest depths).
//
// Screen space is (x, y) in pixels and the reversed depth D, in which rays and planes are affine.
// The ray's parameter is in pixels along the axis on which it moves most. While the whole part of a
// ray in a cell is nearer than the nearest surface there, it leaves the cell and goes on with a
// larger one; else it goes on with a smaller one, down to the pixels.
#ifndef AG_SSR_MARCH_GLSL
#define AG_SSR_MARCH_GLSL

layout(set = 0, binding = SSR_PYRAMID_BINDING) uniform sampler2D pyramid;

struct ssr_ray {
    vec3 from, along; // screen space, per pixel
    float end;        // parameter at the image's border, the near plane or far away
};

struct ssr_cell {
    ivec2 at;        // the pixel
    float in_, out_; // parameters of the ray
    float depth;     // D of its surface
    bool reached;    // false: the ray has ended
};

const float SSR_FAR = 1.0e4;   // m, along a ray
const float SSR_PUSH = 1.0e-3; // px beyond a cell's border

vec3 ssr_screen(vec4 clip)
{
    vec3 at = clip.xyz / clip.w;
    return vec3((at.xy * 0.5 + 0.5) * vec2(frame.width, frame.height), at.z);
}

ssr_ray ssr_ray_of(vec3 position, vec3 direction)
{
    vec4 start = frame.clip_from_world * vec4(position, 1.0);
    float distance_m = dot(frame.axis.xyz, position) + frame.axis.w;
    float towards = -dot(frame.axis.xyz, direction);
    float most = 0.999 * (distance_m - frame.near_m) / max(towards, 1.0e-6);
    float reach = towards > 0.0 ? min(most, SSR_FAR) : SSR_FAR;
    ssr_ray ray;
    ray.from = ssr_screen(start);
    vec3 whole =
        ssr_screen(start + reach * (frame.clip_from_world * vec4(direction, 0.0))) - ray.from;
    float pixels = max(abs(whole.x), abs(whole.y));
    ray.along = whole / max(pixels, 1.0e-6);
    vec2 border =
        mix(vec2(0.0), vec2(frame.width, frame.height), greaterThan(ray.along.xy, vec2(0.0)));
    vec2 leaves = (border - ray.from.xy) / ray.along.xy; // ±infinite along an axis of no motion
    leaves = mix(leaves, vec2(1.0e9), lessThan(abs(ray.along.xy), vec2(1.0e-9)));
    ray.end = min(pixels, min(leaves.x, leaves.y)) - SSR_PUSH;
    return ray;
}

// Parameter at which the ray leaves a cell of `size` pixels.
float ssr_exit(ssr_ray ray, vec2 cell, float size)
{
    vec2 edge = (cell + vec2(greaterThan(ray.along.xy, vec2(0.0)))) * size;
    vec2 leaves = (edge - ray.from.xy) / ray.along.xy;
    leaves = mix(leaves, vec2(1.0e9), lessThan(abs(ray.along.xy), vec2(1.0e-9)));
    return min(leaves.x, leaves.y) + SSR_PUSH;
}

// The next pixel, from parameter t on, whose surface the ray touches or is behind of.
ssr_cell ssr_next(ssr_ray ray, float t, inout int left)
{
    ssr_cell cell = ssr_cell(ivec2(0), t, t, 0.0, false);
    int level = 0;
    for (; left > 0; left--) {
        if (t >= ray.end) break;
        float size = float(1 << level);
        vec2 at = floor((ray.from.xy + t * ray.along.xy) / size);
        float leaves = max(ssr_exit(ray, at, size), t + SSR_PUSH);
        float nearest = texelFetch(pyramid, ivec2(at), level).r;
        float farther = ray.from.z + (ray.along.z < 0.0 ? leaves : t) * ray.along.z;
        bool is_behind = farther <= nearest;
        if (is_behind && level == 0) {
            cell = ssr_cell(ivec2(at), t, leaves, nearest, true);
            break;
        }
        // The part in front of the nearest surface is skipped.
        float meets = (nearest - ray.from.z) / min(ray.along.z, -1.0e-12);
        t = is_behind ? (ray.along.z < 0.0 ? max(t, meets) : t) : leaves;
        level = is_behind ? level - 1 : min(level + 1, SSR_LEVELS - 1);
    }
    return cell;
}

#endif
