/* A modal analysis: its modes, which of them are doubtful, the poles that they were taken from, and what the modes make of the
 * measured functions. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/sections.h"
#include "result/ema.h"
#include "result/transfer.h"

#define DRAWN 3 /* functions */

/* The words of the bits that are set. */
static const char *doubts_in_words(struct pool *pool, int doubts, const char *const words[])
{
    const char *text = "";
    for (int b = 0; words[b] && text; b++)
        if (doubts >> b & 1)
            text = pool_format(pool, "%s%s%s", text, *text ? "; " : "", words[b]);
    return text ? text : "";
}

static int count_doubtful(const struct ema_result *ema)
{
    int count = 0;
    for (int k = 0; k < ema->nmodes; k++)
        count += ema->modes[k].doubts != 0;
    return count;
}

static int count_doubtful_channels(const struct ema_result *ema)
{
    int count = 0;
    for (int c = 0; c < ema->nchannels; c++)
        count += ema->channels[c].doubts != 0;
    return count;
}

void answer_ema(struct document *document, const struct result *result)
{
    const struct ema_result *ema = result->ema;
    struct pool *pool = document->pool;
    int modes = count_doubtful(ema), channels = count_doubtful_channels(ema);
    const char *found, *doubt = "Nothing about the modes and the channels looks doubtful.";
    if (!ema->nmodes) {
        document->tone = TONE_BAD;
        document->headline = "No mode was found";
        document->answer = "No pole of the transfer functions is stable enough to be a mode.";
        return;
    }
    found = pool_format(pool, "%d %s from %s to %s\xc2\xa0Hz in %d transfer %s.", ema->nmodes,
                        human_plural(ema->nmodes, "mode", "modes"), human_trimmed(pool, ema->modes[0].frequency_hz, 5),
                        human_trimmed(pool, ema->modes[ema->nmodes - 1].frequency_hz, 5), ema->source.transfer_functions,
                        human_plural(ema->source.transfer_functions, "function", "functions"));
    document->tone = modes || channels ? TONE_CARE : TONE_GOOD;
    if (modes || channels)
        doubt = pool_format(pool, "%d of the modes and %d of the channels %s doubtful, see below.", modes, channels,
                            modes + channels == 1 ? "is" : "are");
    document->answer = pool_format(pool, "%s %s", found ? found : "", doubt ? doubt : "");
    if (!document->answer)
        document->answer = "";
    if (modes || channels)
        document->next = "Next: look at the doubtful ones in the diagram and in the functions, before a model is fitted to them.";
    else
        document->next = "Next: name the file of the modes in *MEASURED of a deck, and identify the model.";
}

static const char *with_std(struct pool *pool, double value, double std)
{
    return isfinite(std) ? human_digits(pool, std, 2) : isfinite(value) ? "not known" : "";
}

static struct number_table *modes_table(struct pool *pool, const struct ema_result *ema)
{
    static const char *const head[] = {"mode",    "frequency [Hz]", "std [Hz]",        "damping [%]",         "std [%]",
                                       "MPC [1]", "MPD [\xc2\xb0]", "modal mass [kg]", "peak over noise [1]", "doubtful"};
    enum { COLUMNS = sizeof head / sizeof *head };
    struct number_table *table = table_headed(pool, ema->nmodes, COLUMNS, head);
    for (int k = 0; k < ema->nmodes; k++) {
        const struct ema_mode_result *m = &ema->modes[k];
        table_cell(table, k, 0, human_fixed(pool, m->mode, 0));
        table_cell(table, k, 1, human_fixed(pool, m->frequency_hz, human_decimals(m->frequency_hz, m->frequency_std_hz)));
        table_cell(table, k, 2, with_std(pool, m->frequency_hz, m->frequency_std_hz));
        table_cell(table, k, 3, human_digits(pool, 100 * m->damping, 4));
        table_cell(table, k, 4, with_std(pool, m->damping, 100 * m->damping_std));
        table_cell(table, k, 5, human_fixed(pool, m->mpc, 3));
        table_cell(table, k, 6, human_fixed(pool, m->mpd_degrees, 1));
        table_cell(table, k, 7, human_digits(pool, m->modal_mass_kg, 4));
        table_cell(table, k, 8, human_digits(pool, m->peak_signal_to_noise, 3));
        table_cell(table, k, 9, m->doubts ? "yes" : "no");
    }
    return table;
}

/* MAC of the modes with each other: what is large beside the diagonal was measured at too few points. */
static struct number_table *mac_table(struct pool *pool, const struct ema_result *ema)
{
    int n = ema->nmodes;
    struct number_table *table = table_new(pool, n, n + 1);
    table_head(table, 0, "mode");
    for (int i = 0; i < n; i++) {
        table_head(table, i + 1, human_fixed(pool, ema->modes[i].mode, 0));
        table_cell(table, i, 0, human_fixed(pool, ema->modes[i].mode, 0));
        for (int j = 0; j < n; j++)
            table_cell(table, i, j + 1, human_fixed(pool, ema->mac[i * n + j], 3));
    }
    return table;
}

static void list_doubts(struct document *document, const struct ema_result *ema)
{
    struct pool *pool = document->pool;
    int count = count_doubtful(ema) + count_doubtful_channels(ema), n = 0;
    const char **text = POOL_ARRAY(pool, const char *, count);
    document_section(document, "doubts", "Doubtful modes and channels");
    if (!text) {
        document->failed = 1;
        return;
    }
    if (!count)
        document_paragraph(document, "Nothing about the modes and the channels looks doubtful.");
    for (int k = 0; k < ema->nmodes; k++)
        if (ema->modes[k].doubts)
            text[n++] = pool_format(pool, "Mode %d at %s\xc2\xa0Hz: %s.", ema->modes[k].mode,
                                    human_trimmed(pool, ema->modes[k].frequency_hz, 5),
                                    doubts_in_words(pool, ema->modes[k].doubts, ema_mode_doubts));
    for (int c = 0; c < ema->nchannels; c++)
        if (ema->channels[c].doubts)
            text[n++] =
                pool_format(pool, "Node %d over node %d: %s.", ema->channels[c].response_node, ema->channels[c].reference_node,
                            doubts_in_words(pool, ema->channels[c].doubts, ema_channel_doubts));
    document_list(document, n, text);
}

/* The modes and the band in the shape of a result of `rotid frf`; NULL where memory is out. */
static struct transfer_result *as_transfer(struct pool *pool, const struct ema_result *ema)
{
    struct transfer_result *out = POOL_NEW(pool, struct transfer_result);
    struct transfer_mode *mode = POOL_ARRAY(pool, struct transfer_mode, ema->nmodes);
    if (!out || !mode)
        return NULL;
    for (int k = 0; k < ema->nmodes; k++)
        mode[k] = (struct transfer_mode){.mode = ema->modes[k].mode,
                                         .model_hz = ema->modes[k].frequency_hz,
                                         .measured_hz = ema->modes[k].frequency_hz,
                                         .damping = ema->modes[k].damping};
    *out = (struct transfer_result){.quantity = transfer_quantity_words[ema->source.quantity],
                                    .unit = transfer_unit_words[ema->source.quantity],
                                    .lines = ema->source.lines,
                                    .low_hz = ema->source.low_hz,
                                    .high_hz = ema->source.high_hz,
                                    .nmodes = ema->nmodes,
                                    .modes = mode};
    return out;
}

static void draw_function(struct document *document, const struct result *result, const struct transfer_result *out,
                          const struct ema_curve *curve, const char *why)
{
    const struct ema_channel_result *channel = &result->ema->channels[curve->channel - 1];
    struct transfer_function *f = POOL_NEW(document->pool, struct transfer_function);
    struct transfer_beside *beside = POOL_NEW(document->pool, struct transfer_beside);
    if (!f || !beside) {
        document->failed = 1;
        return;
    }
    beside->agreement = (struct transfer_agreement){channel->frac, NAN, NAN, NAN, NAN};
    *f = (struct transfer_function){.response = channel->response_node,
                                    .reference = channel->reference_node,
                                    .response_z_m = NAN,
                                    .reference_z_m = NAN,
                                    .beside = beside,
                                    .nfrequency_hz = curve->nfrequency_hz,
                                    .frequency_hz = curve->frequency_hz,
                                    .synthesised_re = curve->synthesised_re,
                                    .synthesised_im = curve->synthesised_im,
                                    .measured_re = curve->measured_re,
                                    .measured_im = curve->measured_im};
    figure_transfer_function(document, result->file, out, f, why);
}

static void draw_functions(struct document *document, const struct result *result)
{
    static const char *const why[DRAWN] = {", the worst of all", ", between worst and best", ", the best of all"};
    const struct ema_result *ema = result->ema;
    const struct transfer_result *out = as_transfer(document->pool, ema);
    int n = ema->ncurves, at[DRAWN] = {0, n / 2, n - 1};
    document_section(document, "functions", "Measured and synthesised functions");
    document_paragraph(document, "Synthesised is what the modes make of a function, with a term for what lies below and one for "
                                 "what lies above the band. FRAC is 1 where both are the same but for a factor.");
    if (!out) {
        document->failed = 1;
        return;
    }
    for (int i = 0; i < DRAWN; i++)
        if ((!i || at[i] > at[i - 1]) && ema->curves[at[i]].channel <= ema->nchannels)
            draw_function(document, result, out, &ema->curves[at[i]], n > 1 ? why[i] : "");
}

void section_ema(struct document *document, const struct result *result)
{
    const struct ema_result *ema = result->ema;
    document_section(document, "modes-of-test", "Modes of the test");
    document_table(document, "Modes, with standard deviations", modes_table(document->pool, ema));
    list_doubts(document, ema);
    document_section(document, "poles", "Where the modes come from");
    figure_stabilisation(document, result);
    if (ema->nmodes > 1 && ema->mac)
        document_table(document, "MAC of the modes with each other", mac_table(document->pool, ema));
    if (ema->ncurves)
        draw_functions(document, result);
}
