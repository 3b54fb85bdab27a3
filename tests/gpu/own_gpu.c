#include "gpu/own_gpu.h"

struct gpu *own_gpu_create(struct own_device *own, void *upload_queue,
                           PFN_vkGetInstanceProcAddr get)
{
    struct gpu_adopt adopt = { .instance = own->instance,
                               .physical_device = own->physical,
                               .device = own->device,
                               .queue = own->queue,
                               .upload_queue = upload_queue,
                               .queue_family = own->family,
                               .lock_queue = own_device_lock,
                               .unlock_queue = own_device_unlock,
                               .user = own,
                               .get_instance_proc_addr = (void (*)(void))get };
    return gpu_create(test_host(), &(struct gpu_desc){ .validation = true, .adopt = &adopt });
}
