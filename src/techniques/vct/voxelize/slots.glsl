// Occupancy: a bit for each face of a voxel, and for each word the number of occupied faces before
// it. Both give the slot of an occupied face in compact buffers. Define VCT_SLOTS(name), the names
// of blocks and variables of this set, and VCT_SLOTS_BINDING, the first of two bindings. May be
// included for several sets.
layout(set = 0, binding = VCT_SLOTS_BINDING, scalar) readonly buffer VCT_SLOTS(mask)
{
    uint VCT_SLOTS(mask_words)[];
};
layout(set = 0, binding = VCT_SLOTS_BINDING + 1, scalar) readonly buffer VCT_SLOTS(word_offsets)
{
    uint VCT_SLOTS(offsets)[];
};

// Occupied faces of a voxel, a bit each.
uint VCT_SLOTS(faces)(uint voxel_index)
{
    return VCT_SLOTS(mask_words)[voxel_index >> 2] >> (8u * (voxel_index & 3u)) & 0xffu;
}

// VCT_NO_SLOT where the face is empty or beyond the capacity.
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
