/* Transfer functions from a table of an analyser: a row a line, the frequency first, two columns a function. */
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <sys/stat.h>

#include "file/file.h"
#include "import/import.h"

#define COLUMNS_MOST 20000
#define RADIAN       57.29577951308232 /* degrees */

enum part { PART_REAL, PART_IMAGINARY, PART_MAGNITUDE, PART_PHASE };

struct column {
    int part;      /* enum part */
    int frf;       /* of the set */
    double factor; /* to SI, to radians */
};

struct analyser {
    struct pool *pool;
    const char *path;
    struct message_list *messages;
    const struct measurement_options *options;
    struct frf_set *set;
    char separator;
    double in_hertz;
    int ncolumn, quantity;  /* quantity: enum frf_quantity, -1: not stated yet */
    int nwithout;           /* columns of a quantity without a unit */
    int has_comma, has_dot; /* a number with a decimal comma, a decimal point */
    struct column *column;  /* [ncolumn] behind the frequency */
};

static int wrong(struct analyser *a, int line, int column, const char *text, const char *cell)
{
    return message_refuse(a->messages, ROTID_ERROR_ARGUMENT, a->path, line, column, text, cell);
}

/* The next cell of a row, its blanks and quotes taken off; *at goes behind the separator, NULL behind the last one. */
static char *next_cell(char **at, char separator)
{
    char *cell = *at, *end = strchr(cell, separator);
    *at = end ? end + 1 : NULL;
    if (end)
        *end = 0;
    while (isspace((unsigned char)*cell) || *cell == '"')
        cell++;
    for (end = cell + strlen(cell); end > cell && (isspace((unsigned char)end[-1]) || end[-1] == '"');)
        *--end = 0;
    return cell;
}

/* One of the words in the name, in capitals or not, which ends where letters end: "re" of "12/1 Re [g/N]". */
static int has_word(const char *name, const char *words)
{
    for (const char *at = name; *at;) {
        while (*at && !isalpha((unsigned char)*at))
            at++;
        size_t length = 0;
        while (isalpha((unsigned char)at[length]))
            length++;
        char word[24] = "|";
        if (length && length < sizeof word - 2) {
            for (size_t i = 0; i < length; i++)
                word[i + 1] = (char)tolower((unsigned char)at[i]);
            word[length + 1] = '|';
            if (strstr(words, word))
                return 1;
        }
        at += length;
        if (*at == '[')
            break; /* the unit */
    }
    return 0;
}

/* What stands in the brackets of a name, "" without. */
static const char *unit_of(struct analyser *a, const char *name)
{
    const char *open = strchr(name, '['), *close = open ? strchr(open, ']') : NULL;
    const char *text = close ? pool_format(a->pool, "%.*s", (int)(close - open - 1), open + 1) : "";
    return text ? text : "";
}

/* A unit that is overlooked is a wrong factor. */
static int refuse_unit(struct analyser *a, int index, const char *name)
{
    return wrong(a, 1, index, "the unit of '%s' does not stand in brackets, expected a name such as '12/1 real [m/s2/N]'", name);
}

static int take_unit(struct analyser *a, int index, const char *name, struct column *column)
{
    static const struct {
        const char *unit;
        enum frf_quantity quantity;
        double factor;
    } units[] = {{"m/s2/N", FRF_ACCELERATION, 1},    {"(m/s2)/N", FRF_ACCELERATION, 1},      {"m/s^2/N", FRF_ACCELERATION, 1},
                 {"(m/s^2)/N", FRF_ACCELERATION, 1}, {"m/(s2 N)", FRF_ACCELERATION, 1},      {"1/kg", FRF_ACCELERATION, 1},
                 {"g/N", FRF_ACCELERATION, 9.80665}, {"mm/s2/N", FRF_ACCELERATION, 1e-3},    {"m/s/N", FRF_VELOCITY, 1},
                 {"(m/s)/N", FRF_VELOCITY, 1},       {"m/(s N)", FRF_VELOCITY, 1},           {"mm/s/N", FRF_VELOCITY, 1e-3},
                 {"(mm/s)/N", FRF_VELOCITY, 1e-3},   {"m/N", FRF_DISPLACEMENT, 1},           {"mm/N", FRF_DISPLACEMENT, 1e-3},
                 {"um/N", FRF_DISPLACEMENT, 1e-6},   {"\xc2\xb5m/N", FRF_DISPLACEMENT, 1e-6}};
    const char *unit = unit_of(a, name);
    if (column->part == PART_PHASE) {
        if (!*unit && has_word(name, "|rad|radian|radians|"))
            return refuse_unit(a, index, name);
        column->factor = same_text(unit, "rad") ? 1 : 1 / RADIAN;
        return !*unit || same_text(unit, "rad") || same_text(unit, "deg") || !strcmp(unit, "\xc2\xb0")
                   ? 0
                   : wrong(a, 1, index, "the phase '%s' has another unit than [deg] and [rad]", name);
    }
    size_t u = 0, count = sizeof units / sizeof *units;
    while (u < count && strcmp(units[u].unit, unit) != 0)
        u++;
    if (*unit && u == count)
        return wrong(a, 1, index, "the unit of '%s' is not known, expected one such as [m/s2/N], [g/N], [m/s/N], [m/N] or [um/N]",
                     name);
    if (has_word(name, "|db|"))
        return wrong(a, 1, index, "'%s' holds levels, expected linear values such as [m/s2/N]", name);
    if (!*unit && has_word(name, "|n|kg|"))
        return refuse_unit(a, index, name);
    column->factor = *unit ? units[u].factor : 1;
    a->nwithout += !*unit;
    if (a->nwithout && (*unit || a->quantity >= 0))
        return wrong(a, 1, index, "'%s' and the columns before do not all have a unit, expected one in each or none", name);
    if (*unit && a->quantity >= 0 && a->quantity != (int)units[u].quantity)
        return wrong(a, 1, index, "'%s' is another quantity than the functions before it, expected one for all", name);
    a->quantity = *unit ? (int)units[u].quantity : a->quantity;
    return 0;
}

/* "12/1 real [m/s2/N]": response, reference, part, unit. */
static int take_name(struct analyser *a, int index, const char *name)
{
    static const char *const words[] = {"|real|re|", "|imaginary|imag|im|", "|magnitude|mag|abs|amplitude|modulus|",
                                        "|phase|arg|angle|"};
    struct column *column = &a->column[index - 2];
    int node[2] = {0, a->options->reference}, count = 0, p = 0;
    for (const char *at = name; *at && *at != '['; at++)
        if (isdigit((unsigned char)*at)) {
            char *end;
            long id = strtol(at, &end, 10);
            if (count < 2)
                node[count] = id <= INT_MAX ? (int)id : 0;
            count++;
            at = end - 1;
        }
    while (p < 4 && !has_word(name, words[p]))
        p++;
    if (p == 4)
        return wrong(a, 1, index,
                     "'%s' does not say what it holds, expected a name such as '12/1 real [m/s2/N]' with real and imaginary or "
                     "magnitude and phase",
                     name);
    if (!count || count > 2 || !node[0] || !node[1])
        return wrong(
            a, 1, index,
            "'%s' does not name response and reference, expected two numbers as in '12/1 real', or one and --reference N", name);
    column->part = p;
    for (column->frf = 0; column->frf < a->set->nfrf; column->frf++)
        if (a->set->frf[column->frf].response_node == node[0] && a->set->frf[column->frf].reference_node == node[1])
            break;
    if (column->frf == a->set->nfrf)
        a->set->frf[a->set->nfrf++] = (struct frf){
            .line = 1, .response_node = node[0], .response_direction = 1, .reference_node = node[1], .reference_direction = 1};
    return take_unit(a, index, name, column);
}

static int take_head(struct analyser *a, char *row)
{
    int count = 1, *parts;
    if (!a->separator)
        a->separator = strchr(row, ';') ? ';' : strchr(row, '\t') ? '\t' : ',';
    for (const char *at = row; (at = strchr(at, a->separator)) != NULL; at++)
        count++;
    if (count < 3 || count > COLUMNS_MOST)
        return wrong(a, 1, 1, "the first row is '%.60s', expected the names of a frequency and of two columns a function", row);
    a->column = POOL_ARRAY(a->pool, struct column, count);
    a->set->frf = POOL_ARRAY(a->pool, struct frf, count);
    if (!a->column || !a->set->frf)
        return ROTID_ERROR_MEMORY;
    char *at = row, *name = next_cell(&at, a->separator);
    const char *unit = unit_of(a, name);
    if (!*unit && has_word(name, "|khz|mhz|ghz|rad|rpm|min|s|"))
        return wrong(a, 1, 1, "the unit of the first column '%.60s' does not stand in brackets, expected frequency [Hz]", name);
    if (!has_word(name, "|frequency|freq|f|hz|") || (*unit && !same_text(unit, "Hz") && !same_text(unit, "kHz")))
        return wrong(a, 1, 1, "the first column is '%.60s', expected frequency [Hz]", name);
    a->in_hertz = same_text(unit, "kHz") ? 1e3 : 1;
    for (int i = 2; at; i++) {
        int status = take_name(a, i, next_cell(&at, a->separator));
        if (status)
            return status;
        a->ncolumn++;
    }
    parts = POOL_ARRAY(a->pool, int, 2 * (ptrdiff_t)a->set->nfrf);
    if (!parts)
        return ROTID_ERROR_MEMORY;
    memset(parts, 0, 2 * (size_t)a->set->nfrf * sizeof *parts);
    for (int i = 0; i < a->ncolumn; i++)
        parts[2 * (ptrdiff_t)a->column[i].frf + a->column[i].part / 2] += a->column[i].part % 2 ? 16 : 1;
    for (int c = 0; c < a->set->nfrf; c++)
        if (parts[2 * (ptrdiff_t)c] + parts[2 * c + 1] != 17 || (parts[2 * (ptrdiff_t)c] && parts[2 * c + 1]))
            return wrong(a, 1, 1, "%s has not two columns, expected real and imaginary, or magnitude and phase, once each",
                         pool_format(a->pool, "%d/%d", a->set->frf[c].response_node, a->set->frf[c].reference_node));
    if (a->quantity < 0)
        message_add(a->messages, SEVERITY_WARNING, a->path, 1, 1,
                    "no column has a unit: accelerances in (m/s2)/N are assumed, as in '12/1 real [m/s2/N]'");
    a->set->quantity = a->quantity < 0 ? FRF_ACCELERATION : (enum frf_quantity)a->quantity;
    return ROTID_OK;
}

/* A decimal comma where cells are apart by something else. */
static int number_of(struct analyser *a, char *cell, double *value)
{
    char *comma = a->separator == ',' ? NULL : strchr(cell, ','), *end;
    a->has_dot |= strchr(cell, '.') != NULL;
    a->has_comma |= comma != NULL;
    if (comma)
        *comma = '.';
    *value = strtod(cell, &end);
    return end != cell && !*end && isfinite(*value);
}

/* A row into line n of the functions; *taken: it lies in the band. */
static int take_row(struct analyser *a, int line, char *row, int *taken)
{
    struct frf_set *set = a->set;
    int n = set->nline, i = 0;
    double hz, value;
    char *at = row, *cell = next_cell(&at, a->separator);
    if (!number_of(a, cell, &hz) || hz < 0)
        return wrong(a, line, 1, "the frequency is '%.60s', expected a number not below zero", cell);
    hz *= a->in_hertz;
    if (n && hz <= set->frequency_hz[n - 1])
        return wrong(a, line, 1, "the frequency %.60s does not rise, expected more than in the row above", cell);
    *taken = hz >= a->options->low_hz * (1 - 1e-9) && (a->options->high_hz <= 0 || hz <= a->options->high_hz * (1 + 1e-9));
    set->frequency_hz[n] = hz;
    for (; at && i < a->ncolumn; i++) {
        const struct column *column = &a->column[i];
        double complex *h = &set->frf[column->frf].h[n];
        if (!number_of(a, cell = next_cell(&at, a->separator), &value))
            return wrong(a, line, i + 2, "the cell is '%.60s', expected a number", cell);
        value *= column->factor;
        /* magnitude and phase stand in the parts until the row is read */
        *h = column->part == PART_REAL || column->part == PART_MAGNITUDE ? value + I * cimag(*h) : creal(*h) + I * value;
    }
    if (i < a->ncolumn || at)
        return wrong(a, line, 1, "the row has another number of cells than the first one%s, expected as many", "");
    if (a->has_comma && a->has_dot)
        return wrong(a, line, 1, "numbers have decimal commas and decimal points%s, expected one of them in a table", "");
    for (i = 0; i < a->ncolumn; i++)
        if (a->column[i].part == PART_PHASE) {
            double complex *h = &set->frf[a->column[i].frf].h[n];
            *h = creal(*h) * cexp(I * cimag(*h));
        }
    return ROTID_OK;
}

/* The bytes of the file with a zero behind them. */
static int read_text(struct analyser *a, struct pool *scratch, char **text)
{
    struct stat about;
    char why[256];
    FILE *file = file_open_regular(a->path, &about);
    if (!file) {
        int status = file_status(errno);
        return message_refuse(a->messages, status, a->path, 1, 1, "cannot be opened: %s", file_error_text(errno, why));
    }
    *text = POOL_ARRAY(scratch, char, about.st_size + 1);
    size_t length = *text ? fread(*text, 1, (size_t)about.st_size, file) : 0;
    if (*text)
        (*text)[length] = 0;
    int failed = ferror(file);
    (void)fclose(file);
    if (failed)
        message_add(a->messages, SEVERITY_ERROR, a->path, 1, 1, "cannot be read");
    else if (*text && strlen(*text) < length)
        return wrong(a, 1, 1, "the file has zero bytes%s, expected text", "");
    return failed ? ROTID_ERROR_IO : ROTID_OK;
}

/* Only functions over the reference that was asked for. */
static int keep_reference(struct analyser *a)
{
    struct frf_set *set = a->set;
    int kept = 0;
    for (int c = 0; c < set->nfrf; c++)
        if (!a->options->reference || set->frf[c].reference_node == a->options->reference)
            set->frf[kept++] = set->frf[c];
    set->nfrf = kept;
    return kept ? ROTID_OK : wrong(a, 1, 1, "no function has the reference asked for%s, expected one", "");
}

int analyser_is(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (same_text(dot, ".csv") || same_text(dot, ".txt") || same_text(dot, ".tsv"));
}

int analyser_read(struct pool *pool, const char *path, const struct measurement_options *options, struct message_list *messages,
                  struct measurement *out)
{
    struct analyser a = {.pool = pool, .path = path, .messages = messages, .options = options, .set = &out->set, .quantity = -1};
    struct pool scratch;
    char *text = NULL;
    int lines = 1, line = 1;
    pool_open(&scratch, pool->allocator);
    int status = read_text(&a, &scratch, &text);
    char *row = text;
    if (!status && !text)
        status = ROTID_ERROR_MEMORY;
    if (!status && !strncmp(row, "\xef\xbb\xbf", 3))
        row += 3;
    for (const char *c = row; !status && *c; c++)
        lines += *c == '\n' || *c == '\r';
    if (!status && !strncmp(row, "sep=", 4) && row[4] && strchr("\r\n", row[5])) { /* what is left of this row is blank */
        a.separator = row[4];
        row += 5 + strspn(row + 5, "\r\n");
        line++;
    }
    for (int is_head = 1; !status && row && (is_head || *row); line++) {
        char *end = row + strcspn(row, "\r\n"), *next = *end ? end + 1 + (end[0] == '\r' && end[1] == '\n') : NULL;
        *end = 0;
        if (is_head) {
            status = take_head(&a, row);
            a.set->frequency_hz = POOL_ARRAY(pool, double, lines);
            for (int c = 0; c < a.set->nfrf && !status; c++)
                if (!(a.set->frf[c].h = POOL_ARRAY(pool, double complex, lines)))
                    status = ROTID_ERROR_MEMORY;
            if (!status && !a.set->frequency_hz)
                status = ROTID_ERROR_MEMORY;
            is_head = 0;
        } else if (*row) {
            int taken = 0;
            status = take_row(&a, line, row, &taken);
            a.set->nline += !status && taken;
        }
        row = next;
    }
    if (!status && a.set->nline < 2)
        status = wrong(&a, 1, 1, "fewer than two lines lie in the band asked for%s, expected some", "");
    if (!status)
        status = keep_reference(&a);
    pool_close(&scratch);
    return messages->pool->out_of_memory ? ROTID_ERROR_MEMORY : status;
}
