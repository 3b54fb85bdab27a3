// A bake file (safetensors). Every byte of the tensors that it offers is in memory.
#include "fuzz/fuzz.h"

#include "bake/safetensors.h"

#include <string.h>

static void read_all(const struct tensors *set)
{
    static volatile uint8_t byte;
    for (size_t i = 0; i < set->count; i++) {
        size_t bytes = 0;
        const struct tensor *tensor = &set->at[i];
        FUZZ_CHECK(tensor_extent(tensor->type, tensor->rank, tensor->shape, &bytes));
        FUZZ_CHECK(bytes == tensor->bytes);
        FUZZ_CHECK(tensors_find(set, tensor->name) == tensor);
        for (size_t k = 0; k < bytes; k++) byte = ((const uint8_t *)tensor->data)[k];
        (void)tensor_is_finite(tensor);
    }
    (void)byte;
    for (size_t i = 0; i < set->metadata_count; i++)
        FUZZ_CHECK(tensors_metadata(set, set->metadata[i].key));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct safetensors file;
    if (safetensors_read(fuzz_host(), fuzz_file(data, size, "safetensors"), &file)) {
        read_all(&file.set);
        safetensors_finish(fuzz_host(), &file);
    }
    return 0;
}
