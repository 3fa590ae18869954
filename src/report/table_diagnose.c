#include "report/report.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/base.h"
#include "fit/fit.h"
#include "result/result.h"

/* A bar of 2 half + 1 columns around '|' that reaches the end at +-scale; '>' or '<' at the end beyond that. */
static void chart_bar(FILE *out, int half, double scale, double value)
{
    double size = isfinite(value) && scale > 0 ? fabs(value) / scale * half : 0;
    int beyond = size > half + 0.5, length = beyond ? half : (int)(size + 0.5);
    for (int c = -half; c <= half; c++) {
        int inside = value < 0 ? c < 0 && c >= -length : c > 0 && c <= length;
        int end = beyond && c == (value < 0 ? -half : half);
        (void)fputc(c == 0 ? '|' : end ? (value < 0 ? '<' : '>') : inside ? '=' : ' ', out);
    }
}

void strip_open(struct strip *strip, double length, int columns)
{
    strip->length = length > 0 ? length : 1;
    strip->columns = columns < 10 ? 10 : columns > STRIP_MOST ? STRIP_MOST : columns;
    memset(strip->line, ' ', (size_t)strip->columns);
    strip->line[strip->columns] = 0;
}

static int column_of(const struct strip *strip, double z)
{
    double column = z / strip->length * (strip->columns - 1) + 0.5;
    return column >= strip->columns - 1 ? strip->columns - 1 : column >= 0 ? (int)column : 0; /* NaN: 0 */
}

/* One digit a column, the largest value there rounded to the nearest; '+' from 9.5; values that are not finite leave no trace. */
static void strip_digits(struct strip *strip, int count, const double *z, const double *value)
{
    for (int i = 0; i < count; i++) {
        if (!isfinite(value[i]) || !isfinite(z[i]))
            continue;
        char *cell = &strip->line[column_of(strip, z[i])];
        char now = value[i] >= 9.5 ? '+' : (char)('0' + (int)(fmax(value[i], 0) + 0.5));
        if (*cell == ' ' || (*cell != '+' && (now == '+' || now > *cell)))
            *cell = now;
    }
}

/* Straight lines between the points, 0 outside them. */
static double interpolate(int count, const rotid_localisation *point, double at)
{
    for (const rotid_localisation *b = point + 1; b < point + count; b++) {
        const rotid_localisation *a = b - 1;
        if (a->z_m <= at && at <= b->z_m)
            return b->z_m > a->z_m ? a->indicator + (b->indicator - a->indicator) * (at - a->z_m) / (b->z_m - a->z_m)
                                   : fmax(a->indicator, b->indicator);
    }
    return 0;
}

/* From 0 (' ') to 1 ('@'), between the points [count] with increasing z by straight lines. */
static void strip_density(struct strip *strip, int count, const rotid_localisation *point)
{
    static const char scale[] = " .:-=+*#%@";
    for (int c = 0; c < strip->columns; c++) {
        double largest = interpolate(count, point, strip->length * c / (strip->columns - 1));
        for (int i = 0; i < count; i++)
            if (column_of(strip, point[i].z_m) == c) /* no peak falls between two columns */
                largest = fmax(largest, point[i].indicator);
        double level = 10 * largest;
        strip->line[c] = level >= 9 ? scale[9] : level > 0 ? scale[(int)level] : ' ';
    }
}

#define LETTER '\1' /* in a column whose character has several bytes, or none that is shown */

/* Writes over blanks only, as far as the strip reaches; a character a column. */
static void write_at(struct strip *strip, int column, const char *text, int most)
{
    for (size_t bytes; most > 0 && *text && column < strip->columns; most--, column++, text += bytes) {
        bytes = text_utf8(text) ? text_utf8(text) : 1;
        if (column < 0 || strip->line[column] != ' ')
            continue;
        strip->line[column] = (char)(bytes == 1 && text_visible(text) ? *text : LETTER);
        strip->letter[column] = text;
    }
}

/* "^", or "^---^" where it spans more than a column, with a label behind or before it. */
static void strip_mark(struct strip *strip, double from, double to, const char *label)
{
    int first = column_of(strip, from), last = column_of(strip, to), columns = text_columns(label);
    for (int c = first; c <= last; c++)
        strip->line[c] = c == first || c == last ? '^' : '-';
    if (last + 2 + columns <= strip->columns || first < columns + 1)
        write_at(strip, last + 2, label, columns);
    else
        write_at(strip, first - 1 - columns, label, columns);
}

void strip_name(struct strip *strip, double from, double to, const char *name)
{
    int first = column_of(strip, from), room = column_of(strip, to) - first - 1;
    strip->line[first] = '|';
    write_at(strip, first + 1, name, room);
}

/* Round numbers of z. */
static void strip_ticks(struct strip *strip)
{
    double step = pow(10, floor(log10(strip->length))), most = strip->columns / 9.0;
    while (strip->length / step < most / 2)
        step /= 2; /* 1, 0.5, 0.25, 0.125: round enough for a position */
    char text[32];
    for (int i = 0; i * step <= strip->length * (1 + 1e-9); i++) {
        int bytes = snprintf(text, sizeof text, "%.4g", i * step), column = column_of(strip, i * step);
        if (column + bytes > strip->columns)
            column = strip->columns - bytes;
        write_at(strip, column, text, bytes);
    }
}

void strip_print(const struct strip *strip, FILE *out, int width, const char *label)
{
    int last = strip->columns;
    while (last > 0 && strip->line[last - 1] == ' ')
        last--;
    text_cell(out, width, label);
    for (int c = 0; c < last; c++)
        if (strip->line[c] == LETTER)
            text_character(out, strip->letter[c]);
        else
            (void)fputc(strip->line[c], out);
    (void)fputc('\n', out);
}

#define LABEL    14 /* columns before a strip */
#define BAR_HALF 14
#define MARKS    4 /* causes that are drawn */

static double standardised(const rotid_diagnosis *d, int k)
{
    return k < d->nmodes_standardised ? d->modes_standardised[k] : NAN;
}

/* The state whose modes begin with mode k of all, NULL where none does. */
static const char *state_at(const rotid_identification *fit, int k)
{
    for (int s = 0; s < fit->nstates; k -= fit->states[s++].nmodes)
        if (!k)
            return fit->states[s].name;
    return NULL;
}

static void print_modes(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    double scale = 3; /* noise alone fills no more than the bar */
    for (int k = 0; k < d->base->nmodes; k++)
        if (isfinite(standardised(d, k)))
            scale = fmax(scale, ceil(fabs(standardised(d, k))));
    (void)fprintf(view->out, "  mode  measured [Hz]  predicted  error [%%]  res./sigma  %-+*.0f0%+*.0f    NCO\n", BAR_HALF,
                  -scale, BAR_HALF, scale);
    for (int k = 0; k < d->base->nmodes; k++) {
        const rotid_compared_mode *mode = &d->base->modes[k];
        if (state_at(d->base, k))
            (void)fprintf(view->out, "  state %s\n", state_at(d->base, k));
        (void)fprintf(view->out, "  %4d", mode->mode);
        digits_cell(view->out, 15, 6, mode->measured_hz);
        digits_cell(view->out, 11, 6, mode->predicted_hz);
        signed_cell(view->out, 11, 3, mode->error_percent);
        signed_cell(view->out, 12, 1, standardised(d, k));
        (void)fputs("  ", view->out);
        chart_bar(view->out, BAR_HALF, scale, standardised(d, k));
        number_cell(view->out, 7, 3, mode->nco);
        (void)fprintf(view->out, "%s\n", mode->holdout ? "  held out" : "");
    }
}

static int same_state(const rotid_sensor_residual *a, const rotid_sensor_residual *b)
{
    return a->state == b->state || (a->state && b->state && !strcmp(a->state, b->state));
}

/* A line for each state. */
static int print_sensors(const struct diagnosis_view *view, int columns)
{
    const rotid_diagnosis *d = view->diagnosis;
    int any = 0;
    for (int s = 0, end; s < d->nsensors; s = end) {
        struct strip strip;
        char label[LABEL + 1];
        int measured = 0;
        strip_open(&strip, d->geometry->length_m, columns);
        for (end = s; end < d->nsensors && same_state(&d->sensors[s], &d->sensors[end]); end++) {
            strip_digits(&strip, 1, &d->sensors[end].z_m, &d->sensors[end].rms);
            measured |= isfinite(d->sensors[end].rms);
        }
        (void)snprintf(label, sizeof label, "  %.11s", d->sensors[s].state ? d->sensors[s].state : "sensors");
        if (measured)
            strip_print(&strip, view->out, LABEL, label);
        any |= measured;
    }
    return any;
}

/* The most of mere noise is no place to look at. */
static int print_localisation(const struct diagnosis_view *view, int columns)
{
    const rotid_diagnosis *d = view->diagnosis;
    struct strip strip;
    if (!d->nlocalisation || !(view->verbose || !d->verdict.sentence || d->verdict.kind != ROTID_ADEQUATE))
        return 0;
    strip_open(&strip, d->geometry->length_m, columns);
    strip_density(&strip, d->nlocalisation, d->localisation);
    strip_print(&strip, view->out, LABEL, "  force resid.");
    return 1;
}

static void print_axis(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    const rotid_verdict *v = &d->verdict;
    const rotid_geometry *geometry = d->geometry;
    const rotid_cause *mark = v->ncauses ? v->causes : v->alternative_causes;
    int columns = view->width - LABEL, nmark = v->ncauses ? v->ncauses : v->nalternative_causes;
    struct strip strip;
    struct cause_place place;
    (void)fputs("\n", view->out);
    int sensors = print_sensors(view, columns), local = print_localisation(view, columns);
    strip_open(&strip, geometry->length_m, columns);
    for (int g = 0; g < geometry->ngroups; g++)
        if (!geometry->groups[g].layer_of)
            strip_name(&strip, geometry->groups[g].from_m, geometry->groups[g].to_m, geometry->groups[g].name);
    strip_print(&strip, view->out, LABEL, "  group");
    for (int i = 0; i < nmark && i < MARKS; i++) {
        if (!cause_place(geometry, &mark[i], &place))
            continue;
        strip_open(&strip, geometry->length_m, columns);
        strip_mark(&strip, place.from, place.to, mark[i].id);
        strip_print(&strip, view->out, LABEL, v->ncauses ? "  cause" : "  possible");
    }
    strip_open(&strip, geometry->length_m, columns);
    strip_ticks(&strip);
    strip_print(&strip, view->out, LABEL, "  z [m]");
    if (!sensors && !local)
        return;
    struct wrap wrap;
    wrap_open(&wrap, view->out, 4, view->width, "  ");
    if (sensors)
        wrap_words(&wrap, "sensors: rms of residual/sigma, 1 is noise alone;");
    if (local)
        wrap_words(&wrap, "force residual: force that the model lacks, most at @");
    wrap_close(&wrap);
}

static void table_misfit(const struct diagnosis_view *view)
{
    const rotid_identification *base = view->diagnosis->base;
    if (!base)
        return;
    if (view->diagnosis->before)
        (void)fprintf(view->out, "\nWHAT CHANGED  %s beside the model that fits %s, less what that misses there",
                      view->diagnosis->after, view->diagnosis->before);
    else
        (void)fprintf(view->out, "\nWHAT IS WRONG  full model, likelihood");
    if (isfinite(base->chi2))
        (void)fprintf(view->out, ", chi2 %.4g with %d degrees of freedom", base->chi2, base->dof);
    (void)fprintf(view->out, "%s\n",
                  !base->nparameters                       ? "; nothing to identify"
                  : !strcmp(base->status, "not_converged") ? "; NOT CONVERGED"
                                                           : "");
    print_modes(view);
    print_axis(view);
}

#define SET_SHOWN 5 /* candidates of the set, unless verbose */
#define SHOWN     4 /* of the others */

static void print_values(struct wrap *wrap, const rotid_cause *cause)
{
    for (int p = 0; p < cause->nparameters; p++) {
        const rotid_cause_value *value = &cause->parameters[p];
        wrap_item(wrap, "%s%s %s%s%s%s", p ? ", " : "", value->name, IN_DIGITS(4, value->value), layout_gap(value->unit),
                  layout_unit(value->unit), value->fixed ? " fixed" : "");
        if (!value->fixed && isfinite(value->ci95[0]) && isfinite(value->ci95[1]))
            wrap_item(wrap, "(%.3g ... %.3g)", value->ci95[0], value->ci95[1]);
    }
}

static void print_candidate(const struct diagnosis_view *view, const rotid_round *round, const rotid_candidate *c, int in_set)
{
    struct wrap wrap;
    (void)fprintf(view->out, "  %c ", in_set ? '*' : ' ');
    text_cell(view->out, 19, c->suspect ? c->cause.name : c->cause.id);
    (void)fputc(' ', view->out);
    text_cell(view->out, 12, c->cause.target);
    digits_cell(view->out, 9, 4, c->predicted_drop);
    digits_cell(view->out, 8, 4, c->chi2_drop);
    digits_cell(view->out, 8, 5, c->bic);
    chance_cell(view->out, 8, c->p_value);
    digits_cell(view->out, 8, 3, c->mode_out_rms);
    digits_cell(view->out, 9, 3, c->sensor_out_rms);
    digits_cell(view->out, 9, 3, c->holdout_rms);
    (void)fputc('\n', view->out);
    wrap_open(&wrap, view->out, 8, view->width, "      ");
    if (in_set)
        wrap_item(&wrap, "%s%s", round->kind == ROTID_NAMED ? "NAMED" : "POSSIBLE", c->cause.nparameters ? ":" : "");
    if (c->cause.state)
        wrap_item(&wrap, "in state %s%s", c->cause.state, c->cause.nparameters ? "," : "");
    print_values(&wrap, &c->cause);
    if (c->with) {
        wrap_item(&wrap, "%swith %s%s%s%s", c->cause.nparameters ? "; " : "", c->with->id, *c->with->target ? " of " : "",
                  c->with->target, c->with->nparameters ? ":" : "");
        print_values(&wrap, c->with);
    }
    if (c->at_bound)
        wrap_item(&wrap, "AT A BOUND");
    if (c->suspect)
        wrap_item(&wrap, "[your suspicion, a %s]", c->cause.id);
    if (c->collinear_with && isfinite(c->cosine))
        wrap_item(&wrap, "; similar to %s%s%s (%.2f)", c->collinear_with, c->collinear_target && *c->collinear_target ? " " : "",
                  c->collinear_target ? c->collinear_target : "", c->cosine);
    if (c->rejected_because) {
        wrap_item(&wrap, "; rejected:");
        wrap_words(&wrap, c->rejected_because);
    } else if (!c->refitted) {
        wrap_item(&wrap, "; not refitted");
    }
    wrap_close(&wrap);
}

static void print_chance(struct wrap *wrap, const char *what, double chance)
{
    if (isfinite(chance))
        wrap_item(wrap, chance < 0.001 ? "%s <0.001" : "%s %.3f", what, chance);
}

static void print_columns(FILE *out)
{
    (void)fputs("    cause               target       expected    chi2     BIC p-value   held-out prediction error\n"
                "    size and place, 95 % interval        drop    drop                  modes  sensors held out\n",
                out);
}

static void print_round(const struct diagnosis_view *view, int number)
{
    const rotid_diagnosis *d = view->diagnosis;
    const rotid_round *round = &d->rounds[number];
    struct wrap wrap;
    int hidden = 0, shown = 0, any = 0, place = 0; /* place: among the candidates of the round */
    wrap_open(&wrap, view->out, 4, view->width, "  ");
    wrap_item(&wrap, "round %d, %s:", round->round, rotid_verdict_name(round->kind));
    if (isfinite(round->chi2))
        wrap_item(&wrap, "chi2 %.4g of %d degrees of freedom", round->chi2, round->dof);
    if (isfinite(round->largest) && isfinite(round->threshold))
        wrap_item(&wrap, "; expected drop %.3g (noise: %.3g)", round->largest, round->threshold);
    print_chance(&wrap, "; p-value of that drop", round->p_scan);
    print_chance(&wrap, ", of the frequencies", round->p_frequency);
    print_chance(&wrap, ", of chi2", round->p_total);
    wrap_close(&wrap);
    for (int i = 0; i < d->ncandidates; i++) {
        const rotid_candidate *c = &d->candidates[i];
        if (c->round != round->round)
            continue;
        int in_set = place++ < round->set;
        if (!c->suspect && !view->verbose && (in_set ? place > SET_SHOWN : !c->refitted || shown >= SHOWN)) {
            hidden++;
            continue;
        }
        if (!any++)
            print_columns(view->out);
        shown += !in_set;
        print_candidate(view, round, c, in_set);
    }
    if (hidden)
        (void)fprintf(view->out, "    %d more with --verbose\n", hidden);
    if (isfinite(round->required_margin) && round->set > 1)
        (void)fprintf(view->out, "    a cause is named alone where its chi2 drop leads every other by %.3g\n",
                      round->required_margin);
}

static void table_evidence(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    if (d->nrounds)
        (void)fprintf(view->out,
                      "\nEVIDENCE  (noise: drop that chance alone reaches in 3 %% of tests; modes in %%, sensors res./sigma)\n");
    for (int i = 0; i < d->nrounds; i++)
        print_round(view, i);
}

/* The parameters that a diagnosis leaves, at the top: with their intervals, of an ambiguous one by each cause that cannot be told
 * apart, and by how much a cause that these data do not show may have moved them. */

#define NAME   18
#define LISTED 6 /* causes of a set; --verbose has all */

static rotid_fitted_parameter of_cause(const rotid_cause_value *value)
{
    return (rotid_fitted_parameter){.value = value->value,
                                    .unit = value->unit,
                                    .ci95 = {value->ci95[0], value->ci95[1]},
                                    .at_bound = !isfinite(value->ci95[0]),
                                    .identifiable = 1};
}

/* "stiffness_gradient of right", a pair with its second cause. */
static void cause_items(struct wrap *wrap, const rotid_verdict *v, int first)
{
    for (int i = first; i < v->nalternative_causes && (i == first || verdict_is_pair(v, i)); i++) {
        const rotid_cause *cause = &v->alternative_causes[i];
        wrap_item(wrap, "%s%s%s%s%s%s", i > first ? "with " : "", cause->name && cause->variant ? cause->name : cause->id,
                  *cause->target ? " of " : "", cause->target, cause->state ? " in state " : "",
                  cause->state ? cause->state : "");
    }
}

/* Parameter p by each of the causes, then its spread. */
static void print_by_cause(const struct diagnosis_view *view, int p)
{
    const rotid_verdict *v = &view->diagnosis->verdict;
    const rotid_spread *spread = &v->spread[p];
    char text[PARAMETER_TEXT], figure[32];
    int shown = 0, left = 0;
    for (int i = 0; i < v->nalternative_causes; i++) {
        const rotid_cause *cause = &v->alternative_causes[i];
        if (verdict_is_pair(v, i) || p >= cause->nidentified)
            continue;
        if (shown == LISTED && !view->verbose) {
            left++;
            continue;
        }
        rotid_fitted_parameter value = of_cause(&cause->identified[p]);
        struct wrap wrap;
        shown++;
        wrap_open(&wrap, view->out, 6, view->width, "    ");
        wrap_item(&wrap, "%s if it is", parameter_text(&value, text));
        cause_items(&wrap, v, i);
        wrap_close(&wrap);
    }
    if (left)
        (void)fprintf(view->out, "    %d more with --verbose\n", left);
    if (shown + left > 1)
        (void)fprintf(view->out, "    these causes leave %.4g to %.4g%s%s, %s apart; their intervals %s to %s\n", spread->lowest,
                      spread->highest, layout_gap(spread->unit), layout_unit(spread->unit),
                      percent_text(200 * (spread->highest - spread->lowest) / fabs(spread->highest + spread->lowest), figure),
                      IN_DIGITS(4, spread->ci95[0]), IN_DIGITS(4, spread->ci95[1]));
}

/* What may hide in it: the causes that move it most. */
static void print_hidden(const struct diagnosis_view *view, const rotid_fitted_parameter *p)
{
    const rotid_diagnosis *d = view->diagnosis;
    struct wrap wrap;
    char figure[32];
    int shown = 0;
    for (int i = 0; i < d->nhidden; i++) {
        const rotid_hidden *hidden = &d->hidden[i];
        if (strcmp(hidden->parameter, p->name) != 0)
            continue;
        if (!shown)
            wrap_open(&wrap, view->out, 6, view->width, "    unseen: ");
        wrap_item(&wrap, "%s%s by", shown++ ? "; " : "", linear_percent_text(100 * fabs(hidden->shift / p->value), figure));
        wrap_item(&wrap, "%s%s%s", hidden->id, *hidden->target ? " of " : "", hidden->target);
        if (isfinite(hidden->z_m))
            wrap_item(&wrap, "at z %.3g m", hidden->z_m);
        if (strcmp(hidden->component, "presence") != 0)
            wrap_item(&wrap, "(%s %.2g%s%s)", hidden->component, fabs(hidden->size), layout_gap(hidden->size_unit),
                      layout_unit(hidden->size_unit));
    }
    if (shown)
        wrap_close(&wrap);
}

static void table_parameters(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    const rotid_verdict *v = &d->verdict;
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    int unseen = d->nhidden && (v->kind == ROTID_ADEQUATE || v->adequate_after); /* else what is left is seen */
    char text[PARAMETER_TEXT];
    if (!v->sentence || !fit || !d->base || !d->base->nparameters)
        return;
    (void)fprintf(view->out, "\nPARAMETERS  %s, 95 %% intervals%s\n", d->extended ? "extended model" : "model of the deck",
                  unseen ? "; unseen: shift by a cause below its detection limit" : "");
    for (int p = 0; p < d->base->nparameters; p++) {
        const rotid_fitted_parameter *value = fit_parameter(fit, d->base->parameters[p].name);
        (void)fputs("  ", view->out);
        text_cell(view->out, NAME, d->base->parameters[p].name);
        (void)fprintf(view->out, " %s\n", parameter_text(value, text));
        if (p < v->nspread)
            print_by_cause(view, p);
        if (value && unseen)
            print_hidden(view, value);
    }
}

static void print_heading(const struct diagnosis_view *view)
{
    const struct result_head *head = view->head;
    for (int i = 0; i < head->nheading; i++)
        wrap_text(view->out, 0, view->width, "", head->heading[i]);
    if (!head->nheading)
        wrap_text(view->out, 0, view->width, "", head->deck);
}

static void print_verdict(const struct diagnosis_view *view)
{
    const rotid_verdict *v = &view->diagnosis->verdict;
    const rotid_noise *noise = &view->diagnosis->noise;
    struct wrap wrap;
    (void)fprintf(view->out, "\nVERDICT  ");
    for (const char *c = v->sentence ? rotid_verdict_name(v->kind) : "none"; *c; c++)
        (void)fputc(toupper((unsigned char)*c), view->out);
    (void)fputc('\n', view->out);
    if (view->diagnosis->interrupted)
        wrap_text(view->out, 2, view->width, "  ", "INTERRUPTED: the finished part stands below; the diagnosis is not complete.");
    if (v->sentence)
        wrap_text(view->out, 2, view->width, "  ", v->sentence);
    wrap_open(&wrap, view->out, 2, view->width, "  ");
    if (isfinite(v->p_value) && v->sentence) {
        wrap_words(&wrap, "p-value (hypothesis: adequate model):");
        wrap_item(&wrap, v->p_value < 0.001 ? "below %g" : "%.3g", v->p_value < 0.001 ? 0.001 : v->p_value);
        if (v->kind != ROTID_ADEQUATE)
            wrap_words(&wrap, !v->adequate_after           ? "; the residual still exceeds the noise"
                              : v->kind == ROTID_AMBIGUOUS ? "; with the best of these causes the model is adequate"
                                                           : "; the extended model is adequate");
        wrap_close(&wrap);
    } else {
        wrap_words(&wrap, v->sentence ? "no p-value can be stated" : "no verdict was reached");
        wrap_close(&wrap);
    }
    if (noise->frequency_assumed || noise->shape_assumed)
        wrap_text(view->out, 2, view->width, "  ",
                  "The deck states no noise for all of the data: the assumed values stand below, so statements are relative.");
    if (v->next_measurement)
        wrap_text(view->out, 10, view->width, "  to settle it: ", v->next_measurement);
}

static double value_of(const rotid_identification *fit, const char *name)
{
    const rotid_fitted_parameter *parameter = fit_parameter(fit, name);
    return parameter ? parameter->value : NAN;
}

/* Errors of its frequencies, and the share of the reduction in them. */
static void print_frequencies_today(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    const rotid_identification *fit = d->today;
    struct wrap wrap;
    int shown = 0, found = !strcmp(fit->reduction, "NONE"), worst = fit_worst_mode(fit);
    if (worst < 0)
        return;
    for (int i = 0; i < d->nnumerical_findings; i++) /* says it mode by mode */
        found |= !strcmp(d->numerical_findings[i].id, "guyan_reduction");
    wrap_open(&wrap, view->out, 4, view->width, "  ");
    wrap_item(&wrap, "frequencies that were fitted: error %.3g %% rms, %.3g %% at most", fit_rms_percent(fit, 0),
              fabs(fit->modes[worst].error_percent));
    for (int k = 0; k < fit->nmodes && !found; k++) {
        double error = fit->reduction_error_percent[k];
        if (isfinite(error))
            wrap_item(&wrap, "%smode %d %+.2f", shown++ ? "" : "; error of the reduction [%]: ", fit->modes[k].mode, error);
    }
    wrap_close(&wrap);
}

static void print_today(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    const rotid_identification *fit = d->today;
    if (!fit)
        return;
    int as_judged = !strcmp(fit->functional, "LIKELIHOOD") && !strcmp(fit->reduction, "NONE");
    (void)fprintf(view->out, "\nFIT AS SPECIFIED  %s, reduction %s: %s\n", fit->functional, fit->reduction,
                  as_judged ? "as it is judged below" : "what that choice alone costs");
    for (int i = 0; i < fit->nparameters; i++) {
        const rotid_fitted_parameter *p = &fit->parameters[i];
        struct wrap wrap;
        double base = 100 * (p->value / value_of(d->base, p->name) - 1),
               extended = 100 * (p->value / value_of(d->extended, p->name) - 1);
        wrap_open(&wrap, view->out, 4, view->width, "  ");
        wrap_item(&wrap, "%s %.4g%s%s", p->name, p->value, layout_gap(p->unit), layout_unit(p->unit));
        if (p->at_bound)
            wrap_item(&wrap, "AT ITS BOUND");
        if (isfinite(base))
            wrap_item(&wrap, ": %+.1f %% off the full model by the likelihood", base);
        if (isfinite(extended))
            wrap_item(&wrap, ", %+.1f %% off the extended one", extended);
        wrap_close(&wrap);
    }
    print_frequencies_today(view);
}

static void print_numerical(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    if (d->nnumerical_findings)
        (void)fprintf(view->out, "\nNUMBERS  errors of the numbers themselves; the model that is judged is free of them\n");
    for (int i = 0; i < d->nnumerical_findings; i++) {
        const rotid_numerical_finding *finding = &d->numerical_findings[i];
        struct wrap wrap;
        wrap_open(&wrap, view->out, 4, view->width, "  ");
        wrap_item(&wrap, "%s%s%s:", finding->id, finding->state ? " in state " : "", finding->state ? finding->state : "");
        if (finding->text)
            wrap_words(&wrap, finding->text);
        for (int k = 0, shown = 0; k < finding->nmodes; k++)
            if (isfinite(finding->error_percent[k]))
                wrap_item(&wrap, "%smode %d %+.3g", shown++ ? ", " : "; error [%]: ", finding->modes[k],
                          finding->error_percent[k]);
        wrap_close(&wrap);
    }
}

static void print_data(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    if (d->ndata_findings)
        (void)fprintf(view->out, "\nDATA  faults of the measurement, taken out before the physics is judged\n");
    for (int i = 0; i < d->ndata_findings; i++) {
        const rotid_data_finding *finding = &d->data_findings[i];
        struct wrap wrap;
        wrap_open(&wrap, view->out, 4, view->width, "  ");
        wrap_item(&wrap, "%s%s%s", finding->id, finding->state ? " in state " : "", finding->state ? finding->state : "");
        for (int n = 0; n < finding->nsensors; n++)
            wrap_item(&wrap, "%s%d", n ? "and " : "sensor ", finding->sensors[n]);
        for (int k = 0; k < finding->nmodes; k++)
            wrap_item(&wrap, "%s%d", k ? "and " : "mode ", finding->modes[k]);
        if (finding->block)
            wrap_item(&wrap, "%s", finding->block);
        if (isfinite(finding->value))
            wrap_item(&wrap, ": %.3g%s%s", finding->value, layout_gap(finding->unit), layout_unit(finding->unit));
        if (isfinite(finding->std))
            wrap_item(&wrap, "+- %.2g", finding->std);
        if (isfinite(finding->chi2_drop))
            wrap_item(&wrap, ", chi2 less by %.4g", finding->chi2_drop);
        if (finding->text) {
            wrap_item(&wrap, ";");
            wrap_words(&wrap, finding->text);
        }
        wrap_close(&wrap);
    }
}

static void print_noise(const struct diagnosis_view *view)
{
    static const char *const said[] = {"stated", "the deck states none: assumed"};
    const rotid_noise *noise = &view->diagnosis->noise;
    struct wrap wrap;
    int frequency = noise->frequency > 0, shape = noise->shape > 0; /* NaN: no */
    wrap_open(&wrap, view->out, 7, view->width, "noise  ");
    if (frequency)
        wrap_item(&wrap, "frequencies %.3g %% (%s)%s", 100 * noise->frequency, said[noise->frequency_assumed != 0],
                  shape ? "," : "");
    if (shape)
        wrap_item(&wrap, "shapes %.3g %% of the largest component (%s)", 100 * noise->shape, said[noise->shape_assumed != 0]);
    if (!frequency && !shape)
        wrap_item(&wrap, "unknown");
    wrap_close(&wrap);
}

static void print_foot(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    struct wrap wrap;
    double seconds = 0;
    (void)fputc('\n', view->out);
    print_noise(view);
    for (int i = 0; i < d->nsteps; i++)
        seconds += d->steps[i].seconds;
    (void)fprintf(view->out, "seed %.0f, %d thread%s", view->head->seed, view->head->threads,
                  view->head->threads == 1 ? "" : "s");
    if (d->nsteps)
        (void)fprintf(view->out, ", %.3g s", seconds);
    (void)fputc('\n', view->out);
    if (!view->verbose || !d->nsteps)
        return;
    wrap_open(&wrap, view->out, 7, view->width, "time   ");
    for (int i = 0; i < d->nsteps; i++)
        wrap_item(&wrap, "%s %.3g s%s", d->steps[i].name, d->steps[i].seconds, i + 1 < d->nsteps ? "," : "");
    wrap_close(&wrap);
}

void table_diagnose(const struct diagnosis_view *view)
{
    print_heading(view);
    print_verdict(view);
    table_parameters(view);
    print_today(view);
    print_numerical(view);
    print_data(view);
    table_misfit(view);
    table_evidence(view);
    table_gain(view);
    table_detection_limits(view);
    print_foot(view);
}
