/* One line of JSON a case, and the scores of a log read back. */
#include <errno.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
        add_number(o, "sensor_out", c->result.sensor_out_rms);
    }
    add_number(o, "probability", c->result.probability);
    return o;
}

static cJSON *candidates(int count, const struct candidate *c)
{
    cJSON *list = cJSON_CreateArray();
    for (int i = 0; i < count; i++)
        if (c[i].result.refitted || i < 3)
            cJSON_AddItemToArray(list, candidate_line(&c[i]));
    return list;
}

static cJSON *round_line(const struct diagnosis_round *r)
{
    cJSON *o = cJSON_CreateObject();
    add_number(o, "chi2", r->result.chi2);
    add_number(o, "dof", r->result.dof);
    add_number(o, "largest", r->result.largest);
    add_number(o, "p_frequency", r->result.p_frequency);
    add_number(o, "p_total", r->result.p_total);
    cJSON_AddItemToObject(o, "candidate", candidates(r->ncandidate, r->candidate));
    return o;
}

static void add_diagnosis(cJSON *line, const struct diagnosis *d, const cJSON *truth)
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
    list = cJSON_AddArrayToObject(line, "explanation");
    for (int i = 0; i < d->posterior.count && i < 60; i++) {
        const struct explanation *e = &d->posterior.item[i];
        cJSON *o = cJSON_CreateObject(), *set = cJSON_AddArrayToObject(o, "causes");
        cJSON_AddNumberToObject(o, "right", hidden_truths(d, e, truth, HIDDEN_PLACE));
        for (int m = 0; m < e->nmember; m++)
            cJSON_AddItemToArray(set, candidate_line(&e->member[m]));
        cJSON_AddBoolToObject(o, "else", e->something_else);
        add_number(o, "probability", e->probability);
        add_number(o, "log_z", e->evidence.log_z);
        add_number(o, "log_stated", e->evidence.log_stated);
        add_number(o, "log_else", e->evidence.log_else);
        add_number(o, "log_prior", e->log_prior);
        add_number(o, "noise_f", e->evidence.noise[0]);
        add_number(o, "noise_s", e->evidence.noise[1]);
        add_number(o, "chi2", e->refit ? e->refit->chi2 : NAN);
        cJSON_AddItemToArray(list, o);
    }
    list = cJSON_AddObjectToObject(line, "step");
    for (int i = 0; i < d->result.nsteps; i++)
        cJSON_AddNumberToObject(list, d->result.steps[i].name, round(1e3 * d->result.steps[i].seconds) / 1e3);
}

/* What a score is but for its class, outcome and values. */
static const struct {
    const char *name;
    enum { TEXT, INTEGER, NUMBER } type;
    size_t offset, room; /* room of a text */
} field[] = {{"id", TEXT, offsetof(struct hidden_score, id), HIDDEN_NAME},
             {"wrong", TEXT, offsetof(struct hidden_score, wrong), HIDDEN_NAME},
             {"failure", TEXT, offsetof(struct hidden_score, failure), sizeof((struct hidden_score *)0)->failure},
             {"shapes", INTEGER, offsetof(struct hidden_score, shapes), 0},
             {"coloured", INTEGER, offsetof(struct hidden_score, coloured), 0},
             {"reported", INTEGER, offsetof(struct hidden_score, reported), 0},
             {"names", INTEGER, offsetof(struct hidden_score, names), 0},
             {"truths", INTEGER, offsetof(struct hidden_score, truths), 0},
             {"found", INTEGER, offsetof(struct hidden_score, found), 0},
             {"nset", INTEGER, offsetof(struct hidden_score, nset), 0},
             {"accused", INTEGER, offsetof(struct hidden_score, accused), 0},
             {"channels", INTEGER, offsetof(struct hidden_score, channels), 0},
             {"drop", NUMBER, offsetof(struct hidden_score, drop), 0},
             {"lesser", NUMBER, offsetof(struct hidden_score, lesser), 0},
             {"before", NUMBER, offsetof(struct hidden_score, before), 0},
             {"margin", NUMBER, offsetof(struct hidden_score, margin), 0},
             {"left", NUMBER, offsetof(struct hidden_score, left), 0},
             {"place_error", NUMBER, offsetof(struct hidden_score, place_error), 0},
             {"size_error", NUMBER, offsetof(struct hidden_score, size_error), 0},
             {"seconds", NUMBER, offsetof(struct hidden_score, seconds), 0}};

#define FIELDS ((int)(sizeof field / sizeof *field))

static void add_score(cJSON *line, const struct hidden_score *s)
{
    cJSON_AddStringToObject(line, "class", hidden_class_name(s->class));
    cJSON_AddStringToObject(line, "outcome", hidden_outcome_name(s->outcome));
    for (int i = 0; i < FIELDS; i++) {
        const char *at = (const char *)s + field[i].offset;
        if (field[i].type == TEXT)
            cJSON_AddStringToObject(line, field[i].name, at);
        else
            add_number(line, field[i].name,
                       field[i].type == INTEGER ? *(const int *)(const void *)at : *(const double *)(const void *)at);
    }
    cJSON *values = cJSON_AddArrayToObject(line, "value");
    for (int i = 0; i < s->nvalue; i++) {
        const struct hidden_value *v = &s->value[i];
        cJSON *o = cJSON_CreateObject();
        cJSON_AddStringToObject(o, "name", v->name);
        cJSON_AddNumberToObject(o, "of", v->of);
        add_number(o, "known", v->known);
        add_number(o, "truth", v->truth);
        add_number(o, "estimate", v->estimate);
        add_number(o, "lower", v->lower);
        add_number(o, "upper", v->upper);
        cJSON_AddItemToArray(values, o);
    }
}

char *power_line(const struct power_case *c, const struct diagnosis *d, const cJSON *truth, const struct hidden_score *score)
{
    static const char *const of_truth[] = {"noise", "modes", "rigid_modes", "length", "effects", "parameters"};
    cJSON *line = cJSON_CreateObject();
    cJSON_AddNumberToObject(line, "case", c->hidden.number);
    cJSON_AddStringToObject(line, "again", c->again);
    for (size_t i = 0; truth && i < sizeof of_truth / sizeof *of_truth; i++)
        cJSON_AddItemToObject(line, of_truth[i], cJSON_Duplicate(cJSON_GetObjectItem(truth, of_truth[i]), 1));
    add_score(line, score);
    if (d)
        add_diagnosis(line, d, truth);
    char *text = cJSON_PrintUnformatted(line);
    cJSON_Delete(line);
    return text;
}

/* ---- read back */

static double number_of(const cJSON *object, const char *name)
{
    const cJSON *item = cJSON_GetObjectItem(object, name);
    return cJSON_IsNumber(item) ? item->valuedouble : NAN;
}

static const char *text_of(const cJSON *object, const char *name)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(object, name));
    return text ? text : "";
}

static void take_score(const cJSON *line, struct hidden_score *s)
{
    const cJSON *value;
    *s = hidden_score_none();
    while ((int)s->class + 1 < HIDDEN_CLASSES && strcmp(hidden_class_name(s->class), text_of(line, "class")) != 0)
        s->class ++;
    for (int o = 0; o < HIDDEN_OUTCOMES; o++)
        if (!strcmp(hidden_outcome_name((enum hidden_outcome)o), text_of(line, "outcome")))
            s->outcome = (enum hidden_outcome)o;
    for (int i = 0; i < FIELDS; i++) {
        char *at = (char *)s + field[i].offset;
        if (field[i].type == TEXT)
            snprintf(at, field[i].room, "%s", text_of(line, field[i].name));
        else if (field[i].type == INTEGER)
            *(int *)(void *)at = (int)number_of(line, field[i].name);
        else
            *(double *)(void *)at = number_of(line, field[i].name);
    }
    cJSON_ArrayForEach(value, cJSON_GetObjectItem(line, "value"))
    {
        if (s->nvalue == HIDDEN_VALUES)
            break;
        struct hidden_value *v = &s->value[s->nvalue++];
        snprintf(v->name, sizeof v->name, "%s", text_of(value, "name"));
        v->of = (enum hidden_of)number_of(value, "of");
        v->known = number_of(value, "known");
        v->truth = number_of(value, "truth");
        v->estimate = number_of(value, "estimate");
        v->lower = number_of(value, "lower");
        v->upper = number_of(value, "upper");
    }
}

struct taking {
    const struct power_options *options;
    struct power_result *result;
};

/* Nonzero where the line is not one of this run. */
static int take_line(void *context, const cJSON *line)
{
    const struct taking *t = context;
    double number = number_of(line, "case") - t->options->first;
    int other = isnan(number);
    if (number >= 0 && number < t->options->cases) {
        struct power_case c;
        struct power_result *r = &t->result[(int)number];
        other = power_draw(t->options, t->options->first + (int)number, &c) || strcmp(c.again, text_of(line, "again")) != 0;
        r->done = !other;
        memcpy(r->again, c.again, sizeof c.again);
        take_score(line, &r->score);
        free(c.deck);
    }
    return other;
}

FILE *power_lines(const char *path, int (*take)(void *context, const cJSON *line), void *context)
{
    FILE *file = fopen(path, "a+b");
    char *text = NULL;
    size_t room = 0;
    ssize_t length;
    long whole = 0;
    int other = 0;
    if (file)
        rewind(file);
    while (file && !other && (length = getline(&text, &room, file)) > 0) {
        int ends = text[length - 1] == '\n';
        cJSON *line = ends ? cJSON_Parse(text) : NULL;
        other = ends ? take(context, line) : *text != '{';
        cJSON_Delete(line);
        whole += ends ? length : 0;
    }
    free(text);
    if (file && !other && !ftruncate(fileno(file), whole) && !fseek(file, 0, SEEK_END))
        return file;
    fprintf(stderr, "power: %s: %s\n", path, other ? "expected a log of this run, or no file" : strerror(errno));
    if (file)
        fclose(file);
    return NULL;
}

FILE *power_log(const struct power_options *options, struct power_result *result)
{
    struct taking taking = {options, result};
    return power_lines(options->log, take_line, &taking);
}

void power_keep(const struct power_options *options, const char *name, int number, const char *text)
{
    char path[600];
    (void)snprintf(path, sizeof path, "%s/%s_%d.inp", options->keep, name, number);
    FILE *file = fopen(path, "w");
    if (!file || fputs(text, file) < 0 || fclose(file))
        fprintf(stderr, "power: cannot write %s\n", path);
}
