// Pipelines from embedded shaders or shaders on disk, and their reload when a file changes.
#include "gpu/vk.h"

#include "core/files/file.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

// The words of one stage: embedded, or read from shader_dir.
struct code {
    const uint32_t *words;
    size_t count;
    struct file_bytes file;
};

static char *shader_path(struct gpu *gpu, const struct shader_stage *stage)
{
    return gpu->shader_dir ? host_sprintf(gpu->host, "%s/%s.spv", gpu->shader_dir, stage->name)
                           : NULL;
}

// Changes with the file; 0: no file.
static int64_t stamp_of(struct gpu *gpu, const struct shader_stage *stage)
{
    char *path = shader_path(gpu, stage);
    struct stat info;
    int64_t stamp = 0;
    if (path && stat(path, &info) == 0 && S_ISREG(info.st_mode)) {
        stamp = ((int64_t)info.st_mtim.tv_sec * 1000000000 + info.st_mtim.tv_nsec) ^
                (int64_t)info.st_size;
        if (!stamp) stamp = 1;
    }
    host_free(gpu->host, path);
    return stamp;
}

static void use_embedded(const struct shader_stage *stage, struct code *out)
{
    out->words = stage->embedded.words;
    out->count = stage->embedded.word_count;
}

// from_file: the file on disk if there is one, which must hold whole words.
static bool load_code(struct gpu *gpu, const struct shader_stage *stage, bool from_file,
                      struct code *out)
{
    *out = (struct code){ 0 };
    if (!from_file || !stage->stamp) {
        use_embedded(stage, out);
        return true;
    }
    char *path = shader_path(gpu, stage);
    if (!path) return false;
    bool ok = file_read(gpu->host, path, 64u << 20, &out->file);
    if (ok && out->file.size % 4) {
        ok = host_fail(gpu->host, FAIL_FORMAT, "gpu shader %s: %zu bytes are not whole words", path,
                       out->file.size);
    }
    out->words = (const uint32_t *)(const void *)out->file.data;
    out->count = out->file.size / 4;
    host_free(gpu->host, path);
    return ok;
}

static bool create_layouts(struct gpu *gpu, struct pipeline *p)
{
    const struct reflection *r = &p->reflection;
    VkDescriptorSetLayoutBinding bindings[MAX_BINDINGS];
    for (int i = 0; i < r->binding_count; i++) {
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = r->bindings[i].binding,
            .descriptorType = r->bindings[i].type,
            .descriptorCount = 1,
            .stageFlags = r->bindings[i].shader_stages,
        };
    }
    VkDescriptorSetLayoutCreateInfo set = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR,
        .bindingCount = (uint32_t)r->binding_count,
        .pBindings = bindings,
    };
    if (!VK_CALL(gpu, CreateDescriptorSetLayout, gpu->device, &set, gpu->allocator, &p->set_layout))
        return false;
    VK_NAME(gpu, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, p->set_layout, p->name);
    VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &p->set_layout,
        .pushConstantRangeCount = r->push_bytes ? 1 : 0,
        .pPushConstantRanges = &(VkPushConstantRange){ r->push_stages, 0, r->push_bytes },
    };
    if (!VK_CALL(gpu, CreatePipelineLayout, gpu->device, &layout, gpu->allocator, &p->layout))
        return false;
    VK_NAME(gpu, VK_OBJECT_TYPE_PIPELINE_LAYOUT, p->layout, p->name);
    return true;
}

static VkResult create_compute(struct gpu *gpu, struct pipeline *p,
                               const VkPipelineShaderStageCreateInfo *stages)
{
    return gpu->vk.CreateComputePipelines(
        gpu->device, gpu->pipeline_cache, 1,
        &(VkComputePipelineCreateInfo){
            .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
            .stage = stages[0],
            .layout = p->layout,
        },
        gpu->allocator, &p->handle);
}

static bool create_module(struct gpu *gpu, const struct code *code, const char *name,
                          VkShaderModule *out)
{
    if (!VK_CALL(gpu, CreateShaderModule, gpu->device,
                 &(VkShaderModuleCreateInfo){ .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                              .codeSize = code->count * 4,
                                              .pCode = code->words },
                 gpu->allocator, out)) {
        *out = VK_NULL_HANDLE;
        return false;
    }
    VK_NAME(gpu, VK_OBJECT_TYPE_SHADER_MODULE, *out, name);
    return true;
}

static bool create_handle(struct gpu *gpu, struct pipeline *p, const struct code *codes)
{
    enum { MOST = sizeof p->reflection.constant_ids / sizeof *p->reflection.constant_ids };
    VkSpecializationMapEntry entries[MOST];
    VkShaderModule modules[MAX_STAGES] = { 0 };
    VkPipelineShaderStageCreateInfo stages[MAX_STAGES];
    for (int i = 0; i < p->constant_count; i++) {
        size_t offset = (size_t)i * sizeof *p->constants + offsetof(struct gpu_constant, value);
        entries[i] =
            (VkSpecializationMapEntry){ p->constants[i].id, (uint32_t)offset, sizeof(uint32_t) };
    }
    VkSpecializationInfo constants = {
        .mapEntryCount = (uint32_t)p->constant_count,
        .pMapEntries = entries,
        .dataSize = (size_t)p->constant_count * sizeof *p->constants,
        .pData = p->constants,
    };
    bool ok = true;
    for (int i = 0; ok && i < p->stage_count; i++) {
        ok = create_module(gpu, &codes[i], p->stages[i].name, &modules[i]);
        stages[i] = (VkPipelineShaderStageCreateInfo){
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = p->stages[i].stage,
            .module = modules[i],
            .pName = "main",
            .pSpecializationInfo = p->constant_count ? &constants : NULL,
        };
    }
    if (ok) {
        VkResult result =
            p->graphics ? pipeline_create_graphics(gpu, p, stages) : create_compute(gpu, p, stages);
        ok = vk_check(gpu, result,
                      p->graphics ? "vkCreateGraphicsPipelines" : "vkCreateComputePipelines");
        if (!ok) p->handle = VK_NULL_HANDLE;
    }
    for (int i = 0; i < p->stage_count; i++)
        gpu->vk.DestroyShaderModule(gpu->device, modules[i], gpu->allocator);
    if (ok) VK_NAME(gpu, VK_OBJECT_TYPE_PIPELINE, p->handle, p->name);
    return ok;
}

static bool check_constants(struct gpu *gpu, const struct pipeline *p)
{
    for (int i = 0; i < p->constant_count; i++) {
        bool known = false;
        for (int k = 0; k < p->reflection.constant_count; k++) {
            known |= p->reflection.constant_ids[k] == p->constants[i].id;
        }
        if (!known) {
            return host_fail(gpu->host, FAIL_ARGUMENT,
                             "gpu pipeline %s: its shaders have no specialization constant %u",
                             p->name, p->constants[i].id);
        }
    }
    return true;
}

static void free_handles(struct gpu *gpu, struct pipeline *p)
{
    gpu->vk.DestroyPipeline(gpu->device, p->handle, gpu->allocator);
    gpu->vk.DestroyPipelineLayout(gpu->device, p->layout, gpu->allocator);
    gpu->vk.DestroyDescriptorSetLayout(gpu->device, p->set_layout, gpu->allocator);
    p->handle = VK_NULL_HANDLE;
    p->layout = VK_NULL_HANDLE;
    p->set_layout = VK_NULL_HANDLE;
}

// Builds reflection, layouts and pipeline. from_files: with shaders in shader_dir if present.
static bool build(struct gpu *gpu, struct pipeline *p, bool from_files)
{
    struct code codes[MAX_STAGES] = { 0 };
    p->reflection = (struct reflection){ 0 };
    bool ok = true;
    for (int i = 0; ok && i < p->stage_count; i++) {
        const struct shader_stage *stage = &p->stages[i];
        ok = load_code(gpu, stage, from_files, &codes[i]) &&
             reflect_stage(gpu, codes[i].words, codes[i].count, stage->name, stage->stage,
                           &p->reflection);
    }
    ok = ok && check_constants(gpu, p) && create_layouts(gpu, p) && create_handle(gpu, p, codes);
    if (!ok) free_handles(gpu, p);
    for (int i = 0; i < p->stage_count; i++) file_bytes_finish(gpu->host, &codes[i].file);
    return ok;
}

void pipeline_free(struct gpu *gpu, void *object)
{
    struct pipeline *p = object;
    if (!p) return;
    free_handles(gpu, p);
    host_free(gpu->host, p->constants);
    host_free(gpu->host, p);
}

static bool copy_constants(struct gpu *gpu, struct pipeline *p,
                           const struct gpu_constant *constants, int count)
{
    const int most = sizeof p->reflection.constant_ids / sizeof *p->reflection.constant_ids;
    if (count < 0 || count > most) {
        return host_fail(gpu->host, FAIL_ARGUMENT,
                         "gpu pipeline %s: %d specialization constants, at most %d", p->name, count,
                         most);
    }
    if (!count) return true;
    p->constants = host_alloc(gpu->host, (size_t)count, sizeof *constants);
    if (!p->constants) return false;
    memcpy(p->constants, constants, (size_t)count * sizeof *constants);
    p->constant_count = count;
    return true;
}

static void add_stage(struct gpu *gpu, struct pipeline *p, const struct gpu_shader *shader,
                      VkShaderStageFlagBits kind)
{
    struct shader_stage *stage = &p->stages[p->stage_count++];
    *stage = (struct shader_stage){ .stage = kind, .embedded = *shader };
    snprintf(stage->name, sizeof stage->name, "%s", shader->name);
    stage->stamp = stamp_of(gpu, stage);
}

static bool build_any(struct gpu *gpu, struct pipeline *p)
{
    bool on_disk = false;
    for (int i = 0; i < p->stage_count; i++) on_disk |= p->stages[i].stamp != 0;
    if (on_disk) {
        if (build(gpu, p, true)) return true;
        host_log(gpu->host, LOG_WARNING,
                 "gpu pipeline %s: invalid shader in %s; the embedded one is used", p->name,
                 gpu->shader_dir);
    }
    return build(gpu, p, false);
}

// Takes over p.
static bool finish(struct gpu *gpu, struct pipeline *p, gpu_pipeline *out)
{
    if (gpu->lost) {
        host_fail(gpu->host, FAIL_DEVICE, "gpu pipeline %s: the device was lost", p->name);
        goto fail;
    }
    if (!gpu->compiler) deferred_delete_collect(gpu);
    struct pipeline *equal = pipeline_find_equal(&gpu->pipelines, p);
    if (!equal) equal = pipeline_pool_take(&gpu->pipeline_pool, p);
    if (!equal) equal = compiled_take(&gpu->compiled, p);
    if (equal) {
        pipeline_free(gpu, p);
        p = equal;
    } else if (!build_any(gpu, p)) {
        goto fail;
    }
    p->users++;
    gpu->counters.compiled += !equal;
    gpu->counters.pipelines++;
    out->id = table_add(gpu->host, &gpu->pipelines, p);
    if (out->id) return true;
    pipeline_release(gpu, p);
    return false;
fail:
    pipeline_free(gpu, p);
    return false;
}

static struct pipeline *pipeline_new(struct gpu *gpu, const char *name, gpu_pipeline *out)
{
    out->id = 0;
    struct pipeline *p = host_alloc(gpu->host, 1, sizeof *p);
    char full[NAME_SIZE];
    if (p) snprintf(p->name, sizeof p->name, "%s", name ? owner_name(gpu, name, full) : "");
    return p;
}

bool gpu_compute_pipeline_create(struct gpu *gpu, const char *name, const struct gpu_shader *shader,
                                 const struct gpu_constant *constants, int constant_count,
                                 gpu_pipeline *out)
{
    struct pipeline *p = pipeline_new(gpu, name, out);
    if (!p) return false;
    if (!copy_constants(gpu, p, constants, constant_count)) {
        pipeline_free(gpu, p);
        return false;
    }
    add_stage(gpu, p, shader, VK_SHADER_STAGE_COMPUTE_BIT);
    return finish(gpu, p, out);
}

static bool check_graphics(struct gpu *gpu, struct pipeline *p)
{
    const struct gpu_graphics_desc *d = &p->desc;
    while (p->color_count < MAX_COLORS && d->color_formats[p->color_count] != GPU_FORMAT_NONE)
        p->color_count++;
    if ((uint32_t)p->color_count > gpu->vk_limits.maxColorAttachments ||
        (d->depth_format != GPU_FORMAT_NONE && d->depth_format != GPU_D32F) ||
        (unsigned)d->depth_compare > GPU_GREATER || (unsigned)d->blend > GPU_BLEND_ADD) {
        return host_fail(gpu->host, FAIL_ARGUMENT,
                         "gpu pipeline %s: too many colour targets, no depth format, or an unknown "
                         "comparison or "
                         "blending",
                         p->name);
    }
    for (int i = 0; i < p->color_count; i++) {
        if (d->color_formats[i] < GPU_D32F) continue;
        return host_fail(gpu->host, FAIL_ARGUMENT,
                         "gpu pipeline %s: colour target %d has no colour format", p->name, i);
    }
    return true;
}

bool gpu_graphics_pipeline_create(struct gpu *gpu, const struct gpu_graphics_desc *desc,
                                  gpu_pipeline *out)
{
    struct pipeline *p = pipeline_new(gpu, desc->name, out);
    if (!p) return false;
    p->graphics = true;
    p->desc = *desc;
    p->desc.name = p->name;
    p->desc.vertex = p->desc.fragment = NULL;
    p->desc.constants = NULL;
    if (!check_graphics(gpu, p) || !copy_constants(gpu, p, desc->constants, desc->constant_count)) {
        pipeline_free(gpu, p);
        return false;
    }
    add_stage(gpu, p, desc->vertex, VK_SHADER_STAGE_VERTEX_BIT);
    if (desc->fragment) add_stage(gpu, p, desc->fragment, VK_SHADER_STAGE_FRAGMENT_BIT);
    return finish(gpu, p, out);
}

void gpu_pipeline_destroy(struct gpu *gpu, gpu_pipeline *handle)
{
    struct pipeline *p = gpu && handle ? table_remove(&gpu->pipelines, handle->id) : NULL;
    if (handle) handle->id = 0;
    if (p && --p->users > 0) return;
    if (p) p = pipeline_pool_give(&gpu->pipeline_pool, p);
    if (p) deferred_delete_add(gpu, pipeline_free, p);
}

void pipeline_release(struct gpu *gpu, void *object)
{
    struct pipeline *p = object;
    if (p && --p->users == 0) pipeline_free(gpu, p);
}

static bool has_changed(struct gpu *gpu, struct pipeline *p)
{
    bool changed = false;
    for (int i = 0; i < p->stage_count; i++) {
        int64_t stamp = stamp_of(gpu, &p->stages[i]);
        changed |= stamp != p->stages[i].stamp;
        p->stages[i].stamp = stamp; // an invalid shader is retried only after another change
    }
    return changed;
}

// A new pipeline from the description of `old`; NULL: the old one stays.
static struct pipeline *rebuild(struct gpu *gpu, const struct pipeline *old)
{
    struct pipeline *p = host_alloc(gpu->host, 1, sizeof *p);
    if (!p) return NULL;
    *p = *old;
    p->desc.name = p->name;
    p->handle = VK_NULL_HANDLE;
    p->layout = VK_NULL_HANDLE;
    p->set_layout = VK_NULL_HANDLE;
    p->constants = NULL;
    p->constant_count = 0;
    if (copy_constants(gpu, p, old->constants, old->constant_count) && build(gpu, p, true))
        return p;
    host_log(gpu->host, LOG_WARNING, "gpu pipeline %s: invalid shader; the previous one is kept",
             old->name);
    pipeline_free(gpu, p);
    return NULL;
}

int gpu_reload_shaders(struct gpu *gpu)
{
    int count = 0;
    if (!gpu->shader_dir || gpu->lost) return 0;
    for (uint32_t i = 0; i < gpu->pipelines.count; i++) {
        struct pipeline *old = gpu->pipelines.objects[i];
        struct pipeline *p = old && has_changed(gpu, old) ? rebuild(gpu, old) : NULL;
        if (!p) continue;
        for (uint32_t k = i; k < gpu->pipelines.count; k++)
            if (gpu->pipelines.objects[k] == old) gpu->pipelines.objects[k] = p;
        deferred_delete_add(gpu, pipeline_free, old);
        host_log(gpu->host, LOG_INFO, "gpu pipeline %s: reloaded", p->name);
        count++;
    }
    return count;
}
