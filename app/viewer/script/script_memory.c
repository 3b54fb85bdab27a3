// The command "memory": bytes on the device by owner, and those of the process in main memory.
#include "script_state.h"

#include "viewer/operations.h"

#ifdef __linux__
#include <unistd.h>
#endif
#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 33)
#include <malloc.h>
#define HAS_MALLINFO2
#endif
#endif

enum { MOST_OWNERS = 64 };

static json_t *resident_bytes(void)
{
#ifdef __linux__
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    const bool read = file && fscanf(file, "%*d %ld", &pages) == 1;
    if (file) fclose(file);
    if (read) return json_integer((json_int_t)pages * sysconf(_SC_PAGESIZE));
#endif
    return json_null();
}

// Allocated and not freed: without what the allocator keeps.
static json_t *heap_bytes(void)
{
#ifdef HAS_MALLINFO2
    const struct mallinfo2 heap = mallinfo2();
    return json_integer((json_int_t)(heap.uordblks + heap.hblkhd));
#else
    return json_null();
#endif
}

bool script_run_memory(const struct words *w)
{
    struct ag_memory owners[MOST_OWNERS];
    const int count = ag_device_memory(w->v->device, owners, MOST_OWNERS);
    json_t *list = json_object();
    json_int_t sum = 0;
    for (int i = 0; i < count && i < MOST_OWNERS; i++) {
        json_object_set_new(list, owners[i].owner, json_integer((json_int_t)owners[i].bytes));
        sum += (json_int_t)owners[i].bytes;
    }
    json_t *document = json_pack("{s:I, s:o, s:o, s:o}", "device_bytes", sum, "owners", list,
                                 "resident_bytes", resident_bytes(), "heap_bytes", heap_bytes());
    return script_done(w, viewer_write_json(w->v, w->rest, document, 0));
}
