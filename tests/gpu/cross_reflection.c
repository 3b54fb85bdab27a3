// The reflection of SPIRV-Cross: the twin of gpu/reflect.c.
#include "gpu/cross_reflection.h"

#include <spirv_cross_c.h>
#include <stdio.h>
#include <string.h>

struct reader {
    struct gpu *gpu;
    const char *what;
    VkShaderStageFlagBits stage;
    spvc_context context;
    spvc_compiler compiler;
    spvc_resources resources;
    struct reflection *out;
};

static bool refuse(const struct reader *r, const char *name, const char *why)
{
    return host_fail(r->gpu->host, FAIL_FORMAT, "gpu shader %s: \"%s\" %s", r->what, name, why);
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

static bool view_type(spvc_type type, VkImageViewType *out)
{
    bool arrayed = spvc_type_get_image_arrayed(type);
    switch (spvc_type_get_image_dimension(type)) {
    case SpvDim2D:
        *out = arrayed ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
        break;
    case SpvDimCube:
        *out = arrayed ? VK_IMAGE_VIEW_TYPE_CUBE_ARRAY : VK_IMAGE_VIEW_TYPE_CUBE;
        break;
    case SpvDim3D:
        *out = VK_IMAGE_VIEW_TYPE_3D;
        break;
    default:
        return false;
    }
    return !spvc_type_get_image_multisampled(type);
}

// glslang puts `readonly` on each member of a block and on the variable of an image.
static bool is_read_only(const struct reader *r, spvc_variable_id id, bool buffer)
{
    if (spvc_compiler_has_decoration(r->compiler, id, SpvDecorationNonWritable)) return true;
    const SpvDecoration *decorations;
    size_t count;
    if (!buffer || spvc_compiler_get_buffer_block_decorations(r->compiler, id, &decorations,
                                                              &count) != SPVC_SUCCESS) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        if (decorations[i] == SpvDecorationNonWritable) return true;
    }
    return false;
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

static bool read_binding(const struct reader *r, const spvc_reflected_resource *resource,
                         VkDescriptorType type)
{
    bool buffer =
        type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    spvc_type handle = spvc_compiler_get_type_handle(r->compiler, resource->type_id);
    const char *name = buffer ? spvc_compiler_get_name(r->compiler, resource->base_type_id)
                              : spvc_compiler_get_name(r->compiler, resource->id);
    struct shader_binding binding = {
        .type = type,
        .shader_stages = r->stage,
        .stages = pipeline_stage(r->stage),
        .binding = spvc_compiler_get_decoration(r->compiler, resource->id, SpvDecorationBinding),
        .writes = (type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ||
                   type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) &&
                  !is_read_only(r, resource->id, buffer),
    };
    if (!name || !name[0])
        return refuse(r, "", "names were stripped from it; compile it without -O");
    if (strlen(name) >= sizeof binding.name) return refuse(r, name, "has too long a name");
    snprintf(binding.name, sizeof binding.name, "%s", name);
    if (spvc_compiler_get_decoration(r->compiler, resource->id, SpvDecorationDescriptorSet) != 0) {
        return refuse(r, name, "is not in set 0");
    }
    if (spvc_type_get_num_array_dimensions(handle) > 0)
        return refuse(r, name, "is an array of bindings");
    if (!buffer && !view_type(handle, &binding.view))
        return refuse(r, name, "is no 2D, 3D or cube image");
    return add_binding(r, &binding);
}

static bool read_kind(const struct reader *r, spvc_resource_type kind, VkDescriptorType type)
{
    const spvc_reflected_resource *list;
    size_t count;
    if (spvc_resources_get_resource_list_for_type(r->resources, kind, &list, &count) !=
        SPVC_SUCCESS) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        if (type == VK_DESCRIPTOR_TYPE_MAX_ENUM) {
            return refuse(r, list[i].name,
                          "is of a kind that is not supported (samplers are combined ones)");
        }
        if (!read_binding(r, &list[i], type)) return false;
    }
    return true;
}

static bool read_push(const struct reader *r)
{
    const spvc_reflected_resource *list;
    size_t count, bytes;
    if (spvc_resources_get_resource_list_for_type(r->resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT,
                                                  &list, &count) != SPVC_SUCCESS ||
        count == 0) {
        return true;
    }
    spvc_type type = spvc_compiler_get_type_handle(r->compiler, list[0].base_type_id);
    if (spvc_compiler_get_declared_struct_size(r->compiler, type, &bytes) != SPVC_SUCCESS)
        return false;
    bytes = (bytes + 3) & ~(size_t)3;
    if (bytes > r->gpu->limits.max_push_bytes)
        return refuse(r, list[0].name, "has more push constants than the device");
    if (bytes > 128) return refuse(r, list[0].name, "has more than 128 bytes of push constants");
    r->out->push_stages |= r->stage;
    if (bytes > r->out->push_bytes) r->out->push_bytes = (uint32_t)bytes;
    return true;
}

static bool read_constants(const struct reader *r)
{
    const int most = sizeof r->out->constant_ids / sizeof *r->out->constant_ids;
    const spvc_specialization_constant *list;
    size_t count;
    if (spvc_compiler_get_specialization_constants(r->compiler, &list, &count) != SPVC_SUCCESS)
        return false;
    for (size_t i = 0; i < count && r->out->constant_count < most; i++) {
        r->out->constant_ids[r->out->constant_count++] = list[i].constant_id;
    }
    return true;
}

static bool open_reader(struct reader *r, const uint32_t *words, size_t count)
{
    spvc_parsed_ir ir;
    spvc_set active;
    return spvc_context_create(&r->context) == SPVC_SUCCESS &&
           spvc_context_parse_spirv(r->context, words, count, &ir) == SPVC_SUCCESS &&
           spvc_context_create_compiler(r->context, SPVC_BACKEND_NONE, ir,
                                        SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                        &r->compiler) == SPVC_SUCCESS &&
           spvc_compiler_get_active_interface_variables(r->compiler, &active) == SPVC_SUCCESS &&
           spvc_compiler_create_shader_resources_for_active_variables(r->compiler, &r->resources,
                                                                      active) == SPVC_SUCCESS;
}

static bool check_stage(const struct reader *r)
{
    SpvExecutionModel model = spvc_compiler_get_execution_model(r->compiler);
    bool right = (model == SpvExecutionModelVertex && r->stage == VK_SHADER_STAGE_VERTEX_BIT) ||
                 (model == SpvExecutionModelFragment && r->stage == VK_SHADER_STAGE_FRAGMENT_BIT) ||
                 (model == SpvExecutionModelGLCompute && r->stage == VK_SHADER_STAGE_COMPUTE_BIT);
    return right || host_fail(r->gpu->host, FAIL_ARGUMENT, "gpu shader %s: it is for another stage",
                              r->what);
}

bool cross_reflect_stage(struct gpu *gpu, const uint32_t *words, size_t word_count,
                         const char *what, VkShaderStageFlagBits stage, struct reflection *out)
{
    static const struct {
        spvc_resource_type kind;
        VkDescriptorType type;
    } kinds[] = {
        { SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER },
        { SPVC_RESOURCE_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER },
        { SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER },
        { SPVC_RESOURCE_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE },
        { SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, VK_DESCRIPTOR_TYPE_MAX_ENUM },
        { SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, VK_DESCRIPTOR_TYPE_MAX_ENUM },
        { SPVC_RESOURCE_TYPE_SUBPASS_INPUT, VK_DESCRIPTOR_TYPE_MAX_ENUM },
        { SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE, VK_DESCRIPTOR_TYPE_MAX_ENUM },
    };
    struct reader r = { .gpu = gpu, .what = what, .stage = stage, .out = out };
    bool ok = open_reader(&r, words, word_count);
    if (!ok) {
        host_fail(gpu->host, FAIL_FORMAT, "gpu shader %s: it cannot be reflected (%s)", what,
                  r.context ? spvc_context_get_last_error_string(r.context) : "no memory");
    }
    ok = ok && check_stage(&r);
    for (size_t i = 0; ok && i < sizeof kinds / sizeof *kinds; i++)
        ok = read_kind(&r, kinds[i].kind, kinds[i].type);
    ok = ok && read_push(&r) && read_constants(&r);
    if (r.context) spvc_context_destroy(r.context);
    return ok;
}
