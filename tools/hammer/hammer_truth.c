/* The truth as JSON, and the deck that is to find it. */
#include <math.h>
#include <stdlib.h>

#include "hammer.h"
#include "hammer_file.h"
#include "hide/hide_states.h"

static void add_numbers(struct hide_text *text, int count, int stride, const double *value)
{
    hide_add(text, "[");
    for (int i = 0; i < count; i++)
        hide_add(text, "%s%.12g", i ? ", " : "", value[(ptrdiff_t)i * stride]);
    hide_add(text, "]");
}

static void add_options(const struct hammer_test *test, uint64_t seed, struct hide_text *text)
{
    const struct hammer_options *o = &test->options;
    hide_add(text, "{\n  \"schema\": 1,\n  \"seed\": %llu,\n  \"rate_hz\": %.12g,\n  \"band_hz\": %.12g,\n  \"samples\": %d,\n",
             (unsigned long long)seed, o->rate, o->band_hz, test->count);
    hide_add(text, "  \"impacts\": %d,\n  \"roving\": \"%s\",\n  \"fixed\": %ld,\n  \"sensor_mass\": %.12g,\n", o->impacts,
             o->roving_hammer ? "hammer" : "sensor", test->id[test->fixed], o->sensor_mass);
    hide_add(text, "  \"noise\": {\"response\": %.12g, \"force\": %.12g, \"floor\": %.12g},\n  \"drift\": %.12g,\n", o->noise,
             o->force_noise, o->floor, o->drift);
    hide_add(text, "  \"parameters\": [");
    for (int i = 0; i < test->parameters; i++)
        hide_add(text, "%s{\"name\": \"%s\", \"value\": %.12g}", i ? ", " : "", test->parameter[i].name,
                 test->parameter[i].value);
    hide_add(text, "],\n  \"faults\": [");
    for (int i = 0; i < o->faults; i++) {
        static const char *const kind[] = {"dead", "duplicate", "flip", "gain", "loose"};
        const struct hammer_fault *f = &o->fault[i];
        hide_add(text, "%s{\"kind\": \"%s\", \"id\": %ld, \"other\": %ld, \"value\": %.12g}", i ? ", " : "", kind[f->kind], f->id,
                 f->other, f->value);
    }
    hide_add(text, "],\n");
}

/* Elastic modes of the rotor by itself, largest component +1, with the generalised mass that belongs to it. */
static void add_modes(const struct hammer_test *test, struct hide_text *text)
{
    hide_add(text, "  \"rigid_hz\": ");
    add_numbers(text, test->rigid, 1, test->bare_hz);
    hide_add(text, ",\n  \"modes\": [");
    for (int k = test->rigid; k < test->modes; k++) {
        const double *shape = test->bare_shape + (ptrdiff_t)k * test->points;
        double largest = 0;
        for (int s = 0; s < test->points; s++)
            largest = fabs(shape[s]) > fabs(largest) ? shape[s] : largest;
        hide_add(text, "%s\n    {\"hz\": %.12g, \"damping\": %.12g, \"mass\": %.12g, \"in_band\": %s,\n     \"shape\": [",
                 k > test->rigid ? "," : "", test->bare_hz[k], hammer_damping(test, k), 1 / (largest * largest),
                 test->bare_hz[k] <= test->options.band_hz ? "true" : "false");
        for (int s = 0; s < test->points; s++)
            hide_add(text, "%s%.10g", s ? ", " : "", shape[s] / largest);
        hide_add(text, "],\n     \"recorded_hz\": ");
        add_numbers(text, test->options.sensor_mass > 0 ? test->points : 0, test->modes, test->hz + k);
        hide_add(text, "}");
    }
    hide_add(text, "\n  ],\n");
}

static int add_impacts(const struct hammer_test *test, uint64_t seed, struct hide_text *text)
{
    double *record = malloc(2 * (size_t)test->count * sizeof *record);
    if (!record)
        return 1;
    hide_add(text, "  \"measurements\": [");
    for (int i = 0; i < test->points * test->options.impacts; i++) {
        struct hammer_impact d;
        int point = i / test->options.impacts;
        hammer_record(test, seed, point, i % test->options.impacts, record, record + test->count, &d);
        hide_add(text, "%s\n    {\"load_case\": %d, \"point\": %ld, \"start\": %.9g, \"duration\": %.9g, \"peak\": %.9g, ",
                 i ? "," : "", i + 1, test->id[point], d.start, d.duration, d.peak);
        hide_add(text, "\"second_start\": %.9g, \"second_peak\": %.9g, \"clipped\": %s, \"drift\": %.12g}",
                 d.second_peak > 0 ? d.second_start : 0, d.second_peak, d.clipped ? "true" : "false", d.drift);
    }
    hide_add(text, "\n  ]\n}\n");
    free(record);
    return 0;
}

int hammer_write_truth(const struct hammer_test *test, uint64_t seed, const char *path, char *message, size_t room)
{
    struct hide_message to = {message, room};
    struct hide_text text = {NULL, 0, 0, 0};
    add_options(test, seed, &text);
    hide_add(&text, "  \"points\": [");
    for (int s = 0; s < test->points; s++)
        hide_add(&text, "%s{\"id\": %ld, \"z\": %.12g}", s ? ", " : "", test->id[s], test->z[s]);
    hide_add(&text, "],\n");
    add_modes(test, &text);
    text.failed |= add_impacts(test, seed, &text);
    return hammer_file_write(path, &text, &to);
}

/* Name of a file in the deck, and how it lies. */
static void add_measured(struct hide_text *text, const char *modes_file)
{
    hide_add(text, "%s*MEASURED, FILE=%s, AXIS=Z, DIRECTION=X\n",
             text->length && text->data[text->length - 1] != '\n' ? "\n" : "", modes_file);
}

static void add_fit(struct hide_text *text)
{
    hide_add(text, "*FIT, FUNCTIONAL=LIKELIHOOD, REDUCTION=NONE\n");
}

static int is_one_of(const char *name, int count, const char *const *names)
{
    for (int i = 0; i < count; i++)
        if (hide_same(name, names[i]))
            return 1;
    return 0;
}

static void add_card(struct hide_text *text, const char *deck, const struct hide_card *card)
{
    hide_add_bytes(text, deck + card->begin, card->end - card->begin);
}

/* The common sensors, into a state that is still to be tested: the file of *MEASURED brings its own. */
static void add_common_sensors(struct hide_text *text, const char *deck, const struct hide_cards *cards, int state)
{
    for (int i = state + 1; i < cards->cards && !hide_same(cards->card[i].name, "STATE"); i++)
        if (hide_same(cards->card[i].name, "SENSORS") || hide_same(cards->card[i].name, "MEASURED"))
            return;
    for (int i = 0; i < cards->cards && !hide_same(cards->card[i].name, "STATE"); i++)
        if (hide_same(cards->card[i].name, "SENSORS"))
            add_card(text, deck, &cards->card[i]);
}

int hammer_write_state(const char *deck, const char *state, const char *modes_file, const char *path, char *message, size_t room)
{
    static const char *const dropped[] = {"MODES", "SHAPE", "MEASURED", "NOISE", "FREQUENCIES", "SENSORS"};
    struct hide_message to = {message, room};
    struct hide_text text = {NULL, 0, 0, 0};
    struct hide_cards cards = {0};
    int first = 0, end = 0, has_fit = 0, status = hide_cards_read(deck, "deck", &cards, &to);
    char *own = status ? NULL : hide_state_text(deck, "deck", state, &cards, &first, &end, &status, &to);
    free(own);
    if (!status)
        hide_add_bytes(&text, deck, cards.card[0].begin);
    for (int i = 0, states = 0; i < cards.cards && !status; i++) {
        const struct hide_card *card = &cards.card[i];
        has_fit |= hide_same(card->name, "FIT");
        if (hide_same(card->name, "STATE") && !states++ && !has_fit)
            add_fit(&text);
        int common = !states, own_state = i >= first && i < end;
        if (!(common && hide_same(card->name, "SENSORS")) && !(own_state && is_one_of(card->name, 6, dropped)))
            add_card(&text, deck, card);
        if (hide_same(card->name, "STATE") && i != first)
            add_common_sensors(&text, deck, &cards, i);
        if (i == end - 1)
            add_measured(&text, modes_file);
    }
    hide_cards_free(&cards);
    if (!status)
        return hammer_file_write(path, &text, &to);
    free(text.data);
    return status;
}

int hammer_write_deck(const struct hammer_test *test, const char *modes_file, const char *path, char *message, size_t room)
{
    static const char *const dropped[] = {"MODES", "SHAPE", "MEASURED", "NOISE", "FIT", "SENSORS"};
    struct hide_message to = {message, room};
    struct hide_text text = {NULL, 0, 0, 0};
    struct hide_cards cards = {0};
    int status = hide_cards_read(test->deck, "deck", &cards, &to);
    if (!status)
        hide_add_bytes(&text, test->deck, cards.cards ? cards.card[0].begin : 0);
    for (int i = 0; i < cards.cards && !status; i++) {
        if (!is_one_of(cards.card[i].name, 6, dropped))
            add_card(&text, test->deck, &cards.card[i]);
    }
    hide_cards_free(&cards);
    if (status) {
        free(text.data);
        return status;
    }
    add_measured(&text, modes_file);
    add_fit(&text);
    return hammer_file_write(path, &text, &to);
}
