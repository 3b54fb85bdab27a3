// Content hashes.
#include "framework/test.h"

#include "core/hash.h"

#include <string.h>

TEST(hash_of_empty_input_is_the_published_value)
{
    CHECK(hash_bytes(NULL, 0, 0) == UINT64_C(0x2d06800538d394c2));
}

TEST(hash_depends_on_each_byte_the_size_and_the_seed)
{
    unsigned char bytes[1000];
    for (size_t size = 1; size <= sizeof bytes; size += 37) {
        memset(bytes, 0, sizeof bytes);
        uint64_t plain = hash_bytes(bytes, size, 0);
        CHECK(hash_bytes(bytes, size, 0) == plain);
        CHECK(hash_bytes(bytes, size, 1) != plain);
        CHECK(hash_bytes(bytes, size - 1, 0) != plain);
        for (size_t i = 0; i < size; i++) {
            bytes[i] = 1;
            CHECK(hash_bytes(bytes, size, 0) != plain);
            bytes[i] = 0;
        }
    }
}

TEST(hash_does_not_depend_on_alignment)
{
    char buffer[300];
    for (int i = 0; i < 300; i++) buffer[i] = (char)(i * 31);
    for (size_t shift = 1; shift < 16; shift++) {
        char moved[300];
        memcpy(moved + shift, buffer, 256);
        CHECK(hash_bytes(moved + shift, 256, 5) == hash_bytes(buffer, 256, 5));
    }
}
