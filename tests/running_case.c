#include "running_case.h"

#include "api/api.h"
#include "folder.h"
#include "support.h"

int running_case_open(const char *text, double to, int count, int draws, struct running_case *c)
{
    memset(c, 0, sizeof *c);
    int status = rotid_deck_read_text(strlen(text), text, "deck", ROTID_SOURCE_DIR, 0, NULL, NULL, NULL, &c->deck);
    for (int i = 0; status && i < c->deck->nmessage; i++)
        if (c->deck->message[i].severity == ROTID_ERROR)
            print_message("%d: %s\n", c->deck->message[i].line, c->deck->message[i].text);
    if (status)
        return status;
    const struct states *states = deck_states_of(c->deck);
    c->machine = states->machine;
    c->job = &states->state[0].job;
    assert_non_null(c->machine);
    c->x = POOL_ARRAY(&test_pool, double, c->job->unknowns.nparameter + 1);
    for (int p = 0; p < c->job->unknowns.nparameter; p++)
        c->x[p] = c->job->unknowns.bounds[p].start;
    return running_case_run(c, NULL, to, count, draws);
}

int running_case_run(struct running_case *c, const rotid_fit_result *fit, double to, int count, int draws)
{
    struct message_list notes;
    const struct speeds_options options = {
        .to = to * RPM, .count = count, .harmonic = 1, .draws = draws, .seed = 1, .threads = 1};
    message_open(&notes, &test_pool);
    return speeds_run(&test_pool, c->machine, c->job, c->x, fit, &options, NULL, &notes, &c->speeds);
}

void running_case_close(struct running_case *c)
{
    rotid_deck_free(c->deck);
}

/* Columns of the models. */
enum { ITEM, ELEMENT, Z, LENGTH, OUTER, INNER, MASS, DIAMETRAL, POLAR, KXX, E = 17, G, NU, RHO, NOTE, COLUMNS };

static void split(char *line, char *field[COLUMNS])
{
    line[strcspn(line, "\r\n")] = 0;
    for (int i = 0; i < COLUMNS; i++) {
        field[i] = line;
        size_t length = *line == '"' ? strlen(line) : strcspn(line, ",");
        line += length;
        if (*line)
            *line++ = 0;
    }
}

static void put(char **text, const char *more)
{
    *text = pool_format(&test_pool, "%s%s", *text, more);
    assert_non_null(*text);
}

char *running_case_deck(const char *name, int elements, const char *more)
{
    char *text = pool_copy_text(&test_pool, "*HEADING\ncase\n"), line[1024], *f[COLUMNS], path[512];
    (void)snprintf(path, sizeof path, "%s/tests/data/running/%s_model.csv", ROTID_SOURCE_DIR, name);
    FILE *in = fopen(path, "r");
    FILE *table = NULL;
    double table_z = -1;
    int running = 0, tables = 0;
    assert_non_null(in);
    while (fgets(line, sizeof line, in)) {
        if (*line == '#' || !strncmp(line, "item", 4))
            continue;
        split(line, f);
        if (!strcmp(f[ITEM], "material"))
            put(&text, pool_format(&test_pool,
                                   "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n%s, %s, %s\n*DENSITY\n%s\n*SHAFT, NAME=shaft, "
                                   "MATERIAL=steel\n",
                                   f[E], f[G], f[NU], f[RHO]));
        if (!strcmp(f[ITEM], "element"))
            put(&text, pool_format(&test_pool, "%s, %s, %s, %d\n", f[LENGTH], f[OUTER], *f[INNER] ? f[INNER] : "0", elements));
        if (strcmp(f[ITEM], "material") != 0 && strcmp(f[ITEM], "element") != 0 && !running++)
            put(&text, "*RUNNING\n");
        if (!strcmp(f[ITEM], "disk"))
            put(&text, pool_format(&test_pool, "*DISK\n%s, %s, %s, %s\n", f[Z], f[MASS], f[DIAMETRAL], f[POLAR]));
        if (!strcmp(f[ITEM], "bearing")) {
            put(&text, pool_format(&test_pool, "*BEARING\n%s", f[Z]));
            for (int i = 0; i < 8; i++)
                put(&text, pool_format(&test_pool, ", %s", f[KXX + i]));
            put(&text, "\n");
        }
        if (!strcmp(f[ITEM], "bearing_at_speed")) {
            const char *at = strstr(f[NOTE], " at ");
            assert_non_null(at);
            if (atof(f[Z]) != table_z) {
                char *file = pool_format(&test_pool, "%s_%d.csv", name, tables++);
                if (table)
                    (void)fclose(table);
                table = fopen(folder_path(file), "w");
                assert_non_null(table);
                (void)fputs("speed_rpm,kxx,kxy,kyx,kyy,cxx,cxy,cyx,cyy\n", table);
                table_z = atof(f[Z]);
                put(&text, pool_format(&test_pool, "*BEARING, FILE=%s\n%s\n", folder_path(file), f[Z]));
            }
            (void)fprintf(table, "%g", atof(at + 4));
            for (int i = 0; i < 8; i++)
                (void)fprintf(table, ",%s", f[KXX + i]);
            (void)fputc('\n', table);
        }
    }
    if (table)
        (void)fclose(table);
    (void)fclose(in);
    put(&text, more);
    return text;
}

const rotid_campbell_mode *running_case_mode(const struct running_case *c, double rpm, int index)
{
    for (int i = 0; i < c->speeds.ncampbell; i++) {
        const rotid_campbell_speed *at = &c->speeds.campbell[i];
        if (fabs(at->speed_rpm - rpm) <= 1e-9 * rpm && index <= at->nmodes)
            return &at->modes[index - 1];
    }
    return NULL;
}
