#include <stdio.h>

#include "cli/arguments.h"
#include "page/page.h"

/* "rotid report a.json b.json -o page" as a user can repeat it. */
static const char *how_it_was_made(struct command *command)
{
    const char *text = pool_format(&command->pool, "Made by rotid %s (%s): rotid report", ROTID_VERSION, build_commit);
    for (int i = 0; i < command->nfile && text; i++)
        text = pool_format(&command->pool, "%s %s", text, command->file[i]);
    return text ? pool_format(&command->pool, "%s -o %s", text, command->output) : NULL;
}

int command_report(struct command *command)
{
    struct pool *pool = &command->pool;
    struct result *result = POOL_ARRAY(pool, struct result, command->nfile);
    const rotid_environment environment = {.size = sizeof environment, .cancelled = command_cancelled};
    struct document document;
    struct page_written written;
    int status = result ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int i = 0; i < command->nfile && result; i++) {
        int wrong = page_result_read(pool, command->file[i], &command->messages, &result[i]);
        status = status ? status : wrong; /* all files are judged */
    }
    if (status)
        return command_fail(command, status);
    const char *made_by = how_it_was_made(command);
    document_open(&document, pool);
    page_compose(&document, command->nfile, result);
    status = made_by ? page_write(&document, command->output, made_by, &environment, &command->messages, &written)
                     : ROTID_ERROR_MEMORY;
    if (status == ROTID_STOP_CANCELLED) {
        terminal_say("rotid: interrupted; %s is as it was\n", command->output);
        return EXIT_DOUBTFUL;
    }
    if (status == ROTID_ERROR_IO) {
        command_print_messages(command);
        return EXIT_INTERNAL;
    }
    if (status)
        return command_fail(command, status);
    command_print_messages(command);
    if (!command->quiet)
        (void)fprintf(terminal_out(), "%s/index.html\n", command->output);
    return written.gnuplot && written.ndrawn < written.nfigure ? EXIT_DOUBTFUL : EXIT_DONE;
}
