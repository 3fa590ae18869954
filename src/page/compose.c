/* A page of one or more results: what it says of a fit, of modes, sensitivities, transfer functions, a modal analysis, a
 * suggestion and a study; what it rests on and where it comes from; then its name, the answers, the sections in the order in
 * which they are read. */
#include "page/page.h"
#include "study/study.h"

/* ---- reading */

/* A file of results of a study: its first line says what it is. */
static void read_lines(const struct json_place *lines, struct result *result)
{
    struct reader *reader = lines->reader;
    struct json_place head = place_first(lines, PLACE_OBJECT);
    struct study_result *study = POOL_NEW(reader->pool, struct study_result);
    struct study_header header;
    if (!head.json || !place_has(&head, "rotid") || !place_has(&head, "studies")) {
        place_wrong(lines, "has a value a line and is no file of results, expected one of rotid study, or one result");
        return;
    }
    int status = study ? summary_read(reader->pool, reader->file, reader->messages, &header, NULL, study) : ROTID_ERROR_MEMORY;
    if (status)
        reader->status = status == ROTID_ERROR_MEMORY ? status : ROTID_ERROR_SYNTAX;
    else
        result->head = (struct result_head){.schema = RESULT_SCHEMA,
                                            .command = "study",
                                            .rotid = header.rotid,
                                            .commit = header.commit,
                                            .seed = header.seed,
                                            .blas = ""};
    result->study = study;
}

int page_result_read(struct pool *pool, const char *file, struct message_list *messages, struct result *result)
{
    return result_read(pool, file, messages, read_lines, result);
}

/* The deck of a result, of a modal analysis the measured file, else the file of the result; of an absolute path the last part. */
static const char *page_source(const struct result *result)
{
    return plain_file(result->ema                               ? result->ema->source.file
                      : result->head.deck && *result->head.deck ? result->head.deck
                                                                : result->file);
}

static void section_agreement(struct document *document, const struct result *result)
{
    document_section(document, "agreement", "Model and measurement", "shapes");
    document_figures(document, "agreement");
    document_figures(document, "matrices");
    document_table(document, table_of_compared_modes(document->pool, &result->head, result->identify, NULL));
    document_table(document, table_of_weighed(document->pool, result->identify->nweighed, result->identify->weighed));
    document_table(document, table_of_runup(document->pool, result->identify->nrunup, result->identify->runup));
}

static void section_identify(struct document *document, const struct result *result)
{
    const rotid_identification *fit = result->identify;
    section_trust(document, result);
    if (fit->nstates) {
        document_section(document, "states", "All states together", "states");
        document_table(document, table_of_states(document->pool, fit));
    }
    document_section(document, "parameters", "What was identified", "parameters");
    document_table(document, table_of_parameters(document->pool, fit));
    document_section(document, "fit", "How the fit got there", "fit");
    document_table(document, table_of_minimisers(document->pool, fit));
}

static void add_shown(struct document *document, const struct shown *shown)
{
    document_list(document, shown->said.count, shown->said.text);
    for (int i = 0; shown->table[i]; i++)
        document_table(document, shown->table[i]);
}

static void section_modes(struct document *document, const struct result *result)
{
    const struct shown shown = shown_of_modes(document->pool, result->modes);
    document_section(document, "model-modes", "Modes of the model", "modes");
    add_shown(document, &shown);
}

static void section_sensitivity(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct sensitivity *s = result->sensitivity;
    document_section(document, "dependence", "Sensitivity", NULL);
    document_paragraph(document, "%s", sensitivity_in_words(pool, s));
    document_figures(document, "sensitivity");
    document_table(document, table_of_sensitivity(pool, s));
}

static void section_transfer(struct document *document, const struct result *result)
{
    const struct reasons said = sentences_of_transfer(document->pool, result->frf);
    document_section(document, "transfer", "Transfer functions", NULL);
    document_list(document, said.count, said.text);
    if (!result->frf->with_curves)
        document_paragraph(document, "The result has no curves, because there were too many lines: rotid frf -o writes them as a "
                                     "universal file.");
    document_figures(document, "transfer");
    document_table(document, table_of_transfer_modes(document->pool, result->frf));
}

/* ---- the machine in operation */

static void section_speeds(struct document *document, const struct result *result)
{
    const struct shown shown = shown_of_speeds(document->pool, result->speeds, 1);
    document_section(document, "operation", "The machine in operation", "speeds");
    add_shown(document, &shown);
}

/* ---- modal analysis */

static void answer_ema(struct document *document, const struct result *result)
{
    const struct ema_result *ema = result->ema;
    struct pool *pool = document->pool;
    int modes = 0, channels = 0;
    for (int k = 0; k < ema->nmodes; k++)
        modes += ema->modes[k].is.quality_flags != 0;
    for (int c = 0; c < ema->nchannels; c++)
        channels += ema->channels[c].quality_flags != 0;
    const int doubtful = modes || channels;
    if (!ema->nmodes) {
        document->now.tone = TONE_BAD;
        document->now.headline = "No mode was found";
        document->now.text = "No pole of the transfer functions is stable enough to be a mode.";
        return;
    }
    document->now.tone = doubtful ? TONE_CARE : TONE_GOOD;
    document->now.text =
        pool_text(pool, "%d %s from %s in %d transfer %s. %s", ema->nmodes, human_plural(ema->nmodes, "mode", "modes"),
                  human_range(pool, ema->modes[0].is.frequency_hz, ema->modes[ema->nmodes - 1].is.frequency_hz, "Hz"),
                  ema->source.transfer_functions, human_plural(ema->source.transfer_functions, "function", "functions"),
                  doubtful ? pool_text(pool, "%d of the modes and %d of the channels %s doubtful, see below.", modes, channels,
                                       modes + channels == 1 ? "is" : "are")
                           : "No mode and no channel is doubtful.");
    for (int k = 0; k < ema->nmodes && k < TILES_MOST; k++)
        document_tile(document, pool_text(pool, "mode %d [Hz]", ema->modes[k].mode),
                      human_digits(pool, ema->modes[k].is.frequency_hz, 6),
                      pool_text(pool, "damping %s\xc2\xa0%%%s", human_digits(pool, 100 * ema->modes[k].is.damping, 3),
                                ema->modes[k].is.quality_flags ? "; doubtful" : ""));
    document->now.next =
        doubtful ? "Next: look at the doubtful ones in the diagram and in the functions, before a model is fitted to them."
                 : "Next: name the file of the modes in *MEASURED of a deck, and identify the model.";
}

static void section_ema(struct document *document, const struct result *result)
{
    const struct ema_result *ema = result->ema;
    document_section(document, "modes-of-test", "Modes of the test", "ema-shapes");
    document_table(document, table_of_test_modes(document->pool, ema));
    int count;
    const char **text = ema_doubts(document->pool, ema, &count);
    document_section(document, "doubts", "Doubtful modes and channels", NULL);
    document_list(document, text ? count : 0, text);
    document_section(document, "poles", "Where the modes come from", "ema-poles");
    if (!ema->ncurves)
        return;
    document_section(document, "functions", "Measured and synthesised functions", NULL);
    document_paragraph(document, "Synthesised: the modes of the result, with one term for the modes below and one for those "
                                 "above the band. FRAC is 1 where both are the same but for a factor.");
    document_figures(document, "ema-functions");
}

/* ---- what to measure next */

static void section_suggest(struct document *document, const struct result *result)
{
    const struct shown shown = shown_of_suggestion(document->pool, result->suggest, 0);
    document_section(document, "tests", "What could be measured next", result->suggest->ntests ? "tests" : NULL);
    if (!isfinite(result->suggest->speed_rpm))
        document_figures(document, "sensors");
    add_shown(document, &shown);
}

/* ---- a study */

static void answer_study(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct study_result *s = result->study;
    const struct reasons said = shown_of_study(pool, s).said;
    if (s->plan)
        document->title = pool_text(pool, "Study %s", strrchr(s->plan, '/') ? strrchr(s->plan, '/') + 1 : s->plan);
    document->now.tone = said.tone;
    document->now.headline =
        s->done < s->runs ? pool_text(pool, "%d of %d runs", s->done, s->runs) : pool_text(pool, "%d runs", s->done);
    document->now.text = said.count ? said.text[0] : "";
}

static void section_study(struct document *document, const struct result *result)
{
    const struct study_result *s = result->study;
    const struct shown shown = shown_of_study(document->pool, s);
    document_section(document, "study", "The study", NULL);
    document_figures(document, "study");
    if (!cJSON_IsArray(result->json) && s->done > 0)
        document_paragraph(
            document,
            "%s is a summary. The file of results itself (.jsonl) holds the single runs, of which more figures are "
            "made: starts and ends, what depends on the number of modes, errors of the runs.",
            result->file);
    add_shown(document, &shown);
}

/* ---- basis and provenance */

#define KEYS_SINCE "0.3.0" /* the version whose results hold what a page asks for beyond those of 0.2 */

static const char *noise_of(struct pool *pool, const struct result *result)
{
    const rotid_noise *noise = noise_of_result(result);
    if (!noise || !fit_of_result(result) || !(noise->intervals_from || result->diagnose))
        return NULL;
    return noise_in_words(pool, noise);
}

static const char *data_of(struct pool *pool, const struct result *result)
{
    const rotid_identification *fit = fit_of_result(result);
    int shapes = 0;
    if (result->ema) {
        const struct ema_source *of = &result->ema->source;
        const char *impacts = pool_text(pool, ", from %d impacts of which %d are used", of->impacts, of->impacts_used);
        return pool_text(pool, "%d transfer %s of %d lines from %s%s", of->transfer_functions,
                         human_plural(of->transfer_functions, "function", "functions"), of->lines,
                         human_range(pool, of->low_hz, of->high_hz, "Hz"), of->from_time_records ? impacts : "");
    }
    if (!fit || !fit->nmodes)
        return NULL;
    for (int k = 0; fit->shapes && k < fit->shapes->nmodes; k++)
        shapes += fit->shapes->modes[k].measured != NULL;
    double low = INFINITY, high = 0;
    for (int k = 0; k < fit->nmodes; k++) {
        low = fmin(low, fit->modes[k].measured_hz);
        high = fmax(high, fit->modes[k].measured_hz);
    }
    const char *text = pool_text(pool, "%d measured %s from %s", fit->nmodes, human_plural(fit->nmodes, "mode", "modes"),
                                 human_range(pool, low, high, "Hz"));
    if (!fit->shapes)
        return text;
    return shapes ? pool_text(pool, "%s, %d with a shape at %d sensors", text, shapes, fit->shapes->nsensor_id)
                  : pool_text(pool, "%s, without shapes", text);
}

/* Elements along the axis. */
static int elements_of(const rotid_geometry *geometry)
{
    int elements = 0;
    for (int g = 0; g < geometry->ngroups; g++)
        for (int s = 0; s < geometry->groups[g].nsegments && !geometry->groups[g].layer_of; s++)
            elements += geometry->groups[g].segments[s].elements;
    return elements;
}

static const char *model_of(struct pool *pool, const struct result *result)
{
    const rotid_identification *fit = fit_of_result(result);
    const rotid_geometry *geometry = geometry_of_result(result);
    const char *size = geometry ? pool_text(pool, "%s\xc2\xa0m, %d %s", human_trimmed(pool, geometry->length_m, 4),
                                            elements_of(geometry), human_plural(elements_of(geometry), "element", "elements"))
                                : "",
               *how = fit ? pool_text(pool, "%s%s\xc2\xa0kg, centre of mass at %s\xc2\xa0m; functional %s, reduction %s",
                                      *size ? ", " : "", human_trimmed(pool, fit->mass_kg, 4),
                                      human_trimmed(pool, fit->center_of_mass_m, 4), fit->functional, fit->reduction)
                          : "";
    return geometry || fit ? pool_text(pool, "%s%s", size, how) : NULL;
}

#define MOST_FACTS 6

/* What one section says of a result: names and values, NULL where it has none. */
struct facts {
    int count;
    const char *const *name;
    void (*of)(struct pool *pool, const struct result *result, const char *value[MOST_FACTS]);
};

/* The values of a result that none before it has: a model said in fewer words is no other one. Their number. */
static int new_facts(struct pool *pool, const struct facts *facts, const struct result *result, int i,
                     const char *value[MOST_FACTS])
{
    const char *before[MOST_FACTS] = {NULL};
    int told = 0;
    facts->of(pool, &result[i], value);
    for (int j = 0; j < i; j++) {
        facts->of(pool, &result[j], before);
        for (int k = 0; k < facts->count; k++)
            if (value[k] && before[k] && !strncmp(value[k], before[k], strlen(value[k])))
                value[k] = NULL;
    }
    for (int k = 0; k < facts->count; k++)
        told += value[k] != NULL;
    return told;
}

static void add_facts(struct document *document, const struct facts *facts, int count, const struct result *result)
{
    const char *value[MOST_FACTS] = {NULL};
    for (int i = 0; i < count; i++) {
        if (!new_facts(document->pool, facts, result, i, value))
            continue;
        if (count > 1)
            document_heading(document, page_source(&result[i]));
        document_facts(document, facts->count, facts->name, value);
    }
}

static void basics_of(struct pool *pool, const struct result *result, const char *value[MOST_FACTS])
{
    value[0] = data_of(pool, result);
    value[1] = noise_of(pool, result);
    value[2] = model_of(pool, result);
}

static void section_basis(struct document *document, int count, const struct result *result)
{
    static const char *const name[] = {"Data", "Noise", "Model"};
    static const struct facts basics = {3, name, basics_of};
    const char *value[MOST_FACTS] = {NULL};
    int told = result->head.nheading > 1;
    for (int i = 0; i < count; i++)
        told |= result[i].nwarnings > 0 || new_facts(document->pool, &basics, result, i, value) > 0;
    if (!told)
        return;
    document_section(document, "basis", "What it rests on", NULL);
    add_facts(document, &basics, count, result);
    for (int k = 1; k < result->head.nheading; k++)
        document_paragraph(document, "%s", result->head.heading[k]);
    for (int i = 0; i < count; i++)
        if (result[i].nwarnings) {
            document_heading(document, "What rotid notes");
            document_list(document, result[i].nwarnings, result[i].warnings);
        }
}

/* "soft zone: stiffness_local", of every cause that a diagnosis tried or has a limit for and whose name in words is another one.
 */
static const char *ids_of(struct pool *pool, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    const char *text = "";
    for (int r = 0; d && r < d->nrounds; r++) {
        int count;
        const rotid_candidate *candidate = diagnosis_candidates(d, r, &count);
        for (int i = 0; i < count; i++) {
            const char *id = candidate[i].cause.id,
                       *pair = strchr(id, '_') ? pool_text(pool, "%s: %s", plain_cause(pool, id), id) : NULL;
            if (pair && !strstr(text, pair))
                text = pool_text(pool, "%s%s%s", text, *text ? "; " : "", pair);
        }
    }
    return *text ? text : NULL;
}

static void origin_of(struct pool *pool, const struct result *result, const char *value[MOST_FACTS])
{
    value[0] = pool_text(pool, "%s (rotid %s)", result->file, result->head.command);
    value[1] = result->ema ? result->ema->source.file : result->head.deck;
    value[2] = pool_text(pool, "rotid %s, commit %s", result->head.rotid, result->head.commit);
    value[3] = result->head.threads ? pool_text(pool, "seed %.0f, %d %s", result->head.seed, result->head.threads,
                                                human_plural(result->head.threads, "thread", "threads"))
                                    : pool_text(pool, "seed %.0f", result->head.seed);
    value[4] = *result->head.blas ? result->head.blas : NULL;
    value[5] = ids_of(pool, result);
}

static void section_provenance(struct document *document, int count, const struct result *result)
{
    static const char *const name[] = {"Result", "Deck or file", "Program", "Seed, threads", "Linear algebra", "Causes on cards"};
    static const struct facts origin = {MOST_FACTS, name, origin_of};
    document->of = NULL;
    document->verbatim = 1;
    document_section(document, "provenance", "Provenance", NULL);
    add_facts(document, &origin, count, result);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < result[i].nlacking; k++)
            document_paragraph(
                document,
                "Not shown: %s. %s was made by rotid %s and has no key \"%s\", which results have from rotid %s on. rotid "
                "%s %s --json %s makes a new one.",
                result[i].lacking[k].shows, result[i].file, result[i].head.rotid, result[i].lacking[k].key, KEYS_SINCE,
                result[i].head.command, result[i].head.deck ? result[i].head.deck : "DECK", result[i].file);
    document->verbatim = 0;
}

/* ---- the whole */

/* What a result is, in words, and how much the answer of a page rests on it: of several results that with the least rank gives
 * the page its title, wherever it was given. */
typedef void page_part(struct document *document, const struct result *result);
static const struct kind {
    const char *command, *words;
    int judged;                     /* it says how far it can be relied on */
    page_part *answer, *body, *end; /* NULL: none; end: behind the parts of the states */
    page_part *state;               /* what each state has, or a deck that is one */
} kinds[] = {{"diagnose", "Diagnosis", 1, answer_diagnose, section_diagnose, NULL, NULL},
             {"identify", "Identification", 1, answer_identify, NULL, section_identify, section_agreement},
             {"study", "Study", 1, answer_study, section_study, NULL, NULL},
             {"ema", "Modal analysis", 1, answer_ema, section_ema, NULL, NULL},
             {"suggest", "Next measurement", 0, answer_plain, section_suggest, NULL, NULL},
             {"modes", "Modes", 0, answer_plain, NULL, NULL, section_modes},
             {"speeds", "Critical speeds", 0, answer_plain, section_speeds, NULL, NULL},
             {"frf", "Transfer functions", 0, answer_plain, NULL, NULL, section_transfer},
             {"sensitivity", "Sensitivity", 0, answer_plain, NULL, NULL, section_sensitivity},
             {"check", "Check", 0, answer_plain, NULL, NULL, NULL}};
#define KINDS (int)(sizeof kinds / sizeof *kinds)

static int rank_of(const struct result *result)
{
    int k = 0;
    while (k < KINDS - 1 && strcmp(kinds[k].command, result->head.command) != 0)
        k++;
    return k;
}

/* "Diagnosis of rotor.inp" */
static const char *words_of(struct pool *pool, const struct result *result)
{
    return pool_text(pool, "%s of %s", kinds[rank_of(result)].words, page_source(result));
}

/* The first line of the heading that says something; of a deck without one its name. */
static const char *title_of(const struct result *result)
{
    for (int i = 0; i < result->head.nheading; i++)
        if (result->head.heading[i][strspn(result->head.heading[i], " \t")])
            return result->head.heading[i];
    return page_source(result);
}

/* The names of all results, each once; of more than two decks the first two titles stand over the page. */
static void name_page(struct document *document, int count, const struct result *const by_rank[])
{
    struct pool *pool = document->pool;
    const char *title = "", *subtitle = "";
    int titles = 0;
    for (int i = 0; i < count; i++) {
        const char *own = title_of(by_rank[i]), *words = words_of(pool, by_rank[i]);
        if (!strstr(subtitle, words))
            subtitle = pool_text(pool, "%s%s%s", subtitle, *subtitle ? "; " : "", words);
        if (strstr(title, own) || (*title && own == page_source(by_rank[i]))) /* a file is no title beside one */
            continue;
        if (titles++ < 2)
            title = pool_text(pool, "%s%s%s", title, *title ? "; " : "", own);
    }
    if (titles > 2)
        title = pool_text(pool, "%s; and %d more", title, titles - 2);
    document->title = plain_text(pool, title);
    document->subtitle = subtitle;
}

/* Whether the results are of more than one deck. */
static int several_decks(int count, const struct result *result)
{
    const char *deck = NULL;
    int several = 0;
    for (int i = 0; i < count; i++) {
        several |= deck && result[i].head.deck && strcmp(result[i].head.deck, deck) != 0;
        deck = deck ? deck : result[i].head.deck;
    }
    return several;
}

static void add(struct document *document, page_part *part, const struct result *result)
{
    if (part)
        part(document, result);
}

/* The answers of the results that judge; of a page without one those of all. */
static void answer_all(struct document *document, int count, const struct result *const by_rank[], int decks)
{
    int judged = kinds[rank_of(by_rank[0])].judged;
    for (int i = 0; i < count; i++) {
        if (judged && !kinds[rank_of(by_rank[i])].judged)
            continue;
        document->of = decks ? page_source(by_rank[i]) : NULL;
        add(document, kinds[rank_of(by_rank[i])].answer, by_rank[i]);
        document_answer(document, count > 1 ? words_of(document->pool, by_rank[i]) : NULL);
    }
    document->of = NULL;
}

/* of: the deck where it is not that of the page, or NULL; drawn: the rotors are on the page already */
static void compose_states(struct document *document, const struct result *result, const char *of, int drawn)
{
    for (int s = 0; s < result_states(result); s++) {
        const struct result own = result_of_state(document->pool, result, s);
        const char *name = result->identify ? result->identify->states[s].name : result->states[s].name;
        document->of = pool_text(document->pool, "%s%sstate %s", of ? of : "", of ? ", " : "", name);
        document->state = s;
        if (document->pool->out_of_memory) /* then the state has no result */
            break;
        if (!drawn && !result->identify && !result->modes && geometry_of_result(&own))
            document_section(document, "model", "The rotor", "rotor");
        add(document, kinds[rank_of(result)].state, &own);
    }
    document->of = of;
    document->state = -1;
}

/* A result as a page shows it outside its section on provenance: of absolute paths the last part. */
static struct result without_folders(const struct result *result)
{
    struct result own = *result;
    own.head.deck = plain_file(result->head.deck);
    own.file = plain_file(result->file);
    return own;
}

static const struct result **sorted(struct pool *pool, int count, const struct result *result)
{
    const struct result **list = POOL_ARRAY(pool, const struct result *, count);
    for (int i = 0; i < count && list; i++) {
        int k = i;
        for (; k > 0 && rank_of(list[k - 1]) > rank_of(&result[i]); k--)
            list[k] = list[k - 1];
        list[k] = &result[i];
    }
    return list;
}

static void compose_result(struct document *document, const struct result *result, int drawn)
{
    const struct kind *kind = &kinds[rank_of(result)];
    add(document, kind->body, result);
    if (result_states(result))
        compose_states(document, result, document->of, drawn);
    else
        add(document, kind->state, result);
    add(document, kind->end, result);
}

void page_compose(struct document *document, int count, const struct result *given)
{
    struct result *result = POOL_ARRAY(document->pool, struct result, count);
    int decks = several_decks(count, given);
    for (int i = 0; i < count && result; i++) {
        result[i] = without_folders(&given[i]);
        human_units_of(&result[i].head);
    }
    const struct result **by_rank = result ? sorted(document->pool, count, result) : NULL;
    if (!by_rank)
        return;
    name_page(document, count, by_rank);
    answer_all(document, count, by_rank, decks);
    int drawn = 0; /* one picture of the rotor, of each state, does: shapes in motion show it as well */
    for (int i = 0; i < count; i++)
        drawn |= result[i].identify || result[i].diagnose || result[i].modes;
    for (int i = 0; i < count; i++) {
        document->of = decks ? page_source(&result[i]) : NULL;
        document->result = i;
        if (!drawn && geometry_of_result(&result[i]) && !result_states(&result[i])) {
            document_section(document, "model", "The rotor", "rotor");
            drawn = 1;
        }
        compose_result(document, &result[i], drawn);
    }
    section_basis(document, count, result);
    section_provenance(document, count, given);
}
