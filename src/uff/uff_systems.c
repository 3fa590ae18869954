/* Coordinate systems: set 18 by three points, set 2420 by its axes. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "uff/uff_reader.h"

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Makes the vector one of length 1; nonzero when it has no direction. `scale` is a length it must not be tiny against. */
static int normalize(double *a, double scale)
{
    double length = sqrt(dot(a, a));
    if (!(length > 1e-6 * scale) || !isfinite(length)) /* the six digits of the format */
        return 1;
    for (int i = 0; i < 3; ++i)
        a[i] /= length;
    return 0;
}

/* Set 18: origin, a point on the x axis, a point of the half plane x, +z. */
static int read_points(struct uff_lines *lines, const char *what, struct uff_system *system)
{
    double point[9];
    int status = uff_read_reals(lines, 9, 6, 13, what, point);
    if (status != ROTID_OK)
        return status;
    double *x = system->matrix, *y = x + 3, *z = x + 6;
    for (int i = 0; i < 3; ++i) {
        system->origin[i] = point[i];
        x[i] = point[3 + i] - point[i];
        z[i] = point[6 + i] - point[i];
    }
    int bad = normalize(x, 0);
    double along = dot(x, z), length = sqrt(dot(z, z));
    for (int i = 0; i < 3; ++i)
        z[i] -= along * x[i];
    bad |= normalize(z, length);
    if (bad)
        return uff_fail(lines, 0, "%s: the points lie on a line; expected an origin, a point on x, a point in the plane x, z",
                        what);
    y[0] = z[1] * x[2] - z[2] * x[1];
    y[1] = z[2] * x[0] - z[0] * x[2];
    y[2] = z[0] * x[1] - z[1] * x[0];
    return ROTID_OK;
}

/* Set 2420: three rows of the matrix, and the origin as the fourth. */
static int read_rows(struct uff_lines *lines, const char *what, struct uff_system *system)
{
    int status = ROTID_OK;
    for (int row = 0; row < 4 && status == ROTID_OK; ++row)
        status = uff_read_reals(lines, 3, 3, 25, what, row < 3 ? system->matrix + 3 * (ptrdiff_t)row : system->origin);
    return status;
}

/* One system, of which the first line is at hand. */
static int read_system(struct uff_lines *lines, int number, struct uff_system *system)
{
    static const struct uff_column column[] = {{UFF_REQUIRED_INTEGER, 0, 10},
                                               {UFF_INTEGER, 10, 10},
                                               {UFF_INTEGER, 20, 10},
                                               {UFF_INTEGER, 30, 10},
                                               {UFF_INTEGER, 40, 10}};
    static const char what[] = "a coordinate system (number, type, reference or color)";
    struct uff_cell cell[5];
    int columns = number == 18 ? 5 : 3; /* the fifth is the method of definition, and there is but one */
    *system = (struct uff_system){0};
    int status = uff_cut_record(lines, columns, column, what, cell);
    if (status != ROTID_OK)
        return status;
    if (cell[0].integer < INT_MIN || cell[0].integer > INT_MAX)
        return uff_fail(lines, 1, "%s: the number is too large for 32 bits", what);
    if (cell[1].integer < 0 || cell[1].integer > 2)
        return uff_fail(lines, 11, "%s: type %lld; expected 0 (cartesian), 1 (cylindrical) or 2 (spherical)", what,
                        cell[1].integer);
    system->id = (int)cell[0].integer;
    system->type = (int)cell[1].integer;
    system->reference = number == 18 ? (int)cell[2].integer : 0;
    system->color = (int)cell[number == 18 ? 3 : 2].integer;
    status = uff_expect_line(lines, "the name of a coordinate system");
    if (status != ROTID_OK)
        return status;
    uff_copy_text(lines->text, lines->length, sizeof system->name, system->name);
    return number == 18 ? read_points(lines, "record 3", system) : read_rows(lines, "records 5 to 8", system);
}

int uff_read_systems(struct uff_reader *reader, struct pool *pool, int *count, struct uff_system **out)
{
    struct pool scratch;
    struct uff_system *list = NULL;
    size_t used = 0, capacity = 0;
    char part[UFF_TEXT + 1];
    int number = reader->set.number, is_end = 0;
    *count = 0;
    *out = NULL;
    int status = number == 18 || number == 2420 ? uff_begin(reader, number) : ROTID_ERROR_ARGUMENT;
    if (status != ROTID_OK)
        return status;
    pool_open(&scratch, reader->allocator);
    for (int i = 0; i < 2 && number == 2420 && status == ROTID_OK; ++i)
        status = uff_read_text(&reader->lines, i ? "the name of a part" : "the number of a part", part);
    while (status == ROTID_OK) {
        status = uff_next_record(reader, "a coordinate system or '-1'", &is_end);
        if (status != ROTID_OK || is_end)
            break;
        struct uff_system *grown = used < INT_MAX ? pool_grow(&scratch, list, used, &capacity, sizeof *grown) : NULL;
        status = grown ? ROTID_OK : ROTID_ERROR_MEMORY;
        if (grown) {
            list = grown;
            status = read_system(&reader->lines, number, &list[used++]);
        }
    }
    if (status == ROTID_OK) {
        *out = POOL_ARRAY(pool, struct uff_system, used);
        status = *out ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    if (status == ROTID_OK) {
        if (used)
            memcpy(*out, list, used * sizeof *list);
        *count = (int)used;
    }
    pool_close(&scratch);
    return uff_end(reader, status, UFF_BETWEEN);
}
