#include "report/table.h"

#include <math.h>
#include <string.h>

#include "report/layout.h"

static double reference_value(const struct reference *reference, int i)
{
    return reference && i < reference->count ? reference->value[i] : NAN;
}

/* 11 columns */
static void signed_power(FILE *out, double value)
{
    if (isfinite(value))
        (void)fprintf(out, "%+.4e", value);
    else
        (void)fprintf(out, "%11s", "-");
}

void table_sensitivity(FILE *out, const struct job *job, const rotid_parameter *parameter,
                       const struct sensitivity_options *options, const struct sensitivity *r)
{
    table_job_heading(out, job);
    (void)fprintf(out,
                  "sensitivity of E_k = 1 - R*_k/w_k^2 to the relative value of each parameter, %g %% steps, reduction %s\n\n",
                  100 * options->step, reduction_name(job->fit.reduction));
    for (int p = 0; p < r->n; p++) {
        char quantity[128];
        (void)snprintf(quantity, sizeof quantity, "sensitivity %s", parameter[p].name);
        const struct reference *paper = job_reference(job, quantity);
        (void)fprintf(out, "%s at %.6g %s\n", parameter[p].name, r->reference[p],
                      strcmp(parameter[p].unit, "1") ? parameter[p].unit : "");
        (void)fprintf(out, "mode   frequency [Hz]   step        limit       %s\n", paper ? "paper (magnitude)" : "");
        for (int k = 0; k < r->m; k++) {
            (void)fprintf(out, "%3d", k + 1);
            number_cell(out, 16, 4, r->hz[k]);
            (void)fputs("  ", out);
            signed_power(out, r->difference[k + (ptrdiff_t)p * r->m]);
            (void)fputc(' ', out);
            signed_power(out, r->derivative[k + (ptrdiff_t)p * r->m]);
            if (isfinite(reference_value(paper, k)))
                (void)fprintf(out, "  %.3e", reference_value(paper, k));
            (void)fputc('\n', out);
        }
        (void)fprintf(out, "1/2 E_k^2 over the relative value (Figure 5 of the paper)\n value");
        for (int k = 0; k < r->m; k++)
            (void)fprintf(out, "   mode %d ", k + 1);
        (void)fputc('\n', out);
        for (int i = 0; i < r->points; i++) {
            (void)fprintf(out, "%6.3f", r->relative[i]);
            for (int k = 0; k < r->m; k++)
                power_cell(out, 10, 2, r->curve[k + (ptrdiff_t)r->m * (i + (ptrdiff_t)r->points * p)]);
            (void)fputc('\n', out);
        }
        (void)fputc('\n', out);
    }
}
