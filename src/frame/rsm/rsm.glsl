// Reading reflective shadow maps (Dachsbacher & Stamminger 2005). Include after frame.glsl; the
// caller declares the bindings: buffer rsm_faces, sampler2DArray for depth, normal and flux
// (nearest).
//
// Flux of a texel. A texel of a sun's map is a beam of perpendicular area A, and E⊥·A lumens go
// through it whatever the slope of the surface behind: the surface is then larger, and E is
// smaller, by the same cosine. A texel of a point's or spot's map is a cone of solid angle Ω with
// I·Ω lumens. Martin 2012, sec. 3.1, multiplies by another (n·l): that would count the slope twice,
// so there is no such factor here.
#ifndef AG_FRAME_RSM_GLSL
#define AG_FRAME_RSM_GLSL

struct rsm_texel {
    bool valid;    // something was hit
    vec3 position; // world, m
    vec3 normal;   // unit, towards the light
    vec3 flux;     // reflected, scaled lumen
};

// Texel centre in clip space, −1…1.
vec2 rsm_clip(ivec2 texel, uint size)
{
    return (vec2(texel) + 0.5) * (2.0 / float(size)) - 1.0;
}

vec3 rsm_position(rsm_face face, ivec2 texel, uint size, float depth)
{
    vec4 h = face.world_from_clip * vec4(rsm_clip(texel, size), depth, 1.0);
    return h.xyz / h.w;
}

// Solid angle of a texel of a perspective face, sr: area on the plane at distance 1 × cosine /
// distance², with both at the texel's centre.
float rsm_solid_angle(rsm_face face, ivec2 texel, uint size)
{
    vec2 p = rsm_clip(texel, size) * face.tan_half;
    float edge = 2.0 * face.tan_half / float(size);
    float r2 = 1.0 + dot(p, p);
    return edge * edge / (r2 * sqrt(r2));
}

// Flux through a texel, scaled lumen. Times the reflectance from the flux image it is the reflected
// flux.
vec3 rsm_flux_through(rsm_face face, ivec2 texel, uint size)
{
    if (face.type == FRAME_LIGHT_SUN) return face.intensity;
    return face.intensity * rsm_solid_angle(face, texel, size);
}

#ifdef AG_FRAME_OCTAHEDRAL_GLSL
// All of a texel; `layer` is the face's index.
rsm_texel rsm_fetch(rsm_face face, ivec2 texel, int layer, uint size, sampler2DArray depth_maps,
                    sampler2DArray normal_maps, sampler2DArray flux_maps)
{
    rsm_texel r;
    ivec3 at = ivec3(texel, layer);
    float depth = texelFetch(depth_maps, at, 0).r;
    r.valid = depth > 0.0;
    r.position = rsm_position(face, texel, size, max(depth, 1e-12));
    r.normal = octahedral_decode(texelFetch(normal_maps, at, 0).rg);
    r.flux = texelFetch(flux_maps, at, 0).rgb * rsm_flux_through(face, texel, size);
    return r;
}
#endif

#endif
