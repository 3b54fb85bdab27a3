// A program's G-buffer: images, and the mapped memory from which a frame copies their texels.
#ifndef HOST_GBUFFER_H
#define HOST_GBUFFER_H

#include "host_device.h"

enum surface_image {
    SURFACE_DEPTH,
    SURFACE_NORMAL,
    SURFACE_ALBEDO,
    SURFACE_MOTION,
    SURFACE_IMAGES
};

struct host_gbuffer {
    int width, height;
    VkFormat formats[SURFACE_IMAGES]; // VK_FORMAT_UNDEFINED: no such image
    VkImage images[SURFACE_IMAGES];
    VkDeviceMemory memory[SURFACE_IMAGES];
    struct mapped_buffer texels; // images one after the other, rows from the top
};
// Texels of 4 bytes, of 8 in VK_FORMAT_R32G32_SFLOAT.
void host_gbuffer_create(const struct host_device *host, int width, int height,
                         const VkFormat formats[SURFACE_IMAGES], struct host_gbuffer *out);
void host_gbuffer_destroy(const struct host_device *host, const struct host_gbuffer *gbuffer);
// Mapped memory of the texels of an image.
void *host_gbuffer_texels(const struct host_gbuffer *gbuffer, enum surface_image which);
// Records the copies of all texels to the images, and describes these for the library.
void host_gbuffer_upload(const struct host_gbuffer *gbuffer, VkCommandBuffer commands,
                         struct ag_gbuffer *out);
// One layer of the whole of an image, for copies.
VkBufferImageCopy host_whole_image(int width, int height, VkImageAspectFlags aspect,
                                   VkDeviceSize offset);

#endif
