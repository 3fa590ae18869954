/* Evidence of the candidates of a round: one bar each, with what chance reaches and what a name asks for. */
#include <math.h>
#include <stdlib.h>

#include "page/cause_words.h"
#include "page/figures_diagnosis.h"
#include "page/human.h"
#include "page/names.h"
#include "page/series.h"

#define MOST_BARS 14
#define NAMES_PX  216.0
#define EDGE_PX   14.0
#define NUMBER_PX 62.0 /* behind a bar */

enum fate { FATE_NAMED, FATE_POSSIBLE, FATE_LOSES, FATE_REFUSED, FATE_SCANNED, FATES };
static const char *const fate_color[FATES] = {"VERMILION", "PURPLE", "BLUE", "MUTED", "BLUE"};

struct bar {
    const rotid_candidate *evidence;
    enum fate fate;
    double drop;
    const char *label;
};

struct bar_list {
    int count, hidden, has[FATES];
    struct bar bar[MOST_BARS]; /* longest first */
};

static int longer(const void *a, const void *b)
{
    const struct bar *first = a, *second = b;
    return (first->drop < second->drop) - (first->drop > second->drop);
}

/* The longest ones, the set in any case. NULL: memory is out. */
static struct bar_list *collect(struct pool *pool, const rotid_diagnosis *d, int number)
{
    int ncandidate;
    const rotid_candidate *candidate = diagnosis_candidates(d, number, &ncandidate);
    const rotid_round *round = &d->rounds[number];
    struct bar_list *bars = POOL_NEW(pool, struct bar_list);
    struct bar *all = POOL_ARRAY(pool, struct bar, ncandidate);
    int count = 0;
    if (!bars || !all)
        return NULL;
    for (int i = 0; i < ncandidate; i++) {
        const rotid_candidate *c = &candidate[i];
        double drop = c->refitted ? c->chi2_drop : c->predicted_drop;
        enum fate fate = i < round->set          ? round->kind == ROTID_NAMED ? FATE_NAMED : FATE_POSSIBLE
                         : !c->refitted          ? FATE_SCANNED
                         : candidate_is_rival(c) ? FATE_LOSES
                                                 : FATE_REFUSED;
        if (isfinite(drop))
            all[count++] = (struct bar){c, fate, fmax(drop, 0), candidate_words(pool, d, c)};
    }
    qsort(all, (size_t)count, sizeof *all, longer);
    for (int i = 0; i < count; i++) {
        if (bars->count == MOST_BARS)
            break;
        bars->bar[bars->count++] = all[i];
        bars->has[all[i].fate] = 1;
    }
    bars->hidden = count - bars->count;
    return bars;
}

static int legend_of(const struct bar_list *bars, const rotid_round *round, int with_margin, struct plot_entry *entry)
{
    static const char *const texts[FATES] = {"named", "possible, not to be told apart", "fitted, loses",
                                             "refused for a reason of its own", "only scanned: the drop expected"};
    int n = 0;
    for (int f = 0; f < FATES; f++)
        if (bars->has[f])
            entry[n++] = (struct plot_entry){.text = texts[f],
                                             .keys = f == FATE_SCANNED ? KEY_HATCH : KEY_FACE,
                                             .face = f == FATE_SCANNED ? "" : fate_color[f]};
    if (isfinite(round->threshold))
        entry[n++] = (struct plot_entry){.text = "chance alone reaches this in 3 of 100 tests", .style = 11, .keys = KEY_LINE};
    if (with_margin)
        entry[n++] = (struct plot_entry){.text = "a rival that loses may not come beyond this", .style = 12, .keys = KEY_LINE};
    return n;
}

/* Where the number behind a bar begins: upright lines do not run through it. */
static double behind(double drop, double most, const char *text, int layout, const double line[2])
{
    double px = (layout == WIDE ? WIDE_PX - NAMES_PX : NARROW_PX - EDGE_PX) - NUMBER_PX,
           wide = (plot_width(text) + 8) * most / px;
    double at = drop;
    for (int round = 0; round < 2; round++)
        for (int i = 0; i < 2; i++)
            if (line[i] >= at && line[i] <= at + wide)
                at = line[i];
    return at;
}

static void draw_bars(struct plot *plot, const struct bar_list *bars, double most, const double line[2])
{
    int n = bars->count;
    for (int l = 0; l < LAYOUTS; l++) {
        plot_line(plot, l == WIDE ? "if (!narrow) {" : "} else {");
        for (int i = 0; i < n; i++) {
            const struct bar *bar = &bars->bar[i];
            char where[80];
            const char *number = human_digits(plot->pool, bar->drop, 3);
            (void)snprintf(where, sizeof where, "first %.6g, first %d-LIFT", behind(bar->drop, most, number, l, line), n - i);
            plot_label(plot, number, where, "INK", "left offset char 0.5, 0");
        }
    }
    plot_line(plot, "}");
}

/* An upright line; on a phone beside the bars alone, since names stand between them. */
static void upright(struct plot *plot, double x, int n, int style)
{
    if (!isfinite(x))
        return;
    plot_line(
        plot,
        "if (!narrow) { set arrow %d from first %.6g, graph 0 to first %.6g, graph 1 nohead front ls %d } \\\n"
        "else { do for [i = 1:%d] { set arrow %d+i from first %.6g, first i-LIFT-0.6*BAR to first %.6g, first i-LIFT+0.6*BAR "
        "nohead front ls %d } }",
        100 * style, x, x, style, n, 100 * style, x, x, style);
}

static struct series *collect_series(struct document *document, const struct bar_list *bars)
{
    static const char *const fates[FATES] = {"named", "possible", "loses", "refused for a reason of its own", "only scanned"};
    static const struct column columns[] = {{"row from below", NULL, AS_PLACE, 0},
                                            {"cause", NULL, AS_TEXT, 0},
                                            {"drop expected", "1", AS_DIGITS, 4},
                                            {"drop reached", "1", AS_DIGITS, 4},
                                            {"length of the bar", "1", AS_PLACE, 0},
                                            {"number of its fate", NULL, AS_PLACE, 0},
                                            {"fate", NULL, AS_TEXT, 0}};
    struct series *series = series_new(document, "candidates", bars->count, 7, columns);
    for (int i = 0; i < bars->count; i++) {
        const struct bar *bar = &bars->bar[i];
        series_row(
            series, i,
            (const double[]){bars->count - i, bar->evidence->predicted_drop, bar->evidence->chi2_drop, bar->drop, bar->fate});
        series_text(series, i, 1, bar->label);
        series_text(series, i, 6, fates[bar->fate]);
    }
    return series;
}

static void script(struct plot *plot, const struct series *series, const rotid_round *round, const struct bar_list *bars,
                   double margin_at)
{
    struct plot_entry entry[FATES + 2];
    int n = bars->count, nentry = legend_of(bars, round, isfinite(margin_at), entry);
    double most = fmax(bars->bar[0].drop, isfinite(round->threshold) ? round->threshold : 0);
    const char *name[MOST_BARS], *color[MOST_BARS];
    for (int i = 0; i < n; i++) {
        name[i] = bars->bar[i].label;
        color[i] = bars->bar[i].fate <= FATE_POSSIBLE ? fate_color[bars->bar[i].fate] : "INK";
    }
    struct name_rows names = names_measure(n, name, (const double[]){NAMES_PX - 12, NARROW_PX - 2 * EDGE_PX},
                                           (const double[]){24, 38}); /* names stand over the bars of a narrow page */
    struct plot_layout layout = {.panels = 1,
                                 .columns = {1, 1},
                                 .height = 10 + names.height[WIDE] * n + 52,
                                 .narrow_height = 10 + names.height[NARROW] * n + 52,
                                 .left = NAMES_PX,
                                 .right = NUMBER_PX,
                                 .top = 10,
                                 .bottom = 52};
    most = most > 0 ? most : 1;
    plot_head(entry, nentry, layout.head);
    plot_line(plot, "set style line 11 lc rgb INK lw 1.25 dt (2,3)\nset style line 12 lc rgb INK lw 1.25 dt (8,4)");
    plot_series(plot, series);
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    plot_line(plot, "if (narrow) { set lmargin at screen %g/W }", EDGE_PX);
    plot_line(plot, "set xrange [0:%.6g]\nset yrange [0.5:%g]\nunset ytics\nset border 1\nset xtics %g", most * 1.02, n + 0.5,
              plot_tic(most, 5));
    plot_legend(plot, entry, nentry);
    plot_axes(plot, "drop of the misfit \xcf\x87\xc2\xb2 [1]", NULL);
    names_draw(plot, &names, color);
    plot_line(plot, "BAR = SHARE*(narrow ? 0.36 : 0.62) # width of a bar over that of its row");
    draw_bars(plot, bars, most, (const double[]){round->threshold, margin_at});
    upright(plot, round->threshold, n, 11);
    upright(plot, margin_at, n, 12);
    const char *between = "plot ";
    for (int f = 0; f < FATES; f++) {
        if (!bars->has[f])
            continue;
        (void)fprintf(
            plot->out,
            "%s$candidates using 4:($5 == %d ? $1-LIFT : NaN):(0):4:($1-LIFT-0.5*BAR):($1-LIFT+0.5*BAR) with boxxyerror %s%s",
            between, f, f == FATE_SCANNED ? "fs transparent pattern 4 border lc rgb BLUE lw 1 " : "fs solid noborder fc rgb ",
            f == FATE_SCANNED ? "fc rgb BLUE" : fate_color[f]);
        between = ", \\\n    ";
    }
    (void)fputc('\n', plot->out);
}

/* Who leads whom, and by how much. */
static const char *lead(struct pool *pool, const rotid_diagnosis *d, int number, const struct bar_list *bars)
{
    int first, second, count;
    const rotid_round *round = &d->rounds[number];
    const rotid_candidate *candidate = diagnosis_candidates(d, number, &count);
    diagnosis_leaders(d, number, &first, &second);
    const rotid_candidate *best = first >= 0 ? &candidate[first] : NULL, *longest = bars->bar[0].evidence;
    const char *name = best ? candidate_words(pool, d, best) : "",
               *next = second >= 0 ? candidate_words(pool, d, &candidate[second]) : "";
    const char *asked = human_trimmed(pool, round->required_margin, 3), *text = "";
    if (round->kind == ROTID_NAMED && best)
        text = pool_format(pool, "%s lowers the misfit of %s by %s", name, human_digits(pool, round->chi2, 4),
                           human_digits(pool, best->chi2_drop, 3));
    if (round->kind == ROTID_NAMED && best && second >= 0 && text)
        text =
            pool_format(pool, "%s and leads the runner-up, %s, by %s, with 3 charged for each parameter; the required lead is %s",
                        text, next, human_digits(pool, candidate_lead(best, &candidate[second]), 3), asked);
    else if (round->kind == ROTID_NAMED && best && longest != best && text)
        text = pool_format(pool, "%s. %s does so by more and was refused: %s", text, bars->bar[0].label,
                           longest->rejected_because ? longest->rejected_because : "");
    else if (round->set > 1)
        text = pool_format(pool,
                           "%s causes explain the data about equally well: a name requires a lead of %s over every other, with 3 "
                           "charged for each parameter",
                           words_sentence(pool, human_count(pool, round->set)), asked);
    else if (round->set == 1 && round->kind != ROTID_NAMED)
        text = pool_format(pool, "%s leads, but these data do not suffice to name a cause", name);
    else if (!round->set)
        text =
            pool_format(pool, "Nothing is left to name: the longest bar, %s, was refused%s%s", bars->bar[0].label,
                        longest->rejected_because ? " because " : "", longest->rejected_because ? longest->rejected_because : "");
    return text ? text : "";
}

void figure_evidence(struct document *document, const struct result *result, int number)
{
    const rotid_diagnosis *d = result->diagnose;
    const rotid_round *round = &d->rounds[number];
    struct pool *pool = document->pool;
    struct bar_list *bars = collect(pool, d, number);
    int first, second, count;
    const rotid_candidate *candidate = diagnosis_candidates(d, number, &count);
    if (!bars || !bars->count ||
        (!bars->has[FATE_NAMED] && !bars->has[FATE_POSSIBLE] && !bars->has[FATE_LOSES] && !bars->has[FATE_REFUSED])) {
        document->failed |= !bars;
        return;
    }
    diagnosis_leaders(d, number, &first, &second);
    double margin_at = first >= 0 ? candidate[first].chi2_drop - round->required_margin : NAN;
    if (!(margin_at > 0) || !bars->has[FATE_LOSES])
        margin_at = NAN;
    struct figure *figure =
        document_figure(document, "evidence",
                        number ? pool_format(pool, "Evidence, round %d: with the causes named before in the model", number + 1)
                               : "Evidence: drop of the misfit by each cause");
    const char *chance = isfinite(round->threshold) ? pool_format(pool, " Chance alone reaches %s in 3 of 100 tests.",
                                                                  human_digits(pool, round->threshold, 3))
                                                    : "",
               *hidden = bars->hidden ? pool_format(pool, " %s shorter ones stand in the table.",
                                                    words_sentence(pool, human_count(pool, bars->hidden)))
                                      : "";
    const char *says = lead(pool, d, number, bars);
    figure->caption = pool_format(pool, "%s%s%s%s", says, *says ? "." : "", chance ? chance : "", hidden ? hidden : "");
    figure->alt = pool_format(pool, "Bars of %d causes, the longest %s with %s, the shortest %s with %s.", bars->count,
                              bars->bar[0].label, human_digits(pool, bars->bar[0].drop, 3), bars->bar[bars->count - 1].label,
                              human_digits(pool, bars->bar[bars->count - 1].drop, 3));
    struct series *series = collect_series(document, bars);
    struct plot plot;
    figure->table = series_table(series);
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    script(&plot, series, round, bars, margin_at);
    figure_end(document, &plot);
}
