#include "cli/cli.h"
#include "page/page.h"

/* "rotid report a.json b.json -o page.html" as a user can repeat it. */
static const char *how_it_was_made(struct command *command)
{
    const char *text = pool_format(&command->pool, "Made by rotid %s (%s): rotid report", ROTID_VERSION, build_commit);
    for (int i = 0; i < command->nfile && text; i++)
        text = pool_format(&command->pool, "%s %s", text, command->file[i]);
    return text ? pool_format(&command->pool, "%s -o %s", text, command->output) : NULL;
}

/* Where nobody says: result.html of result.json. */
static const char *page_of(struct pool *pool, const char *file)
{
    const char *name = strrchr(file, '/'), *dot = strrchr(name ? name : file, '.');
    return pool_format(pool, "%.*s.html", dot ? (int)(dot - file) : (int)strlen(file), file);
}

static int read_results(struct command *command, struct result *result)
{
    int status = ROTID_OK;
    for (int i = 0; i < command->nfile; i++) {
        int wrong = page_result_read(&command->pool, command->file[i], &command->messages, &result[i]);
        status = status ? status : wrong; /* all files are judged */
    }
    return status;
}

static int write_page(struct command *command, struct result *result, const char **file)
{
    const char *made_by = how_it_was_made(command);
    struct document document;
    int status = document_open(&document, &command->pool);
    if (status)
        return status;
    page_compose(&document, command->nfile, result);
    status = command_cancelled(NULL) ? ROTID_STOP_CANCELLED
             : made_by ? page_write(&document, command->nfile, result, command->output, made_by, &command->messages, file)
                       : ROTID_ERROR_MEMORY;
    document_close(&document);
    return status;
}

int command_report(struct command *command)
{
    struct result *result = POOL_ARRAY(&command->pool, struct result, command->nfile);
    const char *file = NULL;
    if (!command->output)
        command->output = page_of(&command->pool, command->deck);
    int status = result && command->output ? read_results(command, result) : ROTID_ERROR_MEMORY, is_read = !status;
    if (is_read)
        status = write_page(command, result, &file);
    for (int i = 0; i < command->nfile && result; i++)
        cJSON_Delete(result[i].json);
    if (status == ROTID_STOP_CANCELLED)
        return terminal_end(EXIT_DOUBTFUL, "rotid: interrupted; %s is as it was\n", command->output);
    if (status && !(is_read && status == ROTID_ERROR_IO))
        return command_fail(command, status);
    if (!*page_script && !status)
        message_warn(&command->messages, "no figures: this program was built without D3; tools/setup, then make, embeds it");
    command_print_messages(command);
    if (status)
        return EXIT_INTERNAL;
    if (!command->quiet)
        (void)fprintf(terminal_out(), "%s\n", file);
    return EXIT_DONE;
}
