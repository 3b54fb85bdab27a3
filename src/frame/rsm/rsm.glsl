// Lookup of reflective shadow maps (Dachsbacher & Stamminger 2005). Include after frame.glsl; the
// caller declares the bindings: buffer rsm_faces, sampler2DArray for depth, normal and flux
// (nearest).
//
// Flux through a texel: E⊥·A for suns, with the texel's perpendicular area A; I·Ω for points and
// spots, with its solid angle Ω. It does not depend on the surface's slope: on an inclined surface
// the lit area grows and E falls by the same cosine. Martin 2012, sec. 3.1, multiplies by another
// (n·l), which would count that cosine twice; it is left out here.
#ifndef AG_FRAME_RSM_GLSL
#define AG_FRAME_RSM_GLSL

struct rsm_texel {
    bool valid;    // there is a surface
    vec3 position; // world, m
    vec3 normal;   // unit, on the light's side
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

// Incident flux through a texel, scaled lumen; reflected flux = incident flux × reflectance (flux
// image).
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
