/* The truth as JSON, one value of interest a line. */
#include <stdio.h>
#include <string.h>

#include "hide_write.h"

static void add_string(struct hide_text *text, const char *string)
{
    hide_add(text, "\"");
    for (; *string; string++)
        if ((unsigned char)*string < 0x20)
            hide_add(text, "\\u%04x", (unsigned char)*string);
        else
            hide_add(text, *string == '"' || *string == '\\' ? "\\%c" : "%c", *string);
    hide_add(text, "\"");
}

static void add_numbers(struct hide_text *text, int count, const double *value)
{
    hide_add(text, "[");
    for (int i = 0; i < count; i++)
        hide_add(text, "%s%.12g", i ? ", " : "", value[i]);
    hide_add(text, "]");
}

static void add_integers(struct hide_text *text, int count, const int *value)
{
    hide_add(text, "[");
    for (int i = 0; i < count; i++)
        hide_add(text, "%s%d", i ? ", " : "", value[i]);
    hide_add(text, "]");
}

static void add_data(struct hide_text *text, const char *name, const struct hide_data *data)
{
    hide_add(text, "  \"%s\": {\n    \"frequency_mode\": ", name);
    add_integers(text, data->rows, data->origin);
    hide_add(text, ",\n    \"shape_mode\": ");
    add_integers(text, data->rows, data->shape_origin);
    hide_add(text, ",\n    \"frequency_hz\": ");
    add_numbers(text, data->rows, data->hz);
    hide_add(text, ",\n    \"shape\": [");
    for (int k = 0; k < data->rows && data->shape; k++) {
        hide_add(text, "%s\n      ", k ? "," : "");
        add_numbers(text, data->sensors, data->shape + (ptrdiff_t)k * data->sensors);
    }
    hide_add(text, "]\n  }");
}

/* A spring or a disk has a name, or the number it has in the deck. */
static void name_or_number(const char *own, int number, char *name, size_t room)
{
    if (own[0])
        snprintf(name, room, "%s", own);
    else
        snprintf(name, room, "%d", number);
}

/* The target of an effect as its card would name it; "" where it has none. */
static void name_target(const struct hide_rotor *rotor, const struct hide_effect *e, char *name, size_t room)
{
    name[0] = 0;
    for (int k = 0; k < HIDE_MOST_KEYS && e->kind->key[k].name; k++) {
        const struct hide_value *value = &e->value[k];
        if (!value->given)
            continue;
        switch (e->kind->key[k].type) {
        case HIDE_GROUP:
        case HIDE_KNOWN_GROUP:
            snprintf(name, room, "%s", rotor->group[value->index].name);
            break;
        case HIDE_INTERFACE:
            snprintf(name, room, "%s,%s", rotor->group[value->index].name, rotor->group[value->index + 1].name);
            break;
        case HIDE_TIE:
            snprintf(name, room, "%s", rotor->tie[value->index].name);
            break;
        case HIDE_SPRING:
            name_or_number(rotor->spring[value->index].name, value->index + 1, name, room);
            break;
        case HIDE_DISK:
            name_or_number(rotor->disk[value->index].name, value->index + 1, name, room);
            break;
        case HIDE_SENSOR: /* the first one: a duplicate has another key */
            if (!name[0])
                snprintf(name, room, "%ld", rotor->sensor[value->index].id);
            break;
        case HIDE_SENSOR_PAIR:
            snprintf(name, room, "%ld,%ld", rotor->sensor[value->index].id, rotor->sensor[value->second].id);
            break;
        case HIDE_WORD:
            if (!strcmp(e->kind->key[k].name, "block"))
                hide_word(e->kind->key[k].words, value->index, room, name);
            break;
        default:
            break;
        }
    }
}

/* Keys as numbers and words; of a target, what it is called in the SPEC. */
static void add_parameters(struct hide_text *text, const struct hide_rotor *rotor, const struct hide_effect *e)
{
    int count = 0;
    char word[HIDE_NAME];
    hide_add(text, "{");
    for (int k = 0; k < HIDE_MOST_KEYS && e->kind->key[k].name; k++) {
        const struct hide_key *key = &e->kind->key[k];
        const struct hide_value *value = &e->value[k];
        int optional_number = key->type == HIDE_NUMBER && !key->required;
        if (!value->given && !optional_number && key->type != HIDE_WORD)
            continue;
        if (key->type == HIDE_GROUP || key->type == HIDE_KNOWN_GROUP || key->type == HIDE_TIE || key->type == HIDE_SPRING ||
            key->type == HIDE_DISK)
            continue;
        hide_add(text, "%s\"%s\": ", count++ ? ", " : "", key->type == HIDE_INTERFACE ? "z" : key->name);
        if (key->type == HIDE_WORD) {
            hide_word(key->words, value->index, sizeof word, word);
            add_string(text, word);
        } else if (key->type == HIDE_SENSOR)
            hide_add(text, "%ld", rotor->sensor[value->index].id);
        else if (key->type == HIDE_SENSOR_PAIR)
            hide_add(text, "[%ld, %ld]", rotor->sensor[value->index].id, rotor->sensor[value->second].id);
        else if (key->type == HIDE_MODE)
            hide_add(text, "%d", value->index + 1);
        else if (key->type == HIDE_MODE_PAIR)
            hide_add(text, "[%d, %d]", value->index + 1, value->second + 1);
        else
            hide_add(text, "%.12g", value->number);
    }
    hide_add(text, "}");
}

static void add_effect(struct hide_text *text, const struct hide_rotor *rotor, const struct hide_effect *e)
{
    static const char *const classes[] = {"physical", "data", "outside"};
    char target[2 * HIDE_NAME];
    name_target(rotor, e, target, sizeof target);
    hide_add(text, "    {\"id\": \"%s\", ", e->kind->id);
    if (e->kind->outside)
        hide_add(text, "\"kind\": \"%s\", ", e->kind->outside);
    hide_add(text, "\"class\": \"%s\", \"target\": ", classes[e->kind->class]);
    if (target[0])
        add_string(text, target);
    else
        hide_add(text, "null");
    hide_add(text, ", \"parameters\": ");
    add_parameters(text, rotor, e);
    hide_add(text, ", \"spec\": ");
    add_string(text, e->spec);
    hide_add(text, "}");
}

static void add_request(const struct hide_truth *truth, struct hide_text *text)
{
    const struct hide_request *request = truth->request;
    const struct hide_rotor *rotor = truth->physics->rotor;
    hide_add(text, "{\n  \"schema\": 1,\n  \"deck\": ");
    add_string(text, request->name);
    hide_add(text, ",\n  \"seed\": %llu,\n  \"random\": ", (unsigned long long)request->seed);
    if (request->random)
        add_string(text, request->random);
    else
        hide_add(text, "null");
    hide_add(text,
             ",\n  \"modes\": %d,\n  \"rigid_modes\": %d,\n  \"refine\": %d,\n  \"frequency_error\": %.2g,\n"
             "  \"length\": %.12g,\n",
             truth->modes, truth->rigid, truth->hidden->refine, truth->hidden->error, rotor->length);
    hide_add(text, "  \"noise\": {\"frequency\": %.12g, \"shape\": %.12g, \"correlation\": %.12g},\n", truth->frequency_noise,
             truth->shape_noise, request->correlation);
    hide_add(text, "  \"stated_noise\": {\"frequency\": %.12g, \"shape\": %.12g},\n", truth->stated_frequency_noise,
             truth->stated_shape_noise);
}

void hide_write_truth(const struct hide_truth *truth, struct hide_text *text)
{
    const struct hide_rotor *rotor = truth->physics->rotor;
    double z[HIDE_MOST_SENSORS];
    add_request(truth, text);
    hide_add(text, "  \"effects\": [");
    for (int i = 0; i < truth->physics->effects; i++) {
        hide_add(text, i ? ",\n" : "\n");
        add_effect(text, rotor, &truth->physics->effect[i]);
    }
    hide_add(text, "%s],\n  \"parameters\": [", truth->physics->effects ? "\n  " : "");
    for (int i = 0; i < rotor->parameters; i++) {
        hide_add(text, "%s\n    {\"name\": ", i ? "," : "");
        add_string(text, rotor->parameter[i].name);
        hide_add(text, ", \"value\": %.12g}", rotor->parameter[i].truth);
    }
    hide_add(text, "%s],\n  \"sensors\": [", rotor->parameters ? "\n  " : "");
    hide_true_positions(truth->physics, z);
    for (int s = 0; s < rotor->sensors; s++)
        hide_add(text, "%s\n    {\"id\": %ld, \"z\": %.12g, \"true_z\": %.12g}", s ? "," : "", rotor->sensor[s].id,
                 rotor->sensor[s].z, z[s]);
    hide_add(text, "%s],\n", rotor->sensors ? "\n  " : "");
    add_data(text, "with", truth->with);
    hide_add(text, ",\n");
    add_data(text, "without", truth->without);
    hide_add(text, "\n}\n");
}
