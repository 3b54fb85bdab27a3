#include "paper_ort/copy.h"

#include "bench.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_THREADS = 256, LANES = 8, LINE = 64, CACHES = 256 << 20 };

struct work {
    pthread_barrier_t start, end;
    unsigned char *from, *to;  // to NULL: reading
    unsigned char *other;      // CACHES bytes, which are read before each run
    size_t share, other_share; // bytes of a thread
    int runs;
};

struct worker {
    struct work *work;
    pthread_t thread;
    int index;
    uint64_t sum;
};

static volatile uint64_t sink; // keeps the compiler from leaving the reads out

int copy_threads(void)
{
    const char *text = getenv("LP_NUM_THREADS");
    int threads = text ? atoi(text) : (int)sysconf(_SC_NPROCESSORS_ONLN);
    if (threads < 1) threads = 1;
    return threads < MOST_THREADS ? threads : MOST_THREADS;
}

static uint64_t sum_of(const unsigned char *from, size_t bytes)
{
    uint64_t sums[LANES] = { 0 }, sum = 0;
    const uint64_t *words = (const uint64_t *)(const void *)from;
    for (size_t i = 0; i < bytes / sizeof *words; i += LANES)
        for (size_t k = 0; k < LANES; k++) sums[k] += words[i + k];
    for (int k = 0; k < LANES; k++) sum += sums[k];
    return sum;
}

// Nothing of the run before stays in caches: frames of other renderers are between two gathers.
static void clear_caches(struct worker *worker)
{
    const struct work *work = worker->work;
    worker->sum +=
        sum_of(work->other + work->other_share * (size_t)worker->index, work->other_share);
}

static void work_on_share(struct worker *worker)
{
    const struct work *work = worker->work;
    const size_t first = work->share * (size_t)worker->index;
    if (work->to)
        memcpy(work->to + first, work->from + first, work->share);
    else
        worker->sum += sum_of(work->from + first, work->share);
}

static void *run_worker(void *user)
{
    struct worker *worker = user;
    for (int r = 0; r < worker->work->runs; r++) {
        clear_caches(worker);
        pthread_barrier_wait(&worker->work->start);
        work_on_share(worker);
        pthread_barrier_wait(&worker->work->end);
    }
    return NULL;
}

// The calling thread is worker 0.
static double time_runs(struct worker *first)
{
    struct work *work = first->work;
    double least = 0.0;
    for (int r = 0; r < work->runs; r++) {
        clear_caches(first);
        pthread_barrier_wait(&work->start);
        const double begun = bench_now_ms();
        work_on_share(first);
        pthread_barrier_wait(&work->end);
        passes_keep_least(&least, bench_now_ms() - begun);
    }
    return least;
}

static double measure(struct work *work, int threads)
{
    struct worker workers[MOST_THREADS];
    pthread_barrier_init(&work->start, NULL, (unsigned)threads);
    pthread_barrier_init(&work->end, NULL, (unsigned)threads);
    for (int i = 0; i < threads; i++) {
        workers[i] = (struct worker){ .work = work, .index = i };
        if (i > 0 && pthread_create(&workers[i].thread, NULL, run_worker, &workers[i]) != 0)
            abort(); // else the others would wait for it
    }
    const double least = time_runs(&workers[0]);
    uint64_t sum = workers[0].sum;
    for (int i = 1; i < threads; i++) {
        pthread_join(workers[i].thread, NULL);
        sum += workers[i].sum;
    }
    pthread_barrier_destroy(&work->start);
    pthread_barrier_destroy(&work->end);
    sink = sum;
    return least;
}

static size_t share_of(size_t bytes, int threads)
{
    return (bytes / (size_t)threads + LINE - 1) / LINE * LINE;
}

// Pages are there before the first run.
static unsigned char *allocate(size_t share, int threads, int value)
{
    const size_t bytes = share * (size_t)threads;
    unsigned char *out = aligned_alloc(LINE, bytes);
    if (out) memset(out, value, bytes);
    return out;
}

bool copy_measure(size_t bytes, int threads, int runs, struct copy_time *out)
{
    struct work work = { .share = share_of(bytes, threads),
                         .other_share = share_of(CACHES, threads),
                         .runs = runs };
    unsigned char *to = allocate(work.share, threads, 4);
    work.from = allocate(work.share, threads, 2);
    work.other = allocate(work.other_share, threads, 6);
    const bool ok = work.from && to && work.other;
    if (ok) {
        out->read_ms = measure(&work, threads);
        work.to = to;
        out->copy_ms = measure(&work, threads);
    }
    free(work.from);
    free(work.other);
    free(to);
    return ok;
}
