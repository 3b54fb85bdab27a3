// Means over the pixels of one surface around a pixel of what arrives in its specular lobe: each
// pixel has one direction of the lobe. A neighbour counts if its normal, its place and its
// roughness are similar. A mirror's pixels are not averaged. Declare the samplers `depth`,
// `normal`, `material` and `arriving` first.
#ifndef AG_VCT_LOBE_MEAN_GLSL
#define AG_VCT_LOBE_MEAN_GLSL

const float LOBE_LEAST_COSINE = 0.95;  // of two normals
const float LOBE_TOLERANCE = 0.01;     // distance from the plane over that from the camera
const float LOBE_ROUGHNESS_STEP = 0.1; // difference at which a neighbour has no weight

struct lobe_pixel {
    vec3 position, normal;
    float roughness;
};

vec3 lobe_position(ivec2 pixel, float z)
{
    return frame_world_position(frame_uv(uvec2(pixel)), z);
}

lobe_pixel lobe_pixel_at(ivec2 pixel, float z)
{
    return lobe_pixel(lobe_position(pixel, z), octahedral_decode(texelFetch(normal, pixel, 0).rg),
                      texelFetch(material, pixel, 0).r);
}

// Radiance times weight, weight. Pixels outside of the image, and those without a ray, have none.
vec4 lobe_neighbour(lobe_pixel p, ivec2 at, float weight)
{
    ivec2 inside = clamp(at, ivec2(0), ivec2(frame.width, frame.height) - 1);
    float z = texelFetch(depth, inside, 0).r;
    float roughness = texelFetch(material, inside, 0).r;
    vec3 its_normal = octahedral_decode(texelFetch(normal, inside, 0).rg);
    float per_m = 1.0 / (LOBE_TOLERANCE * length(frame_to_viewer(p.position)));
    vec3 alike = vec3(1.0 - abs(dot(p.normal, lobe_position(inside, z) - p.position)) * per_m,
                      (dot(p.normal, its_normal) - LOBE_LEAST_COSINE) / (1.0 - LOBE_LEAST_COSINE),
                      1.0 - abs(roughness - p.roughness) / LOBE_ROUGHNESS_STEP);
    alike = clamp(alike, 0.0, 1.0);
    weight *= z > 0.0 && inside == at ? alike.x * alike.y * alike.z : 0.0;
    vec4 radiance = texelFetch(arriving, inside, 0);
    return radiance.a > 0.0 ? weight * vec4(radiance.rgb, 1.0) : vec4(0.0);
}

#endif
