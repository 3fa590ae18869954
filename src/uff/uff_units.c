/* From the units of a file to SI. */
#include <math.h>
#include <string.h>

#include "uff/uff_read.h"

/* Exponents of length, force and temperature of a quantity along an axis, as the format fixes them (addendum A of set 58). */
static void find_exponents(const struct uff_axis *axis, int exponent[3])
{
    static const struct {
        int type, length, force, temperature;
    } table[] = {{8, 1, 0, 0}, {9, 0, 1, 0}, {11, 1, 0, 0}, {12, 1, 0, 0}, {13, 0, 1, 0}, {15, -2, 1, 0}, {16, -1, 1, 0}};
    int is_free = axis->specific_type == 0 || axis->specific_type == 1; /* unknown and general: as the record says */
    exponent[0] = is_free ? axis->length : 0;
    exponent[1] = is_free ? axis->force : 0;
    exponent[2] = is_free ? axis->temperature : 0;
    for (size_t i = 0; i < sizeof table / sizeof *table; ++i)
        if (table[i].type == axis->specific_type) {
            exponent[0] = table[i].length;
            exponent[1] = table[i].force;
            exponent[2] = table[i].temperature;
        }
}

double uff_si_factor(const struct uff_units *units, const struct uff_axis *axis)
{
    static const double standard_gravity = 9.80665; /* m/s2, by definition */
    if (axis->specific_type == 12 && (strcmp(axis->unit, "g") == 0 || strcmp(axis->unit, "gn") == 0))
        return standard_gravity;
    int exponent[3];
    find_exponents(axis, exponent);
    double unit[3] = {units ? units->length : 1, units ? units->force : 1, units ? units->temperature : 1}, factor = 1;
    for (int i = 0; i < 3; ++i)
        if (exponent[i] && unit[i] > 0 && isfinite(unit[i]))
            factor *= pow(unit[i], -exponent[i]);
    return factor;
}
