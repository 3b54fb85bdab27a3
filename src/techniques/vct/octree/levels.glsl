// Nodes and bricks at each depth of the octree. Binding: VCT_SVO_LEVELS_BINDING.
layout(set = 0, binding = VCT_SVO_LEVELS_BINDING,
       scalar) VCT_SVO_LEVELS_ACCESS buffer vct_svo_levels
{
    vct_svo_level levels[];
};

// First node at a depth: the children of the bricks above. The root has a tile of its own.
uint svo_first_node(uint depth)
{
    return depth == 0u ? 0u : 8u * (levels[depth - 1u].first + 1u);
}

uint svo_node_count(uint depth)
{
    return depth == 0u ? 8u : 8u * levels[depth - 1u].count;
}
