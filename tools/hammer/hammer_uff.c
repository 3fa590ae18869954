/* The records as a universal file: sets 151, 164, 2411, and two sets 58 a measurement. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "hammer.h"
#include "hammer_file.h"

#define DIRECTION 1 /* +x, across the axis z */

enum { FORCE = 13, ACCELERATION = 12 };

/* The date is fixed: the same seed gives the same file. */
static void write_heading(const struct hammer_test *test, FILE *f)
{
    static const char date[] = "01-JAN-00", time[] = "00:00:00";
    fprintf(f, "%6d\n%6d\n%-80s\n%-80s\n%-80s\n", -1, 151, "hammer test",
            "simulated: force and acceleration of every impact, one load case each", "hammer");
    fprintf(f, "%-10s%-10s%10d%10d%10d\n", date, time, 0, 0, 0);
    fprintf(f, "%-10s%-10s\n%-80s\n%-10s%-10s\n%6d\n", date, time, "hammer", date, time, -1);
    fprintf(f, "%6d\n%6d\n%10d%-20s%10d\n%25.17e%25.17e%25.17e\n%25.17e\n%6d\n", -1, 164, 1, "SI: Meter (newton)", 2, 1.0, 1.0,
            1.0, 273.15, -1);
    fprintf(f, "%6d\n%6d\n", -1, 2411);
    for (int s = 0; s < test->points; s++)
        fprintf(f, "%10ld%10d%10d%10d\n%25.16e%25.16e%25.16e\n", test->id[s], 1, 1, 11, 0.0, 0.0, test->z[s]);
    fprintf(f, "%6d\n", -1);
}

static void write_binary(int count, const double *y, FILE *f)
{
    unsigned char bytes[4];
    for (int n = 0; n < count; n++) {
        float single = (float)y[n];
        uint32_t bits;
        memcpy(&bits, &single, sizeof bits);
        for (int b = 0; b < 4; b++)
            bytes[b] = (unsigned char)(bits >> 8 * b); /* little endian whatever the machine */
        fwrite(bytes, 1, sizeof bytes, f);
    }
}

/* One channel of a measurement. The spacing has as many digits as leave a blank before it, which readers by fields need. */
static void write_channel(const struct hammer_test *test, int quantity, int measurement, long response, long reference, int ascii,
                          const double *y, FILE *f)
{
    const char *what = quantity == FORCE ? "force" : "acceleration", *unit = quantity == FORCE ? "N" : "m/s^2";
    fprintf(f, "%6d\n", -1);
    if (ascii)
        fprintf(f, "%6d%74s\n", 58, "");
    else
        fprintf(f, "%6db%6d%6d%12d%12lld%6d%6d%12d%12d\n", 58, 1, 2, 11, 4LL * test->count, 0, 0, 0, 0);
    fprintf(f, "%-80s\n%-80s\n%-80s\n", what, "channels of one impact have the same load case number",
            "the force comes first: its response node is the hammer's; then the acceleration");
    fprintf(f, "%-80s\n%-80s\n", "01-JAN-00 00:00:00", "NONE");
    fprintf(f, "%5d%10d%5d%10d %-10s%10ld%4d %-10s%10ld%4d\n", 1, quantity == FORCE ? 1 : 2, 0, measurement, "NONE", response,
            DIRECTION, "NONE", reference, DIRECTION);
    fprintf(f, "%10d%10d%10d%13.5e%13.6e%13.5e\n", 2, test->count, 1, 0.0, 1 / test->options.rate, 0.0);
    fprintf(f, "%10d%5d%5d%5d %-20s %-20s\n", 17, 0, 0, 0, "Time", "s");
    fprintf(f, "%10d%5d%5d%5d %-20s %-20s\n", quantity, quantity == ACCELERATION, quantity == FORCE, 0, what, unit);
    for (int axis = 0; axis < 2; axis++)
        fprintf(f, "%10d%5d%5d%5d %-20s %-20s\n", 0, 0, 0, 0, "NONE", "NONE");
    if (ascii)
        for (int n = 0; n < test->count; n++)
            fprintf(f, "%13.5e%s", y[n], n % 6 == 5 || n + 1 == test->count ? "\n" : "");
    else
        write_binary(test->count, y, f);
    fprintf(f, "%6d\n", -1);
}

int hammer_write(const struct hammer_test *test, uint64_t seed, int ascii, const char *records_path, char *message, size_t room)
{
    struct hide_message to = {message, room};
    struct hammer_file file;
    struct hammer_impact drawn;
    double *force = malloc((size_t)test->count * sizeof *force), *response = malloc((size_t)test->count * sizeof *response);
    int status = force && response ? hammer_file_open(records_path, &file, &to) : hide_fail(&to, HAMMER_FAILURE, "no memory");
    if (!status) {
        write_heading(test, file.stream);
        for (int i = 0; i < test->points * test->options.impacts; i++) {
            int point = i / test->options.impacts, impact = i % test->options.impacts;
            long fixed = test->id[test->fixed], roving = test->id[point];
            long hammer = test->options.roving_hammer ? roving : fixed, sensor = test->options.roving_hammer ? fixed : roving;
            hammer_record(test, seed, point, impact, force, response, &drawn);
            write_channel(test, FORCE, i + 1, hammer, hammer, ascii, force, file.stream);
            write_channel(test, ACCELERATION, i + 1, sensor, hammer, ascii, response, file.stream);
        }
        status = hammer_file_close(&file, 0, &to);
    }
    free(force);
    free(response);
    return status;
}
