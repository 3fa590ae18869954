#include "cli/cli.h"

static int write_extended(struct command *command, const rotid_diagnosis *diagnosis, int code)
{
    if (!command->extended)
        return code;
    if (!diagnosis->verdict.sentence)
        return terminal_end(code, "rotid: %s is not written: there is no verdict yet\n", command->extended);
    if (!diagnosis->extended_deck)
        return terminal_end(EXIT_INTERNAL, "rotid: cannot write %s: no deck reads as this model\n", command->extended);
    const char *next = NULL; /* of the last one: those before are of the deck that was read */
    for (const char *at = diagnosis->extended_deck; (at = strstr(at, "\n" DECK_EXTENDED_FROM));)
        next = at = at + 1 + strcspn(at + 1, "\n");
    if (next && *next && !strncmp(next + 1, DECK_MESH_REFINED, strlen(DECK_MESH_REFINED)) && !command->quiet)
        terminal_say("rotid: %s: %.*s\n", command->extended, (int)strcspn(next + 1, "\r\n"), next + 1);
    return command_write_deck(command, diagnosis->extended_deck, code);
}

static int show(struct command *command, rotid_diagnosis *diagnosis)
{
    struct result result = {.head = command->head, .diagnose = diagnosis};
    int code = EXIT_DONE, written;
    command_take_messages(command, NULL, diagnosis->nmessage, diagnosis->message);
    command_show(command, &result, screen_diagnose);
    if (diagnosis->interrupted || command_cancelled(NULL))
        code = terminal_end(EXIT_DOUBTFUL, "rotid: interrupted; the result holds what was finished\n");
    written = command_write_result(command, &result, code);
    code = write_extended(command, diagnosis, written);
    return code > written ? code : written; /* the graver one */
}

int command_diagnose(struct command *command)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_diagnose_options options = {.size = sizeof options, .threads = command->threads};
    const char *comma = command->changed ? strchr(command->changed, ',') : NULL;
    if (comma) {
        options.before = pool_format(&command->pool, "%.*s", (int)(comma - command->changed), command->changed);
        options.after = comma + 1;
    }
    const rotid_environment environment = command_environment(command);
    rotid_diagnosis *diagnosis;
    int status = rotid_diagnose(command->read, &options, &environment, failure, &diagnosis);
    if (status)
        return command_fail_with(command, status, failure);
    int code = show(command, diagnosis);
    rotid_diagnosis_free(diagnosis);
    return code;
}
