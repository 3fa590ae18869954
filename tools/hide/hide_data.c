#include "hide_data.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sensors in order along the rotor, into order[sensors]: noise is correlated between neighbours. */
static void sort_sensors(const struct hide_rotor *rotor, int *order)
{
    for (int s = 0; s < rotor->sensors; s++) {
        int at = s;
        for (; at > 0 && rotor->sensor[order[at - 1]].z > rotor->sensor[s].z; at--)
            order[at] = order[at - 1];
        order[at] = s;
    }
}

int hide_noise_draw(uint64_t seed, const struct hide_rotor *rotor, double correlation, struct hide_noise *noise,
                    const struct hide_message *message)
{
    struct hide_random random;
    int order[HIDE_MOST_SENSORS];
    *noise = (struct hide_noise){.shape = calloc(HIDE_MOST_ROWS * (size_t)rotor->sensors + 1, sizeof *noise->shape)};
    if (!noise->shape)
        return hide_fail(message, HIDE_FAILURE, "no memory for noise");
    hide_random_open(seed, HIDE_FOR_FREQUENCIES, &random);
    for (int k = 0; k < HIDE_MOST_ROWS; k++)
        noise->frequency[k] = hide_normal(&random);
    hide_random_open(seed, HIDE_FOR_SHAPES, &random);
    sort_sensors(rotor, order);
    for (int k = 0; k < HIDE_MOST_ROWS; k++)
        for (int i = 0; i < rotor->sensors; i++) {
            double *row = noise->shape + (ptrdiff_t)k * rotor->sensors, fresh = hide_normal(&random);
            row[order[i]] = i == 0 ? fresh : correlation * row[order[i - 1]] + sqrt(1 - correlation * correlation) * fresh;
        }
    return HIDE_OK;
}

void hide_noise_free(struct hide_noise *noise)
{
    free(noise->shape);
}

void hide_data_free(struct hide_data *data)
{
    free(data->shape);
}

void hide_true_positions(const struct hide_physics *physics, double *z)
{
    const struct hide_rotor *rotor = physics->rotor;
    for (int s = 0; s < rotor->sensors; s++)
        z[s] = rotor->sensor[s].z;
    for (int i = 0; i < physics->effects; i++)
        for (int s = 0; s < rotor->sensors && hide_is(&physics->effect[i], "sensor_line"); s++)
            z[s] = hide_on_line(rotor, &physics->effect[i], s);
    for (int i = 0; i < physics->effects; i++)
        if (hide_is(&physics->effect[i], "sensor_position"))
            z[hide_get(&physics->effect[i], "sensor")->index] += hide_get(&physics->effect[i], "shift")->number;
}

static double *row(struct hide_data *data, int k)
{
    return data->shape + (ptrdiff_t)k * data->sensors;
}

/* A second mode beside another one, as of the other plane of a rotor that is nearly round; noise comes later. */
static void double_mode(struct hide_data *data, int mode, double split)
{
    int at = 0;
    while (at < data->rows && data->origin[at] != mode + 1)
        at++;
    if (at == data->rows)
        return;
    for (int k = data->rows++; k > at; k--) {
        data->hz[k] = data->hz[k - 1];
        data->origin[k] = data->origin[k - 1];
        data->shape_origin[k] = data->shape_origin[k - 1];
        if (data->shape)
            memcpy(row(data, k), row(data, k - 1), (size_t)data->sensors * sizeof(double));
    }
    data->hz[at + 1] = data->hz[at] * (1 + split);
    data->origin[at + 1] = 0;
}

static void drop_mode(struct hide_data *data, int mode)
{
    int to = 0;
    for (int k = 0; k < data->rows; k++) {
        if (data->origin[k] == mode + 1)
            continue;
        data->hz[to] = data->hz[k];
        data->origin[to] = data->origin[k];
        data->shape_origin[to] = data->shape_origin[k];
        if (data->shape)
            memmove(row(data, to), row(data, k), (size_t)data->sensors * sizeof(double));
        to++;
    }
    data->rows = to;
}

static void swap(double *a, double *b)
{
    double keep = *a;
    *a = *b;
    *b = keep;
}

/* Frequencies rise with the number in every deck, so what two modes exchange is their shapes. */
static void swap_modes(struct hide_data *data, int a, int b)
{
    int at[2] = {-1, -1};
    for (int k = 0; k < data->rows; k++) {
        at[0] = data->origin[k] == a + 1 ? k : at[0];
        at[1] = data->origin[k] == b + 1 ? k : at[1];
    }
    if (at[0] < 0 || at[1] < 0)
        return;
    for (int s = 0; s < data->sensors; s++)
        swap(&row(data, at[0])[s], &row(data, at[1])[s]);
    int keep = data->shape_origin[at[0]];
    data->shape_origin[at[0]] = data->shape_origin[at[1]];
    data->shape_origin[at[1]] = keep;
}

/* A fault of the table of modes, before noise: each row has noise of its own. */
static void fault_of_modes(const struct hide_effect *e, struct hide_data *data)
{
    const struct hide_value *exchanged = hide_get(e, "swap");
    if (hide_get(e, "double")->given)
        double_mode(data, hide_get(e, "double")->index, hide_get(e, "split")->number);
    if (hide_get(e, "missing")->given)
        drop_mode(data, hide_get(e, "missing")->index);
    if (exchanged->given && data->shape)
        swap_modes(data, exchanged->index, exchanged->second);
}

/* A fault of a channel, after noise: what a channel picks up goes through it too. */
static void fault_of_channels(const struct hide_effect *e, struct hide_data *data)
{
    int sensor = hide_get(e, "sensor")->index;
    for (int k = 0; k < data->rows && data->shape; k++) {
        double *v = row(data, k);
        if (hide_is(e, "sensor_gain"))
            v[sensor] *= hide_get(e, "gain")->number;
        else if (hide_is(e, "sensor_sign"))
            v[sensor] = -v[sensor];
        else if (hide_is(e, "sensor_swap"))
            swap(&v[hide_get(e, "sensors")->index], &v[hide_get(e, "sensors")->second]);
        else if (hide_is(e, "duplicate_channel"))
            v[sensor] = v[hide_get(e, "of")->index];
    }
}

static void add_noise(double frequency_noise, double shape_noise, const struct hide_noise *noise, int modes,
                      struct hide_data *data)
{
    int more = modes; /* rows of noise beyond those of the modes */
    for (int k = 0; k < data->rows; k++) {
        int f = data->origin[k] ? data->origin[k] - 1 : more, s = data->origin[k] ? data->shape_origin[k] - 1 : more;
        more += !data->origin[k];
        data->hz[k] *= 1 + frequency_noise * noise->frequency[f];
        for (int i = 0; i < data->sensors && data->shape; i++)
            row(data, k)[i] += shape_noise * noise->shape[(ptrdiff_t)s * data->sensors + i];
    }
    for (int k = 1; k < data->rows; k++) /* two close ones may have changed places, and a table is by frequency */
        if (data->hz[k] < data->hz[k - 1])
            swap(&data->hz[k], &data->hz[k - 1]);
}

int hide_record(const struct hide_physics *physics, const struct hide_solution *solution, int shapes, double frequency_noise,
                double shape_noise, const struct hide_noise *noise, struct hide_data *data, const struct hide_message *message)
{
    int modes = solution->modes, sensors = shapes ? solution->sensors : 0;
    *data = (struct hide_data){.rows = modes, .sensors = sensors};
    if (sensors && !(data->shape = calloc(HIDE_MOST_ROWS * (size_t)sensors, sizeof *data->shape)))
        return hide_fail(message, HIDE_FAILURE, "no memory for shapes");
    memcpy(data->hz, solution->hz, (size_t)modes * sizeof *data->hz);
    if (sensors)
        memcpy(data->shape, solution->shape, (size_t)modes * (size_t)sensors * sizeof *data->shape);
    for (int k = 0; k < modes; k++)
        data->origin[k] = data->shape_origin[k] = k + 1;
    for (int i = 0; i < physics->effects; i++)
        if (hide_is(&physics->effect[i], "mode_pairing"))
            fault_of_modes(&physics->effect[i], data);
    if (noise)
        add_noise(frequency_noise, shape_noise, noise, modes, data);
    for (int i = 0; i < physics->effects; i++)
        fault_of_channels(&physics->effect[i], data);
    return HIDE_OK;
}
