/* What --csv writes. */
#include <stdio.h>

#include "cli/cli.h"
#include "report/report.h"

int command_refuse_csv(const struct command *command, const struct csv_part *part)
{
    struct pool pool;
    int code = EXIT_DONE;
    if (command->csv && command->read && command_state_count(command) > 1) {
        terminal_say("rotid: --csv writes the tables of one state, expected --set FIT.STATE=NAME of one\n");
        return EXIT_USAGE;
    }
    pool_open(&pool, NULL);
    for (int i = 0; i < CSV_MOST_FILES && part[i].write && command->csv && !code; i++) {
        const char *path = csv_path(&pool, command->csv, &part[i]), *wrong = NULL;
        if (!path)
            continue; /* writing will say so */
        if (command->json && arguments_same_file(command->json, path))
            wrong = "the file of --json";
        if (arguments_same_file(command->deck, path))
            wrong = "which is read";
        for (int f = 0; command->job && f < command->job->nfile; f++)
            if (arguments_same_file(command->job->file[f], path))
                wrong = "which is read";
        if (wrong) {
            terminal_say("rotid: --csv would write %s, %s, expected another name\n", path, wrong);
            code = EXIT_USAGE;
        }
    }
    pool_close(&pool);
    return code;
}

int command_write_csv(struct command *command, const struct csv_part *part, const void *from, int code)
{
    const char *failed = "";
    if (!command->csv)
        return code;
    int status = csv_write(&command->pool, command->csv, part, from, &failed);
    if (status == ROTID_ERROR_IO) {
        terminal_say("rotid: cannot write %s: %s; no table was written\n", failed, output_error());
        return EXIT_INTERNAL;
    }
    if (status)
        return command_fail(command, status);
    for (int i = 0; i < CSV_MOST_FILES && part[i].write && command_wants_table(command); i++) {
        int last = i + 1 == CSV_MOST_FILES || !part[i + 1].write;
        (void)fprintf(terminal_out(), "%s%s.%s.csv%s",
                      !i     ? "\n"
                      : last ? " and "
                             : ", ",
                      command->csv, part[i].suffix, last ? " are written\n" : "");
    }
    return code;
}
