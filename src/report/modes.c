/* What a model is and does before anything is fitted: `rotid check`, `modes`, `sensitivity` on the screen, and their tables. */
#include "report/report.h"

/* ---- check */

/* What an effect acts on, as its hooks tell; "" where that is the whole rotor. */
static const char *target_of(struct pool *pool, const struct rotor *rotor, const struct effect *effect)
{
    const struct effect_kind *kind = effect->kind;
    int target = effect->target;
    if (kind->spring && target >= 0 && target < rotor->nspring && rotor->spring[target].name)
        return pool_text(pool, " at %s", rotor->spring[target].name);
    if (kind->tierod && target >= 0 && target < rotor->ntierod && rotor->tierod[target].name)
        return pool_text(pool, " at %s", rotor->tierod[target].name);
    if (kind->joint && target >= 0 && target + 1 < rotor_axis_groups(rotor))
        return pool_text(pool, " between %s and %s", rotor->group[target].name, rotor->group[target + 1].name);
    if ((kind->field || kind->section) && target >= 0 && target < rotor->ngroup)
        return pool_text(pool, " in %s", rotor->group[target].name);
    return "";
}

static const char *effect_text(struct pool *pool, const struct rotor *rotor, const struct effect *effect)
{
    const char *text = pool_text(pool, "%s%s", effect->kind->id, target_of(pool, rotor, effect));
    for (int p = 0; p < effect_parameters(effect); p++) {
        const struct effect_parameter_name *parameter = &effect->kind->parameter[p];
        text = pool_text(pool, "%s, %s %s", text, parameter->name, human_value(pool, effect->value[p], parameter->unit));
    }
    return text;
}

static const char *correction_text(struct pool *pool, const struct correction *c)
{
    const char *text = c->id;
    for (int s = 0; s < c->nsensor; s++)
        text = pool_text(pool, "%s%s%d", text, s ? " and " : " of sensor ", c->sensor[s]);
    text = pool_text(pool, "%s%s%s, value %.6g", text, c->block ? " of " : "", c->block ? c->block : "", c->value);
    return same_text(c->id, "sensor_line") ? pool_text(pool, "%s, scale %.6g, flip %.6g", text, c->more[0], c->more[1]) : text;
}

/* The CAUSE cards. */
static struct table *table_of_causes(struct pool *pool, const struct job *job)
{
    struct table *table = table_open(pool, "");
    int neffect = job->rotor.neffect, nsuspect = job->unknowns.nsuspect;
    for (int i = 0; i < neffect + nsuspect + job->measurement.ncorrection; i++) {
        const struct effect *effect = i < neffect              ? &job->rotor.effect[i]
                                      : i < neffect + nsuspect ? &job->unknowns.suspect[i - neffect].effect
                                                               : NULL;
        const struct correction *correction = effect ? NULL : &job->measurement.correction[i - neffect - nsuspect];
        text_column(table, "cause", SHOW_TEXT, effect ? effect->name : correction->name);
        text_column(table, "role", SHOW_TEXT, correction ? "taken out of the data" : i < neffect ? "in the model" : "suspected");
        text_column(table, "what", SHOW_TEXT,
                    effect ? effect_text(pool, &job->rotor, effect) : correction_text(pool, correction));
    }
    return table;
}

static struct table *table_of_groups(struct pool *pool, const rotid_geometry *geometry, const struct rotor *rotor)
{
    struct table *table = table_open(pool, "");
    for (int g = 0; g < geometry->ngroups; g++) {
        const rotid_group *group = &geometry->groups[g];
        const rotid_material *material = &group->material;
        text_column(table, "group", SHOW_TEXT, group->name);
        number_column(table, "from", "m", SHOW_FIXED(6), group->from_m);
        number_column(table, "to", "m", SHOW_FIXED(6), group->to_m);
        scaled_column(table, "E", "Pa", SHOW_DIGITS(5), 1e9, material->e_pa);
        scaled_column(table, "G", "Pa", SHOW_DIGITS(5), 1e9, material->g_pa);
        number_column(table, "nu", NULL, SHOW_FIXED(3), material->nu);
        number_column(table, "rho", "kg/m3", SHOW_FIXED(2), material->rho_kg_m3);
        number_column(table, "mass", "kg", SHOW_DIGITS(5), rotor_group_mass(rotor, g));
        text_column(table, "on", SHOW_TEXT, group->layer_of);
    }
    return table;
}

static void print_length(FILE *out, const char *what, double value, const char *more)
{
    const struct human_unit unit = human_unit(value, "m");
    (void)fprintf(out, "%-16s%12.*f %s%s\n", what, unit.factor > 1 ? 3 : 6, value * unit.factor, unit.text, more);
}

#define REST_HZ 0.01 /* below, a motion is that of a free rotor and its rounding */

static int is_free(int count, const double *hz)
{
    int free = count > 0;
    for (int i = 0; i < count; i++)
        free &= hz[i] < REST_HZ;
    return free;
}

void screen_check(const struct screen *to, const struct result *result)
{
    const struct job *job = result->job;
    const rotid_check *check = result->check;
    FILE *out = to->out;
    print_length(out, "length", check->length_m, "");
    (void)fprintf(out, "mass            %12.4f kg\n", check->mass_kg);
    print_length(out, "centre of mass", check->center_of_mass_m, " from the left end");
    (void)fprintf(out, "inertia         %12.4f kg.m2 about a diameter there\n", check->inertia_kg_m2);
    (void)fprintf(out, "mesh            %12d nodes, %d elements", check->nodes, check->elements);
    if (job->mesh_error > 0)
        (void)fprintf(out, ", chosen for an error of %.2g %%", 100 * job->mesh_error);
    (void)fputc('\n', out);
    if (check->solid) {
        (void)fprintf(out, "solid           %12d unknowns, half band %d, %d slices\n", check->solid->unknowns,
                      check->solid->half_band, check->solid->slices);
        if (isfinite(check->solid->corner_m))
            print_length(out, "corner element", check->solid->corner_m, ", where the diameter steps");
        print_length(out, "largest element", check->solid->largest_m, "");
    }
    (void)fprintf(out, "sensors         %12d\n", check->nsensors);
    (void)fprintf(out, "measured modes  %12d\n", check->measured_modes);
    (void)fprintf(out, "rigid-body modes%12d", check->rigid_modes);
    const struct human_unit hz = human_unit(1, "Hz");
    int free = is_free(check->nrigid_hz, check->rigid_hz);
    for (int i = 0; i < check->nrigid_hz && !free; i++)
        (void)fprintf(out, "%s%.*f", i ? ", " : " (modes on the supports at ", hz.factor < 1 ? 6 : 3,
                      check->rigid_hz[i] * hz.factor);
    (void)fprintf(out, free ? " (the rotor is free)\n" : check->nrigid_hz ? " %s)\n" : "\n", hz.text);
    if (job->measurement.numbering.nsupport)
        (void)fprintf(out, "modes counted   %12s, from the lowest %s%s\n", job->rotor.count_all ? "ALL" : "ELASTIC",
                      job->rotor.count_all ? "vibration on the supports" : "mode that bends the rotor",
                      job->measurement.numbering.stated ? "" : ", as the measured ones fit best");
    (void)fprintf(out, "fit             %12s, reduction %s, %d %s\n", check->functional, check->reduction, check->nparameters,
                  human_plural(check->nparameters, "parameter", "parameters"));
    screen_table(to, table_of_groups(to->pool, check->geometry, &job->rotor));
    screen_table(to, table_of_causes(to->pool, job));
    screen_table(to, table_of_weighed(to->pool, check->nweighed, check->weighed));
    const char *steps = doubt_steps(to->pool, job);
    if (steps)
        screen_say(to, "%s", steps);
}

/* ---- modes */

struct table *table_of_model_modes(struct pool *pool, const rotid_spectrum *spectrum)
{
    const int bends = !spectrum->type || same_text(spectrum->type, "BENDING"); /* older results have no type */
    struct table *table = table_open(pool, bends ? "Modes of the full and of the condensed model"
                                                 : pool_text(pool, "Modes of the full and of the condensed model: %s",
                                                             same_text(spectrum->type, "AXIAL") ? "axial" : "torsion"));
    for (int j = 0; j < spectrum->nmodes; j++) {
        const rotid_model_mode *mode = &spectrum->modes[j];
        const rotid_compared_mode *measured = mode->measured;
        number_column(table, "mode", NULL, SHOW_COUNT, mode->mode);
        number_column(table, "frequency", "Hz", SHOW_FIXED(4), mode->full_hz);
        number_column(table, "condensed", "Hz", SHOW_FIXED(4), mode->reduced_hz);
        number_column(table, "reduction", "%", SHOW_SIGNED(3), mode->reduction_error_percent);
        number_column(table, "mesh", "%", SHOW_SIGNED(4), mode->mesh_error_percent);
        number_column(table, "measured", "Hz", SHOW_FIXED(4), measured ? measured->measured_hz : (double)NAN);
        number_column(table, "error", "%", SHOW_SIGNED(3), measured ? measured->error_percent : (double)NAN);
        number_column(table, "nco", NULL, SHOW_FIXED(3), measured ? measured->nco : (double)NAN);
        number_column(table, "mac", NULL, SHOW_FIXED(3) | NOT_IN_CSV, measured ? measured->mac : (double)NAN);
    }
    return table;
}

static struct table *table_of_beside_modes(struct pool *pool, const rotid_beam_beside_solid *beside)
{
    struct table *table =
        table_open(pool, "Modes of the rotor as a beam and as a solid: the difference is beam over solid, less one");
    for (int k = 0; k < beside->nmodes; k++) {
        const rotid_beside_mode *mode = &beside->modes[k];
        number_column(table, "mode", NULL, SHOW_COUNT, mode->mode);
        number_column(table, "solid", "Hz", SHOW_FIXED(4), mode->solid_hz);
        number_column(table, "beam", "Hz", SHOW_FIXED(4), mode->beam_hz);
        number_column(table, "difference", "%", SHOW_SIGNED(2), mode->difference_percent);
        number_column(table, "nco", NULL, SHOW_FIXED(4), mode->nco);
        number_column(table, "mac", NULL, SHOW_FIXED(4), mode->mac);
        number_column(table, "mesh of solid", "%", SHOW_SIGNED(4), mode->solid_mesh_error_percent);
        number_column(table, "mesh of beam", "%", SHOW_SIGNED(4), mode->beam_mesh_error_percent);
        text_column(table, "remark", SHOW_TEXT,
                    mode->beam_mode == mode->mode ? "" : pool_text(pool, "mode %d of the beam", mode->beam_mode));
    }
    return table;
}

static struct table *table_of_beside_moduli(struct pool *pool, const rotid_beam_beside_solid *beside)
{
    struct table *table = table_open(pool, "Moduli of the beam whose frequencies are nearest to those of the solid");
    for (int p = 0; p < beside->nmoduli; p++) {
        const rotid_beside_modulus *modulus = &beside->moduli[p];
        text_column(table, "modulus", SHOW_TEXT, modulus->name);
        scaled_column(table, "solid", "Pa", SHOW_DIGITS(5), 1e9, modulus->stated_pa);
        scaled_column(table, "fitted beam", "Pa", SHOW_DIGITS(5), 1e9, modulus->found_pa);
        number_column(table, "change", "%", SHOW_SIGNED(1), modulus->change_percent);
    }
    return table;
}

/* Without sensors (rotor NULL, or without) the nodes of the axis are numbered from 1. */
struct table *table_of_shapes(struct pool *pool, const struct rotor *rotor, const rotid_spectrum *s)
{
    struct table *table = table_open(pool, "");
    for (int i = 0; i < s->nsensor_z_m; i++) {
        number_column(table, "sensor", NULL, SHOW_COUNT, rotor && rotor->nsensor == s->nsensor_z_m ? rotor->sensor[i].id : i + 1);
        number_column(table, "position", "m", SHOW_FIXED(5), s->sensor_z_m[i]);
        for (int j = 0; j < s->nmodes; j++)
            number_column(table, i ? "" : pool_text(pool, "mode %d", s->modes[j].mode), NULL, SHOW_FIXED(5),
                          s->modes[j].nshape > i ? s->modes[j].shape[i] : (double)NAN);
    }
    return table;
}

struct shown shown_of_modes(struct pool *pool, const rotid_spectrum *s)
{
    struct shown shown = {.said.pool = pool, .table = {table_of_model_modes(pool, s)}};
    const char *hz = "";
    for (int i = 0; i < s->nrigid_hz; i++)
        hz = pool_text(pool, "%s%s%s", hz, i ? ", " : "", human_value(pool, s->rigid_hz[i], "Hz"));
    if (is_free(s->nrigid_hz, s->rigid_hz))
        reasons_say(&shown.said, "rigid-body modes: %d (the rotor is free)", s->nrigid_hz);
    else if (s->nrigid_hz)
        reasons_say(&shown.said, "rotor on its supports: %s", hz);
    if (s->beside) {
        shown.table[1] = table_of_beside_modes(pool, s->beside);
        shown.table[2] = table_of_beside_moduli(pool, s->beside);
        if (s->beside->sentence)
            reasons_say(&shown.said, "The beam beside the solid: %s.", s->beside->sentence);
    }
    return shown;
}

void screen_modes(const struct screen *to, const struct result *result)
{
    const struct shown shown = shown_of_modes(to->pool, result->modes);
    screen_shown(to, &shown);
    if (to->verbose)
        screen_table(to, table_of_shapes(to->pool, NULL, result->modes));
}

/* ---- sensitivity */

const char *sensitivity_in_words(struct pool *pool, const struct sensitivity *s)
{
    const char *at = "";
    for (int p = 0; p < s->nparameters; p++)
        at = pool_text(pool, "%s%s%s = %s", at, p ? ", " : "", s->parameters[p].name,
                       human_value(pool, s->parameters[p].reference, s->parameters[p].unit));
    return pool_text(pool, "At %s, reduction %s.", at, s->reduction);
}

struct table *table_of_sensitivity(struct pool *pool, const struct sensitivity *s)
{
    struct table *table = table_open(pool, "Change of a frequency for a change of a parameter, per cent for a per cent");
    for (int k = 0; k < s->nfrequency_hz; k++) {
        number_column(table, "mode", NULL, SHOW_COUNT, k + 1);
        number_column(table, "frequency", "Hz", SHOW_FIXED(4), s->frequency_hz[k]);
        for (int p = 0; p < s->nparameters; p++) /* older results have no changes of frequencies */
            number_column(table, s->parameters[p].name, NULL, SHOW_SIGNED(4),
                          s->parameters[p].frequency_change ? s->parameters[p].frequency_change[k] : (double)NAN);
    }
    return table;
}

static struct table *table_of_quotients(struct pool *pool, const struct result_head *head, const struct sensitivity *s,
                                        const struct sensitivity_parameter *one)
{
    const char *quantity = pool_text(pool, "sensitivity %s", one->name);
    const rotid_reference *paper = head_reference(head, quantity);
    struct table *table = table_open(pool, pool_text(pool,
                                                     "%s: E_k = 1 - R*_k/w_k^2 of the paper for each relative change, by "
                                                     "steps of %g %% and their limit",
                                                     one->name, 100 * s->step));
    for (int k = 0; k < s->nfrequency_hz; k++) {
        number_column(table, "mode", NULL, SHOW_COUNT, k + 1);
        number_column(table, "frequency", "Hz", SHOW_FIXED(4), s->frequency_hz[k]);
        number_column(table, "step", NULL, SHOW_DIGITS(5), one->sensitivity[k]);
        number_column(table, "limit", NULL, SHOW_DIGITS(5), one->derivative[k]);
        number_column(table, "paper (magnitude)", NULL, SHOW_DIGITS(4), reference_value(paper, k));
    }
    return table;
}

static struct table *table_of_curves(struct pool *pool, const struct sensitivity *s, const struct sensitivity_parameter *one)
{
    struct table *table =
        table_open(pool, pool_text(pool, "%s: E_k^2/2 over the relative value (Figure 5 of the paper)", one->name));
    for (int i = 0; i < s->nrelative_value; i++) {
        number_column(table, "value", NULL, SHOW_FIXED(3), s->relative_value[i]);
        for (int k = 0; k < s->nfrequency_hz; k++)
            number_column(table, i ? "" : pool_text(pool, "mode %d", k + 1), NULL, SHOW_DIGITS(3),
                          one->curves[k + (ptrdiff_t)s->nfrequency_hz * i]);
    }
    return table;
}

void screen_sensitivity(const struct screen *to, const struct result *result)
{
    const struct sensitivity *s = result->sensitivity;
    struct pool *pool = to->pool;
    screen_paragraph(to, "", sensitivity_in_words(pool, s));
    screen_table(to, table_of_sensitivity(pool, s));
    for (int p = 0; p < s->nparameters; p++) {
        screen_table(to, table_of_quotients(pool, &result->head, s, &s->parameters[p]));
        screen_table(to, table_of_curves(pool, s, &s->parameters[p]));
    }
}
