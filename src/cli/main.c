#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "cli/arguments.h"

const struct command_entry command_table[] = {
    {"check", "parse a deck; mass, centre of mass, length, mesh, sensors, warnings", command_check, READS_DECK},
    {"modes", "frequencies and shapes, full and condensed, beside the measured ones", command_modes, READS_DECK},
    {"sensitivity", "how the modes depend on parameters (Table 1 and Figure 5 of the paper)", command_sensitivity, READS_DECK},
    {"identify", "fit the parameters of *IDENTIFY to the measured modes, NLopt beside it", command_identify, READS_DECK},
    {"diagnose", "what the model gets wrong, the cause, the extended model, the gain, the blind spots", command_diagnose,
     READS_DECK | PARALLEL},
    {"frf", "synthesised transfer functions with measured damping, beside measured ones; -o: as universal file", command_frf,
     READS_DECK | TAKES_OUTPUT},
    {"ema", "time records or transfer functions (58, 58b) to modes; -o: as universal file for *MEASURED", command_ema,
     PARALLEL | TAKES_OUTPUT},
    {"export", "the identified model for other programs: Matrix Market, Nastran DMIG, a ROSS script; --format, -o",
     command_export, READS_DECK | TAKES_OUTPUT},
    {"uff", "what a universal file holds, and what is doubtful in it; -o: ASCII to binary and back", command_uff, TAKES_OUTPUT},
    {"report", "results that were written with --json as a page with figures; -o: its folder", command_report,
     TAKES_OUTPUT | SEVERAL_FILES},
    {"study", "many runs from one plan, or of many decks, resumable; -o: the results", command_study,
     PARALLEL | TAKES_OUTPUT | SEVERAL_FILES},
    {NULL, NULL, NULL, 0},
};

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
    for (const struct command_entry *c = command_table; c->name; c++) {
        if (strcmp(command->name, c->name))
            continue;
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
        command->provenance =
            (struct provenance){command->name, ROTID_VERSION, build_commit, build_blas(), command->seed, command->threads};
        build_set_threads(parallel ? 1 : command->threads);
        int code = c->flags & READS_DECK ? command_read_deck(command) : EXIT_DONE;
        return code ? code : c->run(command);
    }
    return arguments_wrong(
        "%s is no command, expected check, modes, sensitivity, identify, diagnose, frf, ema, export, uff, report "
        "or study",
        command->name);
}

int main(int argc, char **argv)
{
    struct command command = {.seed = 1, .step = 0.01, .range = 0.5, .points = 11, .baseline = 1};
    command_watch_signals();
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
