#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "report/table.h"
#include "run/sensitivity.h"

#define MODES_WITHOUT_DATA 6

struct selection {
    int n;
    struct parameter *parameter;
    rotid_parameter *named;
    double *x;
};

/* "core.E=8e10,core.nu": names with or without a reference value; without, the model's own. */
static int select_listed(struct command *command, struct selection *s)
{
    const struct rotor *rotor = &command->job->rotor;
    char *list = pool_copy_text(&command->pool, command->at), *rest = NULL;
    for (char *item = list ? strtok_r(list, ",", &rest) : NULL; item; item = strtok_r(NULL, ",", &rest)) {
        char *equals = strchr(item, '='), *end;
        if (equals)
            *equals = 0;
        rotid_parameter *named = &s->named[s->n];
        named->name = item;
        if (parameter_find(rotor, item, &s->parameter[s->n], &named->unit)) {
            message_add(&command->messages, SEVERITY_ERROR, "--at", 1, (int)(item - list) + 1,
                        "%s is no parameter of this deck, expected one of %s", item, parameter_list(&command->pool, rotor, item));
            return ROTID_ERROR_SYNTAX;
        }
        if (s->parameter[s->n].kind == PARAMETER_G) { /* from here on a modulus of its own */
            struct material *material = &rotor->group[s->parameter[s->n].index].material;
            material->g = material_shear_modulus(material);
            material->isotropic = 0;
        }
        s->x[s->n] = equals ? strtod(equals + 1, &end) : *parameter_value(rotor, s->parameter[s->n]);
        if ((equals && (end == equals + 1 || *end)) || !isfinite(s->x[s->n]) || s->x[s->n] == 0) {
            message_add(&command->messages, SEVERITY_ERROR, "--at", 1, (int)(item - list) + 1,
                        "%s has no reference value, expected a number that is not zero", item);
            return ROTID_ERROR_SYNTAX;
        }
        s->n++;
    }
    if (list && !s->n) {
        message_add(&command->messages, SEVERITY_ERROR, "--at", 1, 1,
                    "no parameter is named, expected NAME or NAME=VALUE, separated by commas");
        return ROTID_ERROR_SYNTAX;
    }
    return list ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int select_parameters(struct command *command, struct selection *s)
{
    const struct job *job = command->job;
    size_t room = (size_t)job->unknowns.nparameter + 1;
    for (const char *c = command->at; c && *c; c++)
        room += *c == ',';
    *s = (struct selection){0, POOL_ARRAY(&command->pool, struct parameter, room),
                            POOL_ARRAY(&command->pool, rotid_parameter, room), POOL_ARRAY(&command->pool, double, room)};
    if (!s->parameter || !s->named || !s->x)
        return ROTID_ERROR_MEMORY;
    if (command->at)
        return select_listed(command, s);
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        s->parameter[p] = job->unknowns.parameter[p];
        s->named[p] = job->unknowns.bounds[p];
        s->x[p] = job->unknowns.bounds[p].start;
    }
    s->n = job->unknowns.nparameter;
    if (!s->n) {
        message_add(&command->messages, SEVERITY_ERROR, job->deck, 1, 1,
                    "nothing to vary, expected *IDENTIFY in the deck or --at NAME=VALUE,...");
        return ROTID_ERROR_SYNTAX;
    }
    return ROTID_OK;
}

int command_sensitivity(struct command *command)
{
    const struct job *job = command->job;
    struct selection selection;
    struct sensitivity found;
    struct result result = {.head = command->head, .sensitivity = &found};
    struct sensitivity_options options = {.step = command->step,
                                          .range = command->range,
                                          .points = command->points,
                                          .with_growth = command->json != NULL,
                                          .seed = command->seed};
    for (int k = 0; k < job->measurement.nmode; k++)
        options.modes = job->measurement.number[k] > options.modes ? job->measurement.number[k] : options.modes;
    if (!options.modes)
        options.modes = MODES_WITHOUT_DATA;
    int status = select_parameters(command, &selection);
    if (!status)
        status = sensitivity_run(&command->pool, job, selection.n, selection.parameter, selection.named, selection.x, &options,
                                 &found);
    if (status)
        return command_fail(command, status);
    if (command_wants_table(command))
        table_sensitivity(terminal_out(), &result);
    return command_write_result(command, &result, EXIT_DONE);
}
