// Cone sums and surfaces at half resolution, and their similarity to full-resolution pixels. The
// including shader declares frame.glsl, the block `set` and the images depth, cone_normal, red,
// green and blue.
#ifndef AG_VCT_UPSAMPLE_GLSL
#define AG_VCT_UPSAMPLE_GLSL

#include "techniques/vct/clipmap/clipmap.glsl"
#include "techniques/vct/cones/cone_sums.glsl"

struct vct_half_pixel {
    bool valid;
    vec3 position, up; // up: the cone normal
};

vct_cone_sums vct_cone_sums_at(ivec2 at)
{
    vec4 r = texelFetch(red, at, 0), g = texelFetch(green, at, 0), b = texelFetch(blue, at, 0);
    return vct_cone_sums(mat3(r.xyz, g.xyz, b.xyz), vec3(r.w, g.w, b.w));
}

ivec2 vct_clamp_to_image(ivec2 at)
{
    return clamp(at, ivec2(0), ivec2(set.width, set.height) - 1);
}

vct_half_pixel vct_half_pixel_at(ivec2 at)
{
    ivec2 pixel = at * int(set.step);
    float z = texelFetch(depth, pixel, 0).r;
    vct_half_pixel p;
    p.valid = z > 0.0;
    p.position = frame_world_position(frame_uv(uvec2(pixel)), max(z, 1e-12));
    p.up = octahedral_decode(texelFetch(cone_normal, at, 0).rg);
    return p;
}

// A surface point at full resolution.
struct vct_surface_point {
    vec3 position, normal;
    float texel_m; // texel size of the light volume there
};

vct_surface_point vct_surface_point_at(vec3 position, vec3 normal)
{
    return vct_surface_point(position, normal,
                             set.texel_m * vct_texel_at((position - clips.origin_m) / set.texel_m));
}

// Bilateral weight 0…1: distance of the point from the plane of the half-resolution pixel, and
// cosine of the normals.
float vct_similarity(vct_half_pixel p, vct_surface_point here)
{
    float distance = abs(dot(p.up, here.position - p.position));
    float c = max(dot(p.up, here.normal), 0.0);
    return p.valid ? c * c * c * c * clamp(1.0 - 2.0 * distance / here.texel_m, 0.0, 1.0) : 0.0;
}

// Fraction of the cone set, 0…1. A whole set has n·(Σ d) of about ½, the mean of |n·d| over the
// sphere.
float vct_cone_fraction(vct_cone_sums v, vec3 n)
{
    return clamp(2.0 * dot(n, v.direction), 0.0, 1.0);
}

void vct_add(inout vct_cone_sums sum, vct_cone_sums more, float weight)
{
    sum.light += weight * more.light;
    sum.direction += weight * more.direction;
}

#endif
