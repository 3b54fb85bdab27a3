#include "framework/shared_pipelines.h"

#include "core/hash.h"
#include "framework/test.h"

#include <string.h>

enum { MOST_MODULES = 16, MOST_PIPELINES = 256 };

static struct {
    VkShaderModule handle; // NULL: free
    uint64_t hash;         // of the code
} modules[MOST_MODULES];

static struct {
    VkPipeline handle;
    uint64_t hash; // of code and constants
} pipelines[MOST_PIPELINES];
static int pipeline_count;
static VkDevice owner; // of all of them

static void forget(void)
{
    pipeline_count = 0;
    memset(modules, 0, sizeof modules);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_module(VkDevice device,
                                                    const VkShaderModuleCreateInfo *info,
                                                    const VkAllocationCallbacks *allocator,
                                                    VkShaderModule *out)
{
    const VkResult result = vkCreateShaderModule(device, info, allocator, out);
    if (result != VK_SUCCESS) return result;
    if (device != owner) forget(); // a test failed
    owner = device;
    int i = 0;
    while (i < MOST_MODULES && modules[i].handle) i++;
    assert_true(i < MOST_MODULES);
    modules[i].handle = *out;
    modules[i].hash = hash_bytes(info->pCode, info->codeSize, 0);
    return result;
}

static VKAPI_ATTR void VKAPI_CALL destroy_module(VkDevice device, VkShaderModule module,
                                                 const VkAllocationCallbacks *allocator)
{
    for (int i = 0; i < MOST_MODULES; i++)
        if (modules[i].handle == module) modules[i].handle = VK_NULL_HANDLE;
    vkDestroyShaderModule(device, module, allocator);
}

// The layout follows from the code.
static uint64_t hash_of(const VkComputePipelineCreateInfo *info)
{
    const VkSpecializationInfo *constants = info->stage.pSpecializationInfo;
    int i = 0;
    while (i < MOST_MODULES && modules[i].handle != info->stage.module) i++;
    assert_true(i < MOST_MODULES);
    uint64_t hash = modules[i].hash;
    if (!constants) return hash;
    hash = hash_bytes(constants->pMapEntries,
                      constants->mapEntryCount * sizeof *constants->pMapEntries, hash);
    return hash_bytes(constants->pData, constants->dataSize, hash);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache,
                                                       uint32_t count,
                                                       const VkComputePipelineCreateInfo *infos,
                                                       const VkAllocationCallbacks *allocator,
                                                       VkPipeline *out)
{
    assert_true(count == 1 && !allocator);
    const uint64_t hash = hash_of(infos);
    for (int i = 0; i < pipeline_count; i++) {
        if (pipelines[i].hash != hash) continue;
        *out = pipelines[i].handle;
        return VK_SUCCESS;
    }
    const VkResult result = vkCreateComputePipelines(device, cache, 1, infos, NULL, out);
    if (result != VK_SUCCESS) return result;
    assert_true(pipeline_count < MOST_PIPELINES);
    pipelines[pipeline_count].handle = *out;
    pipelines[pipeline_count++].hash = hash;
    return result;
}

static VKAPI_ATTR void VKAPI_CALL destroy_pipeline(VkDevice device, VkPipeline pipeline,
                                                   const VkAllocationCallbacks *allocator)
{
    for (int i = 0; i < pipeline_count; i++)
        if (pipelines[i].handle == pipeline) return;
    vkDestroyPipeline(device, pipeline, allocator);
}

PFN_vkVoidFunction shared_pipelines_function(const char *name)
{
    if (strcmp(name, "vkCreateShaderModule") == 0) return (PFN_vkVoidFunction)create_module;
    if (strcmp(name, "vkDestroyShaderModule") == 0) return (PFN_vkVoidFunction)destroy_module;
    if (strcmp(name, "vkCreateComputePipelines") == 0) return (PFN_vkVoidFunction)create_pipelines;
    if (strcmp(name, "vkDestroyPipeline") == 0) return (PFN_vkVoidFunction)destroy_pipeline;
    return NULL;
}

void shared_pipelines_close(VkDevice device)
{
    for (int i = 0; i < pipeline_count; i++) vkDestroyPipeline(device, pipelines[i].handle, NULL);
    forget();
}
