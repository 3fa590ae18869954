#include <errno.h>
#ifdef __linux__
#include <malloc.h>
#endif
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"

static int processors(void)
{
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online < 1 ? 1 : online > THREADS_MOST ? THREADS_MOST : (int)online;
}

/* Whether the BLAS is called at all: not to read files and make pages of them. */
static int computes(const struct command *command, const struct command_entry *c)
{
    return c->flags & (READS_DECK | PARALLEL) && !command->study.merge && !command->study.summary;
}

static int run(struct command *command)
{
    const struct command_entry *c = command_find(command->name);
    int refused = arguments_refuse(command, c), parallel = c->flags & PARALLEL, asked = command->threads > 0;
    if (refused >= 0)
        return refused;
    if (!asked)
        command->threads = parallel ? processors() : 1;
    if (computes(command, c)) {
        int processes = c->run == command_study; /* each with an address space of its own */
        int room = build_make_room(processes ? 1 : command->threads, asked);
        if (!room)
            return EXIT_INTERNAL;
        command->threads = processes ? command->threads : room;
    }
    command_begin_head(command);
    build_set_threads(parallel ? 1 : command->threads);
    int code = c->flags & READS_DECK ? command_read_deck(command) : EXIT_DONE;
    if (code)
        return code;
    if (c->run != command_study) /* a study reads its decks itself */
        command_watch_signals();
    return c->run(command);
}

/* glibc raises the size from which a block is pages of its own to that of the largest block freed so far: matrices then stay in
 * the heap after their use and are cleared by hand where new pages are zero. The rest of the heap is kept: its end would come and
 * go with each pool. */
static void keep_large_blocks_apart(void)
{
#ifdef __GLIBC__
    (void)mallopt(M_MMAP_THRESHOLD, 1 << 20);
    (void)mallopt(M_TRIM_THRESHOLD, 1 << 26);
#endif
}

int main(int argc, char **argv)
{
    struct command command = {0};
    keep_large_blocks_apart();
    command_set_signals();
    if (terminal_open())
        return EXIT_INTERNAL;
    pool_open(&command.pool, NULL);
    message_open(&command.messages, &command.pool);
    int code = arguments_parse(&command, argc, argv);
    if (code < 0)
        code = run(&command);
    if (terminal_flush()) {
        terminal_say("rotid: cannot write to standard output: %s\n", strerror(errno));
        code = EXIT_INTERNAL;
    }
    rotid_deck_free(command.read);
    pool_close(&command.pool);
    return code;
}
