#include "techniques/lpv/rsm_fixture.h"

#include "frame/octahedral.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A multiple of 1/1024 in −1…1 is a half float exactly.
static float grid_value(float x)
{
    return roundf(x * 1024.0f) / 1024.0f;
}

static uint16_t half_of(float x)
{
    if (x == 0.0f) return 0;
    int exponent;
    const float fraction = frexpf(fabsf(x), &exponent); // 0.5 … 1
    const int mantissa = (int)(fraction * 2048.0f) - 1024;
    return (uint16_t)((x < 0.0f ? 0x8000 : 0) | ((exponent + 14) << 10) | mantissa);
}

static vec2s rounded_octahedral(vec3s normal)
{
    const vec2s e = octahedral_encode(normal);
    return (vec2s){ { grid_value(e.x), grid_value(e.y) } };
}

vec3s rsm_fixture_rounded_normal(vec3s normal)
{
    return octahedral_decode(rounded_octahedral(normal));
}

static gpu_image image(struct gpu *gpu, const char *name, enum gpu_dimension dimension,
                       enum gpu_format format, uint32_t width, uint32_t height, uint32_t layers)
{
    gpu_image out = { 0 };
    const uint32_t usage = format == GPU_D32F    ? GPU_SAMPLED | GPU_ATTACHMENT
                           : dimension == GPU_2D ? GPU_SAMPLED | GPU_STORAGE
                                                 : GPU_SAMPLED;
    CHECK(gpu_image_create(gpu,
                           &(struct gpu_image_desc){ .name = name,
                                                     .dimension = dimension,
                                                     .format = format,
                                                     .width = width,
                                                     .height = height,
                                                     .depth = layers,
                                                     .usage = usage },
                           &out));
    return out;
}

static gpu_buffer buffer(struct gpu *gpu, const char *name, size_t bytes, uint32_t usage)
{
    gpu_buffer out = { 0 };
    CHECK(gpu_buffer_create(gpu, &(struct gpu_buffer_desc){ name, bytes, usage }, &out));
    return out;
}

void rsm_fixture_init(struct rsm_fixture *rsm, struct gpu *gpu, uint32_t width, uint32_t height,
                      uint32_t rsm_size, int face_count)
{
    *rsm = (struct rsm_fixture){ .gpu = gpu };
    rsm->depth = image(gpu, "rsm.depth", GPU_2D, GPU_D32F, width, height, 1);
    rsm->normal = image(gpu, "rsm.normal", GPU_2D, GPU_RG16F, width, height, 1);
    rsm->irradiance = image(gpu, "rsm.irradiance", GPU_2D, GPU_RGBA16F, width, height, 1);
    rsm->faces_buffer = buffer(gpu, "rsm.faces", sizeof rsm->faces, GPU_BUFFER_STORAGE);
    rsm->constants_buffer = buffer(gpu, "rsm.constants", sizeof rsm->constants, GPU_BUFFER_UNIFORM);
    const uint32_t layers = face_count > 0 ? (uint32_t)face_count : 1;
    rsm->rsm_depth =
        image(gpu, "rsm.rsm_depth", GPU_2D_ARRAY, GPU_D32F, rsm_size, rsm_size, layers);
    rsm->rsm_normal =
        image(gpu, "rsm.rsm_normal", GPU_2D_ARRAY, GPU_RG16F, rsm_size, rsm_size, layers);
    rsm->rsm_flux = image(gpu, "rsm.rsm_flux", GPU_2D_ARRAY, GPU_RGBA8, rsm_size, rsm_size, layers);
    rsm->texels = calloc((size_t)layers * rsm_size * rsm_size, sizeof *rsm->texels);
    struct frame_view *view = &rsm->view;
    view->width = rsm->constants.width = width;
    view->height = rsm->constants.height = height;
    rsm->constants.radiance_scale = 1.0f;
    view->constants = &rsm->constants;
    view->constants_binding =
        (struct gpu_binding){ .name = "frame_constants", .buffer = rsm->constants_buffer };
    view->ggx_albedo_binding = (struct gpu_binding){ .name = "ggx_albedo" }; // for no lobe
    view->layers[FRAME_DEPTH] = rsm->depth;
    view->layers[FRAME_NORMAL] = rsm->normal;
    view->layers[FRAME_IRRADIANCE] = rsm->irradiance;
    view->rsm_size = rsm_size;
    view->rsm_face_count = face_count;
    view->rsm_faces = rsm->faces;
    view->rsm_faces_binding =
        (struct gpu_binding){ .name = "rsm_faces", .buffer = rsm->faces_buffer };
    view->rsm_depth = rsm->rsm_depth;
    view->rsm_normal = rsm->rsm_normal;
    view->rsm_flux = rsm->rsm_flux;
}

void rsm_fixture_finish(struct rsm_fixture *rsm)
{
    gpu_image *images[] = { &rsm->depth,     &rsm->normal,     &rsm->irradiance,
                            &rsm->rsm_depth, &rsm->rsm_normal, &rsm->rsm_flux };
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        gpu_image_destroy(rsm->gpu, images[i]);
    gpu_buffer_destroy(rsm->gpu, &rsm->faces_buffer);
    gpu_buffer_destroy(rsm->gpu, &rsm->constants_buffer);
    gpu_buffer_destroy(rsm->gpu, &rsm->emitters_buffer);
    free(rsm->texels);
}

// Clip space −1…1 and depth to corner + [0,1] across + [0,1] down + depth · away.
static mat4s world_from_clip(vec3s corner, vec3s across, vec3s down, vec3s away)
{
    const vec3s x = glms_vec3_scale(across, 0.5f), y = glms_vec3_scale(down, 0.5f);
    return (mat4s){ .col = { vec4_of(x, 0), vec4_of(y, 0), vec4_of(away, 0),
                             vec4_of(glms_vec3_add(corner, glms_vec3_add(x, y)), 1) } };
}

void rsm_fixture_show_wall(struct rsm_fixture *rsm, vec3s corner, vec3s across, vec3s down,
                           vec3s normal)
{
    rsm->constants.world_from_clip = world_from_clip(corner, across, down, vec3_of(0, 0, 0));
    const size_t pixels = (size_t)rsm->view.width * rsm->view.height;
    float *depth = malloc(pixels * sizeof *depth);
    uint16_t *packed = malloc(pixels * 2 * sizeof *packed);
    const vec2s e = rounded_octahedral(normal);
    for (size_t i = 0; i < pixels; i++) {
        depth[i] = 0.5f;
        packed[2 * i] = half_of(e.x);
        packed[2 * i + 1] = half_of(e.y);
    }
    CHECK(gpu_image_upload(rsm->gpu, rsm->depth, 0, 0, depth, pixels * sizeof *depth));
    CHECK(gpu_image_upload(rsm->gpu, rsm->normal, 0, 0, packed, pixels * 2 * sizeof *packed));
    free(depth);
    free(packed);
}

void rsm_fixture_set_face(struct rsm_fixture *rsm, int face, vec3s corner, vec3s across, vec3s down,
                          vec3s away, vec3s lumen)
{
    rsm->faces[face] =
        (struct rsm_face){ .world_from_clip = world_from_clip(corner, across, down, away),
                           .intensity = lumen,
                           .type = FRAME_LIGHT_SUN };
}

struct rsm_fixture_texel *rsm_fixture_texel(struct rsm_fixture *rsm, int face, uint32_t x,
                                            uint32_t y)
{
    const uint32_t size = rsm->view.rsm_size;
    return &rsm->texels[((size_t)face * size + y) * size + x];
}

void rsm_fixture_fill_face(struct rsm_fixture *rsm, int face, struct rsm_fixture_texel texel)
{
    const uint32_t size = rsm->view.rsm_size;
    for (uint32_t i = 0; i < size * size; i++)
        *rsm_fixture_texel(rsm, face, i % size, i / size) = texel;
}

vec3s rsm_fixture_texel_position(const struct rsm_fixture *rsm, int face, uint32_t x, uint32_t y)
{
    const float size = (float)rsm->view.rsm_size;
    const float depth =
        rsm->texels[((size_t)face * rsm->view.rsm_size + y) * rsm->view.rsm_size + x].depth;
    return mat4_point(rsm->faces[face].world_from_clip,
                      vec3_of(((float)x + 0.5f) * 2.0f / size - 1.0f,
                              ((float)y + 0.5f) * 2.0f / size - 1.0f, depth));
}

vec3s rsm_fixture_texel_flux(const struct rsm_fixture *rsm, int face, uint32_t x, uint32_t y)
{
    const struct rsm_fixture_texel *texel =
        &rsm->texels[((size_t)face * rsm->view.rsm_size + y) * rsm->view.rsm_size + x];
    const vec3s lumen = rsm->faces[face].intensity;
    if (texel->depth == 0.0f) return vec3_of(0, 0, 0);
    return vec3_of(lumen.x * (float)texel->reflectance[0] / 255.0f,
                   lumen.y * (float)texel->reflectance[1] / 255.0f,
                   lumen.z * (float)texel->reflectance[2] / 255.0f);
}

void rsm_fixture_set_emitters(struct rsm_fixture *rsm, const struct frame_emitter *emitters,
                              int count)
{
    const size_t bytes = (size_t)count * sizeof *emitters;
    gpu_buffer_destroy(rsm->gpu, &rsm->emitters_buffer);
    rsm->view.emitters = emitters;
    rsm->view.emitter_count = count;
    if (count == 0) return;
    rsm->emitters_buffer = buffer(rsm->gpu, "rsm.emitters", bytes, GPU_BUFFER_STORAGE);
    rsm->view.emitters_binding =
        (struct gpu_binding){ .name = "frame_emitters", .buffer = rsm->emitters_buffer };
    CHECK(gpu_buffer_upload(rsm->gpu, rsm->emitters_buffer, 0, emitters, bytes));
}

void rsm_fixture_upload(struct rsm_fixture *rsm)
{
    const size_t count = (size_t)rsm->view.rsm_size * rsm->view.rsm_size;
    float *depth = malloc(count * sizeof *depth);
    uint16_t *normal = malloc(count * 2 * sizeof *normal);
    uint8_t *flux = malloc(count * 4);
    for (int face = 0; face < rsm->view.rsm_face_count; face++) {
        for (size_t i = 0; i < count; i++) {
            const struct rsm_fixture_texel *texel = &rsm->texels[(size_t)face * count + i];
            const vec2s e =
                texel->depth > 0.0f ? rounded_octahedral(texel->normal) : (vec2s){ { 0, 0 } };
            depth[i] = texel->depth;
            normal[2 * i] = half_of(e.x);
            normal[2 * i + 1] = half_of(e.y);
            memcpy(flux + 4 * i, texel->reflectance, 3);
            flux[4 * i + 3] = 255;
        }
        const uint32_t layer = (uint32_t)face;
        CHECK(gpu_image_upload(rsm->gpu, rsm->rsm_depth, 0, layer, depth, count * sizeof *depth));
        CHECK(gpu_image_upload(rsm->gpu, rsm->rsm_normal, 0, layer, normal,
                               count * 2 * sizeof *normal));
        CHECK(gpu_image_upload(rsm->gpu, rsm->rsm_flux, 0, layer, flux, count * 4));
    }
    free(depth);
    free(normal);
    free(flux);
    CHECK(gpu_buffer_upload(rsm->gpu, rsm->faces_buffer, 0, rsm->faces, sizeof rsm->faces));
    CHECK(gpu_buffer_upload(rsm->gpu, rsm->constants_buffer, 0, &rsm->constants,
                            sizeof rsm->constants));
}

void rsm_fixture_read_irradiance(struct rsm_fixture *rsm, float *rgb)
{
    const size_t floats = (size_t)rsm->view.width * rsm->view.height * 3;
    CHECK(gpu_image_download_float(rsm->gpu, rsm->irradiance, 0, 0, rgb, 3, floats));
}
