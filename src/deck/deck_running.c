/* Cards behind *RUNNING: the machine in operation. */
#include <strings.h>

#include "deck/deck_row.h"
#include "running/running.h"

#define MOST_POLES   1000
#define MOST_SPEEDS  10000 /* of a table of a bearing */
#define COEFFICIENTS 8     /* kxx, kxy, kyx, kyy, cxx, cxy, cyx, cyy */

static int is(const struct card *card, const char *name)
{
    return !strcmp(card->name, name);
}

void deck_split_running(struct deck_reader *reader, int *nread)
{
    struct deck_text *text = &reader->text;
    int begin = -1;
    for (int c = 0; c < *nread; c++) {
        const struct card *card = &text->card[c];
        if (is(card, "RUNNING") && begin >= 0)
            deck_error(reader, card->place, "*RUNNING is given twice, expected one machine");
        else if (is(card, "RUNNING"))
            begin = c;
        else if (is(card, "STATE") && begin >= 0)
            deck_error(reader, card->place, "*STATE stands behind *RUNNING, expected the machine behind all states");
        else if (deck_stands(card, CARD_OF_MACHINE) && begin < 0)
            deck_error(reader, card->place, "*%s stands before *RUNNING, expected *RUNNING in front of what the machine has",
                       card->name);
        else if (begin >= 0 && !deck_stands(card, CARD_OF_MACHINE) && !is(card, "DISK") && !is(card, "IDENTIFY"))
            deck_error(reader, card->place,
                       "*%s stands behind *RUNNING, expected it before: behind *RUNNING the machine has *DISK, *IDENTIFY, "
                       "*BEARING and what docs/deck.md lists with them",
                       card->name);
    }
    if (begin < 0)
        return;
    reader->nrunning = *nread - begin;
    reader->running = POOL_COPY(reader->pool, text->card + begin, reader->nrunning, 0);
    memmove(text->card + begin, text->card + *nread, (size_t)(text->ncard - *nread) * sizeof *text->card);
    text->ncard -= reader->nrunning;
    *nread = begin;
}

/* ---- names */

int deck_is_of_bearing(const struct deck_reader *reader, const char *name)
{
    size_t length = strcspn(name, ".");
    for (int c = 0; c < reader->nrunning; c++) {
        const struct card_option *own = is(&reader->running[c], "BEARING") ? card_option(&reader->running[c], "NAME") : NULL;
        if (own && strlen(own->value) == length && !strncasecmp(own->value, name, length))
            return 1;
    }
    return 0;
}

/* The bearing of that name [length], -1: there is none. */
static int find_bearing(const struct machine *machine, const char *name, size_t length)
{
    for (int i = 0; i < machine->nbearing; i++) {
        const char *own = machine->bearing[i].name;
        if (own && strlen(own) == length && !strncasecmp(own, name, length))
            return i;
    }
    return -1;
}

/* -1 after an error. */
static int named_bearing(struct deck_reader *reader, const struct card_option *option)
{
    int found = find_bearing(reader->machine, option->value, strlen(option->value));
    if (found < 0)
        deck_error(reader, option->value_place, "bearing %s is not defined, expected the name of a *BEARING before",
                   option->value);
    return found;
}

static void leave_at_test(struct deck_reader *reader, struct place place, const char *name)
{
    const struct rotor *rotor = &reader->job->rotor;
    struct machine *machine = reader->machine;
    int found = 0, all = same_text(name, "all");
    if (all || same_text(name, "sling")) {
        found = rotor->sling > 0 || all;
        machine->without_sling = 1;
    }
    for (int kind = 0; kind < 2; kind++) {
        int *without = kind ? machine->without_disk : machine->without_spring;
        const char **own;
        for (int i = 0; (own = deck_name_of(rotor, kind ? TARGET_DISK : TARGET_SPRING, i)); i++)
            if ((all && !kind) || (!all && *own && same_text(*own, name)))
                found = without[i] = 1;
    }
    for (int i = 0; i < rotor->neffect; i++)
        if (all ? effect_is_of_test(&rotor->effect[i], rotor) : rotor->effect[i].name && same_text(rotor->effect[i].name, name))
            found = machine->without_effect[i] = 1;
    if (!found)
        deck_error(reader, place,
                   "%s is no support or mass of the test, expected sling, all (the supports) or the name of a *SPRING, *DISK or "
                   "*CAUSE before *RUNNING",
                   name);
}

void deck_running(struct deck_reader *reader, const struct card *card)
{
    struct machine *machine = reader->machine;
    const struct rotor *rotor = &reader->job->rotor;
    const struct card_option *without = card_option(card, "WITHOUT");
    machine->place = card->place;
    machine->without_spring = POOL_ARRAY(reader->pool, int, rotor->nspring);
    machine->without_disk = POOL_ARRAY(reader->pool, int, rotor->ndisk);
    machine->without_effect = POOL_ARRAY(reader->pool, int, rotor->neffect);
    if (reader->pool->out_of_memory)
        return;
    if (without)
        leave_at_test(reader, without->value_place, without->value);
    for (int i = 0; i < card->nline; i++)
        for (int j = 0; j < card->line[i].count; j++)
            leave_at_test(reader, card->line[i].field[j].place, card->line[i].field[j].text);
    for (int s = 0; s < rotor->nsegment; s++)
        if (rotor->segment[s].rectangular) {
            deck_error(reader, card->place, "group %s is a *BEAM, expected round *SHAFT groups in a rotor that turns",
                       rotor->group[rotor->segment[s].group].name);
            return;
        }
}

/* ---- bearings */

static void check_bearing(struct deck_reader *reader, struct place place, const struct bearing *b)
{
    double turn = 0, size = 0;
    int negative = 0;
    for (int i = 0; i < b->film.count; i++) {
        const double *k = b->film.k + 4 * (ptrdiff_t)i, *c = b->film.c + 4 * (ptrdiff_t)i;
        turn = fmin(turn, k[XY] - k[YX]);
        size = fmax(size, fabs(k[XX]) + fabs(k[YY]));
        negative |= c[XX] < 0 || c[YY] < 0;
    }
    if (turn < -1e-9 * size)
        deck_note(reader, place,
                  "kxy - kyx of this bearing is below zero, which drives backward whirl: does the rotor spin from y to "
                  "x, or were rows and columns exchanged?");
    if (negative)
        deck_note(reader, place, "the direct damping of this bearing is below zero, which drives whirl");
}

static int bearing_values(struct deck_reader *reader, const struct data_line *line, struct coefficients *b)
{
    static const char *const what[COEFFICIENTS] = {"kxx [N/m]",   "kxy [N/m]",   "kyx [N/m]",   "kyy [N/m]",
                                                   "cxx [N.s/m]", "cxy [N.s/m]", "cyx [N.s/m]", "cyy [N.s/m]"};
    static const int of_two[2] = {0, 4}, of_four[4] = {0, 3, 4, 7}, of_all[COEFFICIENTS] = {0, 1, 2, 3, 4, 5, 6, 7};
    int count = line->count - 1, bad = 0; /* behind the position */
    const int *place = count == 2 ? of_two : count == 4 ? of_four : of_all;
    double value[COEFFICIENTS] = {0};
    if (count != 2 && count != 4 && count != COEFFICIENTS)
        return deck_error(
            reader, line->place,
            "the bearing has %d coefficients, expected 2 (k, c), 4 (kxx, kyy, cxx, cyy) or 8 by rows (kxx, kxy, kyx, kyy, cxx, "
            "cxy, cyx, cyy)",
            count > 0 ? count : 0);
    for (int i = 0; i < count; i++)
        bad |= deck_number(reader, line, 1 + i, what[place[i]], ANY, &value[place[i]]);
    if (count == 2) {
        value[3] = value[0];
        value[7] = value[4];
    }
    if (!bad && (value[0] < 0 || value[3] < 0))
        bad = deck_error(reader, line->field[1].place,
                         "the direct stiffness of a bearing is below zero, expected *PULL for a magnetic "
                         "pull");
    memcpy(b->k, value, 4 * sizeof *value);
    memcpy(b->c, value + 4, 4 * sizeof *value);
    return bad;
}

static int room_of_table(struct deck_reader *reader, struct coefficients *b, int count)
{
    b->count = count;
    b->speed = POOL_ARRAY(reader->pool, double, 9 * (size_t)count);
    b->k = b->speed + count;
    b->c = b->k + 4 * (ptrdiff_t)count;
    return !b->speed;
}

/* A column of the table by its name, -1 where there is none. */
static int column_of(const struct data_line *head, const char *name)
{
    for (int j = 0; j < head->count; j++)
        if (same_text(head->field[j].text, name))
            return j;
    return -1;
}

/* A table of coefficients over what its first column has. */
struct table_layout {
    const char *names[COEFFICIENTS + 1]; /* NULL: none */
    int may_lack[COEFFICIENTS + 1];
    const char *what[3], *expected; /* the first column, those of k, those of c */
    double speed;                   /* rad/s of 1 in the first column */
    enum range range;               /* of the first column */
};

static const struct table_layout of_bearing = {
    {"speed_rpm", "kxx", "kxy", "kyx", "kyy", "cxx", "cxy", "cyx", "cyy"},
    {0, 0, 1, 1, 0, 0, 1, 1, 0},
    {"speed [rpm]", "stiffness [N/m]", "damping [N.s/m]"},
    "speed_rpm, kxx, kyy, cxx, cyy and, where the planes are coupled, kxy, kyx, cxy, cyx",
    RPM,
    NOT_NEGATIVE};
static const struct table_layout of_pedestal = {
    {"frequency_hz", "kx_re", NULL, NULL, "ky_re", "kx_im", NULL, NULL, "ky_im"},
    {0},
    {"frequency [Hz]", "real part of the dynamic stiffness [N/m]", "imaginary part of the dynamic stiffness [N/m]"},
    "frequency_hz, kx_re, kx_im, ky_re, ky_im",
    60 * RPM,
    POSITIVE};

static int read_coefficients(struct deck_reader *reader, const struct card *card, const struct card_option *file,
                             const struct table_layout *layout, struct coefficients *b)
{
    int column[COEFFICIENTS + 1], bad = 0;
    const struct table_text *table = deck_open_table(reader, card);
    if (!table || table->bad)
        return 1;
    if (table->nrow < 2 || table->nrow > MOST_SPEEDS)
        return deck_error(reader, file->value_place, "%s has %d rows, expected a row of names and 1 to %d of coefficients",
                          table->path, table->nrow, MOST_SPEEDS);
    for (int j = 0; j <= COEFFICIENTS; j++) {
        column[j] = layout->names[j] ? column_of(&table->row[0], layout->names[j]) : -1;
        if (column[j] < 0 && layout->names[j] && !layout->may_lack[j])
            bad = deck_error(reader, table->row[0].place, "the table has no column %s, expected %s", layout->names[j],
                             layout->expected);
    }
    if (bad || room_of_table(reader, b, table->nrow - 1))
        return 1;
    for (int i = 0; i < b->count && !bad; i++) {
        const struct data_line *row = &table->row[i + 1];
        double value[COEFFICIENTS + 1] = {0};
        for (int j = 0; j <= COEFFICIENTS; j++)
            if (column[j] >= 0)
                bad |= deck_number(reader, row, column[j], layout->what[j > 4 ? 2 : j > 0], j ? ANY : layout->range, &value[j]);
        b->speed[i] = value[0] * layout->speed;
        memcpy(b->k + 4 * (ptrdiff_t)i, value + 1, 4 * sizeof *value);
        memcpy(b->c + 4 * (ptrdiff_t)i, value + 5, 4 * sizeof *value);
        if (!bad && i && !(b->speed[i] > b->speed[i - 1]))
            bad = deck_error(reader, row->field[column[0]].place,
                             "the values of %s do not rise, expected each above the one before", layout->names[0]);
    }
    return bad;
}

/* STD=ln-normal deviation of k, of c */
static int bearing_std(struct deck_reader *reader, const struct card *card, struct bearing *b)
{
    const struct card_option *option = card_option(card, "STD");
    char *end;
    if (!option)
        return 0;
    b->std[0] = b->std[1] = strtod(option->value, &end);
    if (end != option->value && *end == ',')
        b->std[1] = strtod(end + 1, &end);
    if (end == option->value || *end || !(b->std[0] >= 0 && b->std[0] <= 3) || !(b->std[1] >= 0 && b->std[1] <= 3))
        return deck_error(reader, option->value_place,
                          "STD=%s is no deviation, expected one or two numbers from 0 to 3: of ln k and of ln c", option->value);
    return 0;
}

/* From axes with x along the load, which points down, and y a quarter of a turn further with the spin: (x, y) of there is
 * (-y, x) of here, K = T' K T. */
static void turn_to_load(double k[4])
{
    double xx = k[XX], xy = k[XY], yx = k[YX], yy = k[YY];
    k[XX] = yy;
    k[XY] = -yx;
    k[YX] = -xy;
    k[YY] = xx;
}

void deck_bearing(struct deck_reader *reader, const struct card *card)
{
    struct machine *machine = reader->machine;
    const struct card_option *name = card_option(card, "NAME"), *file = card_option(card, "FILE"),
                             *like = card_option(card, "LIKE");
    struct bearing b = {.name = name ? name->value : NULL, .like = machine->nbearing, .unknown = {-1, -1}};
    const struct data_line *line = deck_only_line(reader, card);
    if (!line)
        return;
    int bad = bearing_std(reader, card, &b) | deck_position(reader, &line->field[0], "position", &b.z);
    if (like) {
        int of = named_bearing(reader, like);
        bad |= of < 0;
        if (of >= 0) {
            b.like = machine->bearing[of].like;
            memcpy(b.std, machine->bearing[of].std, sizeof b.std);
        }
        if (card_option(card, "STD"))
            bad = deck_error(reader, card_option(card, "STD")->place, "LIKE shares the draws of %s, expected no STD beside it",
                             like->value);
    }
    if (file) {
        reader->layout = "position alone beside FILE";
        bad |= deck_count(reader, line, 1) || read_coefficients(reader, card, file, &of_bearing, &b.film);
    } else {
        bad |= room_of_table(reader, &b.film, 1) || bearing_values(reader, line, &b.film);
    }
    const struct card_option *axes = card_option(card, "AXES");
    int along = axes ? deck_option_word(reader, axes, deck_axes) : 0;
    bad |= along < 0;
    for (int i = 0; i < b.film.count && along > 0 && !bad; i++) {
        turn_to_load(b.film.k + 4 * (ptrdiff_t)i);
        turn_to_load(b.film.c + 4 * (ptrdiff_t)i);
    }
    if (!bad && !POOL_ADD(reader->pool, machine->bearing, machine->nbearing, &b))
        check_bearing(reader, card->place, &b);
}

void deck_pedestal(struct deck_reader *reader, const struct card *card)
{
    const struct card_option *option = card_option(card, "BEARING"), *file = card_option(card, "FILE");
    struct pedestal_line value = {{0}, {0}, {0}};
    int of = deck_option(reader, card, "BEARING", "name of a *BEARING") ? named_bearing(reader, option) : -1;
    const struct data_line *line = of < 0 ? NULL : deck_only_line(reader, card);
    if (!line)
        return;
    struct bearing *b = &reader->machine->bearing[of];
    if (b->pedestal.count)
        deck_error(reader, option->value_place, "the pedestal of %s is given twice, expected once", option->value);
    if (deck_read_values(reader, line, &value))
        return;
    if (file ? line->count != 2 : line->count < 4) {
        deck_error(reader, line->place, "the pedestal has %d values, expected %s", line->count,
                   file ? "mx, my alone beside FILE" : reader->layout);
        return;
    }
    if (file ? read_coefficients(reader, card, file, &of_pedestal, &b->pedestal) : room_of_table(reader, &b->pedestal, 1))
        return;
    memcpy(b->m, value.m, sizeof b->m);
    /* Of a measured dynamic stiffness k - m w^2 + i w c the mass takes its share: at the frequency of the spin, where critical
     * speeds and responses are, nothing depends on it but what is interpolated between the rows, k and c. */
    for (int i = 0; i < b->pedestal.count; i++)
        for (int plane = 0; plane < 2; plane++) {
            ptrdiff_t at = 4 * (ptrdiff_t)i + (plane ? YY : XX);
            double *k = &b->pedestal.k[at], *c = &b->pedestal.c[at], speed = b->pedestal.speed[i];
            *k = file ? *k + b->m[plane] * speed * speed : value.k[plane];
            *c = file ? *c / speed : value.c[plane];
        }
}

/* ---- losses, pull, change */

/* What the damping ratios of the test say, in the kind of the card; both kinds are told. */
static int loss_from_test(struct deck_reader *reader, struct place place, struct loss *loss)
{
    struct loss_of_test found;
    const char *name = reader->job->rotor.group[loss->group].name;
    int status = reader->job->measurement.nmode ? loss_of_test(reader->pool, reader->job, loss->group, &found) : ROTID_OK;
    reader->pool->out_of_memory |= status == ROTID_ERROR_MEMORY;
    if (status || !reader->job->measurement.nmode || !found.count)
        return deck_error(
            reader, place,
            "no measured mode says what %s loses, expected damping ratios in *MODES, of modes that bend it, or a loss factor "
            "without TEST",
            name);
    loss->value = found.value[loss->viscous];
    loss->std = found.std[loss->viscous];
    deck_note(reader, place,
              "%s has a loss factor of %.3g (standard deviation %.2g) or a viscous loss of %.3g s (%.2g s) by the damping of %d "
              "mode%s, of which the %s is taken: losses of supports and air at the test are in it",
              name, found.value[0], found.std[0], found.value[1], found.std[1], found.count, found.count > 1 ? "s" : "",
              loss->viscous ? "second" : "first");
    return 0;
}

int deck_check_loss(struct deck_reader *reader, const struct data_line *line, void *item)
{
    struct loss *loss = item;
    loss->from_test = card_option(reader->card, "TEST") != NULL;
    if (loss->from_test && line->count > 1)
        return deck_error(reader, line->field[1].place, "'%s' is one value too many, expected group alone with TEST",
                          line->field[1].text);
    if (loss->from_test)
        return loss_from_test(reader, line->place, loss);
    return deck_has(line, 1) ? 0 : deck_number(reader, line, 1, "loss", NOT_NEGATIVE, &loss->value);
}

int deck_check_change(struct deck_reader *reader, const struct data_line *line, void *item)
{
    struct change *change = item;
    const char *unit;
    if (deck_find_parameter(reader, &line->field[0], &change->parameter, &unit))
        return 1;
    if (change->parameter.kind == PARAMETER_G && reader->job->rotor.group[change->parameter.index].material.isotropic)
        return deck_error(reader, line->field[0].place, "%s follows E and nu of an isotropic material, expected E to change",
                          change->name);
    if (!machine_has(reader->machine, &reader->job->rotor, change->parameter))
        return deck_error(reader, line->field[0].place, "%s is of a part that is left at the test, expected one of the machine",
                          change->name);
    double now = *parameter_value(&reader->job->rotor, change->parameter) * change->factor,
           si = deck_in_si(reader, unit ? unit : "");
    const char *range = deck_outside_range(reader->pool, &reader->job->rotor, change->parameter, si, &now);
    return range ? deck_error(reader, line->field[1].place, "%s times %s is %.6g, expected a value %s", change->name,
                              line->field[1].text, now / si, range)
                 : 0;
}

/* ---- operation, run-up */

void deck_operation(struct deck_reader *reader, const struct card *card)
{
    struct machine *m = reader->machine;
    const struct card_option *margin = card_option(card, "MARGIN"), *poles = card_option(card, "POLES");
    const struct data_line *line = deck_only_line(reader, card);
    int bad = deck_read_options(reader, card, m);
    if (!line || deck_read_values(reader, line, m) || bad)
        return;
    m->has_operation = 1;
    if (m->high < m->low)
        deck_error(reader, line->field[1].place,
                   "the running range goes from %g down to %g rpm, expected the lowest speed "
                   "first",
                   m->low / RPM, m->high / RPM);
    m->api617 = margin && same_text(margin->value, "API617");
    reader->margin_place = margin ? margin->value_place : card->place;
    if (margin && !m->api617 && !deck_option_number(reader, margin, "", NOT_NEGATIVE, &m->margin) && m->margin >= 1)
        deck_error(reader, margin->value_place, "MARGIN=%s is %g %% of the speed, expected a share below 1", margin->value,
                   100 * m->margin);
    if (poles && (deck_option_number(reader, poles, "", POSITIVE, &m->poles) || fmod(m->poles, 2) != 0 || m->poles > MOST_POLES))
        deck_error(reader, poles->value_place, "POLES=%s is no number of poles, expected an even one up to %d", poles->value,
                   MOST_POLES);
    else if (m->line_hz > 0 && m->poles > 0 && m->high > 1.001 * 4 * PI * m->line_hz / m->poles)
        deck_note(reader, line->field[1].place,
                  "the running range ends above %g rpm, the speed of the field of %g poles at %g Hz: without LINE the line "
                  "frequency follows the speed",
                  120 * m->line_hz / m->poles, m->poles, m->line_hz);
}

int deck_check_runup(struct deck_reader *reader, const struct data_line *line, void *item)
{
    const struct machine *machine = reader->machine;
    struct runup_reading *reading = item;
    reading->place = line->place;
    for (int j = 0; j < machine->nrunup; j++)
        if (machine->runup[j].number == reading->number && machine->runup[j].backward == reading->backward)
            return deck_error(reader, line->field[0].place, "critical speed %d is given twice, expected once for each whirl",
                              reading->number);
    return 0;
}

/* NAME.k or NAME.c of a *BEARING: -1 after an error. */
static int unknown_bearing(struct deck_reader *reader, const struct field *field, int *damping)
{
    const struct machine *machine = reader->machine;
    const char *dot = strrchr(field->text, '.');
    *damping = dot && same_text(dot + 1, "c");
    int i = dot && (*damping || same_text(dot + 1, "k")) ? find_bearing(machine, field->text, (size_t)(dot - field->text)) : -1;
    if (i < 0)
        return -deck_error(
            reader, field->place,
            "%s is no unknown of the machine, expected NAME.k or NAME.c of a *BEARING: a factor on its stiffness or damping",
            field->text);
    const struct bearing *like = &machine->bearing[machine->bearing[i].like];
    return like == &machine->bearing[i] ? i
                                        : -deck_error(reader, field->place, "%s is like %s, expected %s.%s",
                                                      machine->bearing[i].name, like->name, like->name, dot + 1);
}

/* *IDENTIFY behind *RUNNING */
int deck_check_unknown(struct deck_reader *reader, const struct data_line *line, void *item)
{
    struct machine *machine = reader->machine;
    struct machine_unknown *u = item;
    int twice = 0;
    u->bounds.unit = "1";
    u->bearing = unknown_bearing(reader, &line->field[0], &u->damping);
    if (u->bearing < 0)
        return 1;
    if (!(u->bounds.lower < u->bounds.start && u->bounds.start < u->bounds.upper))
        return deck_error(reader, line->field[3].place, "the start of %s is %s, expected a value between its bounds",
                          u->bounds.name, line->field[3].text);
    for (int j = 0; j < reader->job->unknowns.nparameter; j++)
        twice |= same_text(reader->job->unknowns.bounds[j].name, u->bounds.name);
    for (int j = 0; j < machine->nunknown; j++)
        twice |= machine->unknown[j].bearing == u->bearing && machine->unknown[j].damping == u->damping;
    if (twice)
        deck_error(reader, line->field[0].place, "%s is given twice, expected once", u->bounds.name);
    for (int j = u->bearing; j < machine->nbearing && !twice; j++)
        if (machine->bearing[j].like == u->bearing)
            machine->bearing[j].unknown[u->damping] = reader->job->unknowns.nparameter + machine->nunknown;
    return twice;
}

/* U = G m/W of ISO 21940-11: m of the machine (machine_rotor) by the values of the deck, W its highest running speed. */
static void scale_unbalances(struct deck_reader *reader, const struct place running)
{
    struct machine *machine = reader->machine;
    struct job job = *reader->job;
    struct machine_values values;
    struct rotor rotor;
    struct mass_properties mass = {0};
    int graded = 0;
    for (int i = 0; i < machine->nunbalance; i++)
        graded |= machine->unbalance[i].grade > 0;
    if (!graded)
        return;
    if (!machine->has_operation) {
        deck_error(reader, running, "*UNBALANCE, G= is a grade at the highest running speed, expected *OPERATION with it");
        return;
    }
    job.unknowns.nparameter = 0;
    int status = machine_nominal(reader->pool, machine, NULL, &values);
    if (!status)
        status = machine_rotor(reader->pool, machine, &job, &values, &rotor);
    if (!status)
        status = model_weigh(reader->pool, NULL, &rotor, 0, NULL, NULL, &mass);
    reader->pool->out_of_memory |= status != ROTID_OK;
    if (status)
        return;
    for (int i = 0; i < machine->nunbalance; i++)
        if (machine->unbalance[i].grade > 0) {
            machine->unbalance[i].value *= machine->unbalance[i].grade * mass.mass / machine->high;
            machine->unbalance[i].mass = mass.mass;
        }
}

/* HOLDOUT=RUNUP of a *FIT. */
static const struct card_option *held_runup(struct deck_reader *reader)
{
    for (int c = 0; c < reader->text.ncard; c++) {
        const struct card *card = &reader->text.card[c];
        struct deck_holdout held;
        deck_read_holdout(reader->pool, card_option(card, "HOLDOUT"), &held);
        if (is(card, "FIT") && held.runup)
            return card_option(card, "HOLDOUT");
    }
    return NULL;
}

/* What was measured of the machine beside what is to be identified. */
static void check_runup(struct deck_reader *reader, const struct place running)
{
    struct machine *machine = reader->machine;
    const struct job *job = reader->job;
    const struct card_option *held = held_runup(reader);
    machine->runup_held = held != NULL;
    if (held && !machine->nrunup)
        deck_error(reader, held->value_place, "HOLDOUT=RUNUP, but the machine has no *RUNUP, expected measured critical speeds");
    if (machine->nunknown && (!machine->nrunup || held))
        deck_error(reader, running, "%s is to be identified%s, expected *RUNUP with measured critical speeds that are fitted",
                   machine->unknown[0].bounds.name, held ? " and the run-up is held out" : "");
    if (machine->nrunup && !held && job->measurement.nmode && job->options.fit.functional != ROTID_LIKELIHOOD)
        deck_error(
            reader, running,
            "*RUNUP is weighed by its standard deviation, expected *FIT, FUNCTIONAL=LIKELIHOOD with the noise of the modes, "
            "or HOLDOUT=RUNUP");
}

/* Disks without polar inertia turn without gyroscopic moments: said once. A cause that takes diametral inertia leaves the polar
 * one.
 */
static void check_disks(struct deck_reader *reader, struct place place)
{
    const struct rotor *rotor = &reader->job->rotor;
    int count = 0;
    for (int i = 0; i < rotor->ndisk; i++) {
        const struct disk *disk = &rotor->disk[i];
        double diametral = effects_on_disk(rotor, i);
        if (reader->machine->without_disk[i])
            continue;
        count += diametral > 0 && !(disk->polar > 0);
        if (diametral < disk->diametral && disk->polar > 2 * MORE_THAN_ROUNDING * diametral)
            deck_note(
                reader, place,
                "with its added_inertia the disk %s has %.4g kg.m2 about a diameter and %.4g about the axis, expected at most "
                "twice as much: state both in *DISK",
                disk->name, diametral, disk->polar);
    }
    for (int i = 0; i < reader->machine->ndisk; i++)
        count += reader->machine->disk[i].diametral > 0 && !(reader->machine->disk[i].polar > 0);
    if (count)
        deck_note(reader, place,
                  "%d disk%s a diametral inertia and no polar one, which gives no gyroscopic moment: expected both", count,
                  count > 1 ? "s have" : " has");
}

/* Supports and accelerometers of the test that the machine keeps; of a support that a *SPRING states the card says it. */
static void check_causes(struct deck_reader *reader, struct place place)
{
    const struct rotor *rotor = &reader->job->rotor;
    for (int i = 0; i < rotor->neffect; i++)
        if (!reader->machine->without_effect[i] && !rotor->effect[i].kind->spring && effect_is_of_test(&rotor->effect[i], rotor))
            deck_note(reader, place, "the machine has %s, a %s of the test: expected its name in WITHOUT", rotor->effect[i].name,
                      rotor->effect[i].kind->at_sensor ? "sensor" : "support");
}

/* Whether the machine has what a card of the first state adds to the rotor. */
static int is_in_machine(const struct rotor *rotor, const struct machine *machine, const struct card *card)
{
    const struct card_option *name = card_option(card, "NAME");
    const char **own;
    if (is(card, "SET"))
        return 1;
    if (!deck_stands(card, CARD_ANYWHERE) || !card->kind ||
        !(card->kind->section == CARD_CAUSE || (card->kind->section == CARD_MODEL && card->kind->phase > 1)))
        return 0;
    for (int kind = 0; kind < 2; kind++)
        for (int i = 0; (own = deck_name_of(rotor, kind ? TARGET_DISK : TARGET_SPRING, i)); i++) {
            int left = kind ? machine->without_disk[i] : machine->without_spring[i];
            if (left && (*own && name ? same_text(*own, name->value) : !*own && !name && !kind && !is(card, "DISK")))
                return 0;
        }
    for (int i = 0; i < rotor->neffect && name; i++)
        if (rotor->effect[i].name && same_text(rotor->effect[i].name, name->value))
            return !machine->without_effect[i];
    return card->kind->section == CARD_MODEL; /* a cause in the data is none of the rotor */
}

/* The machine is made of the first state: what that has and others may lack is told. */
static void tell_first_state(struct deck_reader *reader, const struct machine *machine, const struct states *states)
{
    int c = 0, count = reader->text.ncard;
    const struct card *card = reader->text.card;
    while (c < count && !is(&card[c], "STATE"))
        c++;
    for (c++; states->nstate > 1 && c < count && !is(&card[c], "STATE"); c++)
        if (is_in_machine(&states->state[0].job.rotor, machine, &card[c])) {
            deck_note(reader, card[c].place,
                      "the machine has the rotor of state %s, the first one, with this *%s: expected its name in WITHOUT of "
                      "*RUNNING, or another state first, where the machine is without it",
                      states->state[0].name, card[c].name);
            return;
        }
}

void deck_read_machine(struct deck_reader *reader, struct states *states)
{
    struct job *job = &states->state[0].job;
    struct deck_reader own = {.pool = reader->pool,
                              .messages = reader->messages,
                              .text = reader->text,
                              .job = job,
                              .length = rotor_length(&job->rotor)};
    if (!reader->nrunning && held_runup(reader))
        deck_error(reader, held_runup(reader)->value_place,
                   "HOLDOUT=RUNUP, but the deck has no machine, expected *RUNNING with *RUNUP");
    if (!reader->nrunning)
        return;
    own.machine = POOL_NEW(reader->pool, struct machine);
    if (!own.machine)
        return;
    for (int c = 0; c < reader->nrunning; c++)
        deck_check_names(reader, &reader->running[c]);
    for (int phase = 9; phase <= 10; phase++)
        for (int c = 0; c < reader->nrunning && !reader->pool->out_of_memory; c++) {
            const struct deck_card *kind = deck_card_of_machine(reader->running[c].name);
            if (kind && kind->phase == phase)
                deck_read_card(&own, &reader->running[c], kind);
        }
    deck_check_unique(reader, reader->nrunning, reader->running, 1);
    reader->text = own.text; /* with the files and tables that were read */
    if (reader->pool->out_of_memory)
        return;
    if (!own.machine->nbearing && !reader->messages->errors)
        deck_error(reader, reader->running[0].place,
                   "the machine has no *BEARING: a free rotor has no critical speed, expected at "
                   "least one");
    if (!reader->messages->errors)
        scale_unbalances(&own, reader->running[0].place);
    if (own.machine->api617 && (!own.machine->nunbalance || !own.machine->nprobe))
        deck_error(reader, own.margin_place,
                   "MARGIN=API617 goes by the amplification factor of a response, expected *UNBALANCE and *PROBE with it");
    check_runup(&own, reader->running[0].place);
    check_disks(&own, reader->running[0].place);
    check_causes(&own, reader->running[0].place);
    tell_first_state(reader, own.machine, states);
    for (int s = 0; s < states->nstate; s++) {
        states->state[s].job.nfile = own.text.nfile;
        states->state[s].job.file = own.text.file;
    }
    states->machine = own.machine;
}
