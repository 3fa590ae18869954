#include <signal.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "cli/cli.h"

#define SAME_NS 200000000L /* timeout(1) sends its signal to the process and to its group: two within 0.2 s are one request */

/* What has not ended after the first time does so then, or at the end of a file that is being written: no file is left
 * half-written. */
#define PATIENCE_US 900000
#define AGAIN_US    50000

static volatile sig_atomic_t interrupted;
static struct timespec first;

static long since_first(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec - first.tv_sec > 1 ? SAME_NS : 1000000000L * (now.tv_sec - first.tv_sec) + now.tv_nsec - first.tv_nsec;
}

static void end_by(int signal_number)
{
    (void)signal(signal_number, SIG_DFL);
    (void)raise(signal_number);
}

/* The first signal asks the command to end and sets the clock of end_late; the second one ends the program. */
static void interrupt(int signal_number)
{
    static const struct itimerval clock = {{0, AGAIN_US}, {0, PATIENCE_US}};
    if (!interrupted) {
        (void)clock_gettime(CLOCK_MONOTONIC, &first);
        interrupted = signal_number;
        (void)setitimer(ITIMER_REAL, &clock, NULL);
    } else if (since_first() >= SAME_NS) {
        end_by(signal_number);
    }
}

static void end_late(int unused)
{
    (void)unused;
    if (!output_is_open())
        end_by((int)interrupted);
}

void command_set_signals(void)
{
    struct sigaction ignore = {.sa_handler = SIG_IGN}, standard = {.sa_handler = SIG_DFL};
    (void)sigaction(SIGXFSZ, &ignore, NULL);   /* a file that may not grow is then an error like a full disk */
    (void)sigaction(SIGCHLD, &standard, NULL); /* who starts the program may ignore it, and then no child says how it ended */
}

void command_watch_signals(void)
{
    struct sigaction action = {.sa_handler = interrupt}, late = {.sa_handler = end_late, .sa_flags = SA_RESTART};
    (void)sigaction(SIGALRM, &late, NULL);
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
}

int command_cancelled(void *unused)
{
    (void)unused;
    return interrupted;
}
