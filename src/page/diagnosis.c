#include "page/diagnosis.h"

#include <math.h>
#include <string.h>

#define MOST 1000000000 /* of what is counted */
#define SAME 1e-3       /* relative difference of parameters that is not worth a word */

static void *room_for(const struct json_place *at, size_t count, size_t size)
{
    void *room = pool_get(at->reader->pool, count, size);
    if (!room)
        at->reader->status = ROTID_ERROR_MEMORY;
    return room;
}

static void read_interval(const struct json_place *at, const char *key, double ci[2])
{
    double *value;
    ci[0] = ci[1] = NAN;
    if (place_list(at, key, 1, 2, &value))
        memcpy(ci, value, 2 * sizeof *ci);
}

static void read_cause(const struct json_place *at, struct told_cause *cause)
{
    struct json_place list;
    cause->id = place_string(at, "id");
    cause->target = place_string(at, "target");
    cause->name = place_string_if(at, "name");
    cause->value = place_items(at, "parameters", sizeof *cause->value, &list, &cause->nvalue);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && cause->value;
         item = place_next(&item, PLACE_OBJECT)) {
        struct told_value *value = &cause->value[item.index];
        const char *unit = place_string_if(&item, "unit");
        value->name = place_string(&item, "name");
        value->unit = unit ? unit : "1";
        value->value = place_number(&item, "value");
        value->fixed = place_flag(&item, "fixed");
        read_interval(&item, "ci95", value->ci);
    }
}

static struct told_cause *read_causes(const struct json_place *verdict, const char *key, int *count)
{
    struct json_place list;
    struct told_cause *cause = place_items(verdict, key, sizeof *cause, &list, count);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && cause; item = place_next(&item, PLACE_OBJECT))
        read_cause(&item, &cause[item.index]);
    return cause;
}

static enum verdict_told read_kind(const struct json_place *above)
{
    static const char *const names[] = {"adequate", "named", "ambiguous", "unexplained"};
    struct json_place at;
    const char *kind = place_string(above, "kind");
    for (int i = 0; i < 4; i++)
        if (!strcmp(names[i], kind))
            return (enum verdict_told)(TOLD_ADEQUATE + i);
    if (*kind && place_find(above, "kind", PLACE_TEXT, &at))
        place_wrong(&at, "is '%s', expected adequate, named, ambiguous or unexplained", kind);
    return TOLD_NONE;
}

static void read_verdict(const struct json_place *root, struct diagnosis_outcome *out)
{
    struct json_place verdict;
    if (!place_need(root, "verdict", PLACE_OBJECT, &verdict))
        return;
    out->kind = read_kind(&verdict);
    out->adequate_after = place_flag(&verdict, "adequate_after");
    out->p_value = place_number(&verdict, "p_value");
    out->cause = read_causes(&verdict, "causes", &out->ncause);
    out->alternative = read_causes(&verdict, "alternative_causes", &out->nalternative);
    out->next_measurement = place_string_if(&verdict, "next_measurement");
    out->sentence = place_string_if(&verdict, "sentence");
}

static struct told_finding *read_findings(const struct json_place *root, const char *key, int numerical, int *count)
{
    struct json_place list;
    struct told_finding *finding = place_items(root, key, sizeof *finding, &list, count);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && finding;
         item = place_next(&item, PLACE_OBJECT)) {
        struct told_finding *now = &finding[item.index];
        now->id = place_string(&item, "id");
        now->text = place_string_if(&item, "text");
        if (!numerical)
            continue;
        now->nerror = place_list(&item, "error_percent", 1, -1, &now->error_percent);
        (void)place_list(&item, "modes", 1, now->nerror, &now->mode);
    }
    return finding;
}

static void read_rounds(const struct json_place *root, struct diagnosis_outcome *out)
{
    struct json_place list;
    out->round = place_items(root, "rounds", sizeof *out->round, &list, &out->nround);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->round;
         item = place_next(&item, PLACE_OBJECT)) {
        struct evidence_round *round = &out->round[item.index];
        round->kind = read_kind(&item);
        round->dof = place_whole(&item, "dof", -MOST, MOST);
        round->nset = place_whole(&item, "set", 0, MOST);
        round->chi2 = place_number(&item, "chi2");
        round->largest = place_number(&item, "largest");
        round->threshold = place_number(&item, "threshold");
        round->p_scan = place_number(&item, "p_scan");
        round->p_frequency = place_number(&item, "p_frequency");
        round->p_total = place_number(&item, "p_total");
        round->required_margin = place_number(&item, "required_margin");
    }
}

static void read_candidate(const struct json_place *at, struct evidence *c)
{
    read_cause(at, &c->cause);
    c->cause.suspect = place_flag(at, "suspect");
    c->refitted = place_flag(at, "refitted");
    c->predicted_drop = place_number(at, "predicted_drop");
    c->chi2_drop = place_number(at, "chi2_drop");
    c->bic = place_number(at, "bic");
    c->holdout_rms = place_number(at, "holdout_rms");
    c->mode_out_rms = place_number(at, "mode_out_rms");
    c->sensor_out_rms = place_number(at, "sensor_out_rms");
    c->p_value = place_number(at, "p_value");
    c->at_bound = place_flag(at, "at_bound");
    c->collinear_with = place_string_if(at, "collinear_with");
    c->collinear_target = place_string_if(at, "collinear_target");
    c->cosine = place_number(at, "cosine");
    c->rejected_because = place_string_if(at, "rejected_because");
}

/* The candidates stand in the order of their rounds. */
static void read_candidates(const struct json_place *root, struct diagnosis_outcome *out)
{
    struct json_place list;
    int count;
    struct evidence *all = place_items(root, "candidates", sizeof *all, &list, &count);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && all && out->round;
         item = place_next(&item, PLACE_OBJECT)) {
        int number = place_whole(&item, "round", 1, out->nround < 1 ? 1 : out->nround);
        struct evidence_round *round = &out->round[number - 1];
        struct evidence *c = &all[item.index];
        if (number > out->nround)
            continue;
        if (!round->ncandidate)
            round->candidate = c;
        else if (round->candidate + round->ncandidate != c)
            place_wrong(&item, "round: is %d behind candidates of a later one, expected them in order", number);
        round->ncandidate++;
        read_candidate(&item, c);
    }
    for (int i = 0; i < out->nround && out->round; i++)
        if (out->round[i].nset > out->round[i].ncandidate)
            place_wrong(root, "rounds[%d].set: is %d, expected no more than its %d candidates", i, out->round[i].nset,
                        out->round[i].ncandidate);
}

static void read_gain(const struct json_place *root, struct diagnosis_outcome *out)
{
    static const char *const keys[GAINS] = {"frequency_rms_percent",
                                            "frequency_max_percent",
                                            "shape_rms",
                                            "holdout_frequency_rms_percent",
                                            "holdout_shape_rms",
                                            "mode_out_frequency_rms_percent",
                                            "mode_out_shape_rms",
                                            "sensor_out_shape_rms",
                                            "chi2_per_dof",
                                            "nco_min"};
    struct json_place gain, pair, list;
    (void)place_need(root, "gain", PLACE_OBJECT, &gain);
    for (int g = 0; g < GAINS; g++) {
        (void)place_need(&gain, keys[g], PLACE_OBJECT, &pair);
        out->gain[g] = (struct told_gain){place_number(&pair, "before"), place_number(&pair, "after")};
    }
    out->parameter = place_items(&gain, "parameters", sizeof *out->parameter, &list, &out->nparameter);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->parameter;
         item = place_next(&item, PLACE_OBJECT)) {
        struct told_parameter *p = &out->parameter[item.index];
        p->name = place_string(&item, "name");
        p->unit = place_string(&item, "unit");
        p->before = place_number(&item, "before");
        p->after = place_number(&item, "after");
        read_interval(&item, "before_ci95", p->before_ci);
        read_interval(&item, "after_ci95", p->after_ci);
    }
}

static void read_misfit(const struct json_place *root, struct diagnosis_outcome *out)
{
    struct json_place list;
    out->nmode = place_list(root, "modes_standardised", 1, -1, &out->mode_z);
    out->sensor = place_items(root, "sensors", sizeof *out->sensor, &list, &out->nsensor);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->sensor;
         item = place_next(&item, PLACE_OBJECT))
        out->sensor[item.index] =
            (struct told_sensor){place_number(&item, "id"), place_number(&item, "z_m"), place_number(&item, "rms")};
    (void)place_need(root, "localisation", PLACE_LIST, &list);
    out->nlocal = place_count(&list);
    out->local_z = room_for(root, (size_t)out->nlocal, sizeof *out->local_z);
    out->local = room_for(root, (size_t)out->nlocal, sizeof *out->local);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->local_z && out->local;
         item = place_next(&item, PLACE_OBJECT)) {
        out->local_z[item.index] = place_number(&item, "z_m");
        out->local[item.index] = place_number(&item, "indicator");
    }
}

static void read_sizes(const struct json_place *root, struct diagnosis_outcome *out)
{
    struct json_place list;
    out->size = place_items(root, "detectable", sizeof *out->size, &list, &out->nsize);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->size;
         item = place_next(&item, PLACE_OBJECT)) {
        struct told_size *size = &out->size[item.index];
        const char *unit = place_string_if(&item, "unit");
        size->id = place_string(&item, "id");
        size->target = place_string(&item, "target");
        size->parameter = place_string(&item, "parameter");
        size->unit = unit ? unit : "1";
        size->smallest = place_number(&item, "smallest");
        size->z = place_number(&item, "z_m");
        size->worst = place_number(&item, "worst");
        size->beyond = place_flag(&item, "beyond");
    }
}

static struct fitted *read_fit(const struct json_place *root, const char *key)
{
    struct json_place at;
    if (!cJSON_HasObjectItem(root->json, key)) {
        (void)place_need(root, key, PLACE_OBJECT, &at);
        return NULL;
    }
    return place_find(root, key, PLACE_OBJECT, &at) ? fitted_read(&at) : NULL;
}

/* The verdict does not say which of its causes were asked for: the evidence does. */
static void mark_suspects(const struct diagnosis_outcome *out, int count, struct told_cause *cause)
{
    for (int i = 0; i < count && cause; i++)
        for (int r = 0; r < out->nround && out->round; r++)
            for (int k = 0; k < out->round[r].ncandidate; k++) {
                const struct told_cause *tried = &out->round[r].candidate[k].cause;
                cause[i].suspect |= tried->suspect && tried->name && cause[i].name && !strcmp(tried->name, cause[i].name);
            }
}

struct diagnosis_outcome *diagnosis_read(const struct json_place *root)
{
    struct diagnosis_outcome *out = room_for(root, 1, sizeof *out);
    if (!out)
        return NULL;
    out->interrupted = place_flag(root, "interrupted");
    read_verdict(root, out);
    out->data = read_findings(root, "data_findings", 0, &out->ndata);
    out->numerical = read_findings(root, "numerical_findings", 1, &out->nnumerical);
    read_rounds(root, out);
    read_candidates(root, out);
    mark_suspects(out, out->ncause, out->cause);
    mark_suspects(out, out->nalternative, out->alternative);
    read_gain(root, out);
    read_misfit(root, out);
    read_sizes(root, out);
    out->today = read_fit(root, "today");
    out->base = read_fit(root, "base");
    out->extended = read_fit(root, "extended");
    if (out->base && out->nmode && out->nmode != out->base->nmode)
        place_wrong(root, "modes_standardised has %d values, expected %d as base.modes", out->nmode, out->base->nmode);
    return root->reader->status ? NULL : out;
}

const struct fitted *diagnosis_today(const struct diagnosis_outcome *d)
{
    const struct fitted *today = d->today, *base = d->base;
    if (!today || !base)
        return today;
    int same = strcmp(today->functional, base->functional) == 0 && strcmp(today->reduction, base->reduction) == 0, near = 1;
    for (int p = 0; p < today->nparameter && p < base->nparameter; p++)
        near &= fabs(today->parameter[p].value - base->parameter[p].value) <= SAME * fabs(base->parameter[p].value);
    return same || near ? NULL : today;
}
