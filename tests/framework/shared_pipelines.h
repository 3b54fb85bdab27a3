// Compute pipelines that outlive the library's devices on a program's Vulkan device: a test that
// opens many devices, one after the other, compiles each pipeline once. Drivers take most of the
// time of such a test to compile.
#pragma once

#include <vulkan/vulkan.h>

// For the vkGetDeviceProcAddr that the program lends, of one thread. NULL: the driver's function is
// wanted.
PFN_vkVoidFunction shared_pipelines_function(const char *name);
// Destroys the pipelines. The library's devices are gone.
void shared_pipelines_close(VkDevice device);
