/* The two results: the deck with the data, and the truth. */
#ifndef HIDE_WRITE_H
#define HIDE_WRITE_H

#include "hide_data.h"

struct hide_truth {
    const struct hide_request *request;
    const struct hide_physics *physics;
    int modes, rigid, shapes;
    double frequency_noise, shape_noise;               /* of the data */
    double stated_frequency_noise, stated_shape_noise; /* of the deck */
    const struct hide_solution *hidden;
    const struct hide_data *with, *without; /* free of noise; without: no effect */
};

/* Cards first ... end - 1 of the deck without measured data; new_sensors: without sensors. The measured data. */
void hide_write_cards(const char *deck, const struct hide_cards *cards, int first, int end, int new_sensors,
                      struct hide_text *text);
void hide_write_data(const struct hide_truth *truth, int new_sensors, const struct hide_data *data, struct hide_text *text);
void hide_write_truth(const struct hide_truth *truth, struct hide_text *text);

#endif
