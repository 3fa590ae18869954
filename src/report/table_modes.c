#include "report/table.h"

#include <math.h>
#include <string.h>

#include "report/layout.h"

static void print_shapes(FILE *out, const rotid_spectrum *s)
{
    (void)fprintf(out, "\n    z [m]");
    for (int j = 0; j < s->nmodes; j++)
        (void)fprintf(out, "  mode %-3d", j + 1);
    (void)fputc('\n', out);
    for (int i = 0; i < s->nsensor_z_m; i++) {
        (void)fprintf(out, "%9.5f", s->sensor_z_m[i]);
        for (int j = 0; j < s->nmodes; j++)
            number_cell(out, 10, 5, s->modes[j].shape[i]);
        (void)fputc('\n', out);
    }
}

void table_modes(FILE *out, const struct result *result, int shapes)
{
    const rotid_spectrum *s = result->modes;
    table_heading(out, &result->head);
    for (int i = 0; i < s->nrigid_hz; i++)
        (void)fprintf(out, "rotor on its supports: %.4f Hz\n", s->rigid_hz[i]);
    (void)fprintf(out, "%smode   full model   %-6s [Hz]  reduction   mesh      measured    error     NCO\n",
                  s->nrigid_hz ? "\n" : "", strcmp(s->reduction, "IRS") ? "Guyan" : "IRS");
    (void)fprintf(out, "           [Hz]                     [%%]       [%%]         [Hz]      [%%]\n");
    for (int j = 0; j < s->nmodes; j++) {
        const rotid_model_mode *mode = &s->modes[j];
        const rotid_compared_mode *measured = mode->measured;
        (void)fprintf(out, "%3d ", mode->mode);
        number_cell(out, 13, 4, mode->full_hz);
        number_cell(out, 14, 4, mode->reduced_hz);
        signed_cell(out, 10, 3, mode->reduction_error_percent);
        signed_cell(out, 9, 4, mode->mesh_error_percent);
        number_cell(out, 13, 4, measured ? measured->measured_hz : NAN);
        signed_cell(out, 9, 2, measured ? measured->error_percent : NAN);
        number_cell(out, 8, 3, measured ? measured->nco : NAN);
        (void)fputc('\n', out);
    }
    if (shapes)
        print_shapes(out, s);
}
