// The share of cores, from the variables that mpirun and Slurm set.
#include "mpi/placement.h"

#include <omp.h>
#include <sched.h>
#include <stdlib.h>
#include <unistd.h>

static int positive(const char *name)
{
    const char *text = getenv(name);
    const long value = text ? strtol(text, NULL, 10) : 0;
    return value > 0 && value < 1 << 20 ? (int)value : 0;
}

static int ranks_of_node(void)
{
    static const char *const names[] = { "OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS",
                                         "SLURM_NTASKS_PER_NODE" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (positive(names[i]) > 0) return positive(names[i]);
    return 1;
}

static int allowed_cores(void)
{
    cpu_set_t set;
    CPU_ZERO(&set);
    return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

// The system keeps those that a control group allows.
static void allow_all(void)
{
    cpu_set_t all;
    CPU_ZERO(&all);
    for (int cpu = 0; cpu < CPU_SETSIZE; cpu++) CPU_SET(cpu, &all);
    sched_setaffinity(0, sizeof all, &all);
}

int placement_share(void)
{
    cpu_set_t bound;
    CPU_ZERO(&bound);
    sched_getaffinity(0, sizeof bound, &bound);
    allow_all();
    const int cores = allowed_cores(), wanted = positive("OMP_NUM_THREADS");
    int share = cores / ranks_of_node();
    if (share < 1) share = 1;
    if (CPU_COUNT(&bound) == share) sched_setaffinity(0, sizeof bound, &bound); // as mpirun chose
    if (wanted > 0 && wanted < share) share = wanted;
    omp_set_num_threads(share);
    return share;
}
