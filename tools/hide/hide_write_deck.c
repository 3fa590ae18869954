#include "hide_write.h"

static int is_measured(const struct hide_card *card, int new_sensors)
{
    static const char *const dropped[] = {"MODES", "SHAPE", "MEASURED", "FREQUENCIES", "NOISE", "FIT", "FRF"};
    for (size_t i = 0; i < sizeof dropped / sizeof *dropped; i++)
        if (hide_same(card->name, dropped[i]))
            return 1;
    return new_sensors && hide_same(card->name, "SENSORS");
}

void hide_write_cards(const char *deck, const struct hide_cards *cards, int first, int end, int new_sensors,
                      struct hide_text *text)
{
    if (first == 0)
        hide_add_bytes(text, deck, cards->cards ? cards->card[0].begin : 0);
    for (int i = first; i < end; i++)
        if (!is_measured(&cards->card[i], new_sensors))
            hide_add_bytes(text, deck + cards->card[i].begin, cards->card[i].end - cards->card[i].begin);
    if (text->length && text->data[text->length - 1] != '\n')
        hide_add(text, "\n");
}

void hide_write_data(const struct hide_truth *truth, int new_sensors, const struct hide_data *data, struct hide_text *text)
{
    const struct hide_rotor *rotor = truth->physics->rotor;
    if (new_sensors) {
        hide_add(text, "*SENSORS\n");
        for (int s = 0; s < rotor->sensors; s++)
            hide_add(text, "%ld, %.6f\n", rotor->sensor[s].id, rotor->sensor[s].z);
    }
    if (truth->stated_frequency_noise > 0 || (data->shape && truth->stated_shape_noise > 0)) {
        hide_add(text, "*NOISE");
        if (truth->stated_frequency_noise > 0)
            hide_add(text, ", FREQUENCY=%g", truth->stated_frequency_noise);
        if (data->shape && truth->stated_shape_noise > 0)
            hide_add(text, ", SHAPE=%g", truth->stated_shape_noise);
        hide_add(text, "\n");
    }
    hide_add(text, "*MODES\n");
    for (int k = 0; k < data->rows; k++)
        hide_add(text, "%d, %.10g\n", k + 1, data->hz[k]);
    for (int k = 0; k < data->rows && data->shape; k++) {
        hide_add(text, "*SHAPE, MODE=%d\n", k + 1);
        for (int s = 0; s < data->sensors; s++)
            hide_add(text, "%ld, %.8g\n", rotor->sensor[s].id, data->shape[(ptrdiff_t)k * data->sensors + s]);
    }
}
