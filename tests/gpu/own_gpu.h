// The GPU layer on a test's own device, with validation.
#pragma once

#include "framework/gpu_test.h"
#include "framework/own_device.h"

// get: the device's Vulkan loader; NULL: the linked one. upload_queue: NULL: none.
struct gpu *own_gpu_create(struct own_device *own, void *upload_queue,
                           PFN_vkGetInstanceProcAddr get);
