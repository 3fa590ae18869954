/* Modes of a model and a fit as tables. */
#include <math.h>

#include "report/report.h"
#include "rotid.h"

static int write_modes(FILE *out, const void *from)
{
    const rotid_spectrum *s = ((const struct csv_spectrum *)from)->spectrum;
    (void)fputs("mode,frequency [Hz],condensed [Hz],reduction [%],mesh [%],measured [Hz],error [%],nco\n", out);
    for (int j = 0; j < s->nmodes; j++) {
        const rotid_model_mode *mode = &s->modes[j];
        const rotid_compared_mode *measured = mode->measured;
        (void)fprintf(out, "%d", mode->mode);
        csv_number(out, ",", mode->full_hz);
        csv_number(out, ",", mode->reduced_hz);
        csv_number(out, ",", mode->reduction_error_percent);
        csv_number(out, ",", mode->mesh_error_percent);
        csv_number(out, ",", measured ? measured->measured_hz : NAN);
        csv_number(out, ",", measured ? measured->error_percent : NAN);
        csv_number(out, ",", measured ? measured->nco : NAN);
        (void)fputc('\n', out);
    }
    return ROTID_OK;
}

/* Without sensors the nodes of the axis are numbered from 1. */
static int write_shapes(FILE *out, const void *from)
{
    const rotid_spectrum *s = ((const struct csv_spectrum *)from)->spectrum;
    const struct rotor *rotor = &((const struct csv_spectrum *)from)->job->rotor;
    (void)fputs("sensor,position [m]", out);
    for (int j = 0; j < s->nmodes; j++)
        (void)fprintf(out, ",mode %d", s->modes[j].mode);
    (void)fputc('\n', out);
    for (int i = 0; i < s->nsensor_z_m; i++) {
        (void)fprintf(out, "%d", rotor->nsensor == s->nsensor_z_m ? rotor->sensor[i].id : i + 1);
        csv_number(out, ",", s->sensor_z_m[i]);
        for (int j = 0; j < s->nmodes; j++)
            csv_number(out, ",", s->modes[j].nshape > i ? s->modes[j].shape[i] : NAN);
        (void)fputc('\n', out);
    }
    return ROTID_OK;
}

const struct csv_part csv_spectrum_parts[CSV_MOST_FILES] = {{"modes", write_modes}, {"shapes", write_shapes}};

static int write_parameters(FILE *out, const void *from)
{
    const rotid_identification *fit = from;
    (void)fputs("parameter,unit,value,std,lower 95 %,upper 95 %,start,at bound,identifiable\n", out);
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_fitted_parameter *parameter = &fit->parameters[p];
        csv_text(out, "", parameter->name);
        csv_text(out, ",", parameter->unit);
        csv_number(out, ",", parameter->value);
        csv_number(out, ",", parameter->std);
        csv_number(out, ",", parameter->ci95[0]);
        csv_number(out, ",", parameter->ci95[1]);
        csv_number(out, ",", parameter->start);
        (void)fprintf(out, ",%d,%d\n", parameter->at_bound, parameter->identifiable);
    }
    return ROTID_OK;
}

static void write_compared(FILE *out, const char *state, int count, const rotid_compared_mode *modes, const double *reduction,
                           const double *mesh)
{
    for (int k = 0; k < count; k++) {
        const rotid_compared_mode *mode = &modes[k];
        if (state) {
            csv_text(out, "", state);
            (void)fputc(',', out);
        }
        (void)fprintf(out, "%d,%d", mode->mode, mode->measured_mode);
        csv_number(out, ",", mode->measured_hz);
        csv_number(out, ",", mode->predicted_hz);
        csv_number(out, ",", mode->error_percent);
        csv_number(out, ",", reduction[k]);
        csv_number(out, ",", mesh[k]);
        csv_number(out, ",", mode->nco);
        csv_number(out, ",", mode->mac);
        (void)fprintf(out, ",%d\n", mode->holdout);
    }
}

static int write_fitted(FILE *out, const void *from)
{
    const rotid_identification *fit = from;
    (void)fprintf(out, "%smode,measured mode,measured [Hz],predicted [Hz],error [%%],reduction [%%],mesh [%%],nco,mac,held out\n",
                  fit->nstates ? "state," : "");
    for (int s = 0; s < fit->nstates; s++)
        write_compared(out, fit->states[s].name, fit->states[s].nmodes, fit->states[s].modes,
                       fit->states[s].reduction_error_percent, fit->states[s].mesh_error_percent);
    if (!fit->nstates)
        write_compared(out, NULL, fit->nmodes, fit->modes, fit->reduction_error_percent, fit->mesh_error_percent);
    return ROTID_OK;
}

const struct csv_part csv_identify_parts[CSV_MOST_FILES] = {{"parameters", write_parameters}, {"modes", write_fitted}};
