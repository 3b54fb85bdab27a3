#include "techniques/common/light_map/columns.h"

#include "frame/frame.h"

struct light_map_columns light_map_columns_for(struct gpu *gpu)
{
    static const struct light_map_columns WIDE = { 64, 1, 16 }, SQUARE = { 8, 8, 1 };
    return gpu_info(gpu)->type == GPU_CPU ? WIDE : SQUARE;
}

void light_map_clear_pixels(struct gpu_cmd *cmd, const struct frame_view *view)
{
    static const float NONE[4] = { 0, 0, 0, 1 };
    const gpu_image *layers = view->layers;
    gpu_clear_image(cmd, layers[FRAME_IRRADIANCE], NONE);
    if (layers[FRAME_SPECULAR].id) gpu_clear_image(cmd, layers[FRAME_SPECULAR], NONE);
}
