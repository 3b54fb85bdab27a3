// Shader reflection: bindings (name, type, read or written), push constants, specialization
// constants. Only variables that the entry point uses are listed.
#include "gpu/pipelines/spirv.h"
#include "gpu/vk.h"

#include <stdio.h>
#include <string.h>

struct reader {
    struct gpu *gpu;
    const char *what;
    VkShaderStageFlagBits stage;
    struct spirv module;
    struct reflection *out;
};

// A variable of the entry point.
struct variable {
    uint32_t id, block; // block: its type behind the pointer and arrays
    bool is_array;
    VkDescriptorType type; // MAX_ENUM: not supported
};

static bool refuse(const struct reader *r, const char *name, const char *why)
{
    return host_fail(r->gpu->host, FAIL_FORMAT, "gpu shader %s: \"%s\" %s", r->what, name, why);
}

// Checks the instruction lengths, which spirv.c and drivers trust.
static bool check_words(struct gpu *gpu, const uint32_t *words, size_t count, const char *what)
{
    enum { HEADER = 5, MAGIC = 0x07230203, OP_ENTRY_POINT = 15, OP_FUNCTION_END = 56 };
    bool entry = false;
    uint32_t op = 0;
    size_t i = HEADER;
    if (count < HEADER || words[0] != MAGIC) {
        return host_fail(gpu->host, FAIL_FORMAT, "gpu shader %s: it is not SPIR-V", what);
    }
    if (words[1] > 0x00010600) {
        return host_fail(gpu->host, FAIL_UNSUPPORTED,
                         "gpu shader %s: SPIR-V %u.%u is newer than 1.6", what,
                         words[1] >> 16 & 0xff, words[1] >> 8 & 0xff);
    }
    while (i < count) {
        uint32_t length = words[i] >> 16;
        op = words[i] & 0xffff;
        entry |= op == OP_ENTRY_POINT;
        if (!length || length > count - i) break;
        i += length;
    }
    if (i == count && entry && op == OP_FUNCTION_END) return true;
    return host_fail(gpu->host, FAIL_FORMAT, "gpu shader %s: the SPIR-V is damaged or cut off",
                     what);
}

static VkPipelineStageFlags2 pipeline_stage(VkShaderStageFlagBits stage)
{
    switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
        return VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
        return VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    default:
        return VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    }
}

// Dimensions of images (specification, section 3.8).
enum { DIMENSION_2D = 1, DIMENSION_3D = 2, DIMENSION_CUBE = 3, DIMENSION_SUBPASS = 6 };
enum {
    IMAGE_DIMENSION = 3,
    IMAGE_ARRAYED = 5,
    IMAGE_MULTISAMPLED = 6,
    IMAGE_SAMPLED = 7
}; // operands
enum { SAMPLED_STORAGE = 2 };

// The image of an image or of a combined image and sampler.
static size_t find_image(const struct spirv *m, uint32_t type)
{
    const size_t at = spirv_find(m, type);
    if (spirv_op_at(m, at) == SPIRV_TYPE_SAMPLED_IMAGE)
        return spirv_find(m, spirv_operand(m, at, 2));
    return at;
}

static bool view_type(const struct spirv *m, uint32_t type, VkImageViewType *out)
{
    const size_t at = find_image(m, type);
    const bool arrayed = spirv_operand(m, at, IMAGE_ARRAYED) == 1;
    switch (spirv_operand(m, at, IMAGE_DIMENSION)) {
    case DIMENSION_2D:
        *out = arrayed ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
        break;
    case DIMENSION_CUBE:
        *out = arrayed ? VK_IMAGE_VIEW_TYPE_CUBE_ARRAY : VK_IMAGE_VIEW_TYPE_CUBE;
        break;
    case DIMENSION_3D:
        *out = VK_IMAGE_VIEW_TYPE_3D;
        break;
    default:
        return false;
    }
    return spirv_operand(m, at, IMAGE_MULTISAMPLED) == 0;
}

// glslang puts `readonly` on each member of a block and on the variable of an image.
static bool is_read_only(const struct spirv *m, const struct variable *variable, bool buffer)
{
    if (spirv_decoration(m, variable->id, SPIRV_WHOLE, SPIRV_NON_WRITABLE, NULL)) return true;
    const size_t block = spirv_find(m, variable->block);
    const int members = buffer && block ? (int)(spirv_next(m, block) - block) - 2 : 0;
    for (int i = 0; i < members; i++)
        if (!spirv_decoration(m, variable->block, i, SPIRV_NON_WRITABLE, NULL)) return false;
    return members > 0;
}

// Adds a binding, or merges it with that of the other stage.
static bool add_binding(const struct reader *r, const struct shader_binding *binding)
{
    struct reflection *out = r->out;
    for (int i = 0; i < out->binding_count; i++) {
        struct shader_binding *known = &out->bindings[i];
        if (known->binding != binding->binding) continue;
        if (strcmp(known->name, binding->name) != 0 || known->type != binding->type ||
            known->view != binding->view) {
            return refuse(r, binding->name, "shares its binding number with something else");
        }
        known->shader_stages |= binding->shader_stages;
        known->stages |= binding->stages;
        known->writes |= binding->writes;
        return true;
    }
    if (out->binding_count == MAX_BINDINGS ||
        (uint32_t)out->binding_count == r->gpu->max_push_descriptors) {
        return refuse(r, binding->name, "is one binding too many");
    }
    out->bindings[out->binding_count++] = *binding;
    return true;
}

static bool read_binding(const struct reader *r, const struct variable *variable)
{
    const struct spirv *m = &r->module;
    const VkDescriptorType type = variable->type;
    const bool buffer =
        type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const char *name = spirv_name(m, buffer ? variable->block : variable->id);
    uint32_t set;
    struct shader_binding binding = {
        .type = type,
        .shader_stages = r->stage,
        .stages = pipeline_stage(r->stage),
        .writes = (type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ||
                   type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) &&
                  !is_read_only(m, variable, buffer),
    };
    spirv_decoration(m, variable->id, SPIRV_WHOLE, SPIRV_BINDING, &binding.binding);
    spirv_decoration(m, variable->id, SPIRV_WHOLE, SPIRV_DESCRIPTOR_SET, &set);
    if (type == VK_DESCRIPTOR_TYPE_MAX_ENUM)
        return refuse(r, name, "is of a kind that is not supported (samplers are combined ones)");
    if (!name[0]) return refuse(r, "", "names were stripped from it; compile it without -O");
    if (strlen(name) >= sizeof binding.name) return refuse(r, name, "has too long a name");
    snprintf(binding.name, sizeof binding.name, "%s", name);
    if (set != 0) return refuse(r, name, "is not in set 0");
    if (variable->is_array) return refuse(r, name, "is an array of bindings");
    if (!buffer && !view_type(m, variable->block, &binding.view))
        return refuse(r, name, "is no 2D, 3D or cube image");
    return add_binding(r, &binding);
}

// ---- Variables

static VkDescriptorType descriptor_type(const struct spirv *m, uint32_t class, uint32_t type)
{
    const size_t at = spirv_find(m, type);
    const uint32_t op = spirv_op_at(m, at);
    if (class == SPIRV_STORAGE_BUFFER ||
        spirv_decoration(m, type, SPIRV_WHOLE, SPIRV_BUFFER_BLOCK, NULL))
        return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    if (class == SPIRV_UNIFORM) return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    if (op == SPIRV_TYPE_SAMPLED_IMAGE) return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    if (op == SPIRV_TYPE_IMAGE && spirv_operand(m, at, IMAGE_SAMPLED) == SAMPLED_STORAGE &&
        spirv_operand(m, at, IMAGE_DIMENSION) != DIMENSION_SUBPASS)
        return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

// The type behind the pointer of a variable, and whether arrays were around it.
static struct variable variable_at(const struct spirv *m, size_t at)
{
    struct variable out = { .id = spirv_operand(m, at, 2) };
    const size_t pointer = spirv_find(m, spirv_operand(m, at, 1));
    out.block = spirv_operand(m, pointer, 3);
    for (int depth = 0; depth < 4; depth++) {
        const size_t type = spirv_find(m, out.block);
        const uint32_t op = spirv_op_at(m, type);
        if (op != SPIRV_TYPE_ARRAY && op != SPIRV_TYPE_RUNTIME_ARRAY) break;
        out.is_array = true;
        out.block = spirv_operand(m, type, 2);
    }
    out.type = descriptor_type(m, spirv_operand(m, at, 3), out.block);
    return out;
}

static bool read_push(const struct reader *r, uint32_t type)
{
    const char *name = spirv_name(&r->module, type);
    const size_t bytes = (spirv_type_size(&r->module, type) + 3) & ~(size_t)3;
    if (bytes > r->gpu->limits.max_push_bytes)
        return refuse(r, name, "has more push constants than the device");
    if (bytes > 128) return refuse(r, name, "has more than 128 bytes of push constants");
    r->out->push_stages |= r->stage;
    if (bytes > r->out->push_bytes) r->out->push_bytes = (uint32_t)bytes;
    return true;
}

static void read_constant(const struct reader *r, uint32_t id)
{
    const int most = sizeof r->out->constant_ids / sizeof *r->out->constant_ids;
    uint32_t number;
    if (r->out->constant_count < most &&
        spirv_decoration(&r->module, id, SPIRV_WHOLE, SPIRV_SPEC_ID, &number))
        r->out->constant_ids[r->out->constant_count++] = number;
}

static bool read_variable(const struct reader *r, size_t at)
{
    const struct spirv *m = &r->module;
    const uint32_t class = spirv_operand(m, at, 3);
    if (!spirv_used(m, spirv_operand(m, at, 2))) return true;
    const struct variable variable = variable_at(m, at);
    if (class == SPIRV_PUSH_CONSTANT) return read_push(r, variable.block);
    if (class != SPIRV_UNIFORM_CONSTANT && class != SPIRV_UNIFORM && class != SPIRV_STORAGE_BUFFER)
        return true;
    return read_binding(r, &variable);
}

static bool read_globals(const struct reader *r)
{
    const struct spirv *m = &r->module;
    bool ok = true;
    for (size_t at = m->types; ok && at < m->functions; at = spirv_next(m, at)) {
        const uint32_t op = spirv_op_at(m, at);
        if (op == SPIRV_VARIABLE) ok = read_variable(r, at);
        if (op >= SPIRV_SPEC_CONSTANT_TRUE && op <= SPIRV_SPEC_CONSTANT)
            read_constant(r, spirv_operand(m, at, 2));
    }
    return ok;
}

// ---- Stages

// Execution models (specification, section 3.3).
enum { MODEL_VERTEX = 0, MODEL_FRAGMENT = 4, MODEL_COMPUTE = 5 };

// Marks what the entry point uses. Entry points come before types.
static bool enter(struct reader *r)
{
    struct spirv *m = &r->module;
    size_t at = 5;
    while (at < m->types && spirv_op_at(m, at) != SPIRV_ENTRY_POINT) at = spirv_next(m, at);
    if (at >= m->types)
        return host_fail(r->gpu->host, FAIL_FORMAT, "gpu shader %s: it has no entry point",
                         r->what);
    const uint32_t model = spirv_operand(m, at, 1);
    const bool right = (model == MODEL_VERTEX && r->stage == VK_SHADER_STAGE_VERTEX_BIT) ||
                       (model == MODEL_FRAGMENT && r->stage == VK_SHADER_STAGE_FRAGMENT_BIT) ||
                       (model == MODEL_COMPUTE && r->stage == VK_SHADER_STAGE_COMPUTE_BIT);
    spirv_mark_used(m, spirv_operand(m, at, 2));
    return right || host_fail(r->gpu->host, FAIL_ARGUMENT, "gpu shader %s: it is for another stage",
                              r->what);
}

bool reflect_stage(struct gpu *gpu, const uint32_t *words, size_t word_count, const char *what,
                   VkShaderStageFlagBits stage, struct reflection *out)
{
    if (!check_words(gpu, words, word_count, what)) return false;
    struct reader r = { .gpu = gpu, .what = what, .stage = stage, .out = out };
    const char *why = spirv_open(&r.module, gpu->host, words, word_count);
    if (why && why[0])
        host_fail(gpu->host, FAIL_FORMAT, "gpu shader %s: it cannot be reflected (%s)", what, why);
    const bool ok = !why && enter(&r) && read_globals(&r);
    spirv_close(&r.module);
    return ok;
}
