// The Vulkan functions that the layer calls: loaded with the linked vkGetInstanceProcAddr, or with
// that of the caller whose device it is.
#pragma once

#include <vulkan/vulkan.h>

// Loaded without an instance.
#define VULKAN_GLOBAL_FUNCTIONS(X)                                                                 \
    X(CreateInstance)                                                                              \
    X(EnumerateInstanceExtensionProperties)                                                        \
    X(EnumerateInstanceLayerProperties)                                                            \
    X(EnumerateInstanceVersion)

#define VULKAN_INSTANCE_FUNCTIONS(X)                                                               \
    X(CreateDevice)                                                                                \
    X(DestroyInstance)                                                                             \
    X(EnumerateDeviceExtensionProperties)                                                          \
    X(EnumeratePhysicalDevices)                                                                    \
    X(GetDeviceProcAddr)                                                                           \
    X(GetPhysicalDeviceFeatures2)                                                                  \
    X(GetPhysicalDeviceFormatProperties)                                                           \
    X(GetPhysicalDeviceImageFormatProperties)                                                      \
    X(GetPhysicalDeviceMemoryProperties)                                                           \
    X(GetPhysicalDeviceProperties)                                                                 \
    X(GetPhysicalDeviceProperties2)                                                                \
    X(GetPhysicalDeviceQueueFamilyProperties)

// Functions of instance extensions: NULL where the extension is not enabled.
#define VULKAN_INSTANCE_EXTENSION_FUNCTIONS(X)                                                     \
    X(CmdBeginDebugUtilsLabelEXT)                                                                  \
    X(CmdEndDebugUtilsLabelEXT)                                                                    \
    X(CreateDebugUtilsMessengerEXT)                                                                \
    X(DestroyDebugUtilsMessengerEXT)                                                               \
    X(SetDebugUtilsObjectNameEXT)

#define VULKAN_DEVICE_FUNCTIONS(X)                                                                 \
    X(AllocateCommandBuffers)                                                                      \
    X(AllocateMemory)                                                                              \
    X(BeginCommandBuffer)                                                                          \
    X(BindBufferMemory)                                                                            \
    X(BindImageMemory)                                                                             \
    X(CmdBeginRendering)                                                                           \
    X(CmdBindIndexBuffer)                                                                          \
    X(CmdBindPipeline)                                                                             \
    X(CmdBlitImage)                                                                                \
    X(CmdClearColorImage)                                                                          \
    X(CmdClearDepthStencilImage)                                                                   \
    X(CmdCopyBuffer)                                                                               \
    X(CmdCopyBufferToImage)                                                                        \
    X(CmdCopyImage)                                                                                \
    X(CmdCopyImageToBuffer)                                                                        \
    X(CmdDispatch)                                                                                 \
    X(CmdDispatchIndirect)                                                                         \
    X(CmdDraw)                                                                                     \
    X(CmdDrawIndexed)                                                                              \
    X(CmdEndRendering)                                                                             \
    X(CmdFillBuffer)                                                                               \
    X(CmdPipelineBarrier2)                                                                         \
    X(CmdPushConstants)                                                                            \
    X(CmdSetCullMode)                                                                              \
    X(CmdSetFrontFace)                                                                             \
    X(CmdSetScissor)                                                                               \
    X(CmdSetViewport)                                                                              \
    X(CmdWriteTimestamp2)                                                                          \
    X(CreateBuffer)                                                                                \
    X(CreateCommandPool)                                                                           \
    X(CreateComputePipelines)                                                                      \
    X(CreateDescriptorSetLayout)                                                                   \
    X(CreateGraphicsPipelines)                                                                     \
    X(CreateImage)                                                                                 \
    X(CreateImageView)                                                                             \
    X(CreatePipelineCache)                                                                         \
    X(CreatePipelineLayout)                                                                        \
    X(CreateQueryPool)                                                                             \
    X(CreateSampler)                                                                               \
    X(CreateSemaphore)                                                                             \
    X(CreateShaderModule)                                                                          \
    X(DestroyBuffer)                                                                               \
    X(DestroyCommandPool)                                                                          \
    X(DestroyDescriptorSetLayout)                                                                  \
    X(DestroyDevice)                                                                               \
    X(DestroyImage)                                                                                \
    X(DestroyImageView)                                                                            \
    X(DestroyPipeline)                                                                             \
    X(DestroyPipelineCache)                                                                        \
    X(DestroyPipelineLayout)                                                                       \
    X(DestroyQueryPool)                                                                            \
    X(DestroySampler)                                                                              \
    X(DestroySemaphore)                                                                            \
    X(DestroyShaderModule)                                                                         \
    X(EndCommandBuffer)                                                                            \
    X(FreeMemory)                                                                                  \
    X(GetBufferMemoryRequirements)                                                                 \
    X(GetDeviceQueue)                                                                              \
    X(GetImageMemoryRequirements)                                                                  \
    X(GetPipelineCacheData)                                                                        \
    X(GetQueryPoolResults)                                                                         \
    X(GetSemaphoreCounterValue)                                                                    \
    X(MapMemory)                                                                                   \
    X(QueueSubmit2)                                                                                \
    X(ResetCommandPool)                                                                            \
    X(ResetQueryPool)                                                                              \
    X(WaitSemaphores)

// Functions of device extensions, likewise.
#define VULKAN_DEVICE_EXTENSION_FUNCTIONS(X) X(CmdPushDescriptorSetKHR)

// Their names are without "vk".
struct vulkan_functions {
#define VULKAN_MEMBER(name) PFN_vk##name name;
    VULKAN_GLOBAL_FUNCTIONS(VULKAN_MEMBER)
    VULKAN_INSTANCE_FUNCTIONS(VULKAN_MEMBER)
    VULKAN_INSTANCE_EXTENSION_FUNCTIONS(VULKAN_MEMBER)
    VULKAN_DEVICE_FUNCTIONS(VULKAN_MEMBER)
    VULKAN_DEVICE_EXTENSION_FUNCTIONS(VULKAN_MEMBER)
#undef VULKAN_MEMBER
};

// Each fills in its part, and returns the name of a function that is missing; NULL: there is none.
const char *vulkan_load_global(struct vulkan_functions *vk);
// get NULL: the linked vkGetInstanceProcAddr.
const char *vulkan_load_instance(struct vulkan_functions *vk, VkInstance instance,
                                 PFN_vkGetInstanceProcAddr get);
const char *vulkan_load_device(struct vulkan_functions *vk, VkDevice device); // after the instance
