// reflect_stage of gpu/vk.h, by SPIRV-Cross.
#pragma once

#include "gpu/vk.h"

bool cross_reflect_stage(struct gpu *gpu, const uint32_t *words, size_t word_count,
                         const char *what, VkShaderStageFlagBits stage, struct reflection *out);
