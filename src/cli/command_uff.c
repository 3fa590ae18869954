#include <sys/stat.h>

#include "cli/cli.h"

static const char *const names[] = {"modes", "shapes", NULL};

/* The modes of the file as the tables of --csv. */
static int write_tables(struct command *command, int code)
{
    struct uff_tables tables;
    int status = uff_tables_read(&command->pool, command->deck, &command->messages, &tables);
    if (status)
        return command_fail(command, status);
    if (tables.points)
        message_warn(&command->messages,
                     "the frequencies at single points stand in no table: *MEASURED reads them from the universal file");
    command_print_messages(command);
    return command_write_csv(command, names, tables.table, code);
}

int command_uff(struct command *command)
{
    const struct listing_options options = {.keep_shapes = command->verbose && command->json, .cancelled = command_cancelled};
    struct listing listing;
    struct stat about;
    int summary_count = 0;
    const char **summary = NULL;
    if (command->csv && stat(command->deck, &about) == 0 && S_ISFIFO(about.st_mode))
        return arguments_wrong("%s is a pipe, expected a regular file beside --csv, for it is read twice", command->deck);
    int refused = command_refuse_csv(command, names);
    if (refused)
        return refused;
    int status = listing_read(&command->pool, command->deck, &options, &command->messages, &listing);
    if (!status)
        status = listing_summarise(&command->pool, &listing, &summary_count, &summary);
    if (status)
        return command_fail(command, status);
    command_print_messages(command);
    int code = listing.faulty_count ? EXIT_DOUBTFUL : EXIT_DONE;
    if (command_wants_table(command)) {
        const struct screen to = command_screen(command);
        screen_uff(&to, command->deck, &listing, summary_count, summary);
    }
    struct result result = {.head = command->head};
    if (command->json)
        result.uff =
            uff_result_of(&command->pool, command->deck, &listing, summary_count, summary, command->verbose, &command->messages);
    code = command_write_result(command, &result, code);
    if (code == EXIT_INTERNAL || !command->csv)
        return code;
    if (listing.faulty_count)
        return terminal_end(EXIT_USAGE, "rotid: %s is not written, for a part of %s cannot be read\n", command->csv,
                            command->deck);
    return write_tables(command, code);
}
