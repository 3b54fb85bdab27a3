// afterglow-mpi: afterglow bake on several processes, as mpirun starts them. Exit status as that of
// afterglow, of rank 0.
#include "cli/program.h"
#include "mpi/placement.h"
#include "mpi/transport.h"

#include <mpi.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WHY_SIZE = 1024 };

// ---- the same command everywhere

// The version and the words of the command line, each with its zero.
static char *describe_call(int count, char **words, int *size)
{
    char version[32];
    snprintf(version, sizeof version, "%d", ag_version());
    size_t bytes = strlen(version) + 1;
    for (int i = 1; i < count; i++) bytes += strlen(words[i]) + 1;
    char *text = malloc(bytes), *at = text;
    if (!text) return NULL;
    at = stpcpy(at, version) + 1;
    for (int i = 1; i < count; i++) at = stpcpy(at, words[i]) + 1;
    *size = (int)bytes;
    return text;
}

// The first word that differs; "" where one has fewer.
static const char *different_word(const char *text, int size, const char *other, int other_size)
{
    int at = 0;
    while (at < size && at < other_size && strcmp(text + at, other + at) == 0)
        at += (int)strlen(text + at) + 1;
    return at < size ? text + at : "";
}

static void describe_difference(int rank, const char *ours, int our_size, const char *theirs,
                                int their_size, char why[WHY_SIZE])
{
    const char *our_word = different_word(ours, our_size, theirs, their_size);
    const char *their_word = different_word(theirs, their_size, ours, our_size);
    if (strcmp(ours, theirs) != 0)
        snprintf(why, WHY_SIZE, "rank %d is version %.20s of the program, rank 0 is version %.20s",
                 rank, theirs, ours);
    else
        snprintf(why, WHY_SIZE, "rank %d was given \"%.300s\" where rank 0 was given \"%.300s\"",
                 rank, their_word, our_word);
}

// Rank 0 compares; all get its finding. Texts have the size of the longest.
static bool agree(int rank, int ranks, int count, char **words, char why[WHY_SIZE])
{
    int size = 0, most = 0;
    char *own = describe_call(count, words, &size);
    MPI_Allreduce(&size, &most, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    char *padded = calloc((size_t)most + 1, 1);
    char *all = calloc((size_t)ranks, (size_t)most + 1);
    int *sizes = calloc((size_t)ranks, sizeof *sizes);
    if (!own || !padded || !all || !sizes) MPI_Abort(MPI_COMM_WORLD, FAILED);
    memcpy(padded, own, (size_t)size);
    MPI_Gather(&size, 1, MPI_INT, sizes, 1, MPI_INT, 0, MPI_COMM_WORLD);
    MPI_Gather(padded, most, MPI_BYTE, all, most, MPI_BYTE, 0, MPI_COMM_WORLD);
    why[0] = 0;
    for (int i = 1; rank == 0 && i < ranks && !why[0]; i++) {
        const char *theirs = all + (size_t)i * (size_t)most;
        if (sizes[i] != size || memcmp(theirs, own, (size_t)size) != 0)
            describe_difference(i, own, size, theirs, sizes[i], why);
    }
    MPI_Bcast(why, WHY_SIZE, MPI_BYTE, 0, MPI_COMM_WORLD);
    free(own);
    free(padded);
    free(all);
    free(sizes);
    return !why[0];
}

// ---- a rank

// Errors of other ranks are told to rank 0, which prints them.
static enum status run(int count, char **words, struct team *team, char why[WHY_SIZE])
{
    const int rank = team->ranks.rank;
    if (!agree(rank, team->ranks.count, count, words, why)) {
        if (rank == 0)
            wrong_usage("cannot run on %d ranks: %s; start all with the same command",
                        team->ranks.count, why);
        return WRONG_USAGE;
    }
    if (rank > 0) messages_keep(why, WHY_SIZE);
    return program_run(count, words, team);
}

int main(int count, char **words)
{
    char why[WHY_SIZE] = "";
    struct team team = { .threads = placement_share() };
    program_begin(true);
    MPI_Init(NULL, NULL);
    transport_begin(&team.ranks);
    const enum status status = run(count, words, &team, why);
    // A rank that was lost would be waited for.
    if (!transport_end(status == DONE ? "" : why)) {
        fflush(NULL);
        _exit(status);
    }
    MPI_Finalize();
    return team.ranks.rank == 0 ? (int)status : (int)DONE;
}
