// Adds the changes by objects to each pixel's irradiance: their volumes times weights of its
// normal, (n_o·n)₊ of one volume (Giuffrida 2016, equation 16). Workgroups are the tiles of the
// image that some object reaches. A pixel that none changes is not written.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_COPIED
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/dnrt/dnrt_shared.h"

#include "techniques/dnrt/dnrt_object.glsl"
#include "techniques/dnrt/dnrt_receiver.glsl"

// An invocation has quads of 2 × 2 pixels, this number one below the other: it skips those without
// a surface.
const int ROWS = 4;
layout(local_size_x = DNRT_TILE / 2, local_size_y = DNRT_TILE / 2 / ROWS) in;

layout(push_constant, scalar) uniform push_block
{
    dnrt_apply_push push;
};
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
#ifdef DNRT_ID
layout(set = 0, binding = 3) uniform usampler2D id; // FRAME_ID
#endif
layout(set = 0, binding = 4, scalar) uniform dnrt_objects
{
    dnrt_gpu_object object_table[DNRT_MAX_OBJECTS];
};
layout(set = 0, binding = 5, scalar) readonly buffer dnrt_tiles
{
    // [group][DNRT_TILE_BITS + words]: the tile; the distance of pixels that share a lookup, m, as
    // bits of a float; a bit for each object.
    uint tile_table[];
};
layout(set = 0, binding = 6) uniform sampler3D volumes;
layout(set = 0, binding = 7, rgba16f) uniform image2D irradiance;

#ifdef DNRT_MAPS
#include "techniques/dnrt/dnrt_intrusion.glsl"
#endif

bool is_own(dnrt_gpu_object object, uint instance)
{
    return instance - object.first_instance < object.instance_count;
}

struct pixel_quad {
    bvec4 counts; // has a surface, in the image
    vec3 position[4], normal[4];
    uint instance[4];
    vec3 change[4];
};

const ivec2 CORNER[4] = ivec2[4](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(1, 1));

vec2 pixel_uv;     // of the image
vec3 volume_texel; // of `volumes`

// The corner that the four have in common: a gather returns them in another order than CORNER.
vec2 middle_of(ivec2 first)
{
    return (vec2(first) + 1.0) * pixel_uv;
}

vec4 depths_at(ivec2 first)
{
    return textureGather(depth, middle_of(first)).wzxy;
}

void read_quad(ivec2 first, vec4 z, out pixel_quad q)
{
    vec2 middle = middle_of(first);
    vec4 x = textureGather(normal, middle, 0).wzxy, y = textureGather(normal, middle, 1).wzxy;
#ifdef DNRT_ID
    uvec4 instance = textureGather(id, middle, 0).wzxy - 1u;
#else
    uvec4 instance = uvec4(~0u);
#endif
    [[unroll]] for (int i = 0; i < 4; i++)
    {
        vec2 uv = (vec2(first + ivec2(CORNER[i])) + 0.5) * pixel_uv;
        q.counts[i] = z[i] > 0.0;
        q.position[i] =
            frame_ray_origin(uv) + frame_view_distance(max(z[i], 1e-12)) * frame_view_ray(uv);
        q.normal[i] = octahedral_decode(vec2(x[i], y[i]));
        q.instance[i] = instance[i];
        q.change[i] = vec3(0.0);
    }
}

// To the pixels `of` the quad: their lookups are at one position.
void add_object(uint index, vec3 position, bvec4 of, inout pixel_quad q)
{
    dnrt_gpu_object object = object_table[index];
    vec3 to_centre = object.centre - position;
    dnrt_receiver at = dnrt_receiver(dnrt_object_from_world(object, -to_centre), vec3(0.0));
    dnrt_place place = dnrt_place_of(object, at, push.size, push.fade);
    vec3 texel = vec3(dnrt_slot(object)) + 0.5 + place.at;
    vec3 change[NORMALS];
    [[unroll]] for (uint k = 0; k < NORMALS; k++)
    {
        vec3 slot = vec3(float(k * push.size), 0.0, 0.0);
        change[k] = textureLod(volumes, (texel + slot) * volume_texel, 0.0).rgb;
        change[k] = place.reach == 0.0 ? vec3(0.0) : place.reach * change[k];
    }
    to_centre *= inversesqrt(max(dot(to_centre, to_centre), 1e-24));
    vec3 added[4];
    [[unroll]] for (int i = 0; i < 4; i++)
    {
        float cosine = max(dot(to_centre, q.normal[i]), 0.0);
        vec3 above = vec3(0.0);
        if (NORMALS > 1u) {
            at.normal = dnrt_object_from_world(object, q.normal[i]);
            above = dnrt_above_horizon(object, at, object.half_m / push.reach);
        }
        added[i] = vec3(0.0);
        [[unroll]] for (uint k = 0; k < NORMALS; k++) added[i] +=
            (NORMALS == 1u ? cosine : dnrt_weight(at, above, k)) * change[k];
        if (!of[i] || place.reach == 0.0 || is_own(object, q.instance[i])) added[i] = vec3(0.0);
#ifndef DNRT_MAPS
        q.change[i] += added[i];
#endif
    }
#ifdef DNRT_MAPS
    [[dont_unroll]] for (int i = 0; i < 4; i++) if (added[i] != vec3(0.0)) q.change[i] +=
        visibility_of(index, object, q.position[i], q.normal[i]) * added[i];
#endif
}

float square(vec3 v)
{
    return dot(v, v);
}

// Pixels on one surface share a lookup, of which there is one more where a quad has an edge.
void add_objects(uint group, float share_m, inout pixel_quad q)
{
    bvec4 left = q.counts;
    do {
        int chosen = 3;
        vec3 first = q.position[3], sum = vec3(0.0);
        [[unroll]] for (int i = 2; i >= 0; i--) if (left[i])
        {
            chosen = i;
            first = q.position[i];
        }
        bvec4 near;
        float count = 0.0;
        [[unroll]] for (int i = 0; i < 4; i++)
        {
            near[i] =
                left[i] && (i == chosen || square(first - q.position[i]) <= share_m * share_m);
            sum += near[i] ? q.position[i] : vec3(0.0);
            count += near[i] ? 1.0 : 0.0;
            left[i] = left[i] && i != chosen && !near[i];
        }
        vec3 position = sum / max(count, 1.0);
        uint w = 0u, bits = tile_table[group + DNRT_TILE_BITS];
        do { // software drivers copy all that a loop changes: one loop, of objects and words
            uint index = 32u * w + uint(max(findLSB(bits), 0));
            bvec4 now = near;
            if (bits == 0u) now = bvec4(false);
            add_object(index, position, now, q);
            bits &= bits - 1u;
            if (bits == 0u && ++w < push.words) bits = tile_table[group + DNRT_TILE_BITS + w];
        } while (w < push.words);
    } while (any(left));
}

void write_quad(ivec2 first, pixel_quad q)
{
    ivec2 size = ivec2(frame.width, frame.height);
    [[unroll]] for (int i = 0; i < 4; i++)
    {
        ivec2 pixel = first + CORNER[i];
        if (!q.counts[i] || q.change[i] == vec3(0.0) || any(greaterThanEqual(pixel, size)))
            continue;
        vec4 before = imageLoad(irradiance, pixel);
        vec3 after = clamp(before.rgb + q.change[i], vec3(0.0), vec3(HALF_MAX));
        imageStore(irradiance, pixel, vec4(after, before.a));
    }
}

// Moves to the next quad with a surface.
vec4 next_quad(inout ivec2 first, int end)
{
    vec4 z = vec4(0.0);
    [[dont_unroll]] for (; first.y < end; first.y += 2)
    {
        z = depths_at(first);
        if (any(greaterThan(z, vec4(0.0)))) break;
    }
    return z;
}

void main()
{
    frame = frame_block;
    pixel_uv = 1.0 / vec2(frame.width, frame.height);
    volume_texel = 1.0 / vec3(textureSize(volumes, 0));
    uint group = (push.first_tile + gl_WorkGroupID.x) * (DNRT_TILE_BITS + push.words);
    uint tile = tile_table[group];
    float share_m = uintBitsToFloat(tile_table[group + 1u]);
    ivec2 first = ivec2(DNRT_TILE * uvec2(tile % push.tiles_x, tile / push.tiles_x) +
                        uvec2(2, 2 * ROWS) * gl_LocalInvocationID.xy);
    int end = first.x < int(frame.width) ? min(first.y + 2 * ROWS, int(frame.height)) : 0;
    vec4 z = next_quad(first, end);
    do {
        pixel_quad q;
        read_quad(first, first.y < end ? z : vec4(0.0), q);
        add_objects(group, share_m, q);
        write_quad(first, q);
        first.y += 2;
        z = next_quad(first, end);
    } while (first.y < end);
}
