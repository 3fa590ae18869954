/* IDENTIFY and FIT. */
#include "deck/deck_row.h"

#include <errno.h>
#include <strings.h>
#include <unistd.h>

void deck_range_of(const struct rotor *rotor, const struct parameter *parameter, double *lower, double *upper)
{
    const struct effect *effect = parameter->kind == PARAMETER_EFFECT ? &rotor->effect[parameter->index] : NULL;
    const struct cause_kind *cause = effect ? catalogue_of(effect) : NULL;
    *lower = parameter->kind == PARAMETER_TENSION ? -INFINITY : parameter->kind == PARAMETER_NU ? -1 : 0;
    *upper = parameter->kind == PARAMETER_NU ? 0.5 : INFINITY;
    if (cause)
        cause_reach(cause, rotor, effect, parameter->component, lower, upper);
}

static void check_range(struct deck_reader *reader, const struct data_line *line, const struct parameter *parameter,
                        rotid_parameter *bounds)
{
    double lower, upper, si = deck_in_si(reader, bounds->unit ? bounds->unit : "");
    deck_range_of(&reader->job->rotor, parameter, &lower, &upper);
    int is_low = !deck_clip(lower, upper, &bounds->lower);
    if (is_low && lower == 0 && isinf(upper))
        deck_error(reader, line->field[1].place, "the lower bound of %s is %s, expected zero or more", bounds->name,
                   line->field[1].text);
    else if (is_low || !deck_clip(lower, upper, &bounds->upper))
        deck_error(reader, line->field[is_low ? 1 : 2].place, "the bounds of %s are %s and %s, expected them inside %.6g to %.6g",
                   bounds->name, line->field[1].text, line->field[2].text, lower / si, upper / si);
}

void deck_drop_unknown(struct deck_reader *reader, int p)
{
    struct job_unknowns *unknowns = &reader->job->unknowns;
    size_t behind = (size_t)(--unknowns->nparameter - p);
    memmove(unknowns->parameter + p, unknowns->parameter + p + 1, behind * sizeof *unknowns->parameter);
    memmove(unknowns->bounds + p, unknowns->bounds + p + 1, behind * sizeof *unknowns->bounds);
    reader->ncommon_unknown -= p < reader->ncommon_unknown;
}

/* Says why there is no such parameter. Returns 1. */
static int refuse_parameter(struct deck_reader *reader, const struct field *field, int is_thing)
{
    const char *known = parameter_list(reader->pool, &reader->job->rotor, field->text);
    if (!is_thing && deck_is_of_bearing(reader, field->text))
        return deck_error(
            reader, field->place,
            "%.*s is a *BEARING, expected its unknowns in an *IDENTIFY behind *RUNNING, where NAME.k and NAME.c are "
            "factors",
            (int)strcspn(field->text, "."), field->text);
    if (!is_thing && deck_cause_explains(reader, field->text, field->place))
        return 1;
    return deck_error(reader, field->place,
                      is_thing ? "%s: there is a thing of that name and it has no such parameter, expected one of %s"
                               : "%s is no parameter, expected one of %s",
                      field->text, known ? known : "");
}

int deck_find_parameter(struct deck_reader *reader, const struct field *field, struct parameter *parameter, const char **unit)
{
    const struct rotor *rotor = &reader->job->rotor;
    char name[PARAMETER_NAME];
    const char *next = field->text;
    int count = 0, *also = NULL;
    *parameter = (struct parameter){.kind = PARAMETER_E};
    for (const char *c = next; *c; c++)
        count += *c == PARAMETER_SHARED_BY;
    if (!count) {
        int failed = parameter_find(rotor, next, parameter, unit);
        return failed ? refuse_parameter(reader, field, failed == 2) : 0;
    }
    also = POOL_ARRAY(reader->pool, int, count);
    for (int i = 0; next && also; i++) {
        struct parameter one;
        next = parameter_next_name(next, name);
        if (parameter_find(rotor, name, &one, unit) || one.kind > PARAMETER_RHO || (i && one.kind != parameter->kind))
            return deck_error(reader, field->place,
                              "%s in %s cannot be shared, expected the same one of E, G, nu and rho of several groups", name,
                              field->text);
        if (i && parameter_is_of_group(parameter, one.index))
            return deck_error(reader, field->place, "%s stands twice in %s, expected once", name, field->text);
        if (i && *parameter_value(rotor, one) != *parameter_value(rotor, *parameter))
            return deck_error(
                reader, field->place, "%s is %.9g and %.*s %.9g in the deck, expected the same value of what is shared", name,
                *parameter_value(rotor, one), (int)strcspn(field->text, "="), field->text, *parameter_value(rotor, *parameter));
        if (i)
            also[parameter->nalso++] = one.index;
        else
            *parameter = one;
        parameter->also = also;
    }
    return !also;
}

void deck_identify(struct deck_reader *reader, const struct card *card)
{
    struct job *job = reader->job;
    int common = card - reader->text.card < reader->ncommon;
    reader->identify_card = card;
    for (int i = 0, count = deck_lines(reader, card, 1, 100); i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct parameter parameter;
        rotid_parameter bounds = {.name = line->field[0].text};
        int bad = deck_find_parameter(reader, &line->field[0], &parameter, &bounds.unit);
        if (deck_read_values(reader, line, &bounds) || bad)
            continue;
        double si = deck_in_si(reader, bounds.unit ? bounds.unit : "");
        bounds.lower *= si;
        bounds.upper *= si;
        bounds.start *= si;
        if (parameter.kind == PARAMETER_E || parameter.kind == PARAMETER_G)
            deck_check_magnitude(reader, line->field[3].place,
                                 parameter.kind == PARAMETER_E ? "start of a Young's modulus [Pa]"
                                                               : "start of a shear modulus [Pa]",
                                 line->field[3].text, bounds.start);
        if (bounds.lower >= bounds.upper)
            deck_error(reader, line->field[1].place, "the bounds of %s are %s and %s, expected the lower one first", bounds.name,
                       line->field[1].text, line->field[2].text);
        else if (!(bounds.lower < bounds.start && bounds.start < bounds.upper))
            deck_error(reader, line->field[3].place, "the start of %s is %s, expected a value between its bounds", bounds.name,
                       line->field[3].text);
        else if (bounds.start == 0)
            deck_error(reader, line->field[3].place,
                       "the start of %s is zero, expected another value: it is the scale of the parameter", bounds.name);
        else
            check_range(reader, line, &parameter, &bounds);
        for (int p = 0; p < job->unknowns.nparameter; p++)
            if (parameters_overlap(&job->unknowns.parameter[p], &parameter)) {
                if (!common && p < reader->ncommon_unknown) /* the state has one of its own in place of the common one */
                    deck_drop_unknown(reader, p--);
                else
                    deck_error(reader, line->field[0].place, "%s is given twice, expected once", bounds.name);
            }
        int last = job->unknowns.nparameter;
        if (POOL_ADD(reader->pool, job->unknowns.parameter, last, &parameter) ||
            POOL_ADD(reader->pool, job->unknowns.bounds, job->unknowns.nparameter, &bounds))
            return;
        reader->ncommon_unknown += common;
    }
}

/* "1-6", "1,2,5-6": sets flag[k] of the measured modes named. 0, or 1 after an error. */
static int mark_modes(struct deck_reader *reader, const struct card_option *option, int *flag)
{
    const struct job *job = reader->job;
    const char *text = option->value;
    int missing = 0;
    do {
        char *end;
        long first = strtol(text, &end, 10), last = first;
        int bad = end == text;
        if (!bad && *end == '-') {
            text = end + 1;
            last = strtol(text, &end, 10);
            bad = end == text || last < first;
        }
        while (*end == ' ')
            end++;
        if (bad || (*end && *end != ',') || first < 1 || last > DECK_MOST_MODES)
            return deck_error(reader, option->value_place, "%s=%s is no list of modes, expected numbers and ranges such as 1-4,6",
                              option->name, option->value);
        for (long number = first; number <= last; number++) {
            int found = 0;
            for (int k = 0; k < job->measurement.nmode; k++)
                if (job->measurement.number[k] == number)
                    found = flag[k] = 1;
            missing |= !found;
            if (!found)
                deck_error(reader, option->value_place, "mode %ld of %s is not measured, expected modes that are", number,
                           option->name);
        }
        text = *end ? end + 1 : end;
    } while (*text);
    return missing;
}

void deck_read_holdout(struct pool *pool, const struct card_option *option, struct deck_holdout *h)
{
    *h = (struct deck_holdout){.modes = option ? option->value : ""};
    for (const char *next = h->modes; *next; h->modes = next) {
        const char *begin = next + strspn(next, " "), *comma = begin + strcspn(begin, ","), *end = comma;
        while (end > begin && end[-1] == ' ')
            end--;
        int is_runup = next == option->value && end - begin == 5 && !strncasecmp(begin, "RUNUP", 5);
        if (!is_runup && strncasecmp(begin, "STATE:", 6) != 0)
            return;
        const char *state = is_runup ? NULL : begin + 6 + strspn(begin + 6, " ");
        if (state && (state = pool_format(pool, "%.*s", end > state ? (int)(end - state) : 0, state)))
            (void)POOL_ADD(pool, h->state, h->nstate, &state);
        h->runup |= is_runup;
        next = comma + (*comma == ',');
    }
}

void deck_choose_modes(struct deck_reader *reader, const struct card *card)
{
    struct job *job = reader->job;
    const struct card_option *modes = card_option(card, "MODES"), *holdout = card_option(card, "HOLDOUT");
    int *fitted = POOL_ARRAY(reader->pool, int, job->measurement.nmode), left = 0;
    if (!fitted)
        return;
    struct deck_holdout held;
    int bad = modes && mark_modes(reader, modes, fitted);
    deck_read_holdout(reader->pool, holdout, &held);
    for (int i = 0; i < held.nstate; i++)
        reader->held_out |= reader->state && !reader->alone && same_text(held.state[i], reader->state);
    if (holdout && (*held.modes || (!held.runup && !held.nstate)))
        bad |=
            mark_modes(reader, &(struct card_option){.name = "HOLDOUT", .value = held.modes, .value_place = holdout->value_place},
                       job->measurement.holdout);
    for (int k = 0; k < job->measurement.nmode; k++) {
        job->measurement.holdout[k] |= modes && !fitted[k];
        left += !job->measurement.holdout[k];
    }
    for (int k = 0; k < job->measurement.nmode && reader->held_out; k++)
        job->measurement.holdout[k] = 1;
    if (job->measurement.nmode && !left && !bad && !reader->held_out)
        deck_error(reader, card->place, "no mode is left to fit, expected fewer in HOLDOUT or more in MODES");
}

void deck_fit(struct deck_reader *reader, const struct card *card)
{
    static const char *const ties[] = {"E:G", NULL};
    struct job *job = reader->job;
    const struct card_option *option;
    reader->fit_card = card;
    job->options.fit.functional = -1;
    (void)deck_read_options(reader, card, &job->options);
    job->options.has_fit = job->options.fit.functional >= 0;
    if ((option = card_option(card, "TIE")))
        reader->tie = deck_option_word(reader, option, ties) == 0;
    if (job->options.solid)
        deck_causes_of_solid(reader);
    option = card_option(card, "DERIVATIVE"); /* missing where a second *FIT takes the first one's */
    if (job->options.fit.derivative == ROTID_MODAL && job->options.fit.reduction == ROTID_REDUCTION_NONE)
        deck_error(reader, option ? option->value_place : card->place,
                   "DERIVATIVE=MODAL needs every vector of the model, expected REDUCTION=GUYAN or IRS with it, or NELSON");
    deck_choose_modes(reader, card);
}

/* FRF: which transfer functions are to be synthesised, beside which measured ones. */

/* Absolute, since an extended deck may be written elsewhere; that it is there is known before anything is computed. */
static const char *measured_file(struct deck_reader *reader, const struct card *card, const struct card_option *option)
{
    char why[HOST_ERROR_TEXT];
    if (!*option->value) {
        deck_error(reader, option->place, "*FRF has an empty FILE, expected FILE=path of a universal file");
        return NULL;
    }
    const char *path = deck_path(reader, card, option);
    if (!path)
        return NULL;
    if (access(path, R_OK)) {
        deck_error(reader, option->value_place, "%s: %s, expected a universal file", path, host_error_text(errno, why));
        return NULL;
    }
    const char *absolute = deck_absolute(reader->pool, path);
    return absolute ? absolute : path;
}

/* What no row says of the lines, and of where the nodes of the file are. */
static void check_options(struct deck_reader *reader, const struct card *card)
{
    const struct frf_request *frf = &reader->job->options.frf;
    const struct card_option *low = card_option(card, "LOW"), *high = card_option(card, "HIGH"),
                             *step = card_option(card, "STEP"), *lines = card_option(card, "LINES"),
                             *damping = card_option(card, "DAMPING"), *of_nodes;
    static const char *const nodes[] = {"AXIS", "FLIP", "ORIGIN"};
    if (low && high && frf->high_hz <= frf->low_hz)
        deck_error(reader, high->value_place, "HIGH is %s and LOW %s, expected HIGH above LOW", high->value, low->value);
    else if (step && lines)
        deck_error(reader, lines->value_place, "STEP and LINES are both given, expected one of them");
    else if ((step || lines) && frf->file)
        deck_error(
            reader, (step ? step : lines)->place,
            "%s with FILE: measured functions are not interpolated, expected the lines of the file (LOW and HIGH limit them)",
            step ? "STEP" : "LINES");
    else if (step && high && frf->high_hz / frf->step_hz > FRF_MOST_LINES)
        deck_error(reader, step->value_place, "STEP is %s, expected at most %d lines up to HIGH", step->value, FRF_MOST_LINES);
    if (damping && frf->damping >= 1)
        deck_error(reader, damping->value_place, "DAMPING is %s, expected a ratio below 1: a fraction of critical damping",
                   damping->value);
    for (int i = 0, told = card_option(card, "FILE") != NULL; i < 3 && !told; i++)
        if ((of_nodes = card_option(card, nodes[i])))
            told = deck_error(reader, of_nodes->place, "%s places the nodes of a file, expected FILE beside it", of_nodes->name);
}

/* Ids that are no sensors may be nodes of the file, which is read when the functions are. */
static void read_pairs(struct deck_reader *reader, const struct card *card)
{
    struct frf_request *frf = &reader->job->options.frf;
    for (int i = 0, count = deck_lines(reader, card, 0, DECK_MOST_LINES); i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct frf_pair pair;
        int bad = deck_count(reader, line, 2);
        bad |= deck_integer(reader, line, 0, "response sensor id", 1, 1000000000, &pair.response);
        bad |= deck_integer(reader, line, 1, "reference sensor id", 1, 1000000000, &pair.reference);
        for (int f = 0; f < 2 && !bad && !card_option(card, "FILE"); f++)
            if (sensor_find(reader->job, f ? pair.reference : pair.response) < 0)
                bad = deck_error(reader, line->field[f].place, "sensor %d is not among *SENSORS, expected one that is",
                                 f ? pair.reference : pair.response);
        if (bad)
            continue;
        (void)POOL_ADD(reader->pool, frf->pair, frf->npair, &pair);
    }
}

void deck_frf(struct deck_reader *reader, const struct card *card)
{
    struct frf_request *frf = &reader->job->options.frf;
    const struct card_option *file = card_option(card, "FILE");
    *frf = (struct frf_request){.given = 1, .has_quantity = card_option(card, "QUANTITY") != NULL};
    if (file)
        frf->file = measured_file(reader, card, file);
    if (!deck_read_options(reader, card, frf))
        check_options(reader, card);
    if (frf->flip && !card_option(card, "ORIGIN"))
        frf->origin = reader->length;
    read_pairs(reader, card);
}
