// A thin coat over cmocka: tests register themselves, and each states a law in its name.
//
//     TEST(sh_rotate_preserves_band_energy) { CHECK_NEAR(a, b, 1e-5); }
//
// Link ag_test_framework and write no main.
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/host.h"

typedef void (*test_function)(void **state);
void test_register(const char *name, test_function function);
// A last check, run once after all tests, while every library is still whole (atexit may be too
// late for that).
void test_register_end(bool (*check)(void));

#define TEST(name)                                                                                 \
    static void test_##name(void **state);                                                         \
    __attribute__((constructor)) static void register_##name(void)                                 \
    {                                                                                              \
        test_register(#name, test_##name);                                                         \
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

// A host whose log goes to standard error when AFTERGLOW_TEST_VERBOSE is set and is remembered:
// test_last_message gives the newest error or warning ("" if none since test_forget_messages).
struct host *test_host(void);
const char *test_last_message(void);
void test_forget_messages(void);

// A path in a folder of this test run's own, removed at exit. Static storage, 16 in turn.
const char *test_path(const char *name);
// A real scene ("sponza.glb", "odd/truncated.glb"); skips the running test, visibly, where the
// scenes are absent.
const char *test_scene_path(const char *name);
