// Reflectance of a scene's surface for light that bounces: the hemispherical one, since neither its
// incident nor its outgoing direction is known. Include it after scene_material_table.
#ifndef AG_FRAME_SCENE_REFLECTANCE_GLSL
#define AG_FRAME_SCENE_REFLECTANCE_GLSL

#include "frame/brdf.glsl"

// base: base colour; x: roughness, y: metallic. The maps of the specular lobe are not read: factors
// alone.
vec3 scene_reflectance(uint material, vec3 base, vec2 roughness_metallic)
{
    if ((scene_material_table[material].flags & SCENE_UNLIT) != 0u) return vec3(0.0);
    float weight = scene_material_table[material].specular;
    vec3 f0 = min(scene_material_table[material].specular_f0, 1.0) * weight;
    return brdf_bounce_reflectance(
        brdf_material(base, roughness_metallic.y, roughness_metallic.x, f0, weight));
}

#endif
