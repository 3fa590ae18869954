#include "cli/cli.h"

#include <errno.h>
#include <sys/stat.h>

static const char *const tables[] = {"cells", "parameters", "runs", NULL};

/* Where standard error is a terminal: a line that is written over. */
static void show_progress(const struct study_record *now, long computed, double seconds)
{
    if (seconds < 0.5 || !computed)
        return;
    double rate = (double)computed / seconds, left = (double)(now->wanted - now->done) / rate;
    int minutes = left >= 120, hours = left >= 7200;
    terminal_progress("rotid: %ld of %ld runs, %ld failed, %.3g a second, %.*f %s left", now->done, now->wanted, now->failed,
                      rate, hours,
                      hours     ? left / 3600
                      : minutes ? left / 60
                                : left,
                      hours     ? "h"
                      : minutes ? "min"
                                : "s");
}

static int in_processes(void *context, struct command *command, const struct study *study, struct study_record *record)
{
    const struct workers_options options = {.workers = command->threads,
                                            .timeout = command->study.timeout,
                                            .cancelled = command_cancelled,
                                            .progress = command_wants_progress(command) ? show_progress : NULL};
    (void)context;
    (void)fflush(NULL); /* before there are two of each buffer */
    return workers_run(&command->pool, study, &options, record);
}

/* What is wrong with files of results stands in the messages. */
static int refuse_study(struct command *command, int status)
{
    command_print_messages(command);
    if (!command->messages.errors)
        return command_fail(command, status);
    return status == ROTID_ERROR_IO || status == ROTID_ERROR_MEMORY ? EXIT_INTERNAL : EXIT_USAGE;
}

static int report(struct command *command, const char *path, int code)
{
    struct study_result summary;
    struct study_header header;
    const struct screen to = command_screen(command);
    struct table *runs = command->csv ? table_open(&command->pool, "") : NULL;
    int status = summary_read(&command->pool, path, &command->messages, &header, runs, &summary);
    if (status)
        return refuse_study(command, status);
    if (command_wants_table(command))
        screen_study(&to, &summary);
    struct table *table[] = {table_of_cells(&command->pool, &summary), table_of_cell_parameters(&command->pool, &summary), runs};
    int written = command_write_csv(command, tables, table, code);
    if (written == EXIT_INTERNAL)
        return written;
    command->head.seed = header.seed;
    if (summary.failed || summary.missing)
        code = code > EXIT_DOUBTFUL ? code : EXIT_DOUBTFUL;
    struct result result = {.head = command->head, .study = &summary};
    return command_write_result(command, &result, code);
}

int study_prepare(struct command *command, struct study *study)
{
    struct plan *plan = POOL_NEW(&command->pool, struct plan);
    int plans = 0, wrong = command_refuse_csv(command, tables);
    if (wrong)
        return wrong;
    if (!plan)
        return command_fail(command, ROTID_ERROR_MEMORY);
    for (int i = 0; i < command->nfile; i++) {
        struct stat about;
        if (stat(command->file[i], &about) == 0 && !S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode))
            return arguments_wrong("%s is no regular file, expected one, for it is read several times", command->file[i]);
        int is = plan_is(command->file[i]);
        if (is < 0)
            return command_fail(command, is);
        plans += is;
    }
    if (plans && command->nfile > 1)
        return arguments_wrong("%s: a plan and another file, expected one plan, or decks", command->name);
    int status = plans ? plan_read(&command->pool, command->deck, &command->messages, plan)
                       : plan_of_decks(&command->pool, command->nfile, command->file, plan);
    if (!status)
        status = study_open(&command->pool, plan, command->noverride, command->override,
                            arguments_given(command, "seed") ? command->seed : plan->seed, &command->messages, study);
    if (status)
        return command_fail(command, status);
    int refused = arguments_refuse_read(command, plan->text.nfile, plan->text.file);
    if (refused < 0)
        refused = arguments_refuse_read(command, study->nfile, study->file);
    if (refused >= 0)
        return refused;
    command_print_messages(command);
    command->head.seed = (double)study->seed;
    return EXIT_DONE;
}

/* Everything is there: in order of the runs from now on. */
static int finish(struct command *command, struct study_record *record, int code)
{
    int status = record_finish(record);
    if (!status)
        return code;
    return terminal_end(EXIT_INTERNAL, "rotid: every run is in %s, but it cannot be put in order: %s\n", command->output,
                        status == ROTID_ERROR_IO ? strerror(errno) : rotid_status_text(status));
}

int study_conduct(struct command *command, const struct study *study, study_compute *compute, void *context)
{
    const struct study_arguments *arguments = &command->study;
    const struct study_header header =
        header_of(&command->pool, study, command->head.rotid, command->head.commit, arguments->shard, arguments->shards);
    struct study_record record;
    int code = EXIT_DONE;
    command_watch_signals();
    int status = record_open(&command->pool, command->output, &header, study->plan && study->plan->path ? NULL : study->deck,
                             arguments->retry_failed, &command->messages, &record);
    if (status)
        return refuse_study(command, status);
    command_print_messages(command);
    long before = record.done;
    if (before && command_wants_progress(command))
        terminal_say("rotid: %ld of %ld runs are in %s already\n", before, record.wanted, command->output);
    status = compute(context, command, study, &record);
    if (status < 0) {
        code = terminal_end(
            EXIT_INTERNAL, "rotid: stopped, %ld of %ld runs are in %s, the same command goes on with the rest: %s\n", record.done,
            record.wanted, command->output, status == ROTID_ERROR_IO ? strerror(errno) : rotid_status_text(status));
    } else if (record.done < record.wanted) {
        code =
            terminal_end(EXIT_DOUBTFUL, "rotid: interrupted, %ld of %ld runs are in %s; the same command goes on with the rest\n",
                         record.done, record.wanted, command->output);
    } else {
        code = finish(command, &record, code);
    }
    record_close(&record);
    return report(command, command->output, code);
}

static int merge(struct command *command)
{
    struct merge merged;
    command_watch_signals();
    int status = merge_results(&command->pool, command->nfile, command->file, command->output, &command->messages, &merged);
    if (status)
        return refuse_study(command, status);
    if (merged.missing)
        terminal_say("rotid: %ld of %ld runs are missing in %s: %s; rotid study PLAN -o %s computes them\n", merged.missing,
                     merged.runs, command->output, merged.list, command->output);
    return report(command, command->output, merged.missing || merged.failed ? EXIT_DOUBTFUL : EXIT_DONE);
}

int command_study(struct command *command)
{
    struct study study = {0};
    int refused = command->study.merge || command->study.summary ? command_refuse_csv(command, tables) : EXIT_DONE;
    if (refused)
        return refused;
    if (command->study.merge)
        return merge(command);
    if (command->study.summary) {
        command_watch_signals();
        return report(command, command->deck, EXIT_DONE);
    }
    int code = study_prepare(command, &study);
    return code ? code : study_conduct(command, &study, in_processes, NULL);
}
