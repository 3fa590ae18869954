#include "report/report.h"

#include <math.h>
#include <string.h>

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

static void print_beside(FILE *out, const rotid_beam_beside_solid *beside)
{
    (void)fprintf(out, "\nmode        solid          beam  difference     NCO     MAC   mesh of solid   of beam\n"
                       "             [Hz]          [Hz]         [%%]                              [%%]       [%%]\n");
    for (int j = 0; j < beside->nmodes; j++) {
        const rotid_beside_mode *mode = &beside->modes[j];
        (void)fprintf(out, "%3d ", mode->mode);
        number_cell(out, 13, 4, mode->solid_hz);
        number_cell(out, 14, 4, mode->beam_hz);
        signed_cell(out, 12, 2, mode->difference_percent);
        number_cell(out, 8, 4, mode->nco);
        number_cell(out, 8, 4, mode->mac);
        signed_cell(out, 16, 4, mode->solid_mesh_error_percent);
        signed_cell(out, 10, 4, mode->beam_mesh_error_percent);
        (void)fprintf(out, mode->beam_mode == mode->mode ? "\n" : "  mode %d of the beam\n", mode->beam_mode);
    }
    for (int p = 0; p < beside->nmoduli; p++) {
        const rotid_beside_modulus *modulus = &beside->moduli[p];
        (void)fprintf(out, "%s", p ? "" : "\nmodulus              solid [Pa]     beam [Pa]  change [%]\n");
        name_cell(out, 16, modulus->name);
        (void)fprintf(out, " %14.4e %13.4e %+11.1f\n", modulus->stated_pa, modulus->found_pa, modulus->change_percent);
    }
    if (beside->sentence)
        (void)fprintf(out, "\n%s\n", beside->sentence);
}

static void print_modes(FILE *out, const rotid_spectrum *s, int shapes)
{
    for (int i = 0; i < s->nrigid_hz; i++)
        (void)fprintf(out, "rotor on its supports: %.4f Hz\n", s->rigid_hz[i]);
    int reduced = 0; /* there are masters for some mode */
    for (int j = 0; j < s->nmodes; j++)
        reduced |= isfinite(s->modes[j].reduced_hz);
    (void)fprintf(out, "%smode   full model", s->nrigid_hz ? "\n" : "");
    if (reduced)
        (void)fprintf(out, "   %-6s [Hz]  reduction", strcmp(s->reduction, "IRS") ? "Guyan" : "IRS");
    (void)fprintf(out, "   mesh      measured    error     NCO\n           [Hz]%s       [%%]         [Hz]      [%%]\n",
                  reduced ? "                     [%]" : "");
    for (int j = 0; j < s->nmodes; j++) {
        const rotid_model_mode *mode = &s->modes[j];
        const rotid_compared_mode *measured = mode->measured;
        (void)fprintf(out, "%3d ", mode->mode);
        number_cell(out, 13, 4, mode->full_hz);
        if (reduced) {
            number_cell(out, 14, 4, mode->reduced_hz);
            signed_cell(out, 10, 3, mode->reduction_error_percent);
        }
        signed_cell(out, 9, 4, mode->mesh_error_percent);
        number_cell(out, 13, 4, measured ? measured->measured_hz : NAN);
        signed_cell(out, 9, 2, measured ? measured->error_percent : NAN);
        number_cell(out, 8, 3, measured ? measured->nco : NAN);
        (void)fputc('\n', out);
    }
    if (s->beside)
        print_beside(out, s->beside);
    if (shapes)
        print_shapes(out, s);
}

void table_modes(FILE *out, const struct result *result, int shapes)
{
    table_heading(out, &result->head);
    if (!result->nstates)
        print_modes(out, result->modes, shapes);
    for (int s = 0; s < result->nstates; s++) {
        table_state(out, s, result->states[s].name);
        print_modes(out, result->states[s].modes, shapes);
    }
}
