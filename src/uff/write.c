#include "uff/uff.h"

#include <math.h>
#include <string.h>

/* Sets that are written in one go: header, units, geometry. */

/* A date and a time of ten columns each, kept as one text. */
static void put_date(struct uff_put *put, const char *text)
{
    uff_put_text(put, 20, text, "");
}

int uff_write_header(FILE *stream, const struct uff_header *header)
{
    struct uff_put put;
    uff_put_open(&put, stream, 151);
    uff_put_text_line(&put, header->model);
    uff_put_text_line(&put, header->description);
    uff_put_text_line(&put, header->program);
    put_date(&put, header->created);
    uff_put_integer(&put, 10, header->version[0]);
    uff_put_integer(&put, 10, header->version[1]);
    uff_put_integer(&put, 10, header->file_type);
    uff_put_line(&put);
    put_date(&put, header->saved);
    uff_put_line(&put);
    uff_put_text_line(&put, header->written_by);
    put_date(&put, header->written);
    uff_put_line(&put);
    return uff_put_close(&put);
}

int uff_write_units(FILE *stream, const struct uff_units *units)
{
    const double factor[] = {units->length, units->force, units->temperature, units->temperature_offset};
    struct uff_put put;
    uff_put_open(&put, stream, 164);
    uff_put_record(&put, &uff_units_164, units);
    uff_put_reals(&put, 25, 16, 3, 4, factor);
    return uff_put_close(&put);
}

int uff_write_nodes(FILE *stream, int set, int count, const struct uff_node *node)
{
    struct uff_put put;
    if ((set != 15 && set != 2411) || count < 0)
        return ROTID_ERROR_ARGUMENT;
    uff_put_open(&put, stream, set);
    for (int i = 0; i < count && put.status == ROTID_OK; ++i) {
        uff_put_record(&put, set == 15 ? &uff_node_15 : &uff_node_2411, &node[i]);
        if (set == 2411)
            uff_put_record(&put, &uff_place_2411, &node[i]);
    }
    return uff_put_close(&put);
}

/* Data at nodes: sets 55 and 2414. */

enum { NORMAL_MODE = 2, COMPLEX_FIRST_ORDER = 3, COMPLEX_SECOND_ORDER = 7 }; /* analysis type */

static void put_ids(struct uff_put *put, const char (*id)[UFF_TEXT + 1])
{
    for (int i = 0; i < UFF_ID_LINES; ++i)
        uff_put_text_line(put, id[i]);
}

/* Records 7 and 8. The eigenvalue of a complex mode stands there and not its frequency. */
static void put_mode(struct uff_put *put, const struct uff_shape *shape)
{
    double real[6] = {shape->frequency_hz};
    int count = 1;
    if (shape->analysis_type == NORMAL_MODE) {
        real[1] = shape->modal_mass;
        real[2] = shape->damping;
        real[3] = shape->hysteretic;
        count = 4;
    } else if (shape->analysis_type == COMPLEX_FIRST_ORDER || shape->analysis_type == COMPLEX_SECOND_ORDER) {
        memcpy(real, shape->eigenvalue, sizeof shape->eigenvalue);
        memcpy(real + 2, shape->modal_a, sizeof shape->modal_a);
        memcpy(real + 4, shape->modal_b, sizeof shape->modal_b);
        count = 6;
    }
    const int record[] = {2, count, shape->load_case, shape->number};
    uff_put_integers(put, 10, 8, 4, record);
    uff_put_reals(put, 13, 5, 6, count, real);
}

int uff_write_shape(FILE *stream, const struct uff_shape *shape)
{
    int components = shape->component_count, is_complex = shape->is_complex != 0;
    int is_eigenvalue = shape->analysis_type == COMPLEX_FIRST_ORDER || shape->analysis_type == COMPLEX_SECOND_ORDER;
    if (components < 1 || components > 6 || shape->node_count < 0 || (is_complex && shape->node_count && !shape->imag))
        return ROTID_ERROR_ARGUMENT;
    if (is_eigenvalue && shape->frequency_hz > 0 && shape->eigenvalue[0] == 0 && shape->eigenvalue[1] == 0)
        return ROTID_ERROR_ARGUMENT; /* the frequency would be lost */

    struct uff_shape head = *shape;
    head.data_type = is_complex ? 5 : 2;
    struct uff_put put;
    uff_put_open(&put, stream, 55);
    put_ids(&put, shape->id);
    uff_put_record(&put, &uff_kind_55, &head);
    put_mode(&put, shape);
    for (int i = 0; i < shape->node_count && put.status == ROTID_OK; ++i) {
        double value[12];
        for (int c = 0; c < components; ++c) {
            size_t at = (size_t)components * (size_t)i + (size_t)c;
            value[is_complex ? 2 * c : c] = shape->real[at];
            if (is_complex)
                value[2 * c + 1] = shape->imag[at];
        }
        uff_put_integer(&put, 10, shape->node[i]);
        uff_put_line(&put);
        uff_put_reals(&put, 13, 5, 6, components * (is_complex ? 2 : 1), value);
    }
    return uff_put_close(&put);
}

/* Set 58. */

#define COUNT_MOST 9999999999 /* I10 */

static int is_complex(const struct uff_function *function)
{
    return function->ordinate == UFF_COMPLEX_SINGLE || function->ordinate == UFF_COMPLEX_DOUBLE;
}

static int is_double(const struct uff_function *function)
{
    return function->ordinate == UFF_REAL_DOUBLE || function->ordinate == UFF_COMPLEX_DOUBLE;
}

static void put_records(struct uff_put *put, const struct uff_function *function)
{
    for (int i = 0; i < UFF_ID_LINES; ++i)
        uff_put_text_line(put, function->id[i]);
    struct uff_function form = *function;
    form.is_even = function->is_even != 0;
    form.start = form.is_even ? form.start : 0;
    form.step = form.is_even ? form.step : 0;
    uff_put_record(put, &uff_location_58, function);
    uff_put_record(put, &uff_form_58, &form);
    uff_put_record(put, &uff_abscissa_58, function);
    uff_put_record(put, &uff_ordinate_58, function);
    uff_put_record(put, &uff_denominator_58, function);
    uff_put_record(put, &uff_z_axis_58, function);
}

int uff_write_function(FILE *stream, const struct uff_function *function, struct uff_function_writer *writer)
{
    struct uff_put put = {.stream = stream};
    *writer = (struct uff_function_writer){.stream = stream, .function = function};
    int known = function->ordinate == UFF_REAL_SINGLE || is_complex(function) || is_double(function);
    if (!known || function->binary.is_binary || function->count < 0 || function->count > COUNT_MOST)
        return ROTID_ERROR_ARGUMENT;
    uff_put_open(&put, stream, 58);
    put_records(&put, function);
    return put.status;
}

/* The columns of the format: 6E13.5, 4E20.12, 2(E13.5,E20.12), E13.5,2E20.12. */
static int write_text(struct uff_function_writer *writer, int count, const double *number, const int *is_abscissa)
{
    const struct uff_function *function = writer->function;
    int wide = is_double(function), uneven = !function->is_even;
    int per_line = !wide ? 6 : uneven && is_complex(function) ? 3 : 4;
    for (int i = 0; i < count; ++i) {
        int ordinate = wide && !is_abscissa[i];
        if (!isfinite(number[i]))
            return ROTID_ERROR_ARGUMENT;
        if (fprintf(writer->stream, ordinate ? "%20.12E" : "%13.5E", number[i]) < 0)
            return ROTID_ERROR_IO;
        if (++writer->on_line == per_line) {
            writer->on_line = 0;
            if (putc('\n', writer->stream) == EOF)
                return ROTID_ERROR_IO;
        }
    }
    return ROTID_OK;
}

int uff_write_values(struct uff_function_writer *writer, long long count, const double *x, const double *real, const double *imag)
{
    const struct uff_function *function = writer->function;
    int uneven = !function->is_even, pair = is_complex(function), status = ROTID_OK;
    if (count < 0 || count > function->count - writer->written || (count && (!real || (uneven && !x) || (pair && !imag))))
        return ROTID_ERROR_ARGUMENT;
    for (long long i = 0; i < count && status == ROTID_OK; ++i) {
        double number[3];
        int is_abscissa[3] = {uneven, 0, 0}, n = 0;
        if (uneven)
            number[n++] = x[i];
        number[n++] = real[i];
        if (pair)
            number[n++] = imag[i];
        status = write_text(writer, n, number, is_abscissa);
    }
    if (status == ROTID_OK)
        writer->written += count;
    return status;
}

int uff_end_function(struct uff_function_writer *writer)
{
    if (writer->written != writer->function->count)
        return ROTID_ERROR_ARGUMENT;
    if (writer->on_line && putc('\n', writer->stream) == EOF)
        return ROTID_ERROR_IO;
    return fputs("    -1\n", writer->stream) < 0 || ferror(writer->stream) ? ROTID_ERROR_IO : ROTID_OK;
}
