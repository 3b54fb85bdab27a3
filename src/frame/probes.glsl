// A probe volume: irradiance at the points of a grid, for what the frame has no pixel of — dynamic
// objects, particles, techniques that come later. Include after core/sh.glsl and
// frame/frame_shared.h.
//
// Each probe holds scaled irradiance E(n) = Σ c_i Y_i(n), n the receiver's normal, in nine
// coefficients for each of R, G, B. They lie in one RGBA16F image of FRAME_PROBE_SLABS slabs, one
// behind the other along z: number 3 i + colour stands in component (3 i + colour) mod 4 of slab (3
// i + colour) div 4; the last number is 0.
#ifndef AG_FRAME_PROBES_GLSL
#define AG_FRAME_PROBES_GLSL

// Of a point of the world, filtered between the eight probes around it; outside of the grid the
// nearest face's.
vec3 probes_irradiance(sampler3D volume, frame_probes place, vec3 position, vec3 normal)
{
    vec3 last = vec3(place.count_x, place.count_y, place.count_z) - 1.0;
    vec3 texel = clamp((position - place.first_m) / place.spacing_m, vec3(0.0), last) + 0.5;
    vec3 size = vec3(textureSize(volume, 0));
    float basis[9];
    sh9_eval(normal, basis);
    vec4 slab;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 9; i++) {
        for (int colour = 0; colour < 3; colour++) {
            int number = 3 * i + colour;
            if (number % 4 == 0) {
                float behind = float(number / 4 * place.slab);
                slab = textureLod(volume, (texel + vec3(0.0, 0.0, behind)) / size, 0.0);
            }
            sum[colour] += basis[i] * slab[number % 4];
        }
    }
    return max(sum, vec3(0.0));
}

// What slab s of FRAME_PROBE_SLABS holds of a probe; its texel is probe + (0, 0, s × place.slab).
vec4 probes_slab(vec3 coefficients[9], int s)
{
    vec4 slab = vec4(0.0);
    for (int k = 0; k < 4; k++)
        if (4 * s + k < 27) slab[k] = coefficients[(4 * s + k) / 3][(4 * s + k) % 3];
    return slab;
}

#endif
