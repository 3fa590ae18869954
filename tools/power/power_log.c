/* One line of JSON a case. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "power.h"

static void add_number(cJSON *object, const char *name, double value)
{
    if (isfinite(value))
        cJSON_AddNumberToObject(object, name, value);
    else
        cJSON_AddNullToObject(object, name);
}

static cJSON *candidate_line(const struct candidate *c)
{
    cJSON *o = cJSON_CreateObject();
    cJSON_AddStringToObject(o, "id", c->cause->id);
    if (c->target[0])
        cJSON_AddStringToObject(o, "target", c->target);
    for (int p = 0; p < c->nparameter && c->effect.kind; p++)
        add_number(o, c->effect.kind->parameter[p].name, c->effect.value[p]);
    if (c->cause->variant[0] && c->effect.kind)
        cJSON_AddStringToObject(o, "variant", c->cause->variant[c->effect.variant]);
    add_number(o, "predicted", c->result.predicted_drop);
    if (c->result.refitted) {
        add_number(o, "drop", c->result.chi2_drop);
        add_number(o, "mode_out", c->result.mode_out_rms);
        add_number(o, "sensor_out", c->result.sensor_out_rms);
    }
    if (c->result.rejected_because)
        cJSON_AddStringToObject(o, "rejected", c->result.rejected_because);
    return o;
}

static cJSON *candidates(int count, const struct candidate *c)
{
    cJSON *list = cJSON_CreateArray();
    for (int i = 0; i < count; i++)
        if (c[i].result.refitted || !c[i].result.rejected_because || i < 3)
            cJSON_AddItemToArray(list, candidate_line(&c[i]));
    return list;
}

static cJSON *round_line(const struct diagnosis_round *r)
{
    cJSON *o = cJSON_CreateObject();
    cJSON_AddStringToObject(o, "kind", rotid_verdict_name(r->result.kind));
    add_number(o, "chi2", r->result.chi2);
    add_number(o, "dof", r->result.dof);
    add_number(o, "largest", r->result.largest);
    add_number(o, "threshold", r->result.threshold);
    add_number(o, "p_scan", r->result.p_scan);
    add_number(o, "p_frequency", r->result.p_frequency);
    add_number(o, "p_total", r->result.p_total);
    add_number(o, "required_margin", r->result.required_margin);
    add_number(o, "nset", r->result.set);
    cJSON_AddItemToObject(o, "candidate", candidates(r->ncandidate, r->candidate));
    return o;
}

static void add_diagnosis(cJSON *line, const struct diagnosis *d)
{
    cJSON *list = cJSON_AddArrayToObject(line, "finding");
    for (int i = 0; i < d->result.ndata_findings; i++)
        cJSON_AddItemToArray(list, cJSON_CreateString(d->result.data_findings[i].text));
    list = cJSON_AddArrayToObject(line, "numerical");
    for (int i = 0; i < d->result.nnumerical_findings; i++)
        cJSON_AddItemToArray(list, cJSON_CreateString(d->result.numerical_findings[i].text));
    cJSON_AddStringToObject(line, "sentence", d->result.verdict.sentence ? d->result.verdict.sentence : "");
    cJSON_AddItemToObject(line, "named", candidates(d->ncause, d->cause));
    list = cJSON_AddArrayToObject(line, "round");
    for (int r = 0; r < d->nround; r++)
        cJSON_AddItemToArray(list, round_line(&d->round[r]));
    list = cJSON_AddObjectToObject(line, "step");
    for (int i = 0; i < d->result.nsteps; i++)
        cJSON_AddNumberToObject(list, d->result.steps[i].name, round(1e3 * d->result.steps[i].seconds) / 1e3);
}

static void add_score(cJSON *line, const struct hidden_score *s)
{
    cJSON_AddStringToObject(line, "id", s->id);
    add_number(line, "class", s->class);
    cJSON_AddStringToObject(line, "outcome", hidden_outcome_name(s->outcome));
    cJSON_AddStringToObject(line, "wrong", s->wrong);
    add_number(line, "D", s->drop);
    add_number(line, "margin", s->margin);
    add_number(line, "left", s->left);
    add_number(line, "nset", s->nset);
    add_number(line, "found", s->found);
    add_number(line, "accused", s->accused);
    add_number(line, "place_error", s->place_error);
    add_number(line, "size_error", s->size_error);
    add_number(line, "seconds", s->seconds);
    if (s->failure[0])
        cJSON_AddStringToObject(line, "failure", s->failure);
    cJSON *values = cJSON_AddArrayToObject(line, "value");
    for (int i = 0; i < s->nvalue; i++) {
        const struct hidden_value *v = &s->value[i];
        cJSON *o = cJSON_CreateObject();
        cJSON_AddStringToObject(o, "name", v->name);
        add_number(o, "truth", v->truth);
        add_number(o, "estimate", v->estimate);
        add_number(o, "lower", v->lower);
        add_number(o, "upper", v->upper);
        cJSON_AddItemToArray(values, o);
    }
}

char *power_line(const struct hidden_case *c, const struct diagnosis *d, const cJSON *truth, const struct hidden_score *score)
{
    char command[600];
    cJSON *line = cJSON_CreateObject();
    power_command(c, sizeof command, command);
    cJSON_AddNumberToObject(line, "case", c->number);
    cJSON_AddStringToObject(line, "hide", command);
    if (truth) {
        cJSON_AddItemToObject(line, "effects", cJSON_Duplicate(cJSON_GetObjectItem(truth, "effects"), 1));
        cJSON_AddItemToObject(line, "parameters", cJSON_Duplicate(cJSON_GetObjectItem(truth, "parameters"), 1));
    }
    add_score(line, score);
    if (d)
        add_diagnosis(line, d);
    char *text = cJSON_PrintUnformatted(line);
    cJSON_Delete(line);
    return text;
}
