// A thin wrapper of cmocka: tests register themselves, and each name states a property.
//
//     TEST(sh_rotate_preserves_band_energy) { CHECK_NEAR(a, b, 1e-5); }
//
// Link ag_test_framework and write no main. A program has the tests of several files
// test_<name>.c:
//
//     PROGRAM [NAME [PATTERN]]     those of a file, of which the names match
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/host.h"

#undef skip // test_skip takes its place

typedef void (*test_function)(void **state);
void test_register(const char *file, const char *name, test_function function);
// A final check, run once after all tests, while all libraries are still loaded (unlike atexit).
void test_register_end(bool (*check)(void));

#define TEST(name)                                                                                 \
    static void test_##name(void **state);                                                         \
    __attribute__((constructor)) static void register_##name(void)                                 \
    {                                                                                              \
        test_register(__FILE__, #name, test_##name);                                               \
    }                                                                                              \
    static void test_##name(void **state __attribute__((unused)))

// |a − b| ≤ tolerance; prints both values. NaN fails.
#define CHECK_NEAR(a, b, tolerance)                                                                \
    test_near((double)(a), (double)(b), (double)(tolerance), #a, #b, __FILE__, __LINE__)
// |a − b| ≤ tolerance · max(|a|, |b|)
#define CHECK_RELATIVE(a, b, tolerance)                                                            \
    test_relative((double)(a), (double)(b), (double)(tolerance), #a, #b, __FILE__, __LINE__)
#define CHECK(condition)   test_check((condition), #condition, __FILE__, __LINE__)
#define CHECK_STRING(a, b) assert_string_equal((a), (b))

void test_near(double a, double b, double tolerance, const char *a_text, const char *b_text,
               const char *file, int line);
void test_relative(double a, double b, double tolerance, const char *a_text, const char *b_text,
                   const char *file, int line);
void test_check(bool condition, const char *text, const char *file, int line);

// Ends the running test as skipped. Reasons are counted: static storage, without commas, the same
// for all tests that lack the same thing.
__attribute__((noreturn)) void test_skip(const char *reason);

// A locale with a decimal comma until setlocale(LC_ALL, "C"). Reports the running test as skipped
// where there is none.
void test_use_decimal_comma(void);

// Factor of time limits on a loaded machine, from AFTERGLOW_TEST_TIME_FACTOR: at least 1.
double test_time_factor(void);
void test_pause_ms(double ms);

// A host that stores the newest error or warning (test_last_message; "" after
// test_forget_messages). AFTERGLOW_TEST_VERBOSE sends its log to standard error too.
struct host *test_host(void);
const char *test_last_message(void);
void test_forget_messages(void);

// The importer program that was built.
const char *test_importer(void);

// A path in a temporary folder that is removed at exit. Static storage, valid for 16 calls.
const char *test_path(const char *name);
// The path at which tests keep a bake of that key: in the folder of test_path, or in
// AFTERGLOW_TEST_BAKES, which ./check makes and removes. Static storage, as of test_path.
const char *test_bake_path(const char *key);
// The path of a test scene ("sponza.glb", "odd/truncated.glb"). Reports the running test as skipped
// where it is absent.
const char *test_scene_path(const char *name);
