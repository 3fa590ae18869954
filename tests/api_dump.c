#include "api_dump.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

static void put_text(FILE *out, const char *name, const char *text)
{
    (void)fprintf(out, "%s %s%s\n", name, text ? "=" : "-", text ? text : "");
}

static void put_number(FILE *out, const char *name, double value)
{
    if (value == value)
        (void)fprintf(out, "%s %a\n", name, value);
    else
        (void)fprintf(out, "%s nan\n", name); /* whatever its sign */
}

static void put_numbers(FILE *out, const char *name, ptrdiff_t count, const double *value)
{
    if (!value)
        put_text(out, name, NULL);
    for (ptrdiff_t i = 0; value && i < count; i++)
        put_number(out, name, value[i]);
}

static void put_integers(FILE *out, const char *name, int count, const int *value)
{
    if (!value)
        put_text(out, name, NULL);
    for (int i = 0; value && i < count; i++)
        (void)fprintf(out, "%s %d\n", name, value[i]);
}

static void put_parameters(FILE *out, int count, const rotid_parameter *parameter)
{
    for (int p = 0; p < count; p++) {
        put_text(out, "name", parameter[p].name);
        put_text(out, "unit", parameter[p].unit);
        put_numbers(out, "bounds", 3, (const double[]){parameter[p].lower, parameter[p].upper, parameter[p].start});
    }
}

static void put_messages(FILE *out, int count, const rotid_message *message)
{
    for (int i = 0; i < count; i++) {
        put_integers(out, "message", 3, (const int[]){message[i].severity, message[i].line, message[i].column});
        put_text(out, "file", message[i].file);
        put_text(out, "text", message[i].text);
    }
}

static char *close_text(FILE *out, char **text)
{
    if (!out || fclose(out) != 0)
        abort();
    return *text;
}

char *dump_deck(const rotid_deck *d)
{
    char *text;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    put_text(out, "path", d->path);
    put_messages(out, d->nmessage, d->message);
    put_integers(out, "sizes", 4, (const int[]){d->nerror, d->nsensor, d->nmode, d->nparameter});
    put_numbers(out, "rotor", 3, (const double[]){d->length, d->mass, d->centre});
    put_integers(out, "sensor", d->nsensor, d->sensor_id);
    put_numbers(out, "z", d->nsensor, d->sensor_z);
    put_integers(out, "number", d->nmode, d->number);
    put_numbers(out, "hz", d->nmode, d->frequency_hz);
    put_numbers(out, "std", d->nmode, d->frequency_std);
    put_numbers(out, "shape", (ptrdiff_t)d->nsensor * d->nmode, d->shape);
    put_numbers(out, "shape std", (ptrdiff_t)d->nsensor * d->nmode, d->shape_std);
    put_integers(out, "holdout", d->nmode, d->holdout);
    put_parameters(out, d->nparameter, d->parameter);
    return close_text(out, &text);
}

char *dump_spectrum(const rotid_spectrum *s)
{
    char *text;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    put_integers(out, "sizes", 3, (const int[]){s->nrigid, s->nmode, s->nmaster});
    put_numbers(out, "rigid", 2, s->rigid_hz);
    put_numbers(out, "hz", s->nmode, s->hz);
    put_numbers(out, "reduced", s->nmode, s->reduced_hz);
    put_numbers(out, "reduction", s->nmode, s->reduction_error_percent);
    put_numbers(out, "mesh", s->nmode, s->mesh_error_percent);
    put_numbers(out, "shape", (ptrdiff_t)s->nmaster * s->nmode, s->shape);
    put_numbers(out, "z", s->nmaster, s->master_z);
    put_numbers(out, "mass", (ptrdiff_t)s->nmaster * s->nmaster, s->master_mass);
    return close_text(out, &text);
}

static void put_fit(FILE *out, const rotid_fit_result *f)
{
    ptrdiff_t n = f->n;
    put_integers(out, "fit", 12,
                 (const int[]){f->status, f->converged, f->any_at_bound, f->any_undetermined, f->n, f->m, f->nresidual, f->dof,
                               f->iterations, f->evaluations, f->jacobians, f->variance_from_residuals});
    put_numbers(out, "objective", 6,
                (const double[]){f->objective, f->gradient, f->chi2, f->chi2_per_dof, f->condition_number, f->widened_by});
    put_numbers(out, "x", n, f->x);
    put_numbers(out, "x std", n, f->std);
    put_numbers(out, "lower", n, f->ci_lower);
    put_numbers(out, "upper", n, f->ci_upper);
    put_integers(out, "at bound", f->n, f->at_bound);
    put_integers(out, "identifiable", f->n, f->identifiable);
    put_numbers(out, "covariance", n * n, f->covariance);
    put_numbers(out, "correlation", n * n, f->correlation);
    put_numbers(out, "singular", n, f->singular_value);
    put_numbers(out, "direction", n * n, f->direction);
    put_integers(out, "undetermined", f->n, f->direction_undetermined);
    put_numbers(out, "predicted", f->m, f->predicted_hz);
    put_numbers(out, "mac", f->m, f->mac);
    put_numbers(out, "residual", f->m, f->residual);
    put_numbers(out, "r", f->nresidual, f->r);
    put_numbers(out, "jacobian", f->nresidual * n, f->jacobian);
    for (int i = 0; i < f->nhistory; i++)
        put_numbers(out, "history", 6,
                    (const double[]){f->history[i].iteration, f->history[i].objective, f->history[i].gradient, f->history[i].mu,
                                     f->history[i].gain_ratio, f->history[i].step});
    put_numbers(out, "history x", n * f->nhistory, f->history_x);
    for (int i = 0; i < f->nbaseline; i++) {
        const rotid_baseline *b = &f->baseline[i];
        put_text(out, "algorithm", b->algorithm);
        put_text(out, "result", b->result);
        put_integers(out, "baseline", 3, (const int[]){b->code, b->usable, b->evaluations});
        put_numbers(out, "baseline", 2, (const double[]){b->objective, b->gradient});
        put_numbers(out, "baseline x", n, b->x);
    }
}

static void put_identification(FILE *out, const rotid_identification *r)
{
    put_fit(out, r->fit);
    put_parameters(out, r->nparameter, r->parameter);
    put_integers(out, "number", r->nmode, r->number);
    put_numbers(out, "measured", r->nmode, r->measured_hz);
    put_numbers(out, "nco", r->nmode, r->nco);
    put_numbers(out, "reduction", r->nmode, r->reduction_error_percent);
    put_numbers(out, "mesh", r->nmode, r->mesh_error_percent);
    put_numbers(out, "rotor", 2, (const double[]){r->mass, r->centre});
    put_messages(out, r->nmessage, r->message);
}

char *dump_identification(const rotid_identification *r)
{
    char *text;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    put_identification(out, r);
    return close_text(out, &text);
}

static void put_causes(FILE *out, const char *title, int count, const rotid_cause *cause)
{
    for (int i = 0; i < count; i++) {
        const rotid_cause *c = &cause[i];
        put_text(out, title, c->id);
        put_text(out, "target", c->target);
        put_text(out, "name", c->name);
        put_text(out, "variant", c->variant);
        put_integers(out, "round", 3, (const int[]){c->round, c->refitted, c->at_bound});
        put_numbers(out, "judged", 9,
                    (const double[]){c->chi2, c->chi2_drop, c->bic, c->holdout_rms, c->mode_out_rms, c->sensor_out_rms,
                                     c->predicted_drop, c->p_value, c->cosine});
        put_text(out, "collinear", c->collinear_with);
        put_text(out, "rejected", c->rejected_because);
        for (int v = 0; v < c->nvalue; v++) {
            put_text(out, "value", c->value[v].name);
            put_text(out, "unit", c->value[v].unit);
            put_integers(out, "fixed", 1, &c->value[v].fixed);
            put_numbers(out, "value", 4,
                        (const double[]){c->value[v].value, c->value[v].std, c->value[v].ci_lower, c->value[v].ci_upper});
        }
    }
}

static void put_findings(FILE *out, int count, const rotid_finding *finding)
{
    for (int i = 0; i < count; i++) {
        const rotid_finding *f = &finding[i];
        put_text(out, "finding", f->id);
        put_integers(out, "sensor", f->nsensor, f->sensor);
        put_integers(out, "mode", f->nmode, f->mode);
        put_numbers(out, "error", f->nmode, f->error_percent);
        put_text(out, "block", f->block);
        put_numbers(out, "found", 3, (const double[]){f->value, f->std, f->chi2_drop});
        put_text(out, "text", f->text);
    }
}

static void put_quality(FILE *out, const rotid_quality *q)
{
    put_numbers(out, "quality", 10,
                (const double[]){q->frequency_rms_percent, q->frequency_max_percent, q->shape_rms, q->chi2_per_dof, q->nco_min,
                                 q->holdout_frequency_rms_percent, q->holdout_shape_rms, q->mode_out_frequency_rms_percent,
                                 q->mode_out_shape_rms, q->sensor_out_shape_rms});
}

char *dump_diagnosis(const rotid_diagnosis *d)
{
    char *text;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    put_integers(out, "verdict", 3, (const int[]){d->kind, d->adequate_after, d->interrupted});
    put_number(out, "p", d->p_value);
    put_text(out, "sentence", d->sentence);
    put_text(out, "next", d->next_measurement);
    put_causes(out, "cause", d->ncause, d->cause);
    put_causes(out, "alternative", d->nalternative, d->alternative);
    put_causes(out, "candidate", d->ncandidate, d->candidate);
    put_findings(out, d->ndata_finding, d->data_finding);
    put_findings(out, d->nnumerical_finding, d->numerical_finding);
    if (d->base)
        put_identification(out, d->base);
    if (d->extended)
        put_identification(out, d->extended);
    put_quality(out, &d->before);
    put_quality(out, &d->after);
    put_numbers(out, "local z", d->nlocal, d->local_z);
    put_numbers(out, "local", d->nlocal, d->local);
    for (int i = 0; i < d->ndetectable; i++) {
        const rotid_detectable *f = &d->detectable[i];
        put_text(out, "detectable", f->id);
        put_text(out, "target", f->target);
        put_text(out, "parameter", f->parameter);
        put_text(out, "unit", f->unit);
        put_numbers(out, "size", 4, (const double[]){f->smallest, f->z, f->worst, f->beyond});
    }
    put_text(out, "deck", d->extended_deck);
    put_messages(out, d->nmessage, d->message);
    return close_text(out, &text);
}

void assert_dump(char *is, const char *expected)
{
    const char *a = is, *b = expected;
    while (*a && *a == *b)
        a++, b++;
    if (*a != *b) {
        while (a > is && a[-1] != '\n')
            a--, b--;
        print_error("%.*s\n    expected\n%.*s\n", (int)strcspn(a, "\n"), a, (int)strcspn(b, "\n"), b);
        free(is);
        fail();
    }
    free(is);
}
