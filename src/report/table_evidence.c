#include <math.h>
#include <string.h>

#include "diagnose/items.h"
#include "report/layout.h"
#include "report/table_diagnose.h"

#define SET_SHOWN 5 /* candidates of the set, unless verbose */
#define SHOWN     4 /* of the others */

static void print_values(struct wrap *wrap, const struct candidate *candidate)
{
    const struct effect_parameter_name *parameter;
    for (int p = 0; (parameter = candidate_parameter(candidate, p)); p++) {
        int pure = !parameter->unit || !strcmp(parameter->unit, "1");
        wrap_item(wrap, "%s%s %s%s%s%s", p ? ", " : "", parameter->name, NUMBER(4, candidate->effect.value[p]), pure ? "" : " ",
                  pure ? "" : parameter->unit, candidate->fixed[p] ? " fixed" : "");
        if (!candidate->fixed[p] && isfinite(candidate->ci_lower[p]) && isfinite(candidate->ci_upper[p]))
            wrap_item(wrap, "(%.3g ... %.3g)", candidate->ci_lower[p], candidate->ci_upper[p]);
    }
}

static void print_candidate(const struct diagnosis_view *view, const struct diagnosis_round *round, const struct candidate *c,
                            int in_set)
{
    struct wrap wrap;
    (void)fprintf(view->out, "  %c ", in_set ? '*' : ' ');
    text_cell(view->out, 19, c->suspect ? c->effect.name : c->cause->id);
    (void)fputc(' ', view->out);
    text_cell(view->out, 12, c->target ? c->target : "");
    digits_cell(view->out, 9, 4, c->predicted_drop);
    digits_cell(view->out, 8, 4, c->refitted ? c->chi2_drop : NAN);
    digits_cell(view->out, 8, 5, c->refitted ? c->bic : NAN);
    chance_cell(view->out, 8, c->p_value);
    digits_cell(view->out, 8, 3, c->refitted ? c->mode_out_rms : NAN);
    digits_cell(view->out, 9, 3, c->refitted ? c->sensor_out_rms : NAN);
    digits_cell(view->out, 9, 3, c->refitted ? c->holdout_rms : NAN);
    (void)fputc('\n', view->out);
    wrap_open(&wrap, view->out, 8, view->width, "      ");
    if (in_set)
        wrap_item(&wrap, "%s%s", round->kind == VERDICT_NAMED ? "NAMED" : "POSSIBLE", candidate_parameter(c, 0) ? ":" : "");
    print_values(&wrap, c);
    if (c->at_bound)
        wrap_item(&wrap, "AT A BOUND");
    if (c->suspect)
        wrap_item(&wrap, "[your suspicion, a %s]", c->cause->id);
    if (c->collinear_with && isfinite(c->cosine))
        wrap_item(&wrap, "; looks like %s%s%s (%.2f)", c->collinear_with, c->collinear_target && *c->collinear_target ? " " : "",
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
    (void)fputs("    cause               target       expected    chi2     BIC  chance   rms of what was left out\n"
                "    size and place, 95 % interval        drop    drop                  modes  sensors held out\n",
                out);
}

static void print_round(const struct diagnosis_view *view, int number)
{
    const struct diagnosis_round *round = &view->diagnosis->round[number];
    struct wrap wrap;
    int hidden = 0, shown = 0, any = 0;
    wrap_open(&wrap, view->out, 4, view->width, "  ");
    wrap_item(&wrap, "round %d, %s:", number + 1, verdict_name(round->kind));
    if (isfinite(round->chi2))
        wrap_item(&wrap, "chi2 %.4g of %d degrees of freedom", round->chi2, round->dof);
    if (isfinite(round->largest) && isfinite(round->threshold))
        wrap_item(&wrap, "; expected drop %.3g (noise: %.3g)", round->largest, round->threshold);
    print_chance(&wrap, "; chance of that drop", round->p_scan);
    print_chance(&wrap, ", of the frequencies", round->p_frequency);
    print_chance(&wrap, ", of chi2", round->p_total);
    wrap_close(&wrap);
    for (int i = 0; i < round->ncandidate; i++) {
        const struct candidate *c = &round->candidate[i];
        int in_set = i < round->nset;
        if (!c->suspect && !view->verbose && (in_set ? i >= SET_SHOWN : !c->refitted || shown >= SHOWN)) {
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
    if (isfinite(round->required_margin) && round->nset > 1)
        (void)fprintf(view->out, "    a cause is named alone where its chi2 drop leads every other by %.3g\n",
                      round->required_margin);
}

void table_evidence(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    if (d->nround)
        (void)fprintf(view->out,
                      "\nEVIDENCE  (noise: drop that chance alone reaches in 3 %% of tests; modes in %%, sensors over noise)\n");
    for (int i = 0; i < d->nround; i++)
        print_round(view, i);
}
