#include "study/study.h"

#include <string.h>

/* ---- what tells whether a deck has changed */

static void digest_doubles(struct digest *digest, size_t count, const double *value)
{
    for (size_t i = 0; i < count; i++) {
        long long bits = -1; /* one NaN is like another */
        if (value[i] == value[i])
            memcpy(&bits, &value[i], sizeof bits);
        digest_integer(digest, bits);
    }
}

/* Names, options and data lines of the cards. */
static void digest_cards(struct digest *digest, const struct deck_text *text)
{
    digest_integer(digest, text->ncard);
    for (int c = 0; c < text->ncard; c++) {
        const struct card *card = &text->card[c];
        digest_text(digest, card->name);
        digest_integer(digest, card->noption);
        for (int i = 0; i < card->noption; i++) {
            digest_text(digest, card->option[i].name);
            digest_text(digest, card->option[i].value);
        }
        digest_integer(digest, card->nline);
        for (int i = 0; i < card->nline; i++) {
            digest_integer(digest, card->line[i].count);
            for (int f = 0; f < card->line[i].count; f++)
                digest_text(digest, card->line[i].field[f].text);
        }
    }
}

/* What was measured, as the deck and its files say it. */
static void digest_measured(struct digest *digest, const struct job *job)
{
    size_t nmode = (size_t)job->measurement.nmode, components = nmode * (size_t)job->rotor.nsensor;
    digest_integer(digest, job->measurement.nmode);
    digest_integer(digest, job->rotor.nsensor);
    for (int k = 0; k < job->measurement.nmode; k++)
        digest_integer(digest, job->measurement.number[k]);
    for (int s = 0; s < job->rotor.nsensor; s++) {
        digest_integer(digest, job->rotor.sensor[s].id);
        digest_doubles(digest, 1, &job->rotor.sensor[s].position);
    }
    digest_doubles(digest, nmode, job->measurement.frequency_hz);
    digest_doubles(digest, nmode, job->measurement.frequency_std);
    digest_doubles(digest, job->measurement.shape ? components : 0, job->measurement.shape);
    digest_doubles(digest, job->measurement.shape ? components : 0, job->measurement.shape_std);
    digest_doubles(digest, job->measurement.point_frequency_hz ? components : 0, job->measurement.point_frequency_hz);
    digest_doubles(digest, job->measurement.point_frequency_hz ? components : 0, job->measurement.point_frequency_std);
    digest_integer(digest, job->measurement.hammer);
}

/* ---- the decks */

/* What the decks of a plan are before the first run: which can be read, how many parameters they have, what they mean. */

struct check {
    int *nparameter; /* [nvariant * ndeck] */
    struct digest decks, data;
};

struct checker {
    struct pool *pool, scratch; /* scratch: of one deck */
    struct study *study;
    struct message_list *messages;
    struct check *check;
    struct digest own; /* of the deck that is read */
};

/* The same words at the same place say nothing new: a plan with many decks would say them for each. */
static int is_known(const struct message_list *list, const char *file, int line, int column, const char *text)
{
    for (size_t i = 0; i < list->count; i++) {
        const rotid_message *m = &list->item[i];
        if (m->file && file && m->line == line && m->column == column && !strcmp(m->file, file) && !strcmp(m->text, text))
            return 1;
    }
    return 0;
}

static void report(struct checker *c, struct place place, const char *text)
{
    if (!is_known(c->messages, place.file, place.line, place.column, text))
        message_add(c->messages, SEVERITY_ERROR, place.file, place.line, place.column, "%s", text);
}

/* Where in the plan the option of a variant or the modes stand that a deck complains of; file NULL where it is something else. */
static struct place place_in_plan(const struct plan *plan, const struct study_cell *cell, const char *file)
{
    const struct plan_variant *variant = &plan->variant[cell->variant];
    const struct plan_modes *modes = &plan->modes[cell->modes];
    for (int i = 0; i < variant->noverride && file; i++)
        if (!strcmp(file, variant->override[i].text))
            return variant->place[i];
    return file && modes->text && !strcmp(file, modes->text) ? modes->place : (struct place){NULL, 0, 0};
}

/* Errors of a deck that can be read as it stands: the plan causes them. */
static void blame_plan(struct checker *c, const struct study_cell *cell, const struct message_list *found)
{
    const struct plan *plan = c->study->plan;
    const char *deck = plan->deck[cell->deck].name, *variant = plan->variant[cell->variant].name,
               *modes = plan->modes[cell->modes].text;
    for (size_t i = 0; i < found->count; i++) {
        const rotid_message *m = &found->item[i];
        char text[1500];
        if (m->severity != SEVERITY_ERROR)
            continue;
        struct place place = place_in_plan(plan, cell, m->file);
        if (place.file)
            (void)snprintf(text, sizeof text, "%s (deck %s)", m->text, deck);
        else
            (void)snprintf(text, sizeof text, "%s (with%s%s%s%s of the plan)", m->text, variant ? " variant " : "",
                           variant ? variant : "", modes ? " modes " : "", modes ? modes : "");
        report(c, place.file ? place : (struct place){m->file, m->line, m->column}, text);
    }
}

/* The first error, with its place. */
static const char *first_error(struct checker *c, const struct message_list *found)
{
    for (size_t i = 0; i < found->count; i++) {
        const rotid_message *m = &found->item[i];
        if (m->severity != SEVERITY_ERROR)
            continue;
        if (found->errors > 1)
            return pool_format(c->pool, "%s:%d:%d: %s (and %d more errors)", m->file ? m->file : "", m->line, m->column, m->text,
                               found->errors - 1);
        return pool_format(c->pool, "%s:%d:%d: %s", m->file ? m->file : "", m->line, m->column, m->text);
    }
    return "the deck cannot be read";
}

/* The runs of a deck that is wrong as it stands fail; every error of it is told now, while somebody may be there to read it. */
static int give_up(struct checker *c, int d, const struct message_list *found)
{
    for (size_t i = 0; i < found->count; i++)
        if (found->item[i].severity == SEVERITY_ERROR)
            message_add(c->messages, SEVERITY_WARNING, found->item[i].file, found->item[i].line, found->item[i].column, "%s",
                        found->item[i].text);
    c->study->deck[d].error = first_error(c, found);
    return c->study->deck[d].error ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The deck as it stands. Status of the reader. */
static int read_plain(struct checker *c, int d, struct message_list *found, struct states *states)
{
    struct plan_variant variant = {0};
    struct plan_modes modes = {0};
    struct plan plain = *c->study->plan; /* no variant, no modes */
    struct study study = *c->study;
    const struct study_cell cell = {.deck = d};
    plain.variant = &variant;
    plain.modes = &modes;
    study.plan = &plain;
    message_open(found, &c->scratch);
    return jobs_read_fitted(&c->scratch, &study, &cell, found, states);
}

/* The files of a deck, those that no deck before it has; of several states the last one has all. */
static int keep_files(struct checker *c, const struct states *states)
{
    struct study *study = c->study;
    const struct job *job = &states->state[states->nstate - 1].job;
    for (int i = 0; i < job->nfile; i++) {
        int known = 0;
        while (known < study->nfile && strcmp(study->file[known], job->file[i]) != 0)
            known++;
        if (known < study->nfile)
            continue;
        const char *file = pool_copy_text(c->pool, job->file[i]);
        if (!file || POOL_ADD(c->pool, study->file, study->nfile, &file))
            return ROTID_ERROR_MEMORY;
    }
    return ROTID_OK;
}

static void check_sensors(struct checker *c, const struct study_cell *cell, const struct job *job)
{
    const struct plan *plan = c->study->plan;
    int highest = 0, nsensor = job->rotor.nsensor;
    char text[512];
    for (int k = 0; k < job->measurement.nmode; k++)
        highest = job->measurement.number[k] > highest ? job->measurement.number[k] : highest;
    for (int s = 0; s < plan->nsensors; s++) {
        const struct plan_sensors *sensors = &plan->sensors[s];
        int left = sensors->keep ? sensors->keep : sensors->every ? (nsensor + sensors->every - 1) / sensors->every : nsensor;
        if (!sensors->text)
            continue;
        *text = 0;
        if (!nsensor)
            (void)snprintf(text, sizeof text, "deck %s has no sensors, expected a plan without *SENSORS",
                           plan->deck[cell->deck].name);
        else if (left > nsensor)
            (void)snprintf(text, sizeof text, "deck %s has %d sensors, expected not more than that", plan->deck[cell->deck].name,
                           nsensor);
        else if (job->options.fit.reduction != ROTID_REDUCTION_NONE && left < 2 * highest)
            (void)snprintf(text, sizeof text,
                           "%d sensors are too few to condense deck %s onto for mode %d, expected at least twice as many as "
                           "modes, or FIT.REDUCTION=NONE",
                           left, plan->deck[cell->deck].name, highest);
        if (*text)
            report(c, sensors->place, text);
    }
}

/* Of a shared one all. */
static int has_parameters(const struct rotor *rotor, const char *names)
{
    char name[PARAMETER_NAME];
    int lacks = 0;
    for (const char *next = names; next && !lacks;) {
        struct parameter parameter;
        const char *unit;
        next = parameter_next_name(next, name);
        lacks = parameter_find(rotor, name, &parameter, &unit) != 0;
    }
    return !lacks;
}

/* In one of the states at least. */
static void check_truth(struct checker *c, int d, const struct states *states)
{
    const struct plan *plan = c->study->plan;
    for (int t = 0; t < plan->ntruth; t++) {
        char text[512];
        (void)snprintf(text, sizeof text, "%s is no parameter of deck %s, expected one such as NAME.E", plan->truth[t].name,
                       plan->deck[d].name);
        int found = 0;
        for (int s = 0; s < states->nstate; s++)
            found |= has_parameters(&states->state[s].job.rotor, plan->truth[t].name);
        if (!found)
            report(c, plan->truth[t].place, text);
    }
}

static int check_hidden(struct checker *c, int d)
{
    const struct plan *plan = c->study->plan;
    int status = ROTID_OK;
    for (int h = 0; h < plan->nhide && status != ROTID_ERROR_MEMORY; h++) {
        struct message_list found;
        struct truth *truth;
        message_open(&found, &c->scratch);
        if (plan->hide[h].lower)
            status = jobs_read_truth(&c->scratch, c->study, d, h, &found, &truth);
        for (size_t i = 0; i < found.count; i++)
            if (found.item[i].severity == SEVERITY_ERROR)
                report(c, (struct place){found.item[i].file, found.item[i].line, found.item[i].column}, found.item[i].text);
    }
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
}

static int check_variants(struct checker *c, int d)
{
    const struct plan *plan = c->study->plan;
    struct study_cell cell = {.deck = d};
    for (cell.variant = 0; cell.variant < plan->nvariant; cell.variant++)
        for (cell.modes = 0; cell.modes < plan->nmodes; cell.modes++) {
            struct message_list found;
            struct states states;
            message_open(&found, &c->scratch);
            int status = jobs_read_fitted(&c->scratch, c->study, &cell, &found, &states);
            if (status == ROTID_ERROR_MEMORY)
                return status;
            if (status) {
                blame_plan(c, &cell, &found);
                continue;
            }
            if (keep_files(c, &states))
                return ROTID_ERROR_MEMORY;
            for (int s = 0; s < states.nstate; s++) {
                check_sensors(c, &cell, &states.state[s].job);
                if (!cell.modes)
                    digest_measured(&c->check->data, &states.state[s].job);
                if (!cell.modes)
                    digest_measured(&c->own, &states.state[s].job);
            }
            c->check->nparameter[cell.variant + (ptrdiff_t)d * plan->nvariant] = states.nparameter;
        }
    return ROTID_OK;
}

/* What a run cannot do without. */
static void check_states(const struct plan *plan, const struct states *states, struct message_list *found)
{
    const char *deck = states->state[0].job.deck;
    for (int s = 0; s < states->nstate; s++)
        if (!states->state[s].job.measurement.nmode)
            message_add(found, SEVERITY_ERROR, deck, 1, 1, "the deck has no measured modes%s%s, expected *MODES or *MEASURED",
                        states->nstate > 1 ? " in state " : "", states->nstate > 1 ? states->state[s].name : "");
    if (!states->nparameter && plan->command == PLAN_IDENTIFY)
        message_add(found, SEVERITY_ERROR, deck, 1, 1, "the deck has no *IDENTIFY, expected the parameters to identify");
}

static int check_deck(struct checker *c, int d)
{
    const struct plan *plan = c->study->plan;
    struct message_list found;
    struct deck_text text;
    struct states states;
    message_open(&found, &c->scratch);
    digest_open(&c->own);
    digest_text(&c->check->decks, plan->deck[d].name);
    digest_text(&c->own, plan->deck[d].name);
    int status =
        deck_text_read(&c->scratch, plan->deck[d].path, &found, &text); /* what is wrong with it deck_read_states says again */
    if (status == ROTID_ERROR_MEMORY)
        return status;
    digest_cards(&c->check->decks, &text);
    digest_cards(&c->own, &text);
    status = read_plain(c, d, &found, &states);
    if (!status)
        status = keep_files(c, &states);
    if (status == ROTID_ERROR_MEMORY)
        return status;
    if (!status)
        check_states(plan, &states, &found);
    if (status || found.errors)
        return give_up(c, d, &found);
    check_truth(c, d, &states);
    status = check_hidden(c, d);
    return status ? status : check_variants(c, d);
}

/* Fills study->deck[].error and study->file. Errors of the plan go to the list with their places in it, decks that are wrong as
 * they stand as warnings. ROTID_OK, ROTID_ERROR_SYNTAX (also where no deck can be used), ROTID_ERROR_MEMORY. */
static int check_decks(struct pool *pool, struct study *study, struct message_list *messages, struct check *check)
{
    const struct plan *plan = study->plan;
    struct checker c = {.pool = pool, .study = study, .messages = messages, .check = check};
    int status = ROTID_OK, bad = 0;
    check->nparameter = POOL_ARRAY(pool, int, (size_t)plan->nvariant *(size_t)plan->ndeck);
    if (!check->nparameter)
        return ROTID_ERROR_MEMORY;
    digest_open(&check->decks);
    digest_open(&check->data);
    for (int d = 0; d < plan->ndeck && !status; d++) {
        pool_open(&c.scratch, pool->allocator);
        status = check_deck(&c, d);
        digest_letters(&c.own, study->deck[d].digest);
        pool_close(&c.scratch);
        bad += study->deck[d].error != NULL;
    }
    for (size_t i = 0; i < messages->count && !status && bad == plan->ndeck;
         i++) { /* to be said whether warnings are wanted or not */
        messages->item[i].severity = SEVERITY_ERROR;
        messages->errors++;
    }
    if (!status && bad == plan->ndeck)
        message_add(messages, SEVERITY_ERROR, plan->path ? plan->path : plan->deck[0].path, 1, 1,
                    plan->ndeck > 1 ? "none of the decks can be used: nothing was computed"
                                    : "the deck cannot be used: nothing was computed");
    if (!status && !messages->errors && bad)
        message_add(messages, SEVERITY_WARNING, NULL, 0, 0, "%d of %d decks cannot be used: their runs are recorded as failed",
                    bad, plan->ndeck);
    return status ? status : messages->errors ? ROTID_ERROR_SYNTAX : ROTID_OK;
}

/* Cells of one deck and variant. */
static long cells(const struct plan *plan)
{
    return (long)plan->nmodes * plan->nsensors * plan->nnoise * plan->nhide;
}

struct study_point study_locate(const struct study *study, long run)
{
    const struct plan *plan = study->plan;
    struct study_point point = {0};
    struct study_cell *cell = &point.cell;
    while (run >= study->deck[cell->deck].first[plan->nvariant])
        cell->deck++;
    const struct study_deck *deck = &study->deck[cell->deck];
    while (run >= deck->first[cell->variant + 1])
        cell->variant++;
    run -= deck->first[cell->variant];
    point.start = run % deck->starts[cell->variant];
    run /= deck->starts[cell->variant];
    point.replicate = run % plan->replicates;
    run /= plan->replicates;
    cell->hide = (int)(run % plan->nhide);
    run /= plan->nhide;
    cell->noise = (int)(run % plan->nnoise);
    run /= plan->nnoise;
    cell->sensors = (int)(run % plan->nsensors);
    cell->modes = (int)(run / plan->nsensors);
    return point;
}

/* grid^n, or more than there may be runs. */
static long starts_of(const struct plan *plan, int nparameter)
{
    long starts = plan->grid ? 1 : plan->count;
    for (int p = 0; p < nparameter && plan->grid && starts <= STUDY_MOST_RUNS; p++)
        starts *= plan->grid;
    return starts;
}

static int count_runs(struct pool *pool, const struct check *check, struct study *study, struct message_list *messages)
{
    const struct plan *plan = study->plan;
    double runs = 0;
    for (int d = 0; d < plan->ndeck; d++) {
        struct study_deck *deck = &study->deck[d];
        deck->first = POOL_ARRAY(pool, long, plan->nvariant + 1);
        deck->starts = POOL_ARRAY(pool, long, plan->nvariant);
        if (!deck->first || !deck->starts)
            return ROTID_ERROR_MEMORY;
        for (int v = 0; v < plan->nvariant; v++) {
            deck->starts[v] = starts_of(plan, check->nparameter[v + (ptrdiff_t)d * plan->nvariant]);
            runs += (double)cells(plan) * plan->replicates * (double)deck->starts[v];
            if (runs > STUDY_MOST_RUNS)
                return message_refuse(messages, ROTID_ERROR_SYNTAX, plan->path ? plan->path : plan->deck[0].path, 1, 1,
                                      "the plan has more than %d runs, expected fewer", STUDY_MOST_RUNS);
            deck->first[v] = study->runs;
            study->runs = (long)runs;
        }
        deck->first[plan->nvariant] = study->runs;
    }
    return ROTID_OK;
}

static void digest_plan(struct study *study)
{
    const struct plan *plan = study->plan;
    struct digest digest;
    digest_open(&digest);
    digest_cards(&digest, &plan->text);
    for (int d = 0; d < plan->ndeck; d++)
        digest_text(&digest, plan->deck[d].name);
    digest_letters(&digest, study->plan_digest);
    digest_open(&digest);
    for (int i = 0; i < study->noverride; i++) {
        digest_text(&digest, study->override[i].card);
        digest_text(&digest, study->override[i].option);
        digest_text(&digest, study->override[i].value);
    }
    digest_letters(&digest, study->options_digest);
}

int study_open(struct pool *pool, const struct plan *plan, int noverride, const struct override *override, unsigned long seed,
               struct message_list *messages, struct study *study)
{
    struct check check;
    *study = (struct study){.plan = plan, .noverride = noverride, .override = override, .seed = seed};
    study->deck = POOL_ARRAY(pool, struct study_deck, plan->ndeck);
    if (!study->deck)
        return ROTID_ERROR_MEMORY;
    int status = check_decks(pool, study, messages, &check);
    if (!status)
        status = count_runs(pool, &check, study, messages);
    if (status)
        return status;
    digest_plan(study);
    digest_letters(&check.decks, study->decks_digest);
    digest_letters(&check.data, study->data_digest);
    study->input = plan->path ? NULL : POOL_ARRAY(pool, const char *, study->runs); /* a run a deck */
    for (long i = 0; i < study->runs && study->input; i++)
        study->input[i] = study->deck[i].digest;
    if (!plan->path && !study->input)
        return ROTID_ERROR_MEMORY;
    return messages->pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}
