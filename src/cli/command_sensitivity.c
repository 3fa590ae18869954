#include "api/api.h"
#include "cli/cli.h"

#define MODES_WITHOUT_DATA 6

struct selection {
    int n;
    struct parameter *parameter;
    rotid_parameter *named;
    double *x;
};

/* "core.E=8e10,core.nu": names with or without a reference value in the unit of the deck; without, the model's own. */
static int select_listed(struct command *command, const struct job *job, struct selection *s)
{
    const struct rotor *rotor = &job->rotor;
    char *list = pool_copy_text(&command->pool, command->at), *rest = NULL;
    for (char *item = list ? strtok_r(list, ",", &rest) : NULL; item; item = strtok_r(NULL, ",", &rest)) {
        char *equals = strchr(item, '='), *end;
        if (equals)
            *equals = 0;
        rotid_parameter *named = &s->named[s->n];
        named->name = item;
        if (parameter_find(rotor, item, &s->parameter[s->n], &named->unit))
            return message_refuse(&command->messages, ROTID_ERROR_SYNTAX, "--at", 1, (int)(item - list) + 1,
                                  "%s is no parameter of this deck, expected one of %s", item,
                                  parameter_list(&command->pool, rotor, item));
        for (int k = 0; k < s->n; k++)
            if (parameters_overlap(&s->parameter[k], &s->parameter[s->n]))
                return message_refuse(&command->messages, ROTID_ERROR_SYNTAX, "--at", 1, (int)(item - list) + 1,
                                      "%s is named twice, expected once", item);
        if (s->parameter[s->n].kind == PARAMETER_G) { /* from here on a modulus of its own */
            struct material *material = &rotor->group[s->parameter[s->n].index].material;
            material->g = material_shear_modulus(material);
            material->isotropic = 0;
        }
        double si = deck_unit_of(&job->units, named->unit ? named->unit : "");
        s->x[s->n] = equals ? strtod(equals + 1, &end) * si : *parameter_value(rotor, s->parameter[s->n]);
        if ((equals && (end == equals + 1 || *end)) || !isfinite(s->x[s->n]) || s->x[s->n] == 0)
            return message_refuse(&command->messages, ROTID_ERROR_SYNTAX, "--at", 1, (int)(item - list) + 1,
                                  "%s has no reference value, expected a number that is not zero", item);
        const char *range = deck_outside_range(&command->pool, rotor, s->parameter[s->n], si, &s->x[s->n]);
        if (range)
            return message_refuse(&command->messages, ROTID_ERROR_SYNTAX, "--at", 1, (int)(item - list) + 1,
                                  "%s is %.6g, expected a value %s", item, s->x[s->n] / si, range);
        s->n++;
    }
    if (list && !s->n)
        return message_refuse(&command->messages, ROTID_ERROR_SYNTAX, "--at", 1, 1,
                              "no parameter is named, expected NAME or NAME=VALUE, separated by commas");
    return list ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int select_parameters(struct command *command, const struct job *job, struct selection *s)
{
    size_t room = (size_t)job->unknowns.nparameter + 1;
    for (const char *c = command->at; c && *c; c++)
        room += *c == ',';
    *s = (struct selection){0, POOL_ARRAY(&command->pool, struct parameter, room),
                            POOL_ARRAY(&command->pool, rotid_parameter, room), POOL_ARRAY(&command->pool, double, room)};
    if (!s->parameter || !s->named || !s->x)
        return ROTID_ERROR_MEMORY;
    if (command->at)
        return select_listed(command, job, s);
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        s->parameter[p] = job->unknowns.parameter[p];
        s->named[p] = job->unknowns.bounds[p];
        s->x[p] = job->unknowns.bounds[p].start;
    }
    s->n = job->unknowns.nparameter;
    if (!s->n)
        return message_refuse(&command->messages, ROTID_ERROR_SYNTAX, job->deck, 1, 1,
                              "nothing to vary, expected *IDENTIFY in the deck or --at NAME=VALUE,...");
    return ROTID_OK;
}

static int run(struct command *command, const rotid_deck *deck, struct result_state *state)
{
    const struct job *job = deck_job_of(deck);
    struct selection selection;
    struct sensitivity_options options = {.step = command->step,
                                          .range = command->range,
                                          .points = command->points,
                                          .with_growth = command->json != NULL,
                                          .seed = command->seed};
    for (int k = 0; k < job->measurement.nmode; k++)
        options.modes = job->measurement.number[k] > options.modes ? job->measurement.number[k] : options.modes;
    if (!options.modes)
        options.modes = MODES_WITHOUT_DATA;
    int status = select_parameters(command, job, &selection);
    if (status == ROTID_ERROR_SYNTAX && state->name)
        message_add(&command->messages, SEVERITY_ERROR, job->deck, 1, 1,
                    "this is of state %s, expected parameters that it has too, or one state as in --set FIT.STATE=%s",
                    state->name, state->name);
    struct sensitivity *found = POOL_NEW(&command->pool, struct sensitivity);
    if (!status)
        status = found ? sensitivity_run(&command->pool, job, selection.n, selection.parameter, selection.named, selection.x,
                                         &options, found)
                       : ROTID_ERROR_MEMORY;
    state->sensitivity = found;
    return status ? command_fail(command, status) : EXIT_DONE;
}

int command_sensitivity(struct command *command)
{
    struct result result = {.head = command->head};
    int count, code = command_each_state(command, &result, run, &count);
    if (code)
        return code;
    if (command_wants_table(command)) {
        const struct screen to = command_screen(command);
        screen_result(&to, &result, screen_sensitivity);
    }
    return command_write_result(command, &result, EXIT_DONE);
}
