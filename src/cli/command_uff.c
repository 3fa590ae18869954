#include <errno.h>
#include <stdio.h>
#include <sys/stat.h>

#include "cli/arguments.h"
#include "cli/command.h"
#include "import/convert.h"
#include "import/listing.h"
#include "report/output.h"
#include "report/report_uff.h"

static int fail_output(const struct command *command)
{
    terminal_say("rotid: cannot write %s: %s\n", command->output, output_error());
    return EXIT_INTERNAL;
}

/* The file that -o asks for, or none. */
static int convert(struct command *command)
{
    const struct convert_options options = {.format = arguments_given(command, "format") ? CONVERT_ASCII + command->format
                                                                                         : CONVERT_OTHER,
                                            .cancelled = command_cancelled};
    struct convert_result result;
    struct output output;
    int status = output_open(&output, command->output);
    if (status)
        return status == ROTID_ERROR_IO ? fail_output(command) : command_fail(command, status);
    status = output_close(&output, convert_file(command->deck, &options, output.stream, &command->messages, &result));
    if (status == ROTID_STOP_CANCELLED) {
        terminal_say("rotid: interrupted, %s was not written\n", command->output);
        return EXIT_DOUBTFUL;
    }
    if (status)
        return status == ROTID_ERROR_IO && !command->messages.errors ? fail_output(command) : command_fail(command, status);
    if (command_wants_table(command))
        (void)fprintf(terminal_out(), "\n%s: %d function%s%s, %d other set%s, %d of them copied as they are\n", command->output,
                      result.functions, result.functions == 1 ? "" : "s",
                      !result.functions  ? ""
                      : result.is_binary ? " in binary (58b, little endian)"
                                         : " as text (58)",
                      result.others + result.copied, result.others + result.copied == 1 ? "" : "s", result.copied);
    return EXIT_DONE;
}

/* The modes of the file as the tables of --csv. */
static int write_tables(struct command *command, int code)
{
    struct csv_universal universal;
    int status = csv_universal_read(&command->pool, command->deck, &command->messages, &universal);
    if (status)
        return command_fail(command, status);
    if (universal.points)
        message_add(&command->messages, SEVERITY_WARNING, NULL, 0, 0,
                    "the frequencies at single points stand in no table: *MEASURED reads them from the universal file");
    command_print_messages(command);
    return command_write_csv(command, csv_universal_parts, &universal, code);
}

int command_uff(struct command *command)
{
    const struct listing_options options = {.keep_shapes = command->verbose && command->json, .cancelled = command_cancelled};
    struct listing listing;
    struct stat about;
    int summary_count = 0;
    const char **summary = NULL;
    if ((command->output || command->csv) && stat(command->deck, &about) == 0 && S_ISFIFO(about.st_mode))
        return arguments_wrong(command->output ? "%s is a pipe, expected a regular file beside --output, for it is read twice"
                                               : "%s is a pipe, expected a regular file beside --csv, for it is read twice",
                               command->deck);
    int refused = command_refuse_csv(command, csv_universal_parts);
    if (refused)
        return refused;
    int status = listing_read(&command->pool, command->deck, &options, &command->messages, &listing);
    if (status == ROTID_STOP_CANCELLED) {
        terminal_say("rotid: interrupted\n");
        return EXIT_DOUBTFUL;
    }
    if (!status)
        status = listing_summarise(&command->pool, &listing, &summary_count, &summary);
    if (status)
        return command_fail(command, status);
    command_print_messages(command);
    int code = listing.faulty_count ? EXIT_DOUBTFUL : EXIT_DONE;
    if (command_wants_table(command))
        table_uff(terminal_out(), command->deck, &listing, summary_count, summary, command->verbose);
    struct result result = {.head = command->head};
    if (command->json)
        result.uff =
            uff_result_of(&command->pool, command->deck, &listing, summary_count, summary, command->verbose, &command->messages);
    code = command_write_result(command, &result, code);
    if (code == EXIT_INTERNAL || (!command->output && !command->csv))
        return code;
    if (listing.faulty_count) {
        terminal_say("rotid: %s is not written, for a part of %s cannot be read\n",
                     command->output ? command->output : command->csv, command->deck);
        return EXIT_USAGE;
    }
    int written = command->csv ? write_tables(command, code) : code;
    if (written != code || !command->output)
        return written;
    int converted = convert(command);
    return converted ? converted : code;
}
