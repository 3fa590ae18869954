/* The cards of the measured data, of causes, and of the identification. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/base.h"
#include "deck/card_table.h"
#include "diagnose/causes/causes.h"
#include "rotid.h"

static void refuse_writing(struct deck_writer *w)
{
    w->status = w->status ? w->status : ROTID_ERROR_ARGUMENT;
}

/* As they were read. */
struct data {
    int nsensor;
    const struct sensor *sensor;
    const double *shape, *shape_std, *frequency_std, *point_hz, *point_std;
};

static struct data data_of(const struct job *job)
{
    const struct job_raw *raw = job->measurement.raw;
    return raw ? (struct data){.nsensor = raw->nsensor,
                               .sensor = raw->sensor,
                               .shape = raw->shape,
                               .shape_std = raw->shape_std,
                               .frequency_std = raw->frequency_std,
                               .point_hz = raw->point_frequency_hz,
                               .point_std = raw->point_frequency_std}
               : (struct data){.nsensor = job->rotor.nsensor,
                               .sensor = job->rotor.sensor,
                               .shape = job->measurement.shape,
                               .shape_std = job->measurement.shape_std,
                               .frequency_std = job->measurement.frequency_std,
                               .point_hz = job->measurement.point_frequency_hz,
                               .point_std = job->measurement.point_frequency_std};
}

/* The one value of all components that are there (of `there`, or all), NaN where they differ or one has none. */
static double uniform(ptrdiff_t count, const double *there, const double *std)
{
    double value = NAN;
    for (ptrdiff_t i = 0, first = 1; i < count; i++) {
        if (there && !isfinite(there[i]))
            continue;
        if (!isfinite(std[i]) || (!first && std[i] != value))
            return NAN;
        value = std[i];
        first = 0;
    }
    return value;
}

static void write_sensors(struct deck_writer *w, const struct data *data)
{
    for (int s = 0; s < data->nsensor; s++) {
        if (s % DECK_MOST_LINES == 0)
            deck_put(w, "*SENSORS\n");
        if (data->sensor[s].id < 1 || data->sensor[s].id > 1000000000)
            refuse_writing(w);
        deck_put(w, "%d", data->sensor[s].id);
        deck_put_number(w, ", ", data->sensor[s].position);
        deck_put(w, "\n");
    }
}

/* A deviation in Hz that gives the relative one back by division, or the nearest there is. */
static double std_hz(double std, double hz)
{
    double product = std * hz, beside[] = {nextafter(product, 0), nextafter(product, INFINITY)};
    for (int i = 0; i < 2 && product / hz != std; i++)
        if (beside[i] / hz == std)
            return beside[i];
    return product;
}

static void write_modes(struct deck_writer *w, const struct data *data, int with_std)
{
    const struct job *job = w->job;
    double last = 0;
    if (job->measurement.nmode > DECK_MOST_MODES)
        refuse_writing(w);
    if (job->measurement.nmode)
        deck_put(w, "*MODES\n");
    for (int k = 0; k < job->measurement.nmode; k++) {
        double hz = job->measurement.frequency_hz[k], std = with_std ? data->frequency_std[k] : NAN;
        int damped = job->measurement.damping[k] >= 0 && job->measurement.damping[k] < 1;
        if (job->measurement.number[k] > DECK_MOST_MODES)
            refuse_writing(w);
        if (k && hz == last) /* two modes of a universal file may have one frequency, those of a deck may not */
            hz = nextafter(hz, INFINITY);
        last = hz;
        deck_put(w, "%d", job->measurement.number[k]);
        deck_put_number(w, ", ", hz);
        if (damped)
            deck_put_number(w, ", ", job->measurement.damping[k]);
        else if (isfinite(std))
            deck_put(w, ", ");
        if (isfinite(std))
            deck_put_number(w, ", ", std_hz(std, hz));
        deck_put(w, "\n");
    }
}

static void write_shape(struct deck_writer *w, const struct data *data, int k, int with_std)
{
    const double *shape = data->shape + (ptrdiff_t)k * data->nsensor, *std = data->shape_std + (ptrdiff_t)k * data->nsensor;
    for (int s = 0, lines = 0; s < data->nsensor; s++) {
        if (!isfinite(shape[s]))
            continue;
        if (lines++ % DECK_MOST_LINES == 0)
            deck_put(w, "*SHAPE, MODE=%d\n", w->job->measurement.number[k]);
        deck_put(w, "%d", data->sensor[s].id);
        deck_put_number(w, ", ", shape[s]);
        if (with_std && isfinite(std[s]))
            deck_put_number(w, ", ", std[s]);
        deck_put(w, "\n");
    }
}

/* With their deviations as they were settled, and without another mean: that in *MODES may have been found by better means. */
static void write_frequencies(struct deck_writer *w, const struct data *data, int k)
{
    const double *hz = data->point_hz + (ptrdiff_t)k * data->nsensor, *std = data->point_std + (ptrdiff_t)k * data->nsensor;
    for (int s = 0, lines = 0; s < data->nsensor; s++) {
        if (!isfinite(hz[s]))
            continue;
        if (lines++ % DECK_MOST_LINES == 0)
            deck_put(w, "*FREQUENCIES, MODE=%d, MEAN=NO\n", w->job->measurement.number[k]);
        deck_put(w, "%d", data->sensor[s].id);
        deck_put_number(w, ", ", hz[s]);
        if (isfinite(std[s]))
            deck_put_number(w, ", ", std[s]);
        deck_put(w, "\n");
    }
}

void deck_write_measured(struct deck_writer *w)
{
    const struct data data = data_of(w->job);
    int nmode = w->job->measurement.nmode;
    double frequency =
               data.point_hz ? NAN : uniform(nmode, NULL, data.frequency_std), /* *MODES states it: it is not settled anew */
        shape = data.shape ? uniform((ptrdiff_t)data.nsensor * nmode, data.shape, data.shape_std) : NAN;
    write_sensors(w, &data);
    write_modes(w, &data, !isfinite(frequency));
    if (isfinite(frequency) || isfinite(shape)) {
        deck_put_card(w, "NOISE");
        if (isfinite(frequency))
            deck_put_option_number(w, "FREQUENCY", frequency);
        if (isfinite(shape))
            deck_put_option_number(w, "SHAPE", shape);
        deck_put(w, "\n");
    }
    for (int k = 0; k < nmode && data.shape; k++)
        write_shape(w, &data, k, !isfinite(shape));
    for (int k = 0; k < nmode && data.point_hz; k++)
        write_frequencies(w, &data, k);
}

/* ------------------------------------------------------------------------------------------------ causes */

/* Whether BETWEEN=left,NAME is read as two groups: the second name stands where an option could. */
static int is_list_item(const char *name)
{
    for (const struct deck_row *row = deck_card_find("CAUSE")->row; !deck_row_is_last(row); row++)
        if (same_text(name, row->option))
            return 0;
    return !strchr(name, '=');
}

static void write_interface(struct deck_writer *w, int left)
{
    const struct group *group = &w->rotor.group[left];
    double from, to;
    rotor_group_span(&w->job->rotor, left, &from, &to); /* with the lengths of its state */
    if (is_list_item(group[1].name)) {
        deck_put_option(w, "BETWEEN", group[0].name);
        deck_put(w, ",%s", group[1].name);
    } else
        deck_put_option_number(w, "AT", to);
}

static void write_target(struct deck_writer *w, const struct cause_kind *kind, int target)
{
    char id[16];
    switch (kind->target) {
    case TARGET_GROUP:
        deck_put_option(w, "GROUP", w->rotor.group[target].name);
        break;
    case TARGET_INTERFACE:
        write_interface(w, target);
        break;
    case TARGET_SPRING:
        deck_put_option(w, "AT", w->rotor.spring[target].name);
        break;
    case TARGET_DISK:
        deck_put_option(w, "AT", w->rotor.disk[target].name);
        break;
    case TARGET_TIEROD:
        deck_put_option(w, "AT", w->rotor.tierod[target].name);
        break;
    case TARGET_SENSOR:
        (void)snprintf(id, sizeof id, "%d", w->rotor.sensor[target].id);
        deck_put_option(w, "SENSOR", id);
        break;
    default:
        break;
    }
}

/* Physical bounds may move with the model, such as those of a joint with E beside it: what is written has to lie inside those of
 * the deck it is written into. */
static double inside_physical(const struct deck_writer *w, const struct effect *effect, int p, double value)
{
    const struct cause_kind *kind = catalogue_of(effect);
    double lower, upper;
    if (!kind || !kind->bounds)
        return value;
    cause_reach(kind, &w->rotor, effect, p, &lower, &upper);
    return fmin(fmax(value, lower), upper);
}

/* fixed: parameters of a suspect that are given, NULL for a cause of the model */
static void write_effect(struct deck_writer *w, const struct effect *effect, const int *fixed)
{
    const struct cause_kind *kind = catalogue_of(effect);
    if (!kind) {
        refuse_writing(w);
        return;
    }
    deck_put_card(w, "CAUSE");
    deck_put_option(w, "NAME", effect->name);
    deck_put_option(w, "TYPE", kind->id);
    if (effect->target >= 0)
        write_target(w, kind, effect->target);
    if (kind->variant_option)
        deck_put_option(w, kind->variant_option, kind->variant[effect->variant]);
    if (fixed)
        deck_put_option(w, "SUSPECT", "YES");
    deck_put(w, "\n");
    for (int p = 0; p < effect_parameters(effect); p++) {
        int bounds = fixed && !fixed[p] && p == kind->size && effect->bound[0] < effect->bound[1];
        if (fixed && !fixed[p] && !bounds)
            continue;
        deck_put(w, "%s", effect->kind->parameter[p].name);
        if (bounds) {
            deck_put_number(w, ", ", effect->bound[0]);
            deck_put_number(w, ", ", effect->bound[1]);
            deck_put(w, "\n");
            continue;
        }
        double value = effect->value[p];
        deck_put_number(w, ", ", value == kind->parameter[p].neutral ? value : inside_physical(w, effect, p, value));
        deck_put(w, "\n");
    }
}

static void write_correction(struct deck_writer *w, const struct correction *correction)
{
    const struct cause_kind *kind = catalogue_find(correction->id);
    if (!kind) {
        refuse_writing(w);
        return;
    }
    deck_put_card(w, "CAUSE");
    deck_put_option(w, "NAME", correction->name);
    deck_put_option(w, "TYPE", kind->id);
    if (kind->target == TARGET_BLOCK)
        deck_put_option(w, "AT", correction->block);
    else if (kind->target != TARGET_NONE)
        deck_put(w, ", SENSOR=%d", correction->sensor[0]);
    if (kind->target == TARGET_SENSORS)
        deck_put(w, ",%d", correction->sensor[1]);
    deck_put(w, "\n");
    struct correction copy = *correction;
    const struct effect_parameter_name *name;
    for (int p = 0; (name = correction_parameter(kind, p)); p++) {
        deck_put(w, "%s", name->name);
        deck_put_number(w, ", ", *correction_value(&copy, p));
        deck_put(w, "\n");
    }
}

void deck_write_corrections(struct deck_writer *w)
{
    for (int i = 0; i < w->job->measurement.ncorrection; i++)
        write_correction(w, &w->job->measurement.correction[i]);
}

void deck_write_causes(struct deck_writer *w)
{
    for (int i = 0; i < w->rotor.neffect; i++)
        write_effect(w, &w->rotor.effect[i], NULL);
    for (int i = 0; i < w->job->unknowns.nsuspect; i++)
        write_effect(w, &w->job->unknowns.suspect[i].effect, w->job->unknowns.suspect[i].fixed);
}

/* ------------------------------------------------------------------------------------------------ identification */

/* A start has to lie between the bounds and must not be zero, being the scale of the parameter. */
static double start_of(const rotid_parameter *bounds, double x)
{
    double margin = 1e-6 * (bounds->upper - bounds->lower);
    if (!(x > bounds->lower))
        x = bounds->lower + margin;
    if (!(x < bounds->upper))
        x = bounds->upper - margin;
    return x != 0 ? x : bounds->start;
}

static int holds_out(const struct job *job)
{
    int any = 0;
    for (int k = 0; k < job->measurement.nmode && job->measurement.holdout; k++)
        any |= job->measurement.holdout[k];
    return any;
}

void deck_write_holdout(struct deck_writer *w)
{
    const char *separator = ", HOLDOUT=";
    for (int k = 0, count = 0; k < w->job->measurement.nmode && w->job->measurement.holdout; k++)
        if (w->job->measurement.holdout[k]) {
            deck_put(w, "%s%d", separator, w->job->measurement.number[k]);
            separator = ++count % 20 ? "," : ",\n    ";
        }
}

void deck_write_unknown(struct deck_writer *w, int p, const char *name)
{
    rotid_parameter bounds = w->job->unknowns.bounds[p];
    struct parameter parameter = w->job->unknowns.parameter[p];
    if (!name || !*name || *name == '*' || strchr(name, ','))
        refuse_writing(w);
    if (parameter.kind == PARAMETER_EFFECT) {
        const struct effect *effect = &w->rotor.effect[parameter.index];
        bounds.lower = inside_physical(w, effect, parameter.component, bounds.lower);
        bounds.upper = inside_physical(w, effect, parameter.component, bounds.upper);
    }
    deck_put(w, "%s", name ? name : "");
    deck_put_number(w, ", ", bounds.lower);
    deck_put_number(w, ", ", bounds.upper);
    deck_put_number(w, ", ", start_of(&bounds, w->x ? w->x[p] : bounds.start));
    deck_put(w, "\n");
}

void deck_write_fit(struct deck_writer *w, int with_holdout)
{
    const struct job_options *options = &w->job->options;
    int holdout = with_holdout && holds_out(w->job);
    if (!options->has_fit && !holdout && !options->solid && options->fit.reduction == ROTID_REDUCTION_NONE &&
        options->fit.derivative == ROTID_NELSON)
        return;
    deck_put_card(w, "FIT");
    deck_write_options(w, options->has_fit ? deck_fit_rows : deck_fit_rows + 1, &options->fit); /* the first one: FUNCTIONAL */
    if (options->solid)
        deck_put_option(w, "MODEL", "SOLID");
    if (holdout)
        deck_write_holdout(w);
    deck_put(w, "\n");
}
