#include <signal.h>
#include <time.h>
#include <unistd.h>

#include "cli/command.h"
#include "report/output.h"

#define SAME_NS 200000000L /* timeout(1) sends its signal to the process and to its group: two within 0.2 s are one request */

#define DEAF_S  1 /* after the signal: what has not asked by then is in a library */
#define GRACE_S 5 /* after the signal: what has asked brings its results together until then */

static volatile sig_atomic_t interrupted, noticed, ends_itself, seconds;
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

/* The first asks the computation to end; where that does not look, in a library or a file, the second ends the program. */
static void interrupt(int signal_number)
{
    if (!interrupted) {
        (void)clock_gettime(CLOCK_MONOTONIC, &first);
        interrupted = signal_number;
        if (ends_itself)
            (void)alarm(DEAF_S);
    } else if (since_first() >= SAME_NS) {
        end_by(signal_number);
    }
}

/* Once a second after the first signal: no file is left half-written. */
static void look_again(int unused)
{
    (void)unused;
    seconds++;
    if (!output_is_open() && (!noticed || seconds >= GRACE_S))
        end_by((int)interrupted);
    (void)alarm(DEAF_S);
}

void command_set_signals(void)
{
    struct sigaction ignore = {.sa_handler = SIG_IGN}, standard = {.sa_handler = SIG_DFL};
    (void)sigaction(SIGXFSZ, &ignore, NULL);   /* a file that may not grow is then an error like a full disk */
    (void)sigaction(SIGCHLD, &standard, NULL); /* who starts the program may ignore it, and then no child says how it ended */
}

void command_watch_signals(int computes)
{
    struct sigaction action = {.sa_handler = interrupt}, again = {.sa_handler = look_again, .sa_flags = SA_RESTART};
    ends_itself = computes;
    if (computes)
        (void)sigaction(SIGALRM, &again, NULL);
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
}

int command_cancelled(void *unused)
{
    (void)unused;
    if (interrupted)
        noticed = 1;
    return interrupted;
}
