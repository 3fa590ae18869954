#include "export_readers.h"

#include <ctype.h>

#include "support.h"

static struct dense_file new_dense(int n)
{
    struct dense_file file = {n, calloc((size_t)n * (size_t)n + 1, sizeof(double))};
    assert_non_null(file.a);
    return file;
}

static void put_both(struct dense_file *file, int i, int j, double value)
{
    assert_true(i >= j && i >= 0 && j >= 0 && i < file->n);
    assert_true(file->a[i + (ptrdiff_t)j * file->n] == 0); /* no entry twice */
    file->a[i + (ptrdiff_t)j * file->n] = file->a[j + (ptrdiff_t)i * file->n] = value;
}

struct dense_file read_market(FILE *stream)
{
    char line[2048];
    int rows, columns, i, j;
    long entries;
    double value;
    assert_non_null(fgets(line, sizeof line, stream));
    int array = !strcmp(line, "%%MatrixMarket matrix array real symmetric\n");
    assert_true(array || !strcmp(line, "%%MatrixMarket matrix coordinate real symmetric\n"));
    do {
        assert_non_null(fgets(line, sizeof line, stream));
        assert_true(strlen(line) <= 1024 && strchr(line, '\n'));
    } while (*line == '%');
    assert_int_equal(sscanf(line, "%d %d %ld", &rows, &columns, &entries), array ? 2 : 3);
    assert_int_equal(rows, columns);
    struct dense_file file = new_dense(rows);
    if (array)
        for (j = 0; j < rows; j++)
            for (i = j; i < rows; i++) {
                assert_int_equal(fscanf(stream, "%lf", &value), 1);
                put_both(&file, i, j, value);
            }
    else
        while (entries-- > 0) {
            assert_int_equal(fscanf(stream, "%d %d %lf", &i, &j, &value), 3);
            put_both(&file, i - 1, j - 1, value);
        }
    assert_int_equal(fscanf(stream, " %d", &i), EOF);
    return file;
}

/* ------------------------------------------------------------------------------------------------ Nastran */

/* Field of `width` columns that begins at `column`, without blanks. */
static const char *field(const char *line, int column, int width, char *text)
{
    int length = (int)strcspn(line, "\n"), count = 0;
    for (int c = column; c < column + width && c < length; c++)
        if (line[c] != ' ')
            text[count++] = line[c];
    text[count] = 0;
    return text;
}

static int integer_of(const char *line, int column, int width)
{
    char text[32], *end;
    long value = strtol(field(line, column, width, text), &end, 10);
    assert_true(end != text && !*end);
    return (int)value;
}

/* A real number with the D that TIN=2 asks for, or where `plain` with any exponent. */
static double real_of(const char *line, int column, int plain)
{
    char text[32], *end, *d = strchr(field(line, column, 16, text), 'D');
    assert_true(plain || d);
    assert_non_null(strchr(text, '.'));
    if (d)
        *d = 'E';
    double value = strtod(text, &end);
    assert_true(end != text && !*end);
    return value;
}

static int begins(const char *line, const char *with)
{
    return !strncmp(line, with, strlen(with));
}

static const char *next_line(const char *line)
{
    const char *end = strchr(line, '\n');
    return end ? end + 1 : line + strlen(line);
}

static void read_names(const char *line, char (*name)[16])
{
    const char *from = strchr(line, '=') + 1;
    char text[64];
    (void)snprintf(text, sizeof text, "%.*s", (int)strcspn(from, "\n"), from);
    name[0][0] = name[1][0] = 0;
    assert_true(sscanf(text, " %15[A-Z] , %15[A-Z]", name[0], name[1]) >= 1);
}

static void read_grid(struct dmig_file *file, const char *line)
{
    char text[32];
    int g = file->ngrid++;
    assert_true(g < DMIG_MOST_GRIDS);
    file->grid[g] = integer_of(line, 8, 16);
    assert_string_equal(field(line, 24, 16, text), ""); /* the basic system */
    assert_true(real_of(line, 40, 1) == 0 && real_of(line, 56, 1) == 0);
    line = next_line(line);
    assert_int_equal(*line, '*');
    file->z[g] = real_of(line, 8, 1);
}

void read_bulk(FILE *stream, struct dmig_file *file)
{
    *file = (struct dmig_file){.text = calloc(1, 1 << 24)};
    assert_non_null(file->text);
    size_t length = fread(file->text, 1, (1 << 24) - 1, stream);
    assert_true(length > 0 && length < (1 << 24) - 1 && file->text[length - 1] == '\n');
    int bulk = 0, ended = 0, solves = 0;
    for (const char *line = file->text; *line; line = next_line(line)) {
        int columns = (int)strcspn(line, "\n");
        file->longest = columns > file->longest ? columns : file->longest;
        for (int c = 0; c < columns; c++)
            assert_true(isprint((unsigned char)line[c]));
        if (begins(line, "SOL 103\n"))
            solves = 1;
        else if (begins(line, "K2GG"))
            read_names(line, file->k2gg);
        else if (begins(line, "M2GG"))
            read_names(line, file->m2gg);
        else if (begins(line, "BEGIN BULK\n"))
            bulk = 1;
        else if (begins(line, "EIGRL"))
            file->nmodes = integer_of(line, 32, 8);
        else if (begins(line, "GRID*"))
            read_grid(file, line);
        else if (begins(line, "ENDDATA\n"))
            ended = 1;
    }
    assert_true(solves && bulk && ended);
}

static int place_of(const struct dmig_file *file, int id)
{
    for (int g = 0; g < file->ngrid; g++)
        if (file->grid[g] == id)
            return g;
    fail_msg("no GRID %d", id);
    return -1;
}

static int dof_of(const struct dmig_file *file, const char *line, int column, int lateral)
{
    int place = place_of(file, integer_of(line, column, 16)), component = integer_of(line, column + 16, 16);
    assert_true(component == 1 || (component == 5 && !lateral));
    return lateral ? place : 2 * place + (component == 5);
}

/* Adds the matrix `name`; returns its entries. */
static int add_matrix(const struct dmig_file *file, const char *name, int lateral, struct dense_file *sum)
{
    char text[32];
    int header = 0, entries = 0, column = -1, row;
    struct dense_file own = new_dense(sum->n);
    for (const char *line = file->text; *line; line = next_line(line)) {
        if (begins(line, "DMIG    ") && !strcmp(field(line, 8, 8, text), name)) {
            header++;
            assert_int_equal(integer_of(line, 16, 8), 0);
            assert_int_equal(integer_of(line, 24, 8), 6); /* symmetric */
            assert_int_equal(integer_of(line, 32, 8), 2); /* real, double precision */
        }
        if (!begins(line, "DMIG*   ") || strcmp(field(line, 8, 16, text), name) != 0)
            continue;
        int next = dof_of(file, line, 24, lateral);
        assert_true(next > column); /* one column, one entry */
        column = next;
        for (const char *more = next_line(line); *more == '*'; more = next_line(more), entries++) {
            row = dof_of(file, more, 8, lateral);
            put_both(&own, row, column, real_of(more, 40, 0));
        }
    }
    assert_int_equal(header, 1);
    for (size_t i = 0; i < (size_t)sum->n * (size_t)sum->n; i++)
        sum->a[i] += own.a[i];
    free(own.a);
    return entries;
}

struct dense_file dmig_sum(const struct dmig_file *file, char (*name)[16], int lateral)
{
    struct dense_file sum = new_dense(lateral ? file->ngrid : 2 * file->ngrid);
    for (int part = 0; part < 2 && *name[part]; part++)
        assert_true(add_matrix(file, name[part], lateral, &sum) > 0);
    return sum;
}

int is_held(const struct dmig_file *file, int id, const char *components)
{
    char text[32];
    for (const char *line = file->text; *line; line = next_line(line)) {
        if (!begins(line, "SPC1    ") || strcmp(field(line, 16, 8, text), components) != 0)
            continue;
        int first = integer_of(line, 24, 8), through = !strcmp(field(line, 32, 8, text), "THRU");
        if (id == first || (through && id > first && id <= integer_of(line, 40, 8)))
            return 1;
    }
    return 0;
}
