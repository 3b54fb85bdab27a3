// Irradiance probe volume: irradiance on a grid, for shading points that are not pixels (dynamic
// objects, particles). Include after core/sh.glsl and frame/frame_shared.h.
//
// Each probe stores scaled irradiance E(n) = Σ c_i Y_i(n), n the receiver's normal, as nine SH
// coefficients per RGB channel. One RGBA16F image has FRAME_PROBE_SLABS slabs along z: coefficient
// 3 i + channel is component (3 i + channel) mod 4 of slab (3 i + channel) div 4; the last
// component is 0.
#ifndef AG_FRAME_PROBES_GLSL
#define AG_FRAME_PROBES_GLSL

// Coefficients between eight probes: `texel` in texels of the first slab, `slab` texels to the
// next.
void probes_coefficients_at(sampler3D volume, int slab, vec3 texel, out vec3 coefficients[9])
{
    vec3 size = vec3(textureSize(volume, 0));
    vec4 values;
    for (int i = 0; i < 9; i++) {
        for (int channel = 0; channel < 3; channel++) {
            int component = 3 * i + channel;
            if (component % 4 == 0) {
                float offset = float(component / 4 * slab);
                values = textureLod(volume, (texel + vec3(0.0, 0.0, offset)) / size, 0.0);
            }
            coefficients[i][channel] = values[component % 4];
        }
    }
}

// Irradiance there.
vec3 probes_irradiance_at(sampler3D volume, int slab, vec3 texel, vec3 normal)
{
    vec3 coefficients[9];
    probes_coefficients_at(volume, slab, texel, coefficients);
    return max(sh9_dot(coefficients, normal), vec3(0.0));
}

// Irradiance at a world position; positions are clamped to the grid.
vec3 probes_irradiance(sampler3D volume, frame_probes grid, vec3 position, vec3 normal)
{
    vec3 last = vec3(grid.count_x, grid.count_y, grid.count_z) - 1.0;
    vec3 texel = clamp((position - grid.first_m) / grid.spacing_m, vec3(0.0), last) + 0.5;
    return probes_irradiance_at(volume, grid.slab, texel, normal);
}

// Probe i of a grid, as its host code counts them; beyond the last one z is count_z or more.
ivec3 probes_cell(frame_probes grid, int i)
{
    int row = grid.count_x, layer = row * grid.count_y;
    return ivec3(i % row, i / row % grid.count_y, i / layer);
}

// Texel of a probe in slab s of FRAME_PROBE_SLABS, at probe + (0, 0, s × grid.slab).
vec4 probes_slab(vec3 coefficients[9], int s)
{
    vec4 slab = vec4(0.0);
    for (int k = 0; k < 4; k++)
        if (4 * s + k < 27) slab[k] = coefficients[(4 * s + k) / 3][(4 * s + k) % 3];
    return slab;
}

#endif
