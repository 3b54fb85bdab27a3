// Which voxels hold a surface: a bit each, and for each word of bits the number of voxels before
// it. Together they give every occupied voxel a slot in compact buffers. Define VCT_SLOTS(name) as
// what a block or variable of this set is called, and VCT_SLOTS_BINDING as the first of two
// bindings; may be included for several sets.
layout(set = 0, binding = VCT_SLOTS_BINDING, scalar) readonly buffer VCT_SLOTS(mask)
{
    uint VCT_SLOTS(mask_words)[];
};
layout(set = 0, binding = VCT_SLOTS_BINDING + 1, scalar) readonly buffer VCT_SLOTS(word_offsets)
{
    uint VCT_SLOTS(offsets)[];
};

// VCT_NO_SLOT where the voxel is empty, or there was no room for it.
uint VCT_SLOTS(slot)(uint index)
{
    uint word = VCT_SLOTS(mask_words)[index >> 5];
    uint bit = 1u << (index & 31u);
    if ((word & bit) == 0u) return VCT_NO_SLOT;
    uint slot = VCT_SLOTS(offsets)[index >> 5] + uint(bitCount(word & (bit - 1u)));
    return slot < vct.capacity ? slot : VCT_NO_SLOT;
}
#undef VCT_SLOTS
#undef VCT_SLOTS_BINDING
