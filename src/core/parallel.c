// Parallel loops on OpenMP threads; without OpenMP (AFTERGLOW_OPENMP=OFF) on the calling thread.
#include "core/parallel.h"

#include <limits.h>
#ifdef _OPENMP
#include <omp.h>
#else
static int omp_get_max_threads(void)
{
    return 1;
}
static void omp_set_num_threads(int threads)
{
    (void)threads;
}
#endif

// GCC's OpenMP library is not instrumented for the thread sanitizer. These annotations declare its
// fork and join: the caller happens before each call of the body, and each call before the return.
#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#define ORDER_BEFORE(tag) __tsan_release(tag)
#define ORDER_AFTER(tag)  __tsan_acquire(tag)
#define NOT_INSTRUMENTED  __attribute__((no_sanitize("thread")))
#else
#define ORDER_BEFORE(tag) ((void)(tag))
#define ORDER_AFTER(tag)  ((void)(tag))
#define NOT_INSTRUMENTED
#endif

struct loop {
    void (*body)(void *user, size_t i);
    void *user;
    char begun, done; // only their addresses are used
};

static void begin(struct loop *loop)
{
    ORDER_BEFORE(&loop->begun);
}

__attribute__((noinline)) static void call(struct loop *loop, size_t i)
{
    ORDER_AFTER(&loop->begun);
    loop->body(loop->user, i);
    ORDER_BEFORE(&loop->done);
}

static void end(struct loop *loop)
{
    ORDER_AFTER(&loop->done);
}

NOT_INSTRUMENTED static void call_all(struct loop *loop, int threads, size_t count, int grain)
{
    (void)threads; // without OpenMP
    (void)grain;
    // A single chunk runs on the calling thread.
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, grain) if (count > (size_t)grain) num_threads(threads)
#endif
    for (size_t i = 0; i < count; i++) call(loop, i);
}

void parallel_for_on(int threads, size_t count, size_t grain, void (*body)(void *user, size_t i),
                     void *user)
{
    struct loop loop = { .body = body, .user = user };
    begin(&loop);
    call_all(&loop, threads < 1 ? 1 : threads, count,
             grain < 1         ? 1
             : grain > INT_MAX ? INT_MAX
                               : (int)grain);
    end(&loop);
}

void parallel_for(size_t count, size_t grain, void (*body)(void *user, size_t i), void *user)
{
    parallel_for_on(parallel_threads(), count, grain, body, user);
}

int parallel_threads(void)
{
    return omp_get_max_threads();
}

void parallel_limit(int threads)
{
    if (threads < omp_get_max_threads()) omp_set_num_threads(threads < 1 ? 1 : threads);
}
