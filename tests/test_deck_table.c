/* Tables in the place of data lines: what spreadsheets write, in two locales, and every mistake with its row and column. The
 * numbers are those that were typed into the sheets, or into the table of the test. */
#include "deck/deck.h"
#include "folder.h"
#include "reading.h"
#include "report/report.h"
#include "support.h"
#include "uff/uff.h"

#define TABLES   ROTID_SOURCE_DIR "/tests/data/tables/"
#define MATERIAL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
#define SHAFT    "*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 20\n"
#define MODES    "*MODES\n1, 500\n2, 1300\n3, 2400\n"
#define SENSORS  "*SENSORS\n1, 0\n2, 0.25\n7, 1\n"

/* A deck whose cards name table.csv beside it. */
static void read_with(struct reading *r, const char *table, const char *deck)
{
    (void)folder_write("table.csv", table);
    read_text(r, deck, NULL);
}

static double component(const struct job *job, int id, int mode)
{
    for (int s = 0; s < job->rotor.nsensor; s++)
        if (job->rotor.sensor[s].id == id)
            return job->measurement.shape[s + (ptrdiff_t)mode * job->rotor.nsensor];
    fail();
    return 0;
}

/* ------------------------------------------------------------------------------------------------ what spreadsheets write */

static void assert_sheets(const char *locale)
{
    static const double diameter[] = {0.05, 0.10025, 0.10025, 0.0605}, length[] = {0.3, 0.4, 0.0005, 0.3};
    char text[2048];
    struct reading r;
    (void)snprintf(text, sizeof text,
                   MATERIAL "*SHAFT, FILE=" TABLES "%s_sections.csv\n*MODES, FILE=" TABLES "%s_modes.csv\n*SENSORS, FILE=" TABLES
                            "%s_shapes.csv\n*SHAPE, FILE=" TABLES "%s_shapes.csv\n",
                   locale, locale, locale, locale);
    try_path(&r, folder_write("deck.inp", text), NULL);
    assert_status(r.status, ROTID_OK);
    assert_int_equal(r.messages.count, 1); /* one note: of the column of remarks */
    assert_non_null(strstr(r.messages.item[0].text, "'remark'"));
    const struct rotor *rotor = &r.job.rotor;
    assert_int_equal(rotor->ngroup, 3);
    assert_string_equal(rotor->group[0].name, "left \"A\"");
    assert_string_equal(rotor->group[1].name, "core");
    assert_int_equal(rotor->nsegment, 4);
    for (int s = 0; s < 4; s++) {
        assert_close(rotor->segment[s].outer, diameter[s], 1e-15, 0);
        assert_close(rotor->segment[s].length, length[s], 1e-15, 0);
        assert_int_equal(rotor->segment[s].group, s < 2 ? s : s - 1);
        assert_int_equal(rotor->segment[s].elements, s == 0 || s == 3 ? 12 : s == 1 ? 16 : 1);
    }
    assert_close(rotor->segment[2].inner, 0.0125, 1e-15, 0);
    const struct job_measurement *m = &r.job.measurement;
    assert_int_equal(m->nmode, 3);
    assert_close(m->frequency_hz[2], 1722.0625, 1e-15, 0);
    assert_close(m->damping[0], 0.002, 1e-15, 0);
    assert_true(isnan(m->damping[1]) && isnan(m->frequency_std[1]));
    assert_close(m->frequency_std[2], 0.3 / 1722.0625, 1e-15, 0);
    assert_int_equal(rotor->nsensor, 5);
    assert_close(rotor->sensor[1].position, 0.1005, 1e-15, 0);
    assert_close(component(&r.job, 2, 0), 0.514304016, 1e-15, 0);
    assert_close(component(&r.job, 4, 2), -0.1475773574, 1e-15, 0);
    assert_close(component(&r.job, 3, 1), -0.0439417889242353, 1e-15, 0);
    assert_true(isnan(component(&r.job, 3, 2)) && isnan(component(&r.job, 4, 1))); /* blank: not measured */
    assert_close(m->shape_std[1], 0.02, 1e-15, 0);
    assert_true(isnan(m->shape_std[2]) && isnan(m->shape_std[1 + rotor->nsensor]));
    pool_close(&r.pool);
}

UNIT_TEST(sheets_of_two_locales_are_the_same_rotor)
{
    assert_sheets("point");
    assert_sheets("comma");
}

UNIT_TEST(marks_and_ends_of_lines_of_all_systems_are_taken)
{
    static const char *const table[] = {"\xef\xbb\xbfmode;frequency\r\n1;500,5\r\n2;1300\r\n",
                                        "sep=;\r\nmode;frequency\r\n1;500,5\r\n2;1300\r\n",
                                        "sep=,\nmode,frequency\n1,500.5\n2,1300\n",
                                        "sep=|\nmode|frequency|a;b\n1|500,5|;\n2|1300|,\n",
                                        "mode\tfrequency\r1\t500,5\r2\t1300",
                                        "\n\n\"mode\",\"frequency (kHz)\"\n\"1\",\"0.5005\"\n,,\n2 , 1.3 ,,\n",
                                        "1;500,5\n2;1300\n",
                                        "frequency_hz,remark,mode\n500.5,\"a \"\"b\"\"\nc\",1\n1300,,2\n"};
    struct reading r;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        read_with(&r, table[i], MATERIAL SHAFT "*MODES, FILE=table.csv\n");
        assert_int_equal(r.job.measurement.nmode, 2);
        assert_close(r.job.measurement.frequency_hz[0], 500.5, 1e-15, 0);
        assert_close(r.job.measurement.frequency_hz[1], 1300, 1e-15, 0);
        pool_close(&r.pool);
    }
}

UNIT_TEST(a_unit_in_the_header_counts_over_that_of_the_deck)
{
    struct reading r;
    read_with(&r, "sensor,position [mm]\n1,250\n2,end\n", MATERIAL SHAFT "*SENSORS, FILE=table.csv\n");
    assert_close(r.job.rotor.sensor[0].position, 0.25, 1e-15, 0);
    assert_close(r.job.rotor.sensor[1].position, 1, 1e-15, 0);
    pool_close(&r.pool);
    read_with(&r, "length [m],outer,inner,elements\n1,100,0,20\n",
              "*UNITS, LENGTH=MM\n" MATERIAL "*SHAFT, NAME=core, MATERIAL=steel, FILE=table.csv\n");
    assert_close(r.job.rotor.segment[0].length, 1, 1e-15, 0);
    assert_close(r.job.rotor.segment[0].outer, 0.1, 1e-15, 0);
    pool_close(&r.pool);
}

/* ------------------------------------------------------------------------------------------------ shapes */

/* mode 1: sensor 1 1, sensor 2 0.5 (0.01), sensor 7 -1; mode 3: sensor 1 0.25, sensor 7 0.75 */
static void assert_shapes(const char *table, const char *card)
{
    struct reading r;
    char deck[1024];
    (void)snprintf(deck, sizeof deck, MATERIAL SHAFT MODES SENSORS "%s\n", card);
    read_with(&r, table, deck);
    assert_int_equal(r.messages.count, 0);
    assert_close(component(&r.job, 1, 0), 1, 0, 0);
    assert_close(component(&r.job, 2, 0), 0.5, 0, 0);
    assert_close(component(&r.job, 7, 0), -1, 0, 0);
    assert_close(component(&r.job, 1, 2), 0.25, 0, 0);
    assert_close(component(&r.job, 7, 2), 0.75, 0, 0);
    assert_close(r.job.measurement.shape_std[1], 0.01, 0, 0);
    assert_true(isnan(component(&r.job, 2, 2)) && isnan(component(&r.job, 1, 1)) && isnan(r.job.measurement.shape_std[0]));
    pool_close(&r.pool);
}

UNIT_TEST(a_table_of_shapes_has_sensors_in_rows_or_columns_or_triples)
{
    assert_shapes("sensor,1,3,std 1\n1,1,0.25,\n2,0.5,,0.01\n7,-1,0.75,\n", "*SHAPE, FILE=table.csv");
    assert_shapes("point;mode 3;mode 2;mode 1;mode_1_std\n7;0,75;;-1\n2;;;0,5;0,01\n1;0,25;;1\n", "*SHAPE, FILE=table.csv");
    assert_shapes("mode,frequency [Hz],sensor 7,1,sensor 2,sensor 2 std\n1,500,-1,1,0.5,0.01\n3,2400,0.75,0.25,,\n",
                  "*SHAPE, FILE=table.csv");
    assert_shapes("mode,sensor,value,std\n1,1,1,\n3,1,0.25,\n1,2,0.5,0.01\n1,7,-1,\n3,7,0.75\n3,2,\n", "*SHAPE, FILE=table.csv");
    assert_shapes("sensor,1,3,std 1\n1,1,0.25,\n2,0.5,,0.01\n7,-1,0.75,\n",
                  "*SHAPE, MODE=3, FILE=table.csv\n*SHAPE, FILE=table.csv, MODE=1");
    assert_shapes("1,1\n2,0.5,0.01\n7,-1\n", "*SHAPE, MODE=1, FILE=table.csv\n*SHAPE, MODE=3\n1, 0.25\n7, 0.75");
}

UNIT_TEST(frequencies_at_sensors_are_a_table_as_well)
{
    struct reading r;
    read_with(&r, "sensor,mode 1 [kHz],mode 2 [Hz]\n1,0.498,1301\n2,,1299\n7,0.5,\n",
              MATERIAL SHAFT MODES SENSORS "*FREQUENCIES, FILE=table.csv, MEAN=NO\n");
    const double *hz = r.job.measurement.point_frequency_hz;
    assert_close(hz[0], 498, 1e-14, 0);
    assert_close(hz[4], 1299, 1e-14, 0);
    assert_true(isnan(hz[1]) && isnan(hz[5]));
    assert_close(r.job.measurement.frequency_hz[0], 500, 0, 0); /* MEAN=NO */
    pool_close(&r.pool);
}

UNIT_TEST(a_table_belongs_to_the_state_of_its_card)
{
    struct pool pool;
    struct message_list messages;
    struct states states;
    (void)folder_write("table.csv", "mode,frequency\n1,500\n2,1300\n");
    const char *path = folder_write("deck.inp", MATERIAL "*SHAFT, FILE=sections.csv, MATERIAL=steel\n*STATE, NAME=bare\n"
                                                         "*MODES, FILE=table.csv\n*STATE, NAME=other\n*MODES\n1, 510\n");
    (void)folder_write("sections.csv", "group,length,outer,elements\na,0.5,0.1,10\nb,0.5,0.12,10\n"); /* no bore: solid */
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    assert_status(deck_read_states(&pool, path, NULL, 0, NULL, &messages, &states), ROTID_OK);
    assert_int_equal(states.nstate, 2);
    assert_int_equal(states.state[0].job.measurement.nmode, 2);
    assert_int_equal(states.state[1].job.measurement.nmode, 1);
    assert_int_equal(states.state[1].job.rotor.ngroup, 2);
    assert_close(states.state[1].job.rotor.segment[1].inner, 0, 0, 1e-15);
    assert_int_equal(states.state[1].job.rotor.segment[1].elements, 10);
    pool_close(&pool);
}

/* ------------------------------------------------------------------------------------------------ mistakes */

static const struct mistake {
    const char *card, *table;
    int row, column;
    const char *text;
} mistakes[] = {
    {"*MODES", "mode,frequency\n1,500\n2,-1300\n", 3, 2, "frequency [Hz] is -1300, expected a number above zero (cell B3)"},
    {"*MODES", "mode,frequency\n1,5o0\n", 2, 2, "'5o0' is not a number, expected one for frequency [Hz] (cell B2)"},
    {"*MODES", "mode,frequency\n1,\n", 2, 2, "a value is missing, expected frequency [Hz] (cell B2)"},
    {"*MODES", "\nmode,frequenzy\n1,500\n", 2, 1, "the first row names no column 'frequency'"},
    {"*MODES", "mode,frequency [bar]\n1,500\n", 1, 2, "the unit of 'frequency [bar]' is not known"},
    {"*MODES", "mode,frequency,f\n1,500,500\n", 1, 3, "'f' is a second column of the frequency"},
    {"*MODES", "1,500,,,7\n", 1, 5, "'7' is one value too many"},
    {"*MODES", "mode;frequency;damping\n1;500,5;0.1\n", 2, 2, "'500,5' has a decimal comma and '0.1' in cell C2 a decimal point"},
    {"*MODES", "mode,frequency\n1,500\n2,1300,5\n", 3, 3, "'5' stands behind the 2 columns that have a name"},
    {"*MODES", "mode,frequency\n1,\"1,300\"\n", 2, 2, "'1,300' is not a number"},
    {"*MODES", "mode,frequency\n1,\"500\n", 2, 2, "the quote is not closed"},
    {"*MODES", "mode,frequency\n1,\"500\"0\n", 2, 2, "text stands behind a quote"},
    {"*MODES", "mode,frequency\n1,5\x01\n", 2, 2, "byte 0x01 is not text"},
    {"*MODES", "mode,frequ\xe2\x80\xaency\n1,5\n", 1, 2, "character U+202E does not stand for itself"},
    {"*MODES", "PK\x03\x04", 1, 1, "the file is a workbook"},
    {"*MODES", "\xff\xfem", 1, 1, "the file is text in UTF-16"},
    {"*MODES", "\n,,\n\n", 1, 1, "the table is empty"},
    {"*SENSORS", "sensor,position\n1,0\n1,0.5\n", 3, 1, "sensor 1 is given twice, expected a new id (cell A3)"},
    {"*SENSORS", "sensor,position [mm]\n1,0\n2,1500\n", 3, 2, "position 1500 in the unit of its column lies outside"},
    {MODES SENSORS "*SHAPE", "sensor,mode 1,mode 4\n1,1,1\n", 1, 3, "mode 4 is not among *MODES, expected one that is (cell C1)"},
    {MODES SENSORS "*SHAPE", "sensor,mode 1\n1,1\n3,1\n", 3, 1, "sensor 3 is not among *SENSORS"},
    {MODES SENSORS "*SHAPE", "sensor,mode 1,1\n1,1,1\n", 2, 1, "sensor 1 is given twice for mode 1"},
    {MODES SENSORS "*SHAPE", "sensor,first\n1,1\n", 1, 1, "the table holds no value for *SHAPE"},
    {MODES SENSORS "*SHAPE", "1,1\n", 1, 1, "the first row does not say what the table of *SHAPE holds"},
    {MODES SENSORS "*SHAPE", "mode,sensor 1\none,1\n", 2, 1, "'one' is not a number, expected that of a mode"},
    {"*SHAFT, MATERIAL=steel", "group,length,outer,inner,elements\n,1,0.1,0,3\n", 2, 1, "the first section has no group"},
    {"*SHAFT, MATERIAL=steel", "group,material,length,outer,inner,elements\na,steel,1,0.1,0,3\n,tin,1,0.1,0,3\n", 3, 2,
     "material tin stands within group a, which is of steel"},
    {"*SHAFT, MATERIAL=steel", "group,length,outer,inner,elements\na,1,0.1,0.2,3\n", 2, 4,
     "inner diameter 0.2 m is not below the outer diameter 0.1 m"},
    {"*SHAFT", "group,length,outer,inner,elements\na,1,0.1,0,3\n", 2, 1, "*SHAFT has no MATERIAL"},
    {"*SHAFT, MATERIAL=steel", "group,length,outer,inner,elements\n\"a,b\",1,0.1,0,3\n", 2, 1, "'a,b' is no name of a group"}};

UNIT_TEST(a_mistake_names_row_and_column)
{
    for (size_t i = 0; i < sizeof mistakes / sizeof *mistakes; i++) {
        const struct mistake *m = &mistakes[i];
        char deck[1024];
        struct reading r;
        (void)folder_write("table.csv", m->table);
        (void)snprintf(deck, sizeof deck, MATERIAL "%s%s, FILE=table.csv\n", strstr(m->card, "*SHAFT") ? "" : SHAFT, m->card);
        try_path(&r, folder_write("deck.inp", deck), NULL);
        const rotid_message *first = r.messages.item;
        while (r.messages.count && first->severity != SEVERITY_ERROR)
            first++;
        if (r.status != ROTID_ERROR_SYNTAX || first->line != m->row || first->column != m->column ||
            !strstr(first->text, m->text) || !strstr(first->file, "table.csv")) {
            print_error("mistake %zu: %s:%d:%d: %s\n", i, r.messages.count ? first->file : "", first->line, first->column,
                        r.messages.count ? first->text : "none");
            fail();
        }
        pool_close(&r.pool);
    }
}

UNIT_TEST(a_card_has_a_table_or_data_lines)
{
    static const char *const deck[][2] = {{MATERIAL SHAFT "*MODES, FILE=table.csv\n1, 500\n", "*MODES has a FILE and data lines"},
                                          {MATERIAL SHAFT "*MODES, FILE=absent.csv\n", "absent.csv: No such file"},
                                          {MATERIAL SHAFT "*MODES, FILE=\n", "*MODES has no FILE"},
                                          {MATERIAL SHAFT "*DISK, FILE=table.csv\n", "option FILE of *DISK is not known"}};
    (void)folder_write("table.csv", "1,500\n");
    for (size_t i = 0; i < sizeof deck / sizeof *deck; i++) {
        struct reading r;
        try_path(&r, folder_write("deck.inp", deck[i][0]), NULL);
        assert_status(r.status, ROTID_ERROR_SYNTAX);
        assert_non_null(strstr(r.messages.item[0].text, deck[i][1]));
        pool_close(&r.pool);
    }
}

/* A table of bytes, all of one kind: the reader ends with one error, before it takes the memory of a machine. */
UNIT_TEST(tables_without_end_are_refused)
{
    static const char *const unit[][2] = {
        {",", "the row has more than 20100 cells"},        {"\n", "the table has more than 500000 cells"},
        {"\"", "the text is longer than 1024 characters"}, {"a", "the text is longer than 1024 characters"},
        {"1,", "the row has more than 20100 cells"},       {"1,\n", "the table has more than 500000 cells"}};
    size_t size = 3u << 20;
    char *bytes = malloc(size + 1);
    assert_non_null(bytes);
    for (size_t i = 0; i < sizeof unit / sizeof *unit; i++) {
        struct reading r;
        for (size_t b = 0; b < size; b++)
            bytes[b] = unit[i][0][b % strlen(unit[i][0])];
        bytes[size] = 0;
        (void)folder_write("table.csv", bytes);
        try_path(&r, folder_write("deck.inp", MATERIAL SHAFT "*MODES, FILE=table.csv\n"), NULL);
        assert_status(r.status, ROTID_ERROR_SYNTAX);
        assert_int_equal(r.messages.errors, 1);
        if (!strstr(r.messages.item[0].text, unit[i][1]))
            fail_msg("%zu: %s", i, r.messages.item[0].text);
        pool_close(&r.pool);
    }
    free(bytes);
}

UNIT_TEST(memory_that_is_out_is_said)
{
    static const char deck[] = MATERIAL "*SHAFT, FILE=sections.csv, MATERIAL=steel\n" MODES SENSORS "*SHAPE, FILE=table.csv\n";
    (void)folder_write("sections.csv", "group,length,outer,inner,elements\na,0.5,0.1,0,10\nb,0.5,0.12,0,10\n");
    (void)folder_write("table.csv", "sensor,1,3,std 1\n1,1,0.25,\n2,0.5,,0.01\n7,-1,0.75,\n");
    const char *path = folder_write("deck.inp", deck);
    int status = ROTID_ERROR_MEMORY;
    for (long n = 1; status == ROTID_ERROR_MEMORY; n++) {
        struct failing_allocator failing;
        struct pool pool;
        struct message_list messages;
        struct job job;
        failing_allocator_open(&failing, n);
        pool_open(&pool, &failing.allocator);
        message_open(&messages, &pool);
        status = deck_read(&pool, path, 0, NULL, &messages, &job);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
    }
    assert_status(status, ROTID_OK);
}

/* ------------------------------------------------------------------------------------------------ written tables */

/* What `rotid uff --csv` writes of the file is read as *MEASURED reads the file: with so many standard deviations, and components
 * that were not measured. */
static void assert_same_modes(const char *path, int expected_deviations, int expected_gaps)
{
    struct reading a, b;
    struct uff_tables universal;
    struct pool pool;
    struct message_list messages;
    const char *failed, *name = folder_path("u"), *file[] = {folder_path("u.modes.csv"), folder_path("u.shapes.csv")};
    char deck[2048];
    int deviations = 0, gaps = 0;
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    assert_status(uff_tables_read(&pool, path, &messages, &universal), ROTID_OK);
    assert_status(csv_write(&pool, name, (const char *const[]){"modes", "shapes", NULL}, universal.table, &failed), ROTID_OK);
    (void)snprintf(deck, sizeof deck,
                   MATERIAL "*SHAFT, NAME=core, MATERIAL=steel\n4, 0.1, 0, 400\n*MEASURED, FILE=%s, DIRECTION=%c\n"
                            "*NOISE, FLOOR_FREQUENCY=0, FLOOR_SHAPE=0\n",
                   path, "XYZ"[universal.direction]);
    try_path(&a, folder_write("measured.inp", deck), NULL);
    (void)snprintf(deck, sizeof deck,
                   MATERIAL "*SHAFT, NAME=core, MATERIAL=steel\n4, 0.1, 0, 400\n*MODES, FILE=%s\n*SENSORS, FILE=%s\n"
                            "*SHAPE, FILE=%s\n",
                   file[0], file[1], file[1]);
    try_path(&b, folder_write("tables.inp", deck), NULL);
    assert_status(a.status, ROTID_OK);
    assert_status(b.status, ROTID_OK);
    const struct job_measurement *m = &a.job.measurement, *t = &b.job.measurement;
    assert_int_equal(m->nmode, t->nmode);
    assert_int_equal(a.job.rotor.nsensor, b.job.rotor.nsensor);
    for (int k = 0; k < m->nmode; k++) {
        assert_int_equal(m->number[k], t->number[k]);
        assert_close(t->frequency_hz[k], m->frequency_hz[k], 0, 0);
        assert_int_equal(isnan(m->frequency_std[k]), isnan(t->frequency_std[k]));
        if (isfinite(m->frequency_std[k]))
            assert_close(t->frequency_std[k], m->frequency_std[k], 1e-15, 0);
        for (int s = 0; s < a.job.rotor.nsensor; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * a.job.rotor.nsensor;
            assert_int_equal(a.job.rotor.sensor[s].id, b.job.rotor.sensor[s].id);
            assert_close(b.job.rotor.sensor[s].position, a.job.rotor.sensor[s].position, 1e-15, 0);
            assert_int_equal(isnan(m->shape[at]), isnan(t->shape[at]));
            assert_int_equal(isnan(m->shape_std[at]), isnan(t->shape_std[at]));
            if (isfinite(m->shape[at]))
                assert_close(t->shape[at], m->shape[at], 0, 0);
            if (isfinite(m->shape_std[at]))
                assert_close(t->shape_std[at], m->shape_std[at], 1e-15, 0);
            deviations += isfinite(m->shape_std[at]);
            gaps += isnan(m->shape[at]);
        }
    }
    assert_int_equal(deviations, expected_deviations);
    assert_int_equal(gaps, expected_gaps);
    pool_close(&a.pool);
    pool_close(&b.pool);
    pool_close(&pool);
}

/* Two modes, the second complex and without node 2, and the standard deviations of the first, in which node 2 was measured along
 * another axis. */
static const char *write_universal(void)
{
    const struct uff_node node[] = {{.id = 7, .x = {0, 0, 0.5}}, {.id = 1, .x = {0, 0, 0.25}}, {.id = 2, .x = {0, 0, 2}}};
    int id[] = {7, 1, 2}, two[] = {7, 1};
    double real[] = {0.1, 2, 0, 0, -4, 0, 0.2, 0, 0}, part[] = {0, 1, 0, 0, -0.5, 0}, imag[] = {0, 0.1, 0, 0, 0.02, 0},
           std[] = {0, 0.04, 0, 0, 0.02, 0, 0.01, 0, 0};
    struct uff_shape shape[] = {{.model_type = 1,
                                 .analysis_type = 2,
                                 .data_characteristic = 2,
                                 .specific_type = 8,
                                 .data_type = 2,
                                 .load_case = 1,
                                 .number = 3,
                                 .frequency_hz = 100.5,
                                 .damping = 0.01,
                                 .component_count = 3,
                                 .node_count = 3,
                                 .node = id,
                                 .real = real},
                                {.model_type = 1,
                                 .analysis_type = 0,
                                 .data_characteristic = 2,
                                 .specific_type = 0,
                                 .data_type = 2,
                                 .load_case = 1,
                                 .number = 3,
                                 .component_count = 3,
                                 .node_count = 3,
                                 .node = id,
                                 .real = std},
                                {.model_type = 1,
                                 .analysis_type = 3,
                                 .data_characteristic = 2,
                                 .specific_type = 8,
                                 .data_type = 5,
                                 .load_case = 1,
                                 .number = 4,
                                 .is_complex = 1,
                                 .eigenvalue = {-5, 1500},
                                 .component_count = 3,
                                 .node_count = 2,
                                 .node = two,
                                 .real = part,
                                 .imag = imag}};
    (void)strcpy(shape[1].id[0], "ROTID STANDARD DEVIATION OF MODE 3");
    (void)strcpy(shape[1].id[1], "FREQUENCY_HZ 0.02 DAMPING 0");
    const char *path = folder_path("modes.uff");
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    assert_status(uff_write_nodes(out, 2411, 3, node), ROTID_OK);
    for (int i = 0; i < 3; i++)
        assert_status(uff_write_shape(out, &shape[i]), ROTID_OK);
    assert_int_equal(fclose(out), 0);
    return path;
}

UNIT_TEST(tables_of_a_universal_file_are_the_measured_modes)
{
    assert_same_modes(ROTID_SOURCE_DIR "/input/data/converged_steel.uff", 0, 0);
    assert_same_modes(write_universal(), 2, 2);
}

POOL_TEST(a_text_in_a_table_is_no_formula)
{
    static const char *const text[][2] = {{"core.E", "core.E"},
                                          {"a,b", "\"a,b\""},
                                          {"say \"x\"", "\"say \"\"x\"\"\""},
                                          {"=1+1", "'=1+1"},
                                          {"@sum(a,b)", "\"'@sum(a,b)\""}};
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        const char *path = folder_path("cell");
        FILE *out = fopen(path, "w");
        assert_non_null(out);
        struct table *table = table_open(&test_pool, "");
        text_column(table, "a", SHOW_TEXT, text[i][0]);
        number_column(table, "b", NULL, SHOW_DIGITS(1), 0.1);
        number_column(table, "c", NULL, SHOW_DIGITS(1), NAN);
        table_write_csv(out, table);
        assert_int_equal(fclose(out), 0);
        char *bytes = file_bytes(path, NULL), expected[64];
        (void)snprintf(expected, sizeof expected, "a,b,c\n%s,0.1,\n", text[i][1]);
        assert_string_equal(bytes, expected);
        free(bytes);
    }
}

UNIT_TEST(cells_are_named_as_spreadsheets_do)
{
    char name[TABLE_CELL_LENGTH];
    assert_string_equal(table_cell_name(1, 1, name), "A1");
    assert_string_equal(table_cell_name(20, 26, name), "Z20");
    assert_string_equal(table_cell_name(7, 27, name), "AA7");
    assert_string_equal(table_cell_name(1048576, 16384, name), "XFD1048576"); /* the last one of Excel and of LibreOffice */
}

TEST_GROUP(folder_make, folder_remove);
