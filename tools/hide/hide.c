#include "hide.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hide_draw.h"
#include "hide_parameter.h"
#include "hide_states.h"
#include "hide_write.h"

struct hide_request hide_request_default(void)
{
    return (struct hide_request){.name = "deck",
                                 .seed = 1,
                                 .modes = 6,
                                 .frequency_noise = 0.001,
                                 .shape_noise = 0.015,
                                 .stated_frequency_noise = NAN,
                                 .stated_shape_noise = NAN,
                                 .refine = 1};
}

#define STATE_NOISE 1000003u /* apart from the seeds that somebody counts */

/* All of one case, on the heap: it is too large for the stack of a thread. */
struct work {
    struct hide_cards cards;
    struct hide_rotor rotor;
    struct hide_effect effect[HIDE_MOST_EFFECTS];
    int effects;
    struct hide_noise noise;
    struct hide_solution bare, hidden; /* without the effects, with them */
    struct hide_data measured, with, without;
    struct hide_text data, truth;
};

static int check(const struct hide_request *r, const struct hide_message *message)
{
    if (!r->deck || !r->name)
        return hide_fail(message, HIDE_INPUT, "no deck, expected one");
    if (r->modes < 1 || r->modes > HIDE_MOST_MODES)
        return hide_fail(message, HIDE_INPUT, "--modes %d: expected 1 to %d", r->modes, HIDE_MOST_MODES);
    if (r->sensors == 1 || r->sensors < 0 || r->sensors > HIDE_MOST_SENSORS)
        return hide_fail(message, HIDE_INPUT, "--sensors %d: expected 2 to %d", r->sensors, HIDE_MOST_SENSORS);
    if (!(r->frequency_noise >= 0 && r->frequency_noise < 0.5) || !(r->shape_noise >= 0 && r->shape_noise < 1e3))
        return hide_fail(message, HIDE_INPUT, "expected noise not below zero, and that of frequencies below 0.5");
    if (r->stated_frequency_noise < 0 || r->stated_shape_noise < 0)
        return hide_fail(message, HIDE_INPUT, "expected stated noise not below zero");
    if (!(r->correlation > -1 && r->correlation < 1))
        return hide_fail(message, HIDE_INPUT, "--correlated %g: expected a number above -1 and below 1", r->correlation);
    if (r->effects < 0 || r->effects > HIDE_MOST_EFFECTS - 2)
        return hide_fail(message, HIDE_INPUT, "--effect: expected at most %d", HIDE_MOST_EFFECTS - 2);
    if (r->refine < 1 || r->refine > 16)
        return hide_fail(message, HIDE_INPUT, "--refine %d: expected 1 to 16", r->refine);
    return HIDE_OK;
}

static int choose_sensors(const struct hide_request *r, struct hide_rotor *rotor, const struct hide_message *message)
{
    if (r->sensors) {
        rotor->sensors = r->sensors;
        for (int s = 0; s < r->sensors; s++) /* as the deck will say it, to the micrometre */
            rotor->sensor[s] =
                (struct hide_sensor){s + 1, fmin(floor(rotor->length * s / (r->sensors - 1) * 1e6 + 0.5) * 1e-6, rotor->length)};
    }
    if (r->half_sensors) {
        int kept = 0;
        for (int s = 0; s < rotor->sensors; s += 2)
            rotor->sensor[kept++] = rotor->sensor[s];
        rotor->sensors = kept;
    }
    if (!rotor->sensors && !r->no_shapes)
        return hide_fail(message, HIDE_INPUT, "%s: no *SENSORS, expected --sensors N or --no-shapes", r->name);
    return HIDE_OK;
}

static int needs_shapes(const struct hide_effect *e)
{
    if (hide_is(e, "accelerometer_mass"))
        return hide_get(e, "mount")->index == 1;
    if (hide_is(e, "mode_pairing"))
        return hide_get(e, "swap")->given;
    if (hide_is(e, "noise_level"))
        return hide_get(e, "block")->index == 0;
    return e->kind->class == HIDE_DATA;
}

static int choose_effects(const struct hide_request *r, struct work *work, const struct hide_message *message)
{
    char drawn[2][HIDE_SPEC];
    int count = 0, status;
    struct hide_random random;
    hide_random_open(r->seed, HIDE_FOR_EFFECTS, &random);
    if (r->random && (status = hide_draw(&work->rotor, r->modes, r->no_shapes, r->random, &random, drawn, &count, message)))
        return status;
    for (int i = 0; i < r->effects + count; i++) {
        const char *spec = i < r->effects ? r->effect[i] : drawn[i - r->effects];
        struct hide_effect *effect = &work->effect[work->effects++];
        if ((status = hide_effect_read(&work->rotor, r->modes, spec, effect, message)))
            return status;
        if (r->no_shapes && needs_shapes(effect))
            return hide_fail(message, HIDE_INPUT, "--effect %s: expected no --no-shapes with it", spec);
    }
    return HIDE_OK;
}

/* noise_level: the data have `factor` times the noise that is stated. */
static void multiply_noise(const struct work *work, struct hide_truth *truth)
{
    for (int i = 0; i < work->effects; i++) {
        const struct hide_effect *e = &work->effect[i];
        if (hide_is(e, "noise_level"))
            *(hide_get(e, "block")->index == 0 ? &truth->shape_noise : &truth->frequency_noise) *= hide_get(e, "factor")->number;
    }
}

static int make(const struct hide_request *r, struct work *work, const struct hide_message *message)
{
    struct hide_random random;
    struct hide_physics bare = {.rotor = &work->rotor, .refine = r->refine, .ground = 1}, physics;
    struct hide_truth truth = {.request = r,
                               .physics = &physics,
                               .modes = r->modes,
                               .shapes = !r->no_shapes,
                               .frequency_noise = r->frequency_noise,
                               .shape_noise = r->shape_noise,
                               .with = &work->with,
                               .without = &work->without};
    double stated[HIDE_MOST_SENSORS], true_z[HIDE_MOST_SENSORS];
    int status, sensors;
    hide_random_open(r->seed, HIDE_FOR_PARAMETERS, &random);
    if ((status = hide_cards_read(r->deck, r->name, &work->cards, message)) ||
        (status = hide_rotor_read(&work->cards, r->name, &work->rotor, message)) ||
        (status = hide_parameters_set(r->truths, r->truth, &random, &work->rotor, message)) ||
        (status = choose_sensors(r, &work->rotor, message)) || (status = choose_effects(r, work, message)))
        return status;
    truth.stated_frequency_noise = isnan(r->stated_frequency_noise) ? truth.frequency_noise : r->stated_frequency_noise;
    truth.stated_shape_noise = isnan(r->stated_shape_noise) ? truth.shape_noise : r->stated_shape_noise;
    multiply_noise(work, &truth);
    physics = bare;
    physics.effects = work->effects;
    physics.effect = work->effect;
    truth.hidden = &work->hidden;
    sensors = truth.shapes ? work->rotor.sensors : 0;
    for (int i = 0; i < work->rotor.sensors; i++)
        stated[i] = work->rotor.sensor[i].z;
    hide_true_positions(&physics, true_z);
    /* Modes are counted from the same one with and without the effects: a spring to the ground is no new mode. */
    if ((status = hide_rigid_modes(&bare, &truth.rigid, message)) ||
        (status =
             hide_noise_draw(r->seed + STATE_NOISE * (uint64_t)r->state, &work->rotor, r->correlation, &work->noise, message)) ||
        (status = hide_solve(&bare, truth.rigid, r->modes, sensors, stated, &work->bare, message)) ||
        (status = hide_solve(&physics, truth.rigid, r->modes, sensors, true_z, &work->hidden, message)) ||
        (status = hide_record(&bare, &work->bare, truth.shapes, 0, 0, NULL, &work->without, message)) ||
        (status = hide_record(&physics, &work->hidden, truth.shapes, 0, 0, NULL, &work->with, message)) ||
        (status = hide_record(&physics, &work->hidden, truth.shapes, truth.frequency_noise, truth.shape_noise, &work->noise,
                              &work->measured, message)))
        return status;
    hide_write_data(&truth, r->sensors || r->half_sensors, &work->measured, &work->data);
    hide_write_truth(&truth, &work->truth);
    return work->data.failed || work->truth.failed ? hide_fail(message, HIDE_FAILURE, "no memory for the texts") : HIDE_OK;
}

int hide_one(const struct hide_request *request, struct hide_part *part, const struct hide_message *message)
{
    struct work *work = calloc(1, sizeof *work);
    int status = work ? check(request, message) : hide_fail(message, HIDE_FAILURE, "no memory for a case");
    *part = (struct hide_part){.effects = 0};
    if (!status)
        status = make(request, work, message);
    if (!work)
        return status;
    part->data = work->data;
    part->truth = work->truth;
    part->effects = work->effects;
    for (int i = 0; i < work->effects; i++)
        memcpy(part->spec[i], work->effect[i].spec, sizeof part->spec[i]);
    hide_cards_free(&work->cards);
    hide_noise_free(&work->noise);
    hide_solution_free(&work->bare);
    hide_solution_free(&work->hidden);
    hide_data_free(&work->measured);
    hide_data_free(&work->with);
    hide_data_free(&work->without);
    free(work);
    return status;
}

void hide_part_free(struct hide_part *part)
{
    free(part->data.data);
    free(part->truth.data);
}

static int make_one(const struct hide_request *request, const struct hide_cards *cards, struct hide_text *deck,
                    struct hide_text *truth, const struct hide_message *message)
{
    struct hide_part part;
    int status = request->effects_in
                     ? hide_fail(message, HIDE_INPUT, "--effect-in: %s has no *STATE, expected --effect", request->name)
                     : hide_one(request, &part, message);
    if (request->effects_in)
        return status;
    if (!status) {
        hide_write_cards(request->deck, cards, 0, cards->cards, request->sensors || request->half_sensors, deck);
        hide_add_bytes(deck, part.data.data, part.data.length);
        hide_add_bytes(truth, part.truth.data, part.truth.length);
    }
    hide_part_free(&part);
    return status;
}

int hide_case(const struct hide_request *request, char **deck, char **truth, char *message, size_t room)
{
    struct hide_message to = {message, room};
    struct hide_cards cards = {NULL, 0, NULL, NULL};
    struct hide_text deck_text = {NULL, 0, 0, 0}, truth_text = {NULL, 0, 0, 0};
    int status = check(request, &to), several = 0;
    *deck = *truth = NULL;
    if (!status)
        status = hide_cards_read(request->deck, request->name, &cards, &to);
    for (int i = 0; i < cards.cards; i++)
        several |= hide_same(cards.card[i].name, "STATE");
    if (!status)
        status = several ? hide_states(request, &cards, &deck_text, &truth_text, &to)
                         : make_one(request, &cards, &deck_text, &truth_text, &to);
    if (!status && (deck_text.failed || truth_text.failed))
        status = hide_fail(&to, HIDE_FAILURE, "no memory for the texts");
    hide_cards_free(&cards);
    if (status) {
        free(deck_text.data);
        free(truth_text.data);
        return status;
    }
    *deck = deck_text.data;
    *truth = truth_text.data;
    return status;
}

char *hide_list(void)
{
    struct hide_text text = {NULL, 0, 0, 0};
    for (int i = 0; i < hide_kinds(); i++) {
        const struct hide_kind *kind = hide_kind(i);
        hide_add(&text, "%s", kind->id);
        if (kind->outside)
            hide_add(&text, ":kind=%s", kind->outside);
        for (int k = 0; k < HIDE_MOST_KEYS && kind->key[k].name; k++) {
            const struct hide_key *key = &kind->key[k];
            static const char *const what[] = {[HIDE_NUMBER] = "NUMBER",
                                               [HIDE_PLACE] = "PLACE",
                                               [HIDE_GROUP] = "GROUP",
                                               [HIDE_KNOWN_GROUP] = "GROUP",
                                               [HIDE_INTERFACE] = "GROUP.end",
                                               [HIDE_TIE] = "TIEROD",
                                               [HIDE_SPRING] = "SPRING",
                                               [HIDE_DISK] = "DISK",
                                               [HIDE_SENSOR] = "SENSOR",
                                               [HIDE_SENSOR_PAIR] = "SENSOR+SENSOR",
                                               [HIDE_MODE] = "MODE",
                                               [HIDE_MODE_PAIR] = "MODE+MODE",
                                               [HIDE_WORD] = NULL};
            const char *value = what[key->type] ? what[key->type] : key->words;
            const char *before = k || kind->outside ? "," : ":";
            hide_add(&text, key->required ? "%s%s=%s" : "[%s%s=%s]", before, key->name, value);
        }
        hide_add(&text, "\n");
    }
    if (text.failed) {
        free(text.data);
        return NULL;
    }
    return text.data;
}
