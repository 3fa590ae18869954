#include "report/report.h"

#include <math.h>
#include <string.h>

#include "run/run.h"

/* 11 columns */
static void signed_power(FILE *out, double value)
{
    if (isfinite(value))
        (void)fprintf(out, "%+.4e", value);
    else
        (void)fprintf(out, "%11s", "-");
}

static void print_sensitivity(FILE *out, const struct result_head *head, const struct sensitivity *r)
{
    (void)fprintf(out,
                  "sensitivity to the relative value of each parameter, reduction %s: per cent of a frequency for each per cent, "
                  "and\nthe paper's E_k = 1 - R*_k/w_k^2 by steps of %g %% and their limit\n\n",
                  r->reduction, 100 * r->step);
    for (int p = 0; p < r->nparameters; p++) {
        const struct sensitivity_parameter *one = &r->parameters[p];
        char quantity[128];
        (void)snprintf(quantity, sizeof quantity, "sensitivity %s", one->name);
        const rotid_reference *paper = head_reference(head, quantity);
        (void)fprintf(out, "%s at %.6g %s\n", one->name, one->reference, strcmp(one->unit, "1") ? one->unit : "");
        (void)fprintf(out, "mode   frequency [Hz]   frequency   E_k: step   limit       %s\n", paper ? "paper (magnitude)" : "");
        (void)fputs("                          [% / %]\n", out);
        for (int k = 0; k < r->nfrequency_hz; k++) {
            (void)fprintf(out, "%3d", k + 1);
            number_cell(out, 16, 4, r->frequency_hz[k]);
            signed_cell(out, 13, 4, one->frequency_change[k]);
            (void)fputs("  ", out);
            signed_power(out, one->sensitivity[k]);
            (void)fputc(' ', out);
            signed_power(out, one->derivative[k]);
            if (isfinite(reference_value(paper, k)))
                (void)fprintf(out, "  %.3e", reference_value(paper, k));
            (void)fputc('\n', out);
        }
        (void)fprintf(out, "1/2 E_k^2 over the relative value (Figure 5 of the paper)\n value");
        for (int k = 0; k < r->nfrequency_hz; k++)
            (void)fprintf(out, "   mode %d ", k + 1);
        (void)fputc('\n', out);
        for (int i = 0; i < r->nrelative_value; i++) {
            (void)fprintf(out, "%6.3f", r->relative_value[i]);
            for (int k = 0; k < r->nfrequency_hz; k++)
                power_cell(out, 10, 2, one->curves[k + (ptrdiff_t)r->nfrequency_hz * i]);
            (void)fputc('\n', out);
        }
        (void)fputc('\n', out);
    }
}

void table_sensitivity(FILE *out, const struct result *result)
{
    table_heading(out, &result->head);
    if (!result->nstates)
        print_sensitivity(out, &result->head, result->sensitivity);
    for (int s = 0; s < result->nstates; s++) {
        table_state(out, 0, result->states[s].name); /* a table ends in a line of its own */
        print_sensitivity(out, &result->head, result->states[s].sensitivity);
    }
}
