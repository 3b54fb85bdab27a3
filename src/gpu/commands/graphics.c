// Fixed state of graphics pipelines. Cull mode, front face, viewport and scissor are dynamic.
#include "gpu/vk.h"

static VkPipelineColorBlendAttachmentState blend_state(enum gpu_blend blend)
{
    return (VkPipelineColorBlendAttachmentState){
        .blendEnable = blend == GPU_BLEND_ADD,
        .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstColorBlendFactor = VK_BLEND_FACTOR_ONE,
        .colorBlendOp = VK_BLEND_OP_ADD,
        .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
        .alphaBlendOp = VK_BLEND_OP_ADD,
        .colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                          VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT,
    };
}

static VkPipelineRasterizationStateCreateInfo raster_state(const struct gpu_graphics_desc *d)
{
    return (VkPipelineRasterizationStateCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .depthClampEnable = d->depth_clamp,
        .polygonMode = VK_POLYGON_MODE_FILL,
        .depthBiasEnable = d->depth_bias_slope != 0,
        .depthBiasSlopeFactor = d->depth_bias_slope,
        .lineWidth = 1,
    };
}

VkResult pipeline_create_graphics(struct gpu *gpu, struct pipeline *p,
                                  const VkPipelineShaderStageCreateInfo *stages)
{
    static const VkDynamicState dynamic[] = { VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                              VK_DYNAMIC_STATE_CULL_MODE,
                                              VK_DYNAMIC_STATE_FRONT_FACE };
    const struct gpu_graphics_desc *d = &p->desc;
    bool depth = d->depth_format != GPU_FORMAT_NONE;
    VkFormat colors[MAX_COLORS];
    VkPipelineColorBlendAttachmentState blends[MAX_COLORS];
    for (int i = 0; i < p->color_count; i++) {
        colors[i] = format_of(d->color_formats[i])->vk;
        blends[i] = blend_state(d->blend);
    }
    VkPipelineRenderingCreateInfo rendering = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = (uint32_t)p->color_count,
        .pColorAttachmentFormats = colors,
        .depthAttachmentFormat = format_of(d->depth_format)->vk,
    };
    VkPipelineRasterizationStateCreateInfo raster = raster_state(d);
    return gpu->vk.CreateGraphicsPipelines(
        gpu->device, gpu->pipeline_cache, 1,
        &(VkGraphicsPipelineCreateInfo){
            .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
            .pNext = &rendering,
            .stageCount = (uint32_t)p->stage_count,
            .pStages = stages,
            .pVertexInputState =
                &(VkPipelineVertexInputStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO },
            .pInputAssemblyState =
                &(VkPipelineInputAssemblyStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
                    .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST },
            .pViewportState =
                &(VkPipelineViewportStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                    .viewportCount = 1,
                    .scissorCount = 1 },
            .pRasterizationState = &raster,
            .pMultisampleState =
                &(VkPipelineMultisampleStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                    .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT },
            .pDepthStencilState =
                &(VkPipelineDepthStencilStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                    .depthTestEnable = depth,
                    .depthWriteEnable = depth && d->depth_write,
                    .depthCompareOp = d->depth_compare == GPU_GREATER ? VK_COMPARE_OP_GREATER
                                                                      : VK_COMPARE_OP_ALWAYS },
            .pColorBlendState =
                &(VkPipelineColorBlendStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                    .attachmentCount = (uint32_t)p->color_count,
                    .pAttachments = blends },
            .pDynamicState =
                &(VkPipelineDynamicStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                    .dynamicStateCount = sizeof dynamic / sizeof *dynamic,
                    .pDynamicStates = dynamic },
            .layout = p->layout,
        },
        gpu->allocator, &p->handle);
}
