// Messages between ranks. A long one is sent in pieces, since MPI counts bytes as int.
#include "mpi/transport.h"

#include <mpi.h>

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { TAG_PIECE = 1, TAG_LAST, TAG_END }; // the last piece of a message; a process has ended
enum { PIECE_BYTES = 1 << 30, HOST_SIZE = 256 };
static const double END_S = 15.0, LOOK_S = 1.0;

struct sending {
    struct sending *next;
    MPI_Request request;
    char data[];
};

// A process of this node, whose end can be seen.
struct process {
    char host[HOST_SIZE];
    long pid;
};

struct peer {
    char *data; // pieces of the message that is arriving
    size_t size;
    bool ended; // it has said so, or it is dead
    bool dead;
    long pid; // 0: of another node
};

static struct {
    int rank, count;
    struct peer *peers;
    struct sending *sending;
    char *received; // the message that was returned last
    double looked_s;
} state;

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// ---- sending

static void free_sent(void)
{
    for (struct sending **at = &state.sending; *at;) {
        struct sending *one = *at;
        int done = 0;
        MPI_Test(&one->request, &done, MPI_STATUS_IGNORE);
        if (!done) {
            at = &one->next;
            continue;
        }
        *at = one->next;
        free(one);
    }
}

static bool send_piece(int to, int tag, const char *data, size_t bytes)
{
    struct sending *one = malloc(sizeof *one + bytes);
    if (!one) return false;
    if (bytes > 0) memcpy(one->data, data, bytes);
    if (MPI_Isend(one->data, (int)bytes, MPI_BYTE, to, tag, MPI_COMM_WORLD, &one->request) !=
        MPI_SUCCESS) {
        free(one);
        return false;
    }
    one->next = state.sending;
    state.sending = one;
    return true;
}

static bool send_message(void *user, int to, const void *data, size_t bytes)
{
    (void)user;
    const char *at = data;
    if (state.peers[to].ended) return false;
    free_sent();
    for (; bytes > PIECE_BYTES; at += PIECE_BYTES, bytes -= PIECE_BYTES)
        if (!send_piece(to, TAG_PIECE, at, PIECE_BYTES)) return false;
    return send_piece(to, TAG_LAST, at, bytes);
}

// ---- receiving

// Appends a piece that has arrived.
static bool receive_piece(const MPI_Status *status)
{
    struct peer *peer = &state.peers[status->MPI_SOURCE];
    int bytes = 0;
    MPI_Get_count(status, MPI_BYTE, &bytes);
    char *data = realloc(peer->data, peer->size + (size_t)bytes + 1);
    if (!data) return false;
    peer->data = data;
    MPI_Recv(data + peer->size, bytes, MPI_BYTE, status->MPI_SOURCE, status->MPI_TAG,
             MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    peer->size += (size_t)bytes;
    return true;
}

static void take_from(struct peer *peer, const void **data, size_t *bytes)
{
    free(state.received);
    state.received = peer->data;
    *data = peer->data;
    *bytes = peer->size;
    peer->data = NULL;
    peer->size = 0;
}

// A process of this node that was killed, where the MPI does not end the others.
static int find_dead(void)
{
    if (now_s() - state.looked_s < LOOK_S) return -1;
    state.looked_s = now_s();
    for (int rank = 0; rank < state.count; rank++) {
        const struct peer *peer = &state.peers[rank];
        if (rank != state.rank && !peer->ended && peer->pid > 0 && kill((pid_t)peer->pid, 0) != 0 &&
            errno == ESRCH)
            return rank;
    }
    return -1;
}

static enum ag_bake_news receive_message(void *user, int *from, const void **data, size_t *bytes)
{
    MPI_Status status;
    int some = 0;
    (void)user;
    free_sent();
    for (;;) {
        MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &some, &status);
        if (!some) break;
        *from = status.MPI_SOURCE;
        if (!receive_piece(&status)) return AG_BAKE_NOTHING;
        if (status.MPI_TAG == TAG_PIECE) continue;
        take_from(&state.peers[*from], data, bytes);
        if (status.MPI_TAG == TAG_LAST) return AG_BAKE_MESSAGE;
        state.peers[*from].ended = true;
        return AG_BAKE_LOST;
    }
    const int dead = find_dead();
    if (dead < 0) return AG_BAKE_NOTHING;
    state.peers[dead].ended = state.peers[dead].dead = true;
    *from = dead;
    *bytes = 0;
    return AG_BAKE_LOST;
}

// ---- the world

static void find_processes(void)
{
    struct process own = { .pid = (long)getpid() };
    struct process *all = calloc((size_t)state.count, sizeof *all);
    gethostname(own.host, sizeof own.host - 1);
    if (!all) return;
    MPI_Allgather(&own, (int)sizeof own, MPI_BYTE, all, (int)sizeof own, MPI_BYTE, MPI_COMM_WORLD);
    for (int rank = 0; rank < state.count; rank++)
        if (strcmp(all[rank].host, own.host) == 0) state.peers[rank].pid = all[rank].pid;
    free(all);
}

void transport_begin(struct ag_bake_team *out)
{
    MPI_Comm_rank(MPI_COMM_WORLD, &state.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &state.count);
    state.peers = calloc((size_t)state.count, sizeof *state.peers);
    if (!state.peers) MPI_Abort(MPI_COMM_WORLD, 1);
    find_processes();
    ag_bake_team_default(out);
    out->rank = state.rank;
    out->count = state.count;
    out->send = send_message;
    out->receive = receive_message;
}

// Rank 0 has to do with all others, those with it alone.
static bool all_have_ended(void)
{
    if (state.rank > 0) return state.peers[0].ended;
    for (int rank = 1; rank < state.count; rank++)
        if (!state.peers[rank].ended) return false;
    return true;
}

static bool some_are_dead(void)
{
    for (int rank = 0; rank < state.count; rank++)
        if (state.peers[rank].dead) return true;
    return false;
}

static void say_end(const char *why)
{
    if (state.rank > 0) send_piece(0, TAG_END, why, strlen(why));
    for (int rank = 1; state.rank == 0 && rank < state.count; rank++)
        if (!state.peers[rank].dead) send_piece(rank, TAG_END, "", 0);
}

static void free_all(void)
{
    for (int rank = 0; rank < state.count; rank++) free(state.peers[rank].data);
    free(state.peers);
    free(state.received);
    state.peers = NULL;
    state.received = NULL;
}

bool transport_end(const char *why)
{
    const double begun = now_s();
    say_end(why);
    while ((!all_have_ended() || state.sending) && now_s() - begun < END_S) {
        int from;
        const void *data;
        size_t bytes;
        while (receive_message(NULL, &from, &data, &bytes) != AG_BAKE_NOTHING) continue;
        nanosleep(&(struct timespec){ .tv_nsec = 2000000 }, NULL);
    }
    const bool ok = all_have_ended() && !state.sending && !some_are_dead();
    if (ok) free_all();
    return ok;
}
