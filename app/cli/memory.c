// The memory limit of the process, and estimates compared with it.
#include "memory.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { TEXT_SIZE = 4096 + 256 };

// The limit of the control group (v2) that the process is in, as its namespace shows it.
static uint64_t group_limit(void)
{
    unsigned long long bytes = 0;
    FILE *file = fopen("/sys/fs/cgroup/memory.max", "re");
    if (!file) file = fopen("/sys/fs/cgroup/memory/memory.limit_in_bytes", "re");
    if (!file) return UINT64_MAX;
    const bool limited = fscanf(file, "%llu", &bytes) == 1; // "max": no limit
    fclose(file);
    return limited ? bytes : UINT64_MAX;
}

static uint64_t machine_limit(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), bytes = sysconf(_SC_PAGESIZE);
    return pages > 0 && bytes > 0 ? (uint64_t)pages * (uint64_t)bytes : UINT64_MAX;
}

static uint64_t address_limit(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return UINT64_MAX;
    return limit.rlim_cur;
}

uint64_t memory_limit(void)
{
    uint64_t least = machine_limit();
    if (group_limit() < least) least = group_limit();
    if (address_limit() < least) least = address_limit();
    return least == UINT64_MAX ? 0 : least;
}

uint64_t memory_resident(void)
{
    unsigned long long all = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (!file) return memory_peak();
    const bool known = fscanf(file, "%llu %llu", &all, &resident) == 2;
    fclose(file);
    const long page = sysconf(_SC_PAGESIZE);
    return known && page > 0 ? resident * (uint64_t)page : memory_peak();
}

uint64_t memory_peak(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_maxrss << 10 : 0;
}

enum status memory_check(uint64_t bytes, const char *what, const char *remedy)
{
    const uint64_t limit = memory_limit();
    detail("%s: about %.2f GB of memory", what, (double)bytes * 1e-9);
    if (limit == 0 || bytes <= limit) return DONE;
    return fail("cannot %s: it takes about %.1f GB of memory, this machine allows %.1f GB; %s",
                what, (double)bytes * 1e-9, (double)limit * 1e-9, remedy);
}

enum status memory_check_size(const char *command, const char *scene, int width, int height,
                              uint64_t bytes_per_pixel, uint64_t more)
{
    char what[TEXT_SIZE];
    snprintf(what, sizeof what, "%s %s at %dx%d", command, scene, width, height);
    const uint64_t pixels = (uint64_t)width * (uint64_t)height;
    return memory_check(pixels * bytes_per_pixel + more, what, "choose a smaller --size");
}
