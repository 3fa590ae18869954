#include <math.h>
#include <string.h>

#include "report/layout.h"
#include "report/table_diagnose.h"

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

void table_evidence(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    if (d->nrounds)
        (void)fprintf(view->out,
                      "\nEVIDENCE  (noise: drop that chance alone reaches in 3 %% of tests; modes in %%, sensors res./sigma)\n");
    for (int i = 0; i < d->nrounds; i++)
        print_round(view, i);
}
