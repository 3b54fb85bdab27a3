#include "techniques/stage.h"

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

vec3s stage_rounded_normal(vec3s normal)
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

void stage_init(struct stage *stage, struct gpu *gpu, uint32_t width, uint32_t height,
                uint32_t rsm_size, int face_count)
{
    *stage = (struct stage){ .gpu = gpu };
    stage->depth = image(gpu, "stage.depth", GPU_2D, GPU_D32F, width, height, 1);
    stage->normal = image(gpu, "stage.normal", GPU_2D, GPU_RG16F, width, height, 1);
    stage->irradiance = image(gpu, "stage.irradiance", GPU_2D, GPU_RGBA16F, width, height, 1);
    stage->faces_buffer = buffer(gpu, "stage.faces", sizeof stage->faces, GPU_BUFFER_STORAGE);
    stage->constants_buffer =
        buffer(gpu, "stage.constants", sizeof stage->constants, GPU_BUFFER_UNIFORM);
    const uint32_t layers = face_count > 0 ? (uint32_t)face_count : 1;
    stage->rsm_depth =
        image(gpu, "stage.rsm_depth", GPU_2D_ARRAY, GPU_D32F, rsm_size, rsm_size, layers);
    stage->rsm_normal =
        image(gpu, "stage.rsm_normal", GPU_2D_ARRAY, GPU_RG16F, rsm_size, rsm_size, layers);
    stage->rsm_flux =
        image(gpu, "stage.rsm_flux", GPU_2D_ARRAY, GPU_RGBA8, rsm_size, rsm_size, layers);
    stage->texels = calloc((size_t)layers * rsm_size * rsm_size, sizeof *stage->texels);
    struct frame_view *view = &stage->view;
    view->width = stage->constants.width = width;
    view->height = stage->constants.height = height;
    stage->constants.radiance_scale = 1.0f;
    view->constants = &stage->constants;
    view->constants_binding =
        (struct gpu_binding){ .name = "frame_constants", .buffer = stage->constants_buffer };
    view->layers[FRAME_DEPTH] = stage->depth;
    view->layers[FRAME_NORMAL] = stage->normal;
    view->layers[FRAME_IRRADIANCE] = stage->irradiance;
    view->rsm_size = rsm_size;
    view->rsm_face_count = face_count;
    view->rsm_faces = stage->faces;
    view->rsm_faces_binding =
        (struct gpu_binding){ .name = "rsm_faces", .buffer = stage->faces_buffer };
    view->rsm_depth = stage->rsm_depth;
    view->rsm_normal = stage->rsm_normal;
    view->rsm_flux = stage->rsm_flux;
}

void stage_finish(struct stage *stage)
{
    gpu_image *images[] = { &stage->depth,     &stage->normal,     &stage->irradiance,
                            &stage->rsm_depth, &stage->rsm_normal, &stage->rsm_flux };
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        gpu_image_destroy(stage->gpu, images[i]);
    gpu_buffer_destroy(stage->gpu, &stage->faces_buffer);
    gpu_buffer_destroy(stage->gpu, &stage->constants_buffer);
    gpu_buffer_destroy(stage->gpu, &stage->emitters_buffer);
    free(stage->texels);
}

// Clip space −1…1 and depth to corner + [0,1] across + [0,1] down + depth · away.
static mat4s world_from_clip(vec3s corner, vec3s across, vec3s down, vec3s away)
{
    const vec3s x = glms_vec3_scale(across, 0.5f), y = glms_vec3_scale(down, 0.5f);
    return (mat4s){ .col = { vec4_of(x, 0), vec4_of(y, 0), vec4_of(away, 0),
                             vec4_of(glms_vec3_add(corner, glms_vec3_add(x, y)), 1) } };
}

void stage_show_wall(struct stage *stage, vec3s corner, vec3s across, vec3s down, vec3s normal)
{
    stage->constants.world_from_clip = world_from_clip(corner, across, down, vec3_of(0, 0, 0));
    const size_t pixels = (size_t)stage->view.width * stage->view.height;
    float *depth = malloc(pixels * sizeof *depth);
    uint16_t *packed = malloc(pixels * 2 * sizeof *packed);
    const vec2s e = rounded_octahedral(normal);
    for (size_t i = 0; i < pixels; i++) {
        depth[i] = 0.5f;
        packed[2 * i] = half_of(e.x);
        packed[2 * i + 1] = half_of(e.y);
    }
    CHECK(gpu_image_upload(stage->gpu, stage->depth, 0, 0, depth, pixels * sizeof *depth));
    CHECK(gpu_image_upload(stage->gpu, stage->normal, 0, 0, packed, pixels * 2 * sizeof *packed));
    free(depth);
    free(packed);
}

void stage_set_face(struct stage *stage, int face, vec3s corner, vec3s across, vec3s down,
                    vec3s away, vec3s lumen)
{
    stage->faces[face] =
        (struct rsm_face){ .world_from_clip = world_from_clip(corner, across, down, away),
                           .intensity = lumen,
                           .type = FRAME_LIGHT_SUN };
}

struct stage_texel *stage_texel(struct stage *stage, int face, uint32_t x, uint32_t y)
{
    const uint32_t size = stage->view.rsm_size;
    return &stage->texels[((size_t)face * size + y) * size + x];
}

void stage_fill_face(struct stage *stage, int face, struct stage_texel texel)
{
    const uint32_t size = stage->view.rsm_size;
    for (uint32_t i = 0; i < size * size; i++)
        *stage_texel(stage, face, i % size, i / size) = texel;
}

vec3s stage_texel_position(const struct stage *stage, int face, uint32_t x, uint32_t y)
{
    const float size = (float)stage->view.rsm_size;
    const float depth =
        stage->texels[((size_t)face * stage->view.rsm_size + y) * stage->view.rsm_size + x].depth;
    return mat4_point(stage->faces[face].world_from_clip,
                      vec3_of(((float)x + 0.5f) * 2.0f / size - 1.0f,
                              ((float)y + 0.5f) * 2.0f / size - 1.0f, depth));
}

vec3s stage_texel_flux(const struct stage *stage, int face, uint32_t x, uint32_t y)
{
    const struct stage_texel *texel =
        &stage->texels[((size_t)face * stage->view.rsm_size + y) * stage->view.rsm_size + x];
    const vec3s lumen = stage->faces[face].intensity;
    if (texel->depth == 0.0f) return vec3_of(0, 0, 0);
    return vec3_of(lumen.x * (float)texel->reflectance[0] / 255.0f,
                   lumen.y * (float)texel->reflectance[1] / 255.0f,
                   lumen.z * (float)texel->reflectance[2] / 255.0f);
}

void stage_set_emitters(struct stage *stage, const struct frame_emitter *emitters, int count)
{
    const size_t bytes = (size_t)count * sizeof *emitters;
    gpu_buffer_destroy(stage->gpu, &stage->emitters_buffer);
    stage->view.emitters = emitters;
    stage->view.emitter_count = count;
    if (count == 0) return;
    stage->emitters_buffer = buffer(stage->gpu, "stage.emitters", bytes, GPU_BUFFER_STORAGE);
    stage->view.emitters_binding =
        (struct gpu_binding){ .name = "frame_emitters", .buffer = stage->emitters_buffer };
    CHECK(gpu_buffer_upload(stage->gpu, stage->emitters_buffer, 0, emitters, bytes));
}

void stage_upload(struct stage *stage)
{
    const size_t count = (size_t)stage->view.rsm_size * stage->view.rsm_size;
    float *depth = malloc(count * sizeof *depth);
    uint16_t *normal = malloc(count * 2 * sizeof *normal);
    uint8_t *flux = malloc(count * 4);
    for (int face = 0; face < stage->view.rsm_face_count; face++) {
        for (size_t i = 0; i < count; i++) {
            const struct stage_texel *texel = &stage->texels[(size_t)face * count + i];
            const vec2s e =
                texel->depth > 0.0f ? rounded_octahedral(texel->normal) : (vec2s){ { 0, 0 } };
            depth[i] = texel->depth;
            normal[2 * i] = half_of(e.x);
            normal[2 * i + 1] = half_of(e.y);
            memcpy(flux + 4 * i, texel->reflectance, 3);
            flux[4 * i + 3] = 255;
        }
        const uint32_t layer = (uint32_t)face;
        CHECK(
            gpu_image_upload(stage->gpu, stage->rsm_depth, 0, layer, depth, count * sizeof *depth));
        CHECK(gpu_image_upload(stage->gpu, stage->rsm_normal, 0, layer, normal,
                               count * 2 * sizeof *normal));
        CHECK(gpu_image_upload(stage->gpu, stage->rsm_flux, 0, layer, flux, count * 4));
    }
    free(depth);
    free(normal);
    free(flux);
    CHECK(gpu_buffer_upload(stage->gpu, stage->faces_buffer, 0, stage->faces, sizeof stage->faces));
    CHECK(gpu_buffer_upload(stage->gpu, stage->constants_buffer, 0, &stage->constants,
                            sizeof stage->constants));
}

void stage_read_irradiance(struct stage *stage, float *rgb)
{
    const size_t floats = (size_t)stage->view.width * stage->view.height * 3;
    CHECK(gpu_image_download_float(stage->gpu, stage->irradiance, 0, 0, rgb, 3, floats));
}
