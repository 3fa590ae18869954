#include "api_dump.h"

#include "record/record.h"
#include "result/result.h"
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

/* What the table of the result says, times apart. */
static char *dump_record(const struct record *record, const void *result, const rotid_fit_result *const fit[2], int nmessage,
                         const rotid_message *message)
{
    char *text;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    char *json = record_text(record, result, 1);
    if (!json)
        abort();
    for (const char *line = json; *line; line += strcspn(line, "\n"), line += *line == '\n') {
        int columns = (int)strcspn(line, "\n");
        const char *time = strstr(line, "\"seconds\"");
        if (!time || time > line + columns)
            (void)fprintf(out, "%.*s\n", columns, line);
    }
    free(json);
    for (int i = 0; i < 2; i++)
        if (fit[i])
            put_fit(out, fit[i]);
    put_messages(out, nmessage, message);
    return close_text(out, &text);
}

char *dump_spectrum(const rotid_spectrum *s)
{
    return dump_record(&spectrum_record, s, (const rotid_fit_result *const[2]){NULL, NULL}, s->nmessage, s->message);
}

char *dump_identification(const rotid_identification *r)
{
    return dump_record(&identification_record, r, (const rotid_fit_result *const[2]){r->fit, NULL}, r->nmessage, r->message);
}

char *dump_diagnosis(const rotid_diagnosis *d)
{
    const rotid_fit_result *const fit[2] = {d->base ? d->base->fit : NULL, d->extended ? d->extended->fit : NULL};
    char *text = dump_record(&diagnosis_record, d, fit, d->nmessage, d->message);
    size_t length = strlen(text), more = d->extended_deck ? strlen(d->extended_deck) : 0;
    text = realloc(text, length + more + 1);
    if (!text)
        abort();
    memcpy(text + length, d->extended_deck ? d->extended_deck : "", more + 1);
    return text;
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
