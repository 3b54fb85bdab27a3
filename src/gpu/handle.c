// Objects by handle.
#include "gpu/vk.h"

struct image *image_get(const struct gpu *gpu, gpu_image image)
{
    return table_get(&gpu->images, image.id);
}

struct buffer *buffer_get(const struct gpu *gpu, gpu_buffer buffer)
{
    return table_get(&gpu->buffers, buffer.id);
}

struct pipeline *pipeline_get(const struct gpu *gpu, gpu_pipeline pipeline)
{
    return table_get(&gpu->pipelines, pipeline.id);
}
