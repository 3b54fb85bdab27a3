// Physical devices: enumeration, requirements, selection; the logical device and its limits.
#include "gpu/vk.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

// Linked for gpu_fill_requirements, which need not know an instance to load it with.
VKAPI_ATTR VkResult VKAPI_CALL vkEnumerateDeviceExtensionProperties(VkPhysicalDevice physical,
                                                                    const char *layer,
                                                                    uint32_t *count,
                                                                    VkExtensionProperties *out);

enum { MAX_DEVICES = 16, MAX_EXTENSIONS = 512, MAX_FAMILIES = 32 };

struct features {
    VkPhysicalDeviceFeatures2 core;
    VkPhysicalDeviceVulkan11Features v11;
    VkPhysicalDeviceVulkan12Features v12;
    VkPhysicalDeviceVulkan13Features v13;
};

// One table of features: checked, enabled, and listed by gpu_required_features.
#define REQUIRED_FEATURES(X)                                                                       \
    X(core.features, imageCubeArray)                                                               \
    X(core.features, independentBlend)                                                             \
    X(core.features, depthClamp)                                                                   \
    X(core.features, fragmentStoresAndAtomics)                                                     \
    X(core.features, shaderStorageImageExtendedFormats)                                            \
    X(core.features, shaderStorageImageWriteWithoutFormat)                                         \
    X(v11, shaderDrawParameters)                                                                   \
    X(v12, scalarBlockLayout)                                                                      \
    X(v12, timelineSemaphore)                                                                      \
    X(v12, hostQueryReset)                                                                         \
    X(v13, dynamicRendering)                                                                       \
    X(v13, synchronization2)                                                                       \
    X(v13, maintenance4)                                                                           \
    X(v13, shaderDemoteToHelperInvocation)                                                         \
    X(v13, shaderTerminateInvocation)

static const struct {
    const char *name;
    size_t offset;
} required_features[] = {
#define ROW(part, feature) { #feature, offsetof(struct features, part.feature) },
    REQUIRED_FEATURES(ROW)
#undef ROW
};
enum { REQUIRED_COUNT = sizeof required_features / sizeof *required_features };

const char *gpu_required_features(void)
{
#define LINE(part, feature) #feature "\n"
    return "Vulkan 1.3\n" VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME "\n" REQUIRED_FEATURES(LINE);
#undef LINE
}

static void features_init(struct features *f)
{
    *f = (struct features){ 0 };
    f->core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    f->core.pNext = &f->v11;
    f->v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
    f->v11.pNext = &f->v12;
    f->v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    f->v12.pNext = &f->v13;
    f->v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
}

static VkBool32 *feature_at(struct features *f, int i)
{
    return (VkBool32 *)(void *)((char *)f + required_features[i].offset);
}

static bool has_extension(const struct vulkan_functions *vk, VkPhysicalDevice physical,
                          const char *name)
{
    VkExtensionProperties list[MAX_EXTENSIONS];
    uint32_t count = MAX_EXTENSIONS;
    VkResult result = vk->EnumerateDeviceExtensionProperties(physical, NULL, &count, list);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE) return false;
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(list[i].extensionName, name) == 0) return true;
    }
    return false;
}

// Returns the number of extensions.
static uint32_t list_extensions(const struct vulkan_functions *vk, VkPhysicalDevice physical,
                                const char *extensions[2])
{
    uint32_t count = 0;
    extensions[count++] = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
    if (has_extension(vk, physical, "VK_KHR_portability_subset"))
        extensions[count++] = "VK_KHR_portability_subset"; // must be enabled if it is supported
    return count;
}

uint32_t gpu_fill_requirements(void *instance, void *physical_device,
                               void (*get_instance_proc_addr)(void), void *features2,
                               void *vulkan11, void *vulkan12, void *vulkan13,
                               const char *extensions[2])
{
    struct features use;
    features_init(&use);
    for (int i = 0; i < REQUIRED_COUNT; i++) *feature_at(&use, i) = VK_TRUE;
    use.core.pNext = vulkan11;
    use.v11.pNext = vulkan12;
    use.v12.pNext = vulkan13;
    memcpy(features2, &use.core, sizeof use.core);
    memcpy(vulkan11, &use.v11, sizeof use.v11);
    memcpy(vulkan12, &use.v12, sizeof use.v12);
    memcpy(vulkan13, &use.v13, sizeof use.v13);
    struct vulkan_functions vk = {
        .EnumerateDeviceExtensionProperties = vkEnumerateDeviceExtensionProperties,
    };
    if (instance &&
        vulkan_load_instance(&vk, instance, (PFN_vkGetInstanceProcAddr)get_instance_proc_addr))
        return 0;
    return list_extensions(&vk, physical_device, extensions);
}

// Copies a struct of a chain without its header, and notes that it is there.
static void copy_features(const VkBaseInStructure *from, struct features *to, bool present[4])
{
    static const struct {
        VkStructureType type;
        size_t offset, size;
    } parts[] = {
        { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, offsetof(struct features, core),
          sizeof(VkPhysicalDeviceFeatures2) },
        { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, offsetof(struct features, v11),
          sizeof(VkPhysicalDeviceVulkan11Features) },
        { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, offsetof(struct features, v12),
          sizeof(VkPhysicalDeviceVulkan12Features) },
        { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, offsetof(struct features, v13),
          sizeof(VkPhysicalDeviceVulkan13Features) },
    };
    for (int i = 0; i < 4; i++) {
        if (from->sType != parts[i].type) continue;
        memcpy((char *)to + parts[i].offset, from, parts[i].size);
        present[i] = true;
    }
}

// The struct of `struct features` that a feature belongs to.
static int part_of(size_t offset)
{
    return offset < offsetof(struct features, v11)   ? 0
           : offset < offsetof(struct features, v12) ? 1
           : offset < offsetof(struct features, v13) ? 2
                                                     : 3;
}

// Features may also be enabled by structs of their own: only structs in the chain are checked.
const char *device_missing_feature(const void *chain)
{
    struct features enabled;
    bool present[4] = { false };
    features_init(&enabled);
    for (const VkBaseInStructure *s = chain; s; s = s->pNext) copy_features(s, &enabled, present);
    for (int i = 0; i < REQUIRED_COUNT; i++)
        if (present[part_of(required_features[i].offset)] && !*feature_at(&enabled, i))
            return required_features[i].name;
    return NULL;
}

bool device_family_is_usable(const struct gpu *gpu, uint32_t family)
{
    VkQueueFamilyProperties families[MAX_FAMILIES];
    uint32_t count = MAX_FAMILIES;
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    gpu->vk.GetPhysicalDeviceQueueFamilyProperties(gpu->physical, &count, families);
    return family < count && (families[family].queueFlags & wanted) == wanted;
}

static uint32_t find_queue_family(const struct vulkan_functions *vk, VkPhysicalDevice physical,
                                  uint32_t *valid_bits)
{
    VkQueueFamilyProperties families[MAX_FAMILIES];
    uint32_t count = MAX_FAMILIES;
    vk->GetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; i++) {
        if ((families[i].queueFlags & wanted) != wanted) continue;
        *valid_bits = families[i].timestampValidBits;
        return i;
    }
    return UINT32_MAX;
}

static void miss(struct gpu_device_info *info, const char *what)
{
    size_t used = strlen(info->missing);
    snprintf(info->missing + used, sizeof info->missing - used, "%s%s", used ? ", " : "", what);
    info->usable = false;
}

static void check_usable(const struct vulkan_functions *vk, VkPhysicalDevice physical,
                         const VkPhysicalDeviceProperties *p, struct gpu_device_info *out)
{
    out->usable = true;
    if (p->apiVersion < VK_API_VERSION_1_3) {
        miss(out, "Vulkan 1.3"); // the structures below need it
        return;
    }
    struct features has;
    features_init(&has);
    vk->GetPhysicalDeviceFeatures2(physical, &has.core);
    for (int i = 0; i < REQUIRED_COUNT; i++) {
        if (!*feature_at(&has, i)) miss(out, required_features[i].name);
    }
    uint32_t bits;
    if (find_queue_family(vk, physical, &bits) == UINT32_MAX)
        miss(out, "a graphics and compute queue");
    if (!has_extension(vk, physical, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME)) {
        miss(out, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    }
}

void device_describe(const struct vulkan_functions *vk, VkPhysicalDevice physical,
                     struct gpu_device_info *out)
{
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
    };
    VkPhysicalDeviceProperties2 p = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
        .pNext = &driver,
    };
    vk->GetPhysicalDeviceProperties2(physical, &p);
    *out = (struct gpu_device_info){ .type = GPU_OTHER };
    snprintf(out->name, sizeof out->name, "%s", p.properties.deviceName);
    snprintf(out->driver, sizeof out->driver, "%.120s %.120s", driver.driverName,
             driver.driverInfo);
    switch (p.properties.deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        out->type = GPU_CPU;
        break;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        out->type = GPU_INTEGRATED;
        break;
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        out->type = GPU_DISCRETE;
        break;
    default:
        break;
    }
    check_usable(vk, physical, &p.properties, out);
}

static uint32_t enumerate(const struct vulkan_functions *vk, VkInstance instance,
                          VkPhysicalDevice out[MAX_DEVICES])
{
    uint32_t count = MAX_DEVICES;
    VkResult result = vk->EnumeratePhysicalDevices(instance, &count, out);
    return result == VK_SUCCESS || result == VK_INCOMPLETE ? count : 0;
}

bool gpu_list_devices(struct host *host, struct gpu_device_info *out, int capacity, int *count)
{
    *count = 0;
    struct vulkan_functions vk;
    VkInstance instance;
    if (!instance_create(host, false, &vk, &instance)) return false;
    VkPhysicalDevice devices[MAX_DEVICES];
    uint32_t found = enumerate(&vk, instance, devices);
    for (uint32_t i = 0; i < found && (int)i < capacity; i++)
        device_describe(&vk, devices[i], &out[i]);
    *count = (int)found;
    vk.DestroyInstance(instance, NULL);
    return true;
}

static int rank(const struct gpu_device_info *info)
{
    switch (info->type) {
    case GPU_DISCRETE:
        return 3;
    case GPU_INTEGRATED:
        return 2;
    case GPU_OTHER:
        return 1;
    default:
        return 0;
    }
}

static bool contains(const char *text, const char *part)
{
    size_t length = strlen(part);
    for (; *text; text++) {
        if (strncasecmp(text, part, length) == 0) return true;
    }
    return false;
}

// Index of the device for `wanted`, -1: none. An unusable device is selected only by name or index.
static int match(const struct gpu_device_info *infos, uint32_t count, const char *wanted)
{
    if (wanted && isdigit((unsigned char)wanted[0])) {
        char *end;
        unsigned long i = strtoul(wanted, &end, 10);
        if (!*end) return i < count ? (int)i : -1;
    }
    int best = -1;
    for (uint32_t i = 0; i < count; i++) {
        if (wanted ? !contains(infos[i].name, wanted) : !infos[i].usable) continue;
        if (best < 0 || infos[i].usable > infos[best].usable ||
            (infos[i].usable == infos[best].usable && rank(&infos[i]) > rank(&infos[best]))) {
            best = (int)i;
        }
    }
    return best;
}

static void list_text(const struct gpu_device_info *infos, uint32_t count, char *out, size_t size)
{
    size_t used = 0;
    out[0] = 0;
    for (uint32_t i = 0; i < count && used < size; i++) {
        used += (size_t)snprintf(out + used, size - used, "%s%u \"%s\"%s%s%s", i ? ", " : "", i,
                                 infos[i].name, infos[i].usable ? "" : " (lacks ", infos[i].missing,
                                 infos[i].usable ? "" : ")");
    }
}

VkPhysicalDevice device_choose(struct host *host, const struct vulkan_functions *vk,
                               VkInstance instance, const char *wanted)
{
    VkPhysicalDevice devices[MAX_DEVICES];
    struct gpu_device_info infos[MAX_DEVICES];
    char list[1024];
    uint32_t count = enumerate(vk, instance, devices);
    for (uint32_t i = 0; i < count; i++) device_describe(vk, devices[i], &infos[i]);
    list_text(infos, count, list, sizeof list);
    if (wanted && !wanted[0]) wanted = NULL;
    int chosen = match(infos, count, wanted);
    if (!count) {
        host_fail(host, FAIL_UNSUPPORTED, "gpu device: there is no Vulkan device; %s",
                  GPU_DRIVER_HINT);
    } else if (chosen < 0 && wanted) {
        host_fail(host, FAIL_ARGUMENT, "cannot find gpu device %s: the devices are %s", wanted,
                  list);
    } else if (chosen < 0) {
        host_fail(host, FAIL_UNSUPPORTED, "gpu device: none has all that is needed: %s", list);
    } else if (!infos[chosen].usable) {
        host_fail(host, FAIL_UNSUPPORTED, "gpu device %s: it lacks %s", infos[chosen].name,
                  infos[chosen].missing);
    } else {
        return devices[chosen];
    }
    return VK_NULL_HANDLE;
}

bool device_use(struct gpu *gpu, VkDevice device)
{
    const char *missing = vulkan_load_device(&gpu->vk, device);
    if (missing) {
        if (!gpu->adopted && gpu->vk.DestroyDevice) gpu->vk.DestroyDevice(device, NULL);
        return vk_missing(gpu->host, missing);
    }
    gpu->device = device;
    if (gpu->vk.CmdPushDescriptorSetKHR) return true;
    return host_fail(gpu->host, FAIL_UNSUPPORTED, "gpu device %s: it was created without %s",
                     gpu->info.name, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
}

bool device_create(struct gpu *gpu)
{
    uint32_t bits;
    gpu->queue_family = find_queue_family(&gpu->vk, gpu->physical, &bits);
    struct features has, use;
    features_init(&has);
    features_init(&use);
    gpu->vk.GetPhysicalDeviceFeatures2(gpu->physical, &has.core);
    for (int i = 0; i < REQUIRED_COUNT; i++) *feature_at(&use, i) = VK_TRUE;
    use.core.features.geometryShader = has.core.features.geometryShader;

    const char *extensions[2] = { NULL };
    const uint32_t count = list_extensions(&gpu->vk, gpu->physical, extensions);
    float priority = 1;
    VkDevice device;
    if (!VK_CALL(gpu, CreateDevice, gpu->physical,
                 &(VkDeviceCreateInfo){
                     .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                     .pNext = &use.core,
                     .queueCreateInfoCount = 1,
                     .pQueueCreateInfos =
                         &(VkDeviceQueueCreateInfo){
                             .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                             .queueFamilyIndex = gpu->queue_family,
                             .queueCount = 1,
                             .pQueuePriorities = &priority,
                         },
                     .enabledExtensionCount = count,
                     .ppEnabledExtensionNames = extensions,
                 },
                 NULL, &device))
        return false;
    if (!device_use(gpu, device)) return false;
    gpu->vk.GetDeviceQueue(gpu->device, gpu->queue_family, 0, &gpu->queue.handle);
    gpu->limits.geometry_shader = use.core.features.geometryShader;
    return true;
}

static void read_timestamps(struct gpu *gpu)
{
    VkQueueFamilyProperties families[MAX_FAMILIES];
    uint32_t count = MAX_FAMILIES;
    gpu->vk.GetPhysicalDeviceQueueFamilyProperties(gpu->physical, &count, families);
    uint32_t bits = gpu->queue_family < count ? families[gpu->queue_family].timestampValidBits : 0;
    gpu->ns_per_tick = (double)gpu->vk_limits.timestampPeriod;
    gpu->tick_mask = bits >= 64 ? UINT64_MAX : ((uint64_t)1 << bits) - 1;
    gpu->limits.timestamps = bits > 0 && gpu->ns_per_tick > 0;
}

void device_read_limits(struct gpu *gpu)
{
    VkPhysicalDeviceMaintenance3Properties allocation = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES,
    };
    VkPhysicalDevicePushDescriptorPropertiesKHR push = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PUSH_DESCRIPTOR_PROPERTIES_KHR,
        .pNext = &allocation,
    };
    VkPhysicalDeviceProperties2 p = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
        .pNext = &push,
    };
    gpu->vk.GetPhysicalDeviceProperties2(gpu->physical, &p);
    const VkPhysicalDeviceLimits *l = &p.properties.limits;
    gpu->vk_limits = *l;
    gpu->max_push_descriptors = push.maxPushDescriptors;
    gpu->memory.max_allocation = allocation.maxMemoryAllocationSize;
    gpu->vk.GetPhysicalDeviceMemoryProperties(gpu->physical, &gpu->memory.properties);

    struct gpu_limits *out = &gpu->limits;
    out->max_image_2d = l->maxImageDimension2D;
    out->max_image_3d = l->maxImageDimension3D;
    out->max_layers = l->maxImageArrayLayers;
    out->max_push_bytes = l->maxPushConstantsSize;
    memcpy(out->max_groups, l->maxComputeWorkGroupCount, sizeof out->max_groups);
    out->max_storage_bytes = l->maxStorageBufferRange;
    for (uint32_t i = 0; i < gpu->memory.properties.memoryHeapCount; i++) {
        VkMemoryHeap heap = gpu->memory.properties.memoryHeaps[i];
        bool local = heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT;
        if (local && heap.size > out->memory_bytes) out->memory_bytes = heap.size;
    }
    out->ray_query = has_extension(&gpu->vk, gpu->physical, VK_KHR_RAY_QUERY_EXTENSION_NAME);
    read_timestamps(gpu);
}
