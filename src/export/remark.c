#include "export/export.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST 4096 /* characters of a remark; what is beyond is cut */

/* `length` characters of text on lines of their own, those behind the first indented by two */
static void put_broken(const struct remark *remark, const char *text, size_t length)
{
    size_t room = (size_t)remark->width - strlen(remark->mark);
    for (int line = 0; length; line++) {
        size_t most = line ? room - 2 : room, take = length;
        if (length > most) {
            for (take = most; take && text[take] != ' ';)
                take--;
            take = take ? take : most;
        }
        (void)fprintf(remark->stream, "%s%s%.*s\n", remark->mark, line ? "  " : "", (int)take, text);
        for (; take < length && text[take] == ' ';)
            take++;
        text += take;
        length -= take;
    }
}

void remark_put(const struct remark *remark, const char *format, ...)
{
    char text[LONGEST];
    va_list list;
    va_start(list, format);
    int length = vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (length < 0)
        return;
    for (char *c = text; *c; c++)
        if (*c < ' ' || *c > '~')
            *c = '?';
    if (*text)
        put_broken(remark, text, strlen(text));
    else
        (void)fprintf(remark->stream, "%.*s\n", (int)strcspn(remark->mark, " "), remark->mark);
}

void remark_word(FILE *stream, const char *name)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
    for (; name && *name; name++)
        (void)fputc(strchr(plain, *name) ? *name : '_', stream);
}

/* The shortest decimal number that is read back as the same double; text [32]. */
static const char *remark_number(double value, char *text)
{
    for (int digits = 6; digits <= 17; digits++) { /* from 6, so that 7850 is not 7.85e+03 */
        (void)snprintf(text, 32, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    return text;
}

static void put_frequencies(const struct remark *remark, const char *what, int count, const double *hz)
{
    char text[LONGEST];
    int length = snprintf(text, sizeof text, "%s [Hz]:", what);
    for (int i = 0; i < count && isfinite(hz[i]) && length > 0 && length < LONGEST; i++) /* few masters have few modes */
        length += snprintf(text + length, LONGEST - (size_t)length, "%s %.10g", i ? "," : "", hz[i]);
    remark_put(remark, "%s", text);
}

static void put_origin(const struct remark *remark, const struct export_model *model)
{
    const struct job *job = model->job;
    if (model->identified) {
        const rotid_fit_result *fit = model->identified->fit;
        remark_put(remark, "Identified from %d measured modes, %s, REDUCTION=%s: %s.", job->measurement.nmode,
                   functional_words[job->options.fit.functional], reduction_words[job->options.fit.reduction],
                   !fit->converged         ? "NOT CONVERGED, not to be trusted"
                   : fit->any_at_bound     ? "AT A BOUND, not to be trusted"
                   : fit->any_undetermined ? "NOT DETERMINED by the data, not to be trusted"
                                           : "converged");
    } else {
        remark_put(remark, "As the deck states it: nothing was fitted.");
    }
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        const char *unit = job->unknowns.bounds[p].unit;
        double std = export_parameter_std(model, p);
        char value[32];
        (void)remark_number(export_parameter(model, p), value);
        unit = unit && strcmp(unit, "1") ? unit : "";
        if (isfinite(std))
            remark_put(remark, "%s = %s%s%s, standard deviation %.3g", job->unknowns.bounds[p].name, value, *unit ? " " : "",
                       unit, std);
        else
            remark_put(remark, "%s = %s%s%s", job->unknowns.bounds[p].name, value, *unit ? " " : "", unit);
    }
}

static void put_causes(const struct remark *remark, const struct rotor *rotor)
{
    for (int i = 0; i < rotor->neffect; i++) {
        const struct effect *effect = &rotor->effect[i];
        char text[512];
        int length = snprintf(text, sizeof text, "Part of the model: cause %s, %s", effect->name, effect->kind->id);
        for (int p = 0; p < effect_parameters(effect) && length > 0 && length < (int)sizeof text; p++)
            length += snprintf(text + length, sizeof text - (size_t)length, ", %s %.10g [%s]", effect->kind->parameter[p].name,
                               effect->value[p], effect->kind->parameter[p].unit);
        remark_put(remark, "%s", text);
    }
}

void remark_model(const struct remark *remark, const struct export_model *model)
{
    const struct spectrum *s = &model->spectrum;
    remark_put(remark, "Bending of a rotor in one plane, written by rotid %s from %s", model->version, model->job->deck);
    for (int i = 0; i < model->job->nheading; i++)
        remark_put(remark, "%s", model->job->heading[i]);
    remark_put(remark, "Units: m, kg, s, N.");
    put_origin(remark, model);
    put_causes(remark, model->discrete->rotor);
    remark_put(remark, "mass %.10g kg, centre of mass at %.10g m", model->mass.mass, model->mass.center);
    if (s->nrigid)
        put_frequencies(remark, "Modes on the supports, or of free motion", s->nrigid, s->rigid_hz);
    put_frequencies(remark, "Bending modes", s->count, s->full_hz);
}

void remark_condensed(const struct remark *remark, const struct export_model *model)
{
    const struct export_condensed *c = &model->condensed;
    remark_put(remark, "Condensed by %s onto the lateral deflection of %d %s:", c->kind == ROTID_IRS ? "IRS" : "GUYAN", c->count,
               model->job->rotor.nsensor ? "sensors" : "nodes");
    put_frequencies(remark, "Bending modes of the condensed model", model->spectrum.count, model->spectrum.reduced_hz);
}
