/* Set 58. */
#include <math.h>

#include "rotid.h"
#include "uff/uff_record.h"
#include "uff/uff_write.h"

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
