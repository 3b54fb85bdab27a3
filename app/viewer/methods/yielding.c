#include "yielding.h"

#include <sys/resource.h>
#ifdef __linux__
#include <sys/syscall.h>
#include <unistd.h>
#endif

enum { NICENESS = 15 }; // a thirtieth of the interface's share

void thread_yields(void)
{
#ifdef __linux__ // where a niceness is a thread's
    setpriority(PRIO_PROCESS, (id_t)syscall(SYS_gettid), NICENESS);
#endif
}
