// Formats: Vulkan formats, sizes, and conversion of texels to floats.
#include "gpu/vk.h"

#include <math.h>
#include <string.h>

static const struct format formats[GPU_IMPORT_FORMAT_COUNT] = {
    [GPU_FORMAT_NONE] = { VK_FORMAT_UNDEFINED, 0, 0, "none" },
    [GPU_R8] = { VK_FORMAT_R8_UNORM, 1, 1, "r8" },
    [GPU_RG8] = { VK_FORMAT_R8G8_UNORM, 2, 2, "rg8" },
    [GPU_RGBA8] = { VK_FORMAT_R8G8B8A8_UNORM, 4, 4, "rgba8" },
    [GPU_RGBA8_SRGB] = { VK_FORMAT_R8G8B8A8_SRGB, 4, 4, "rgba8_srgb" },
    [GPU_RG16_SNORM] = { VK_FORMAT_R16G16_SNORM, 4, 2, "rg16_snorm" },
    [GPU_RGBA8_SNORM] = { VK_FORMAT_R8G8B8A8_SNORM, 4, 4, "rgba8_snorm" },
    [GPU_R16F] = { VK_FORMAT_R16_SFLOAT, 2, 1, "r16f" },
    [GPU_RG16F] = { VK_FORMAT_R16G16_SFLOAT, 4, 2, "rg16f" },
    [GPU_RGBA16F] = { VK_FORMAT_R16G16B16A16_SFLOAT, 8, 4, "rgba16f" },
    [GPU_R32F] = { VK_FORMAT_R32_SFLOAT, 4, 1, "r32f" },
    [GPU_RG32F] = { VK_FORMAT_R32G32_SFLOAT, 8, 2, "rg32f" },
    [GPU_RGBA32F] = { VK_FORMAT_R32G32B32A32_SFLOAT, 16, 4, "rgba32f" },
    [GPU_R32U] = { VK_FORMAT_R32_UINT, 4, 1, "r32u" },
    [GPU_RG32U] = { VK_FORMAT_R32G32_UINT, 8, 2, "rg32u" },
    [GPU_RGBA32U] = { VK_FORMAT_R32G32B32A32_UINT, 16, 4, "rgba32u" },
    [GPU_B10G11R11F] = { VK_FORMAT_B10G11R11_UFLOAT_PACK32, 4, 3, "b10g11r11f" },
    [GPU_D32F] = { VK_FORMAT_D32_SFLOAT, 4, 1, "d32f" },
    [GPU_RG16] = { VK_FORMAT_R16G16_UNORM, 4, 2, "rg16" },
    [GPU_RGBA16] = { VK_FORMAT_R16G16B16A16_UNORM, 8, 4, "rgba16" },
    [GPU_RGBA16_SNORM] = { VK_FORMAT_R16G16B16A16_SNORM, 8, 4, "rgba16_snorm" },
    [GPU_A2B10G10R10] = { VK_FORMAT_A2B10G10R10_UNORM_PACK32, 4, 4, "a2b10g10r10" },
    [GPU_BGRA8] = { VK_FORMAT_B8G8R8A8_UNORM, 4, 4, "bgra8" },
    [GPU_BGRA8_SRGB] = { VK_FORMAT_B8G8R8A8_SRGB, 4, 4, "bgra8_srgb" },
    [GPU_D16] = { VK_FORMAT_D16_UNORM, 2, 1, "d16" },
    [GPU_D24] = { VK_FORMAT_X8_D24_UNORM_PACK32, 4, 1, "d24" },
    [GPU_D24_S8] = { VK_FORMAT_D24_UNORM_S8_UINT, 4, 1, "d24_s8" },
    [GPU_D32F_S8] = { VK_FORMAT_D32_SFLOAT_S8_UINT, 5, 1, "d32f_s8" },
};

const struct format *format_of(enum gpu_format format)
{
    return &formats[(unsigned)format < GPU_IMPORT_FORMAT_COUNT ? format : GPU_FORMAT_NONE];
}

int gpu_format_bytes(enum gpu_format format)
{
    return format_of(format)->bytes;
}

int gpu_format_channels(enum gpu_format format)
{
    return format_of(format)->channels;
}

const char *gpu_format_name(enum gpu_format format)
{
    return format_of(format)->name;
}

enum gpu_format gpu_format_of_vk(uint32_t vk_format)
{
    for (int f = GPU_FORMAT_NONE + 1; f < GPU_IMPORT_FORMAT_COUNT; f++)
        if ((uint32_t)formats[f].vk == vk_format) return (enum gpu_format)f;
    return GPU_FORMAT_NONE;
}

VkImageAspectFlags format_aspects(enum gpu_format format)
{
    const bool stencil = format == GPU_D24_S8 || format == GPU_D32F_S8;
    const bool depth = stencil || format == GPU_D32F || format == GPU_D16 || format == GPU_D24;
    return (depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT) |
           (stencil ? VK_IMAGE_ASPECT_STENCIL_BIT : 0u);
}

// An unsigned float with `exponent` bits, biased by 2^(exponent−1)−1, and `mantissa` bits, with
// IEEE 754 rules.
static float small_float(uint32_t bits, int exponent_bits, int mantissa_bits)
{
    int bias = (1 << (exponent_bits - 1)) - 1;
    int exponent = (int)(bits >> mantissa_bits) & ((1 << exponent_bits) - 1);
    float mantissa = (float)(bits & ((1u << mantissa_bits) - 1));
    if (exponent == (1 << exponent_bits) - 1) return mantissa != 0 ? NAN : INFINITY;
    if (exponent == 0) return ldexpf(mantissa, 1 - bias - mantissa_bits);
    return ldexpf(mantissa + (float)(1u << mantissa_bits), exponent - bias - mantissa_bits);
}

static float half_to_float(uint16_t bits)
{
    float magnitude = small_float(bits & 0x7fffu, 5, 10);
    return bits & 0x8000u ? -magnitude : magnitude;
}

// IEC 61966-2-1.
static float srgb_to_linear(float v)
{
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

static float channel_to_float(enum gpu_format format, const uint8_t *texel, int c)
{
    uint16_t half;
    int16_t snorm;
    uint32_t word;
    float value;
    switch (format) {
    case GPU_R8:
    case GPU_RG8:
    case GPU_RGBA8:
        return (float)texel[c] / 255.0f;
    case GPU_RGBA8_SRGB:
        return c < 3 ? srgb_to_linear((float)texel[c] / 255.0f) : (float)texel[c] / 255.0f;
    case GPU_RGBA8_SNORM:
        return fmaxf((float)(int8_t)texel[c] / 127.0f, -1.0f);
    case GPU_RG16_SNORM:
        memcpy(&snorm, texel + 2 * c, sizeof snorm);
        return fmaxf((float)snorm / 32767.0f, -1.0f);
    case GPU_R16F:
    case GPU_RG16F:
    case GPU_RGBA16F:
        memcpy(&half, texel + 2 * c, sizeof half);
        return half_to_float(half);
    case GPU_R32U:
    case GPU_RG32U:
    case GPU_RGBA32U:
        memcpy(&word, texel + 4 * c, sizeof word);
        return (float)word;
    case GPU_B10G11R11F:
        memcpy(&word, texel, sizeof word);
        if (c == 2) return small_float(word >> 22, 5, 5);
        return small_float(c ? word >> 11 & 0x7ffu : word & 0x7ffu, 5, 6);
    default:
        memcpy(&value, texel + 4 * c, sizeof value);
        return value;
    }
}

void format_to_float(enum gpu_format format, const void *texel, float out[4])
{
    int channels = format_of(format)->channels;
    for (int c = 0; c < 4; c++) {
        out[c] = c < channels ? channel_to_float(format, texel, c) : c == 3 ? 1.0f : 0.0f;
    }
}

VkClearColorValue format_clear(enum gpu_format format, const float value[4])
{
    VkClearColorValue clear;
    bool integer = format == GPU_R32U || format == GPU_RG32U || format == GPU_RGBA32U;
    for (int c = 0; c < 4; c++) {
        if (integer) {
            bool fits = value[c] > 0 && value[c] < 4294967296.0f;
            clear.uint32[c] = fits ? (uint32_t)value[c] : value[c] > 0 ? UINT32_MAX : 0;
        } else {
            clear.float32[c] = value[c];
        }
    }
    return clear;
}
