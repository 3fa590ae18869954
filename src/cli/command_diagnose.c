#include <stdio.h>

#include "cli/command.h"
#include "deck/deck_extended.h"
#include "diagnose/diagnose.h"
#include "report/json_diagnose.h"
#include "report/table.h"
#include "report/table_diagnose.h"

#define WIDTH 100 /* columns: fits a terminal beside an editor, and a page of a log */

static int write_extended(struct command *command, const struct diagnosis *d, int code)
{
    char *text = NULL;
    if (!command->extended)
        return code;
    if (!d->sentence) {
        terminal_say("rotid: %s is not written: there is no verdict yet\n", command->extended);
        return code;
    }
    int status = deck_write_extended(&command->pool, d, command->deck, &text);
    if (status) {
        terminal_say("rotid: cannot write %s: no deck can say this model (%s)\n", command->extended, rotid_status_text(status));
        return EXIT_INTERNAL;
    }
    return command_write_file(command, command->extended, text, code);
}

int command_diagnose(struct command *command)
{
    double last = 0;
    int code = EXIT_DONE, written;
    const struct diagnose_options options = {
        .threads = command->threads, .seed = command->seed, .replicates = command->replicates};
    const rotid_environment environment = command_environment(command, &last);
    struct diagnosis diagnosis;
    int status = diagnose_run(&command->pool, &command->job, &options, &environment, &command->messages, &diagnosis);
    if (environment.progress)
        terminal_progress_end();
    if (status)
        return command_fail(command, status);
    if (command_wants_table(command)) {
        const struct diagnosis_view view = {terminal_out(), &command->provenance, &command->job,
                                            &diagnosis,     command->verbose,     WIDTH};
        table_diagnose(&view);
        table_notes(terminal_out(), &command->messages);
    }
    if (diagnosis.interrupted || command_cancelled(NULL)) {
        terminal_say("rotid: interrupted; the result holds what was finished\n");
        code = EXIT_DOUBTFUL;
    }
    char *text = command->json ? json_diagnose(&command->provenance, &command->job, &diagnosis, &command->messages) : NULL;
    written = command_write_json(command, text, code);
    code = write_extended(command, &diagnosis, written);
    diagnose_free(&diagnosis);
    return code > written ? code : written; /* the graver one */
}
