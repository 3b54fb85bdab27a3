// A block map of modular radiance transfer, as JSON.
#include "fuzz/fuzz.h"

#include "techniques/mrt/level/block_map.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct mrt_block_map map;
    if (!mrt_block_map_read(fuzz_host(), fuzz_file(data, size, "json"), &map)) return 0;
    FUZZ_CHECK(mrt_block_map_check("fuzz", &map));
    (void)mrt_block_map_is_plane(&map);
    mrt_block_map_finish(&map);
    return 0;
}
