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

TEST(hash128_depends_on_each_piece_and_where_it_ends)
{
    const struct hash128 none = { 0 };
    const struct hash128 ab_c = hash128_add_text(hash128_add_text(none, "ab"), "c");
    const struct hash128 a_bc = hash128_add_text(hash128_add_text(none, "a"), "bc");
    const struct hash128 ab_d = hash128_add_text(hash128_add_text(none, "ab"), "d");
    const struct hash128 ab_c_end = hash128_add_text(ab_c, "");
    CHECK(ab_c.low != a_bc.low && ab_c.high != a_bc.high);
    CHECK(ab_c.low != ab_d.low && ab_c.high != ab_d.high);
    CHECK(ab_c.low != ab_c_end.low && ab_c.high != ab_c_end.high);
}

TEST(hash128_is_printed_as_32_digits)
{
    char text[HASH128_TEXT];
    hash128_print((struct hash128){ 0x1, 0xfedcba9876543210 }, text);
    CHECK_STRING(text, "0000000000000001fedcba9876543210");
}
