// Reflection of every shader of the library equals that of SPIRV-Cross, and damaged modules are
// read within their bounds.
#include "framework/test.h"
#include "gpu/cross_reflection.h"

#include "core/files/file.h"
#include "gpu/pipelines/spirv.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const paths[] = {
#include "reflected_shaders.inc"
};
enum { PATHS = sizeof paths / sizeof *paths };

static struct gpu gpu_of(struct host *host)
{
    struct gpu gpu = { .host = host, .max_push_descriptors = MAX_BINDINGS };
    gpu.limits.max_push_bytes = 128;
    return gpu;
}

static VkShaderStageFlagBits stage_of(const char *path)
{
    if (strstr(path, ".vert.spv")) return VK_SHADER_STAGE_VERTEX_BIT;
    if (strstr(path, ".frag.spv")) return VK_SHADER_STAGE_FRAGMENT_BIT;
    return VK_SHADER_STAGE_COMPUTE_BIT;
}

static int by_number(const void *a, const void *b)
{
    const struct shader_binding *x = a, *y = b;
    return (x->binding > y->binding) - (x->binding < y->binding);
}

static void check_equal(const char *path, struct reflection *got, struct reflection *want)
{
    qsort(got->bindings, (size_t)got->binding_count, sizeof *got->bindings, by_number);
    qsort(want->bindings, (size_t)want->binding_count, sizeof *want->bindings, by_number);
    if (got->binding_count != want->binding_count)
        fail_msg("%s: %d bindings, not %d", path, got->binding_count, want->binding_count);
    for (int i = 0; i < got->binding_count; i++) {
        const struct shader_binding *a = &got->bindings[i], *b = &want->bindings[i];
        if (strcmp(a->name, b->name) != 0 || a->binding != b->binding || a->type != b->type ||
            a->view != b->view || a->shader_stages != b->shader_stages || a->stages != b->stages ||
            a->writes != b->writes)
            fail_msg("%s: binding %u, %s, is not %u, %s", path, a->binding, a->name, b->binding,
                     b->name);
    }
    if (got->push_bytes != want->push_bytes || got->push_stages != want->push_stages)
        fail_msg("%s: %u bytes of push constants, not %u", path, got->push_bytes, want->push_bytes);
    if (got->constant_count != want->constant_count ||
        memcmp(got->constant_ids, want->constant_ids, sizeof got->constant_ids) != 0)
        fail_msg("%s: %d specialization constants, not %d", path, got->constant_count,
                 want->constant_count);
}

static struct file_bytes read_words(struct host *host, const char *path)
{
    struct file_bytes bytes;
    assert_true(file_read(host, path, 0, &bytes));
    return bytes;
}

TEST(all_shaders_are_reflected_as_by_spirv_cross)
{
    struct host host = host_default();
    struct gpu gpu = gpu_of(&host);
    int bindings = 0, constants = 0, pushes = 0;
    for (int i = 0; i < PATHS; i++) {
        struct file_bytes bytes = read_words(&host, paths[i]);
        struct reflection got = { 0 }, want = { 0 };
        const uint32_t *words = (const uint32_t *)(const void *)bytes.data;
        const VkShaderStageFlagBits stage = stage_of(paths[i]);
        const bool ok = reflect_stage(&gpu, words, bytes.size / 4, paths[i], stage, &got);
        const bool wanted =
            cross_reflect_stage(&gpu, words, bytes.size / 4, paths[i], stage, &want);
        if (ok != wanted) fail_msg("%s: %s", paths[i], ok ? "was not refused" : "was refused");
        if (ok) check_equal(paths[i], &got, &want);
        if (!ok && !strstr(paths[i], "/test_")) fail_msg("%s: was refused", paths[i]);
        bindings += got.binding_count;
        constants += got.constant_count;
        pushes += got.push_bytes > 0;
        file_bytes_finish(&host, &bytes);
    }
    print_message("%d shaders, %d bindings, %d constants, %d with push constants\n", PATHS,
                  bindings, constants, pushes);
    assert_true(bindings > PATHS && constants > 0 && pushes > 0);
}

// Whether a type or a part of it has offsets or strides.
static bool has_layout(const struct spirv *module, uint32_t type)
{
    uint32_t stride;
    const size_t at = spirv_find(module, type);
    switch (spirv_op_at(module, at)) {
    case SPIRV_TYPE_ARRAY:
        return spirv_decoration(module, type, SPIRV_WHOLE, SPIRV_ARRAY_STRIDE, &stride) ||
               has_layout(module, spirv_operand(module, at, 2));
    case SPIRV_TYPE_STRUCT:
        for (uint32_t i = 2; i < module->words[at] >> 16; i++)
            if (spirv_decoration(module, type, (int)i - 2, SPIRV_OFFSET, NULL) ||
                has_layout(module, spirv_operand(module, at, i)))
                return true;
        return false;
    default:
        return false;
    }
}

// The first variable outside of buffers whose type has the layout of a buffer, NULL without one:
// SPIR-V for Vulkan forbids it, and glslang writes it where a shader copies a struct with an array
// from a buffer into a variable.
static const char *laid_out_variable(const struct spirv *module)
{
    enum { WORKGROUP = 4, PRIVATE = 6, FUNCTION = 7 };
    for (size_t at = module->types; at < module->count; at = spirv_next(module, at)) {
        if (spirv_op_at(module, at) != SPIRV_VARIABLE) continue;
        const uint32_t class = spirv_operand(module, at, 3);
        if (class != WORKGROUP && class != PRIVATE && class != FUNCTION) continue;
        const size_t pointer = spirv_find(module, spirv_operand(module, at, 1));
        if (has_layout(module, spirv_operand(module, pointer, 3)))
            return spirv_name(module, spirv_operand(module, at, 2));
    }
    return NULL;
}

TEST(variables_outside_of_buffers_have_no_layout_of_one)
{
    struct host host = host_default();
    int wrong = 0;
    for (int i = 0; i < PATHS; i++) {
        struct file_bytes bytes = read_words(&host, paths[i]);
        struct spirv module;
        assert_null(
            spirv_open(&module, &host, (const uint32_t *)(const void *)bytes.data, bytes.size / 4));
        const char *name = laid_out_variable(&module);
        if (name) print_message("%s: variable %s\n", paths[i], name);
        wrong += name != NULL;
        spirv_close(&module);
        file_bytes_finish(&host, &bytes);
    }
    CHECK(wrong == 0);
}

// The address sanitizer sees reads beyond the words.
TEST(changed_words_are_read_within_bounds)
{
    struct host host = { .log_up_to = LOG_ERROR };
    struct gpu gpu = gpu_of(&host);
    uint32_t random = 1;
    for (int i = 0; i < PATHS; i += 16) {
        struct file_bytes bytes = read_words(&host, paths[i]);
        const size_t count = bytes.size / 4;
        uint32_t *words = malloc(bytes.size);
        for (int k = 0; k < 200; k++) {
            struct reflection out = { 0 };
            memcpy(words, bytes.data, bytes.size);
            for (int change = 0; change < 1 + k % 4; change++) {
                random = random * 1664525u + 1013904223u;
                const size_t at = random % count;
                random = random * 1664525u + 1013904223u;
                words[at] = k % 2 ? random : words[at] ^ (1u << (random >> 27));
            }
            (void)reflect_stage(&gpu, words, count, "changed", stage_of(paths[i]), &out);
        }
        free(words);
        file_bytes_finish(&host, &bytes);
    }
}
