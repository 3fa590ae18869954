/* A study: every deck read in every variant before the first run, what is wrong with the plan told at its place in it; runs
 * counted and found; digests of all that the runs depend on. */
#include "study/study.h"

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
    const struct job_measurement *m = &job->measurement;
    size_t nmode = (size_t)m->nmode, components = nmode * (size_t)job->rotor.nsensor;
    digest_integer(digest, m->nmode);
    digest_integer(digest, job->rotor.nsensor);
    for (int k = 0; k < m->nmode; k++)
        digest_integer(digest, m->number[k]);
    for (int s = 0; s < job->rotor.nsensor; s++) {
        digest_integer(digest, job->rotor.sensor[s].id);
        digest_doubles(digest, 1, &job->rotor.sensor[s].position);
    }
    digest_doubles(digest, nmode, m->frequency_hz);
    digest_doubles(digest, nmode, m->frequency_std);
    digest_doubles(digest, nmode, m->damping);
    digest_doubles(digest, m->shape ? components : 0, m->shape);
    digest_doubles(digest, m->shape ? components : 0, m->shape_std);
    digest_doubles(digest, m->point_frequency_hz ? components : 0, m->point_frequency_hz);
    digest_doubles(digest, m->point_frequency_hz ? components : 0, m->point_frequency_std);
    digest_integer(digest, m->hammer);
}

/* What tables may say in the place of data lines: the sections. */
static void digest_sections(struct digest *digest, const struct rotor *rotor)
{
    for (int i = 0; i < rotor->nsegment; i++) {
        const struct segment *segment = &rotor->segment[i];
        digest_text(digest, rotor->group[segment->group].name);
        digest_text(digest, rotor->group[segment->group].material.name);
        digest_integer(digest, segment->elements);
        digest_doubles(digest, 6,
                       (const double[]){segment->length, segment->outer, segment->inner, segment->stiff_outer, segment->height,
                                        segment->width});
    }
}

/* And bearings with their pedestals. */
static void digest_bearings(struct digest *digest, const struct machine *machine)
{
    for (int i = 0; machine && i < machine->nbearing; i++)
        for (int pedestal = 0; pedestal < 2; pedestal++) {
            const struct coefficients *all = pedestal ? &machine->bearing[i].pedestal : &machine->bearing[i].film;
            size_t count = (size_t)all->count;
            digest_doubles(digest, count, all->speed);
            digest_doubles(digest, 4 * count, all->k);
            digest_doubles(digest, 4 * count, all->c);
        }
}

/* ---- the decks */

struct checker {
    struct pool *pool, scratch; /* scratch: of one deck */
    struct study *study;
    struct message_list *messages;
    struct digest cards, data; /* of the deck that is read */
};

/* An error at a place. The same words there say nothing new: a plan with many decks would say them for each. */
static void report(struct checker *c, struct place place, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void report(struct checker *c, struct place place, const char *format, ...)
{
    char text[1500];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    for (size_t i = 0; i < c->messages->count; i++) {
        const rotid_message *m = &c->messages->item[i];
        if (equal_texts(m->file, place.file) && m->line == place.line && m->column == place.column && !strcmp(m->text, text))
            return;
    }
    message_at(c->messages, SEVERITY_ERROR, place, "%s", text);
}

/* The errors of a list from number i on, one behind the other; NULL behind the last. */
static const rotid_message *next_error(const struct message_list *found, size_t *i)
{
    while (*i < found->count && found->item[*i].severity != SEVERITY_ERROR)
        ++*i;
    return *i < found->count ? &found->item[(*i)++] : NULL;
}

/* Where in the plan the option of a variant or the modes stand that a deck complains of; file NULL where it is something else. */
static struct place place_in_plan(const struct plan_item *variant, const struct plan_item *modes, const char *file)
{
    for (int i = 0; i < variant->noverride && file; i++)
        if (!strcmp(file, variant->override[i].text))
            return variant->override_place[i];
    return file && modes->name && !strcmp(file, modes->name) ? modes->place : (struct place){NULL, 0, 0};
}

/* Errors of a deck that can be read as it stands: the plan causes them. */
static void blame_plan(struct checker *c, const struct study_cell *cell, const struct message_list *found)
{
    const struct plan *plan = c->study->plan;
    const struct plan_item *variant = plan_at(plan, cell, AXIS_VARIANT), *modes = plan_at(plan, cell, AXIS_MODES);
    const rotid_message *m;
    for (size_t i = 0; (m = next_error(found, &i));) {
        struct place place = place_in_plan(variant, modes, m->file);
        if (place.file)
            report(c, place, "%s (deck %s)", m->text, plan_at(plan, cell, AXIS_DECK)->name);
        else
            report(c, (struct place){m->file, m->line, m->column}, "%s (with%s%s%s%s of the plan)", m->text,
                   variant->name ? " variant " : "", variant->name ? variant->name : "", modes->name ? " modes " : "",
                   modes->name ? modes->name : "");
    }
}

/* The runs of a deck that is wrong as it stands fail, for its first error; every one is told now, while somebody may be there to
 * read it. */
static int give_up(struct checker *c, int d, const struct message_list *found)
{
    const char *error = "the deck cannot be read";
    const rotid_message *m;
    for (size_t i = 0, count = 0; (m = next_error(found, &i)); count++) {
        message_at(c->messages, SEVERITY_WARNING, *m, "%s", m->text);
        const char *more = found->errors > 1 ? pool_format(c->pool, " (and %d more errors)", found->errors - 1) : "";
        if (!count)
            error = pool_format(c->pool, "%s:%d:%d: %s%s", m->file ? m->file : "", m->line, m->column, m->text, more ? more : "");
    }
    c->study->deck[d].error = error;
    return error ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The files of a deck; of several states the last one has all. */
static int keep_files(struct checker *c, const struct states *states)
{
    const struct job *job = &states->state[states->nstate - 1].job;
    for (int i = 0; i < job->nfile; i++) {
        const char *file = pool_copy_text(c->pool, job->file[i]);
        if (!file || POOL_ADD(c->pool, c->study->file, c->study->nfile, &file))
            return ROTID_ERROR_MEMORY;
    }
    return ROTID_OK;
}

static void check_sensors(struct checker *c, const char *deck, const struct job *job)
{
    const struct plan *plan = c->study->plan;
    int highest = comparison_highest(job), nsensor = job->rotor.nsensor;
    for (int s = 0; s < plan->axis[AXIS_SENSORS].count; s++) {
        const struct plan_item *sensors = &plan->axis[AXIS_SENSORS].item[s];
        int left = sensors->keep ? sensors->keep : sensors->every ? (nsensor + sensors->every - 1) / sensors->every : nsensor;
        if (sensors->name && !nsensor)
            report(c, sensors->place, "deck %s has no sensors, expected a plan without *SENSORS", deck);
        else if (sensors->name && left > nsensor)
            report(c, sensors->place, "deck %s has %d sensors, expected not more than that", deck, nsensor);
        else if (sensors->name && job->options.fit.reduction != ROTID_REDUCTION_NONE && left < 2 * highest)
            report(c, sensors->place,
                   "%d sensors are too few to condense deck %s onto for mode %d, expected at least twice as many as modes, or "
                   "FIT.REDUCTION=NONE",
                   left, deck, highest);
    }
}

/* Of a shared one all; with values that they can have. */
static int has_parameters(struct checker *c, const struct job *job, const struct plan_truth *truth)
{
    char name[PARAMETER_NAME];
    int lacks = 0;
    for (const char *next = truth->name; next && !lacks;) {
        struct parameter parameter;
        const char *unit, *range = NULL;
        next = parameter_next_name(next, name);
        lacks = parameter_find(&job->rotor, name, &parameter, &unit) != 0;
        for (int end = 0; end < 2 && !lacks && !range; end++) {
            double si = deck_unit_of(&job->units, unit ? unit : ""), stated = end ? truth->upper : truth->lower,
                   value = stated * si;
            range = deck_outside_range(&c->scratch, &job->rotor, parameter, si, &value);
            if (range)
                report(c, truth->place, "%s is %.6g, expected a value %s in deck %s", name, stated, range, job->deck);
        }
    }
    return !lacks;
}

/* In one of the states at least. */
static void check_truth(struct checker *c, const char *deck, const struct states *states)
{
    const struct plan *plan = c->study->plan;
    for (int t = 0; t < plan->ntruth; t++) {
        int found = 0;
        for (int s = 0; s < states->nstate; s++)
            found |= has_parameters(c, &states->state[s].job, &plan->truth[t]);
        if (!found)
            report(c, plan->truth[t].place, "%s is no parameter of deck %s, expected one such as NAME.E", plan->truth[t].name,
                   deck);
    }
}

static int check_hidden(struct checker *c, struct study_cell cell)
{
    const struct plan *plan = c->study->plan;
    for (cell.at[AXIS_HIDE] = 0; cell.at[AXIS_HIDE] < plan->axis[AXIS_HIDE].count; cell.at[AXIS_HIDE]++) {
        struct message_list found;
        struct truth *truth;
        const rotid_message *m;
        message_open(&found, &c->scratch);
        if (plan_at(plan, &cell, AXIS_HIDE)->end[0] &&
            jobs_read_truth(&c->scratch, c->study, &cell, &found, &truth) == ROTID_ERROR_MEMORY)
            return ROTID_ERROR_MEMORY;
        for (size_t i = 0; (m = next_error(&found, &i));)
            report(c, (struct place){m->file, m->line, m->column}, "%s", m->text);
    }
    return ROTID_OK;
}

/* grid^n, or more than there may be runs. */
static long starts_of(const struct plan *plan, int nparameter)
{
    long starts = plan->grid ? 1 : plan->count;
    for (int p = 0; p < nparameter && plan->grid && starts <= STUDY_MOST_RUNS; p++)
        starts *= plan->grid;
    return starts;
}

/* The deck in a variant and with modes. */
static int check_cell(struct checker *c, const struct study_cell *cell)
{
    const struct plan *plan = c->study->plan;
    struct message_list found;
    struct states states;
    message_open(&found, &c->scratch);
    int status = jobs_read_fitted(&c->scratch, c->study, cell, &found, &states);
    if (status == ROTID_ERROR_MEMORY)
        return status;
    if (status) {
        blame_plan(c, cell, &found);
        return ROTID_OK;
    }
    for (int s = 0; s < states.nstate; s++) {
        check_sensors(c, plan_at(plan, cell, AXIS_DECK)->name, &states.state[s].job);
        if (cell->at[AXIS_MODES])
            continue;
        digest_measured(&c->data, &states.state[s].job);
        digest_sections(&c->data, &states.state[s].job.rotor);
    }
    if (!cell->at[AXIS_MODES])
        digest_bearings(&c->data, states.machine);
    c->study->deck[cell->at[AXIS_DECK]].starts[cell->at[AXIS_VARIANT]] = starts_of(plan, states.nparameter);
    return cell->at[AXIS_MODES] ? ROTID_OK : keep_files(c, &states); /* those of other modes are the same */
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
    struct study_cell cell = {{[AXIS_DECK] = d, [AXIS_VARIANT] = -1, [AXIS_MODES] = -1}}; /* as it stands */
    const struct plan_item *deck = plan_at(plan, &cell, AXIS_DECK);
    struct message_list found;
    struct deck_text text;
    struct states states;
    message_open(&found, &c->scratch);
    digest_open(&c->cards);
    digest_open(&c->data);
    digest_text(&c->cards, deck->name);
    int status = deck_text_read(&c->scratch, deck->path, NULL, &found, &text); /* what is wrong with it is said again below */
    if (status == ROTID_ERROR_MEMORY)
        return status;
    digest_cards(&c->cards, &text);
    message_open(&found, &c->scratch);
    status = jobs_read_fitted(&c->scratch, c->study, &cell, &found, &states);
    if (!status)
        status = keep_files(c, &states);
    if (status == ROTID_ERROR_MEMORY)
        return status;
    if (!status)
        check_states(plan, &states, &found);
    if (status || found.errors)
        return give_up(c, d, &found);
    check_truth(c, deck->name, &states);
    status = check_hidden(c, cell);
    for (cell.at[AXIS_VARIANT] = 0; cell.at[AXIS_VARIANT] < plan->axis[AXIS_VARIANT].count; cell.at[AXIS_VARIANT]++)
        for (cell.at[AXIS_MODES] = 0; cell.at[AXIS_MODES] < plan->axis[AXIS_MODES].count && !status; cell.at[AXIS_MODES]++)
            status = check_cell(c, &cell);
    return status;
}

static void digest_more(struct digest *digest, const struct digest *part)
{
    digest_integer(digest, (long long)part->state);
}

/* Hexadecimal; NULL where memory is out. */
static const char *digest_letters(struct pool *pool, const struct digest *digest)
{
    return pool_format(pool, "%016llx", (unsigned long long)digest->state);
}

/* Fills study->deck but for the numbers of runs, study->file and the digests of decks. Errors of the plan go to the list with
 * their places in it, decks that are wrong as they stand as warnings. ROTID_OK, ROTID_ERROR_SYNTAX (also where no deck can be
 * used), ROTID_ERROR_MEMORY. */
static int check_decks(struct pool *pool, struct study *study, struct message_list *messages)
{
    const struct plan *plan = study->plan;
    struct checker c = {.pool = pool, .study = study, .messages = messages};
    struct digest decks, data;
    int bad = 0, ndeck = plan->axis[AXIS_DECK].count, nvariant = plan->axis[AXIS_VARIANT].count;
    digest_open(&decks);
    digest_open(&data);
    for (int d = 0; d < ndeck; d++) {
        struct study_deck *deck = &study->deck[d];
        struct digest own;
        deck->first = POOL_ARRAY(pool, long, nvariant + 1);
        deck->starts = POOL_ARRAY(pool, long, nvariant);
        if (!deck->first || !deck->starts)
            return ROTID_ERROR_MEMORY;
        for (int v = 0; v < nvariant; v++)
            deck->starts[v] = starts_of(plan, 0);
        pool_open(&c.scratch, pool->allocator);
        int status = check_deck(&c, d);
        pool_close(&c.scratch);
        if (status)
            return status;
        digest_more(&decks, &c.cards);
        digest_more(&data, &c.data);
        own = c.cards;
        digest_more(&own, &c.data);
        deck->digest = digest_letters(pool, &own);
        bad += deck->error != NULL;
    }
    study->digest.decks = digest_letters(pool, &decks);
    study->digest.data = digest_letters(pool, &data);
    for (size_t i = 0; i < messages->count && bad == ndeck; i++) { /* to be said whether warnings are wanted or not */
        messages->item[i].severity = SEVERITY_ERROR;
        messages->errors++;
    }
    if (bad == ndeck)
        message_add(messages, SEVERITY_ERROR, plan->path ? plan->path : plan->axis[AXIS_DECK].item[0].path, 1, 1,
                    ndeck > 1 ? "none of the decks can be used: nothing was computed"
                              : "the deck cannot be used: nothing was computed");
    else if (!messages->errors && bad)
        message_warn(messages, "%d of %d decks cannot be used: their runs are recorded as failed", bad, ndeck);
    return messages->errors ? ROTID_ERROR_SYNTAX : ROTID_OK;
}

/* ---- runs */

struct study_point study_locate(const struct study *study, long run)
{
    const struct plan *plan = study->plan;
    struct study_point point = {0};
    int *deck = &point.cell.at[AXIS_DECK], *variant = &point.cell.at[AXIS_VARIANT];
    while (run >= study->deck[*deck].first[plan->axis[AXIS_VARIANT].count])
        ++*deck;
    while (run >= study->deck[*deck].first[*variant + 1])
        ++*variant;
    run -= study->deck[*deck].first[*variant];
    point.start = run % study->deck[*deck].starts[*variant];
    run /= study->deck[*deck].starts[*variant];
    point.replicate = run % plan->replicates;
    run /= plan->replicates;
    for (int axis = PLAN_AXES - 1; axis > AXIS_VARIANT; axis--) {
        point.cell.at[axis] = (int)(run % plan->axis[axis].count);
        run /= plan->axis[axis].count;
    }
    return point;
}

static int count_runs(struct study *study, struct message_list *messages)
{
    const struct plan *plan = study->plan;
    double runs = 0, cells = plan->replicates; /* with their replicates, of one deck and variant */
    for (int axis = AXIS_MODES; axis < PLAN_AXES; axis++)
        cells *= plan->axis[axis].count;
    for (int d = 0; d < plan->axis[AXIS_DECK].count; d++) {
        struct study_deck *deck = &study->deck[d];
        for (int v = 0; v < plan->axis[AXIS_VARIANT].count; v++) {
            runs += cells * (double)deck->starts[v];
            if (runs > STUDY_MOST_RUNS)
                return message_refuse(messages, ROTID_ERROR_SYNTAX, plan->path ? plan->path : plan->axis[AXIS_DECK].item[0].path,
                                      1, 1, "the plan has more than %d runs, expected fewer", STUDY_MOST_RUNS);
            deck->first[v] = study->runs;
            study->runs = (long)runs;
        }
        deck->first[plan->axis[AXIS_VARIANT].count] = study->runs;
    }
    return ROTID_OK;
}

static void digest_plan(struct pool *pool, struct study *study)
{
    const struct plan *plan = study->plan;
    struct digest digest;
    digest_open(&digest);
    digest_cards(&digest, &plan->text);
    for (int d = 0; d < plan->axis[AXIS_DECK].count; d++)
        digest_text(&digest, plan->axis[AXIS_DECK].item[d].name);
    study->digest.plan = digest_letters(pool, &digest);
    digest_open(&digest);
    for (int i = 0; i < study->noverride; i++) {
        digest_text(&digest, study->override[i].card);
        digest_text(&digest, study->override[i].option);
        digest_text(&digest, study->override[i].value);
    }
    study->digest.options = digest_letters(pool, &digest);
}

int study_open(struct pool *pool, const struct plan *plan, int noverride, const struct override *override, unsigned long seed,
               struct message_list *messages, struct study *study)
{
    *study = (struct study){.plan = plan, .noverride = noverride, .override = override, .seed = seed};
    study->deck = POOL_ARRAY(pool, struct study_deck, plan->axis[AXIS_DECK].count);
    if (!study->deck)
        return ROTID_ERROR_MEMORY;
    int status = check_decks(pool, study, messages);
    if (!status)
        status = count_runs(study, messages);
    if (status)
        return status;
    digest_plan(pool, study);
    return pool->out_of_memory || messages->pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}
