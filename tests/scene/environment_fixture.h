// Environment maps made by functions of the direction, and quadrature over the sphere.
#pragma once

#include "framework/test.h"

#include "scene/environment.h"
#include "scene/environment/environment_map.h"

#include <math.h>
#include <string.h>

typedef vec3s (*fixture_radiance)(vec3s direction);

// Direction and solid angle of point i of a grid of midpoints, width × width/2, by trigonometry
// alone. Rows begin at +y, columns at +z.
static inline vec3s sphere_point(int width, int i, double *sr)
{
    static const double pi = 3.14159265358979323846;
    const double polar = 2.0 * pi * (i / width + 0.5) / width;
    const double azimuth = 2.0 * pi * (i % width + 0.5) / width - pi;
    const double half = pi / width;
    *sr = 2.0 * half * (cos(polar - half) - cos(polar + half));
    return vec3_of((float)(sin(polar) * sin(azimuth)), (float)cos(polar),
                   (float)(-sin(polar) * cos(azimuth)));
}

// width × width/2 texels.
static inline struct environment_map *fixture_map(int width, fixture_radiance radiance)
{
    struct image image;
    double sr;
    CHECK(image_init(&image, test_host(), width, width / 2, 3));
    for (int i = 0; i < width * (width / 2); i++) {
        const vec3s value = radiance(sphere_point(width, i, &sr));
        memcpy(image.pixels + 3 * (size_t)i, value.raw, sizeof value.raw);
    }
    struct environment_map *map = environment_map_create(test_host(), "test", &image);
    image_finish(&image, test_host());
    assert_non_null(map);
    return map;
}

// Irradiance of a surface that sees its hemisphere, by quadrature.
static inline vec3s fixture_irradiance(const struct environment *environment, vec3s normal,
                                       int width)
{
    double sum[3] = { 0 }, sr;
    for (int i = 0; i < width * (width / 2); i++) {
        const vec3s d = sphere_point(width, i, &sr);
        const double cosine = (double)glms_vec3_dot(d, normal);
        if (cosine <= 0.0) continue;
        const vec3s radiance = environment_radiance(environment, d);
        for (int c = 0; c < 3; c++) sum[c] += sr * cosine * (double)radiance.raw[c];
    }
    return vec3_of((float)sum[0], (float)sum[1], (float)sum[2]);
}
