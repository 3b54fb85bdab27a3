// Tables of objects: their limit.
#include "framework/gpu_test.h"

#include <stddef.h>

struct state {
    gpu_buffer buffer[2];
};

static void add_empty(struct gpu_objects *table, int count)
{
    for (int i = 0; i < count; i++) GPU_ADD(table, 0, { GPU_BUFFER, "test.empty", .bytes = 0 });
}

TEST_GPU(a_table_beyond_its_limit_is_refused)
{
    static struct gpu_objects table;
    struct state state = { 0 };
    const struct gpu_object buffer = { GPU_BUFFER, "test.buffer", offsetof(struct state, buffer[1]),
                                       .bytes = 64 };
    for (int beyond = 0; beyond < 3; beyond++) {
        gpu_objects_clear(&table);
        gpu_objects_add(&table, 0, &buffer, 1);
        add_empty(&table, GPU_MAX_OBJECTS - 1 + beyond);
        assert_int_equal(table.count, GPU_MAX_OBJECTS);
        assert_int_equal(gpu_objects_bytes(&table), 64);
        assert_int_equal(gpu_objects_create(gpu, &table, 0, &state), beyond == 0);
        assert_int_equal(state.buffer[1].id != 0, beyond == 0);
        gpu_objects_destroy(gpu, &table, &state);
    }
    CHECK_STRING(test_last_message(), "gpu objects: 290, the limit is 288");
    assert_int_equal(test_host()->failure, FAIL_UNSUPPORTED);
}
