/* SET: a parameter, or the length of a group, has this value. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "deck/deck.h"
#include "deck/deck_row.h"
#include "diagnose/causes/causes.h"

static int is_length(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && same_text(dot + 1, "length");
}

/* All sections of the group in proportion. */
static void set_length(struct deck_reader *reader, const struct data_line *line)
{
    struct rotor *rotor = &reader->job->rotor;
    const char *name = line->field[0].text;
    double length, from, to;
    int group = deck_find_group(reader, rotor->ngroup, name, (size_t)(strrchr(name, '.') - name));
    if (group < 0) {
        deck_error(reader, line->field[0].place, "%s is no length, expected that of a *SHAFT or *BEAM", name);
        return;
    }
    if (deck_count(reader, line, 2, reader->layout) || deck_number(reader, line, 1, "length [m]", POSITIVE, &length))
        return;
    rotor_group_span(rotor, group, &from, &to);
    for (int s = 0; s < rotor->nsegment; s++)
        if (rotor->segment[s].group == group)
            rotor->segment[s].length *= length / (to - from);
}

void deck_set_lengths(struct deck_reader *reader)
{
    for (int c = 0; c < reader->text.ncard; c++) {
        const struct card *card = &reader->text.card[c];
        for (int i = 0; i < card->nline && !strcmp(card->name, "SET"); i++)
            if (is_length(card->line[i].field[0].text))
                set_length(reader, &card->line[i]);
    }
}

/* Of a parameter of a cause its own range; of the others what their cards ask for. 0, or 1 after an error. */
static int check_value(struct deck_reader *reader, const struct data_line *line, struct parameter parameter, double value)
{
    const struct rotor *rotor = &reader->job->rotor;
    double lower = parameter.kind == PARAMETER_TENSION ? -INFINITY : parameter.kind == PARAMETER_NU ? -1 : 0, upper = INFINITY;
    if (parameter.kind == PARAMETER_NU)
        upper = 0.5;
    if (parameter.kind == PARAMETER_EFFECT) {
        const struct cause_kind *cause = catalogue_of(&rotor->effect[parameter.index]);
        if (cause && cause->bounds)
            cause->bounds(rotor, &rotor->effect[parameter.index], parameter.component, &lower, &upper);
    }
    int above = parameter.kind <= PARAMETER_TIEROD_E; /* moduli, nu, densities */
    if (value > lower || (value == lower && !above))
        if (value <= upper)
            return 0;
    deck_error(reader, line->field[1].place, "%s is %s, expected a value %s %.6g%s%.6g", line->field[0].text, line->field[1].text,
               above ? "above" : "from", lower, above ? " and at most " : " to ", upper);
    return 1;
}

/* An unknown that a later *SET gives a value is known. */
static void set_parameter(struct deck_reader *reader, const struct data_line *line)
{
    struct job *job = reader->job;
    const char *name = line->field[0].text, *unit = NULL;
    struct parameter parameter;
    double value;
    int found = deck_find_parameter(reader, &line->field[0], &parameter, &unit);
    if (found && found != 3 && (found == 2 || !deck_cause_explains(reader, name, line->field[0].place)))
        deck_error(reader, line->field[0].place, "%s is no parameter, expected one as for *IDENTIFY, or GROUP.length", name);
    if (found || deck_count(reader, line, 2, reader->layout) || deck_number(reader, line, 1, "value", ANY, &value))
        return;
    value *= deck_in_si(reader, unit ? unit : "");
    if (check_value(reader, line, parameter, value))
        return;
    if (parameter.kind == PARAMETER_G)
        job->rotor.group[parameter.index].material.isotropic = 0;
    for (int i = 0; i < parameter.nalso && parameter.kind == PARAMETER_G; i++)
        job->rotor.group[parameter.also[i]].material.isotropic = 0;
    parameters_set(&job->rotor, 1, &parameter, &value);
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        if (!parameters_overlap(&job->unknowns.parameter[p], &parameter))
            continue;
        if (job->unknowns.parameter[p].nalso != parameter.nalso)
            deck_error(reader, line->field[0].place, "%s has a value in common with the unknown %s, expected *SET of that name",
                       name, job->unknowns.bounds[p].name);
        deck_drop_unknown(reader, p--);
    }
}

void deck_set(struct deck_reader *reader, const struct card *card)
{
    for (int i = 0, count = deck_lines(reader, card, 1, 100, reader->layout); i < count; i++)
        if (!is_length(card->line[i].field[0].text))
            set_parameter(reader, &card->line[i]);
}
