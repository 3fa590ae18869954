#include "api/api.h"
#include "cli/cli.h"
#include "export/export.h"

#define REDUCTION_DOUBTFUL 1 /* % of a frequency */

/* What the condensed matrices are worth, where they are wanted. Nonzero after saying why they cannot be written alone. */
static int judge_condensed(struct command *command, const struct job *job, const struct export_model *model,
                           enum export_format format)
{
    const struct export_condensed *c = &model->condensed;
    const struct spectrum *s = &model->spectrum;
    int alone = format == EXPORT_DMIG, highest = comparison_highest(job), worst = -1;
    if (c->impossible) {
        message_add(&command->messages, alone ? SEVERITY_ERROR : SEVERITY_WARNING, NULL, 0, 0, "no condensed matrices: %s",
                    c->impossible);
        return alone;
    }
    for (int i = 0; i < c->count && alone; i++)
        if (export_master_id(model, i) > DMIG_MOST_ID) {
            struct place place = job_sensor_place(job, i);
            return message_refuse_at(&command->messages, 1, place, "sensor %d cannot be the id of a GRID, expected at most %d",
                                     export_master_id(model, i), DMIG_MOST_ID);
        }
    for (int j = 0; j < s->count && (!highest || j < highest) && worst < 0; j++)
        if (!(fabs(s->reduction_error_percent[j]) <= REDUCTION_DOUBTFUL))
            worst = j;
    if (worst >= 0 && isfinite(s->reduced_hz[worst]))
        message_warn(&command->messages,
                     "the condensed model has mode %d at %.6g Hz, %+.1f %% off: %d masters are too few for it", worst + 1,
                     s->reduced_hz[worst], s->reduction_error_percent[worst], c->count);
    else if (worst >= 0)
        message_warn(&command->messages, "the condensed model has no mode %d: %d masters are too few for it", worst + 1,
                     c->count);
    return 0;
}

/* 0, or an exit code after saying which file would be lost. */
static int refuse_files(const struct command *command, const struct export_files *files)
{
    const struct states *states = deck_states_of(command->read);
    const struct job *job = &states->state[states->nstate - 1].job;
    for (int i = 0; i < files->count; i++) {
        if (command->json && arguments_same_file(command->json, files->path[i]))
            return arguments_wrong("--output would write %s, the file of --json, expected another name", files->path[i]);
        for (int f = 0; f < job->nfile; f++)
            if (arguments_same_file(job->file[f], files->path[i]))
                return arguments_wrong("--output would write %s, which is read, expected another name", files->path[i]);
    }
    return 0;
}

static int write_files(struct command *command, const struct export_files *files, const struct export_model *model, int code)
{
    const char *failed;
    int status = export_files_write(files, model, &failed);
    if (status == ROTID_ERROR_IO)
        return terminal_end(EXIT_INTERNAL, "rotid: cannot write %s: %s; no file was written\n", failed, output_error());
    if (status)
        return command_fail(command, status);
    if (command_wants_table(command)) {
        const struct screen to = command_screen(command);
        screen_export(&to, &command->head, files, model);
        screen_notes(&to, &command->messages);
    }
    struct result result = {.head = command->head,
                            .export = command->json ? export_result_of(&command->pool, files, model) : NULL};
    return command_write_result(command, &result, code);
}

static int export(struct command *command, const struct fitted_state *state, int code)
{
    struct export_model model;
    struct export_files files;
    enum export_format format = (enum export_format)command->format;
    int wants_condensed = format == EXPORT_MATRIX_MARKET || command->condensed;
    const struct identification *identified = state->identified.fit ? &state->identified : NULL;
    int status = export_model_open(&command->pool, state->job, identified, command->head.rotid, wants_condensed, &model);
    if (!status && wants_condensed && judge_condensed(command, state->job, &model, format))
        status = ROTID_ERROR_ARGUMENT;
    if (!status)
        status = export_files_name(&command->pool, format, command->condensed, command->output, &model, &files);
    if (status)
        return command_fail(command, status);
    int refused = refuse_files(command, &files);
    return refused ? refused : write_files(command, &files, &model, code);
}

/* 0, or an exit code after saying why there is no one model, or no such form of a solid. */
static int refuse_model(struct command *command)
{
    enum export_format format = (enum export_format)command->format;
    const char *deck = command->job->deck;
    if (command->read->nstate && !command->state)
        message_add(&command->messages, SEVERITY_ERROR, deck, 1, 1,
                    "the deck has %d states and a file holds the model of one, expected --state %s or another one",
                    command->read->nstate, command->read->state_name[0]);
    else if (command->job->options.solid && format == EXPORT_DMIG && !command->condensed)
        message_add(&command->messages, SEVERITY_ERROR, deck, 1, 1,
                    "a Nastran deck of rotid has beam elements and this rotor is a solid, expected --format matrix-market, "
                    "--condensed (onto the sensors), or --set FIT.MODEL=BEAM");
    else
        return 0;
    return command_fail(command, ROTID_ERROR_ARGUMENT);
}

int command_export(struct command *command)
{
    struct command_fit fit = {0};
    int code = refuse_model(command);
    if (!code)
        code = command_choose_states(command, "a model for other programs", &fit);
    if (!code)
        code = command_fit_deck(command, command->read->nparameter && !command->start, &fit);
    if (!code && command_cancelled(NULL)) {
        code = terminal_end(EXIT_DOUBTFUL, "rotid: interrupted, nothing was written\n");
    } else if (!code) {
        code = export(command, fit.state, command_judge_fit(command, &fit, "written"));
    }
    rotid_fit_free(fit.fit);
    return code;
}
