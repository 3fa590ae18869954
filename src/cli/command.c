#include "cli/cli.h"

#include <unistd.h>

void command_print_messages(struct command *command)
{
    static const char *const words[] = {"note: ", "warning: ", ""};
    for (; command->printed < command->messages.count; command->printed++) {
        const rotid_message *m = &command->messages.item[command->printed];
        if (m->severity != SEVERITY_ERROR && (command->quiet || (m->severity == SEVERITY_NOTE && !command->verbose)))
            continue;
        terminal_mark(TERMINAL_BOLD);
        if (m->file)
            terminal_say("%s:%d:%d: ", m->file, m->line, m->column);
        else if (m->severity == SEVERITY_ERROR && command->deck && strncmp(m->text, command->deck, strlen(command->deck)) != 0)
            terminal_say("%s: ", command->deck);
        terminal_mark(TERMINAL_PLAIN);
        terminal_mark(m->severity == SEVERITY_ERROR     ? TERMINAL_ERROR
                      : m->severity == SEVERITY_WARNING ? TERMINAL_WARNING
                                                        : TERMINAL_PLAIN);
        if (m->severity != SEVERITY_ERROR) {
            terminal_say("%s", words[m->severity]);
            terminal_mark(TERMINAL_PLAIN);
        }
        terminal_say("%s\n", m->text);
        terminal_mark(TERMINAL_PLAIN);
    }
    if (command->messages.errors > MESSAGE_LIMIT)
        terminal_say("%d errors in all, the first %d are shown\n", command->messages.errors, MESSAGE_LIMIT);
}

int command_fail(struct command *command, int status)
{
    if (command_cancelled(NULL)) { /* what failed did so for the signal: a read that it ended has no error of its own */
        return terminal_end(EXIT_DOUBTFUL, "rotid: interrupted\n");
    }
    if (command->job)
        check_sections(command->job, status, &command->messages);
    if (command->job &&
        !command->messages.errors) /* no part of the deck is known to be the reason: its first line stands for all */
        message_add(&command->messages, SEVERITY_ERROR, command->job->deck, 1, 1, "%s", rotid_status_text(status));
    command_print_messages(command);
    if (!command->messages.errors)
        terminal_say("rotid: %s: %s\n", command->deck ? command->deck : command->file[0], rotid_status_text(status));
    int of_input = status == ROTID_ERROR_SYNTAX || status == ROTID_ERROR_SECTION || status == ROTID_ERROR_ARGUMENT ||
                   status == ROTID_ERROR_IO || status == ROTID_ERROR_UNPAIRED || status == ROTID_ERROR_STIFFNESS ||
                   status == ROTID_ERROR_SLAVE || status == ROTID_ERROR_MASS;
    return of_input ? EXIT_USAGE : EXIT_INTERNAL;
}

int command_fail_with(struct command *command, int status, const char *failure)
{
    /* a failure that names no place is of the whole deck, which its first line stands for */
    int placed = !command->job || !strncmp(failure, command->job->deck, strlen(command->job->deck));
    if (*failure && strcmp(failure, rotid_status_text(status)) != 0)
        message_add(&command->messages, SEVERITY_ERROR, placed ? NULL : command->job->deck, !placed, !placed, "%s", failure);
    return command_fail(command, status);
}

int command_wants_table(const struct command *command)
{
    return !command->quiet && !(command->json && !strcmp(command->json, "-"));
}

struct screen command_screen(struct command *command)
{
    return (struct screen){terminal_out(), &command->pool, command->verbose, SCREEN_WIDTH};
}

void command_show(struct command *command, const struct result *result, screen_of *show)
{
    const struct screen to = command_screen(command);
    if (!command_wants_table(command))
        return;
    screen_result(&to, result, show);
    screen_notes(&to, &command->messages);
}

/* Writes text (may be NULL: out of memory) to a file; `code` unless that fails. */
static int command_write_file(struct command *command, const char *path, const char *text, int code)
{
    if (!text)
        return command_fail(command, ROTID_ERROR_MEMORY);
    int status = output_write(path, text);
    if (!status)
        return code;
    return terminal_end(EXIT_INTERNAL, "rotid: cannot write %s: %s\n", path, output_error());
}

int command_write_deck(struct command *command, const char *text, int code)
{
    char *placed;
    int status = deck_place(&command->pool, command->deck, text, command->extended, &command->messages, &placed);
    if (status == ROTID_ERROR_MEMORY)
        return command_fail(command, status);
    if (!status)
        return command_write_file(command, command->extended, placed, code);
    command_print_messages(command);
    return terminal_end(EXIT_INTERNAL, "rotid: %s is not written: %s\n", command->extended,
                        status == ROTID_ERROR_IO ? "there is no such folder" : "it would be read as something else there");
}

void command_begin_head(struct command *command)
{
    command->head = (struct result_head){.schema = RESULT_SCHEMA,
                                         .rotid = ROTID_VERSION,
                                         .commit = build_commit,
                                         .blas = build_blas(),
                                         .seed = (double)command->seed,
                                         .threads = command->threads,
                                         .command = command->name};
}

int command_write_result(struct command *command, struct result *result, int code)
{
    if (!command->json)
        return code;
    result->warnings = message_warnings(&command->messages, &command->pool, &result->nwarnings);
    char *text = result->warnings ? result_json(result) : NULL;
    code = command_write_file(command, command->json, text, code);
    free(text);
    return code;
}

int command_wants_progress(const struct command *command)
{
    return isatty(STDERR_FILENO) && !command->quiet;
}

static void show_progress(void *context, const char *stage, int step)
{
    double *last = context, seconds = clock_seconds();
    if (*last == 0)
        *last = seconds; /* a run shorter than that shows nothing */
    if (seconds - *last < 0.2)
        return;
    *last = seconds;
    terminal_progress("rotid: %s %d", stage, step);
}

rotid_environment command_environment(struct command *command)
{
    command->progressed = 0;
    return (rotid_environment){.size = sizeof(rotid_environment),
                               .cancelled = command_cancelled,
                               .progress = command_wants_progress(command) ? show_progress : NULL,
                               .context = &command->progressed};
}

/* What --csv writes. */

int command_refuse_csv(const struct command *command, const char *const *name)
{
    struct pool pool;
    int code = EXIT_DONE;
    if (command->csv && command->read && command->read->nstate > 1)
        return terminal_end(EXIT_USAGE, "rotid: --csv writes the tables of one state, expected --set FIT.STATE=NAME of one\n");
    pool_open(&pool, NULL);
    for (; *name && command->csv && !code; name++) {
        const char *path = pool_format(&pool, "%s.%s.csv", command->csv, *name), *wrong = NULL;
        if (!path)
            continue; /* writing will say so */
        if (command->json && arguments_same_file(command->json, path))
            wrong = "the file of --json";
        if (arguments_same_file(command->deck, path))
            wrong = "which is read";
        for (int f = 0; command->job && f < command->job->nfile; f++)
            if (arguments_same_file(command->job->file[f], path))
                wrong = "which is read";
        if (wrong)
            code = terminal_end(EXIT_USAGE, "rotid: --csv would write %s, %s, expected another name\n", path, wrong);
    }
    pool_close(&pool);
    return code;
}

int command_write_csv(struct command *command, const char *const *name, struct table *const *table, int code)
{
    const char *failed = "";
    if (!command->csv)
        return code;
    int status = csv_write(&command->pool, command->csv, name, table, &failed);
    if (status == ROTID_ERROR_IO)
        return terminal_end(EXIT_INTERNAL, "rotid: cannot write %s: %s; no table was written\n", failed, output_error());
    if (status)
        return command_fail(command, status);
    for (int i = 0; name[i] && command_wants_table(command); i++)
        (void)fprintf(terminal_out(), "%s%s.%s.csv%s",
                      !i            ? "\n"
                      : name[i + 1] ? ", "
                                    : " and ",
                      command->csv, name[i], name[i + 1] ? "" : " are written\n");
    return code;
}

/* ---- a run of the program */

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

int command_line(int argc, char **argv)
{
    struct command command = {0};
    pool_open(&command.pool, NULL);
    message_open(&command.messages, &command.pool);
    int code = arguments_parse(&command, argc, argv);
    if (code < 0)
        code = run(&command);
    rotid_deck_free(command.read);
    pool_close(&command.pool);
    return code;
}
