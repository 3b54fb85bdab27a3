// A thread waits for the signals that end the program. Unlike a handler it can lock a mutex and
// thus wait for the end of a write. The program's threads block these signals; those that a library
// started before main do not (OpenBLAS), and their handler passes a signal on to the waiting
// thread.
#include "interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>

static pthread_mutex_t writing = PTHREAD_MUTEX_INITIALIZER;
static sigset_t ending, recorded; // recorded: the first one only, while `catching`
static atomic_bool catching, caught;
static void (*clean_up)(void *user); // under the mutex, as is the next
static void *clean_user;

// Ends the program by the same signal, so that the parent sees it. The mutex stays locked.
static void *wait_for_the_end(void *unused)
{
    int number = 0;
    if (sigwait(&ending, &number) != 0) return unused;
    if (sigismember(&recorded, number) == 1 && atomic_exchange(&catching, false)) {
        atomic_store(&caught, true);
        if (sigwait(&ending, &number) != 0) return unused;
    }
    pthread_mutex_lock(&writing);
    if (clean_up) clean_up(clean_user);
    sigset_t one;
    sigemptyset(&one);
    sigaddset(&one, number);
    signal(number, SIG_DFL);
    raise(number);
    pthread_sigmask(SIG_UNBLOCK, &one, NULL);
    return unused;
}

static pthread_t waiting; // set before the handler is

// Async-signal-safe, as signal-safety(7) lists pthread_kill.
static void pass_on(int number)
{
    pthread_kill(waiting, number);
}

static void add_unless_ignored(int number)
{
    struct sigaction action;
    if (sigaction(number, NULL, &action) == 0 && action.sa_handler != SIG_IGN)
        sigaddset(&ending, number);
}

void interrupt_begin(bool term_is_recorded)
{
    sigemptyset(&ending);
    sigemptyset(&recorded);
    sigaddset(&recorded, SIGINT);
    sigaddset(&recorded, SIGUSR1);
    if (term_is_recorded) sigaddset(&recorded, SIGTERM);
    add_unless_ignored(SIGUSR1);
    add_unless_ignored(SIGINT);
    add_unless_ignored(SIGTERM);
    add_unless_ignored(SIGHUP);
    pthread_sigmask(SIG_BLOCK, &ending, NULL);
    if (pthread_create(&waiting, NULL, wait_for_the_end, NULL) != 0) {
        pthread_sigmask(SIG_UNBLOCK, &ending, NULL); // they end it at once, then
        return;
    }
    pthread_detach(waiting);
    for (int number = 1; number < NSIG; number++)
        if (sigismember(&ending, number) == 1) signal(number, pass_on);
}

void interrupt_catch(void)
{
    atomic_store(&catching, true);
}

bool interrupt_caught(void)
{
    return atomic_load(&caught);
}

// The thread that resets `catching` first decides what a concurrent signal does.
bool interrupt_let_go(void)
{
    return !atomic_exchange(&catching, false) || interrupt_caught();
}

void interrupt_clean_with(void (*clean)(void *user), void *user)
{
    pthread_mutex_lock(&writing);
    clean_up = clean;
    clean_user = user;
    pthread_mutex_unlock(&writing);
}

void interrupt_hold(void)
{
    pthread_mutex_lock(&writing);
}

void interrupt_release(void)
{
    pthread_mutex_unlock(&writing);
}
