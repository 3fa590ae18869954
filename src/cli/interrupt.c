#include <signal.h>
#include <time.h>

#include "cli/command.h"

#define SAME_NS 200000000L /* timeout(1) sends its signal to the process and to its group: two within 0.2 s are one request */

static volatile sig_atomic_t interrupted;
static struct timespec first;

static long since_first(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec - first.tv_sec > 1 ? SAME_NS : 1000000000L * (now.tv_sec - first.tv_sec) + now.tv_nsec - first.tv_nsec;
}

/* The first asks the computation to end; where that does not look, in a library or a file, the second ends the program. */
static void interrupt(int signal_number)
{
    if (!interrupted) {
        (void)clock_gettime(CLOCK_MONOTONIC, &first);
        interrupted = 1;
    } else if (since_first() >= SAME_NS) {
        (void)signal(signal_number, SIG_DFL);
        (void)raise(signal_number);
    }
}

void command_watch_signals(void)
{
    struct sigaction action = {.sa_handler = interrupt}, standard = {.sa_handler = SIG_DFL};
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
    (void)sigaction(SIGCHLD, &standard, NULL); /* who starts the program may ignore it, and then no child says how it ended */
}

int command_cancelled(void *unused)
{
    (void)unused;
    return interrupted;
}
