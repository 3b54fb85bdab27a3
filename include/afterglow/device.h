/// A GPU: one that the library opens, or the caller's own.
#ifndef AFTERGLOW_DEVICE_H
#define AFTERGLOW_DEVICE_H

#include <afterglow/context.h>

AG_BEGIN

struct ag_device;

struct ag_device_info {
    char name[256], driver[256];
    bool software;     ///< runs on the CPU
    bool usable;       ///< has all that the library needs
    char missing[256]; ///< what it lacks, where it is not usable
};

/// Fills at most `capacity` entries; *count is the number of devices.
AG_API enum ag_result ag_device_list(struct ag_context *context, struct ag_device_info *out,
                                     int capacity, int *count);

/// A caller's Vulkan objects, as their handles. The device has Vulkan 1.3, VK_KHR_push_descriptor
/// and the features that ag_device_required_features lists enabled. The caller keeps them alive
/// until ag_device_destroy.
struct ag_device_adopt {
    void *instance, *physical_device, *device, *queue;
    uint32_t queue_family;
    void (*lock_queue)(void *user);   ///< around submissions; may be NULL
    void (*unlock_queue)(void *user); ///< likewise
    void *user;
};

struct ag_device_desc {
    const char *device; ///< a number in ag_device_list, a part of a name, or NULL for the best
    bool validation;    ///< Vulkan validation with synchronization checks; default false
    const struct ag_device_adopt *adopt; ///< NULL: the library opens a device of its own
};

AG_API void ag_device_desc_default(struct ag_device_desc *desc);
/// desc may be NULL for the defaults.
AG_API enum ag_result ag_device_create(struct ag_context *context,
                                       const struct ag_device_desc *desc, struct ag_device **out);
AG_API void ag_device_destroy(struct ag_device *device);
AG_API void ag_device_get_info(const struct ag_device *device, struct ag_device_info *out);
/// Vulkan features that an adopted device must have enabled, one name a line.
AG_API const char *ag_device_required_features(void);
/// Messages of the validation layers so far; 0 when validation is off.
AG_API int ag_device_validation_messages(const struct ag_device *device);

AG_END

#endif
