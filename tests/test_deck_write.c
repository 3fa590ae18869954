/* A deck that is written is the text it was read from, with what has to change in it, and reads as what was meant. */
#include <glob.h>
#include <sys/stat.h>
#include <unistd.h>

#include "deck/deck.h"
#include "diagnose/causes/causes.h"
#include "folder.h"
#include "reading.h"
#include "run/run.h"
#include "same_job.h"
#include "support.h"

#define STEEL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
#define MODEL STEEL "*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 20\n"
#define TWO   STEEL "*SHAFT, NAME=left, MATERIAL=steel\n0.4, 0.1, 0, 8\n*SHAFT, NAME=core, MATERIAL=steel\n0.6, 0.14, 0, 12\n"
#define BAR                                                                                                                      \
    "*HEADING\na bar\n" STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n0.25, 0.05, 0, 10\n0.75, 0.05, 0, 30\n*SHAFT, NAME=end, "       \
    "MATERIAL=steel\n0.5, 0.04, 0, 20\n*DISK, NAME=d\n0.3, 1\n*SENSORS\n1, 0\n2, 0.5\n3, bar.end\n"                              \
    "*NOISE, FREQUENCY=0.001, SHAPE=0.01\n*SPRING, NAME=left\n0, 1e6\n*CAUSE, NAME=soft, TYPE=stiffness_local\nz, 0.4\n"         \
    "width, 0.05\ndepth, 0.2\n"
#define UNKNOWN "*IDENTIFY\nbar.E, 1e10, 1e12, 1e11\n"
#define FREE    "*STATE, NAME=free\n*MODES\n1, 225\n2, 610\n"
#define HELD    "*STATE, NAME=held\n*SPRING, NAME=right\nend, 1e7\n*MODES\n1, 300\n3, 900\n"

static const char *write_with(const struct states *given, const struct states *meant, const struct deck_write_options *options)
{
    struct message_list notes;
    char *text;
    message_open(&notes, &test_pool);
    int status = deck_write(&test_pool, given, meant, options, &notes, &text);
    for (size_t i = 0; i < notes.count; i++)
        print_error("%s\n", notes.item[i].text);
    assert_status(status, ROTID_OK);
    return text;
}

static void assert_same_states(const struct states *a, const struct states *b)
{
    assert_int_equal(a->nstate, b->nstate);
    assert_int_equal(a->nparameter, b->nparameter);
    for (int p = 0; p < a->nparameter; p++)
        assert_string_equal(a->bounds[p].name, b->bounds[p].name);
    for (int s = 0; s < a->nstate; s++) {
        if (a->nstate > 1)
            assert_string_equal(a->state[s].name, b->state[s].name);
        assert_same_job(&a->state[s].job, &b->state[s].job);
    }
}

/* ------------------------------------------------------------------------------------------------ what is there stays */

/* Calls `check` with each deck of the project. */
static void for_each_deck(void check(const char *))
{
    static const char *const folders[] = {ROTID_SOURCE_DIR "/input/*.inp", ROTID_SOURCE_DIR "/tests/data/decks/*.inp"};
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        glob_t found;
        assert_int_equal(glob(folders[i], 0, NULL, &found), 0);
        assert_true(found.gl_pathc > 4);
        for (size_t k = 0; k < found.gl_pathc; k++)
            check(found.gl_pathv[k]);
        globfree(&found);
    }
}

static void is_its_own_text(const char *path)
{
    const struct states given = read_states_at(path, NULL);
    const char *text = write_with(&given, &given, NULL);
    char *own = file_bytes(path, NULL);
    int named = 0;
    for (const char *a = own, *b = text; *a || *b;) {
        size_t n = strcspn(a, "\n"), m = strcspn(b, "\n");
        char line[1100];
        (void)snprintf(line, sizeof line, "%.*s", (int)n, a);
        if (strstr(line, "FILE=")) { /* the path has become absolute, the rest of the line is the same */
            named++;
            assert_non_null(memchr(b, '/', m));
        } else {
            assert_int_equal(n, m);
            assert_memory_equal(a, b, n);
        }
        a += n + (a[n] == '\n');
        b += m + (b[m] == '\n');
    }
    free(own);
    assert_true(named < 10);
    const struct states back = read_states(text);
    assert_same_states(&given, &back);
}

POOL_TEST(a_deck_that_says_what_is_meant_is_its_own_text)
{
    for_each_deck(is_its_own_text);
}

/* ------------------------------------------------------------------------------------------------ whatever may change */

static double *scaled(const double *from, ptrdiff_t count, double factor, double step)
{
    double *to = POOL_ARRAY(&test_pool, double, count);
    for (ptrdiff_t i = 0; i < count && from; i++)
        to[i] = from[i] * (factor + step * (double)(i % 5));
    return from ? to : NULL;
}

/* Another *FIT, elements, noise (of all modes, or each its own), modes held out, starts, and a cause. */
static struct states changed(const struct states *given, int each)
{
    struct states meant;
    assert_int_equal(states_copy(&test_pool, given, &meant), ROTID_OK);
    rotid_parameter *all = POOL_ARRAY(&test_pool, rotid_parameter, meant.nparameter);
    for (int p = 0; p < meant.nparameter; p++) {
        all[p] = meant.bounds[p];
        all[p].start = 0.75 * all[p].start + 0.25 * (all[p].start > 0 ? fmin(all[p].upper, 2 * all[p].start) : all[p].upper);
    }
    meant.bounds = all;
    for (int s = 0; s < meant.nstate; s++) {
        struct job *job = &meant.state[s].job;
        struct job_measurement *m = &job->measurement;
        struct segment *segment = POOL_ARRAY(&test_pool, struct segment, job->rotor.nsegment);
        struct effect *effect = POOL_ARRAY(&test_pool, struct effect, job->rotor.neffect + 1);
        rotid_parameter *bounds = POOL_ARRAY(&test_pool, rotid_parameter, job->unknowns.nparameter);
        int *holdout = POOL_ARRAY(&test_pool, int, m->nmode);
        for (int i = 0; i < job->rotor.nsegment; i++) {
            segment[i] = job->rotor.segment[i];
            segment[i].elements += 2;
        }
        for (int i = 0; i < job->rotor.neffect; i++)
            effect[i] = job->rotor.effect[i];
        effect[job->rotor.neffect++] =
            (struct effect){.name = "found",
                            .kind = catalogue_find("added_mass")->effect,
                            .target = -1,
                            .value = {0.02 * rotor_mass(&job->rotor), 0.5 * rotor_length(&job->rotor)}};
        for (int p = 0; p < job->unknowns.nparameter; p++)
            bounds[p] = all[state_unknown(&meant.state[s], p)];
        for (int k = 0; k < m->nmode; k++)
            holdout[k] = k % 2 == 0 && m->nmode > 2;
        job->rotor.segment = segment;
        job->rotor.effect = effect;
        job->unknowns.bounds = bounds;
        m->holdout = holdout;
        job->options.has_fit = 1;
        job->options.fit.functional = ROTID_HYBRID_F;
        job->options.fit.reduction = ROTID_REDUCTION_NONE;
        job->options.fit.derivative = ROTID_NELSON;
        if (m->raw || m->point_frequency_hz)
            continue;
        double *std = POOL_ARRAY(&test_pool, double, m->nmode);
        for (int k = 0; k < m->nmode; k++)
            std[k] = 0.002 * (1 + 0.1 * each * k);
        m->frequency_std = std;
        if (m->shape)
            m->shape_std = scaled(m->shape_std, (ptrdiff_t)job->rotor.nsensor * m->nmode, 1.25, 0.125 * each);
    }
    return meant;
}

static int each_mode;

/* Stated where it differs, and nothing else lost: compared field by field with what was meant by a comparison that shares nothing
 * with that of the writer. */
static void says_what_is_meant(const char *path)
{
    const struct states given = read_states_at(path, NULL), meant = changed(&given, each_mode);
    if (!given.state->job.unknowns.nparameter || !given.state->job.measurement.nmode || given.state->job.options.solid)
        return;
    const struct states back = read_states(write_with(&given, &meant, NULL));
    same_job_rounding = 1e-12;
    assert_same_states(&meant, &back);
    same_job_rounding = 0;
}

POOL_TEST(whatever_differs_is_stated)
{
    for (each_mode = 0; each_mode < 2; each_mode++)
        for_each_deck(says_what_is_meant);
}

/* One deck reads as another that has more in it. */
POOL_TEST(what_is_new_is_added)
{
    static const struct {
        const char *given, *meant;
    } pair[] = {
        {MODEL, MODEL "*MODES\n3, 2400, , 0.7\n1, 500\n2, 1300, 0.01\n"},
        {MODEL "*MODES\n1, 500\n2, 1300\n",
         MODEL "*MODES\n1, 500\n2, 1300\n*IDENTIFY\ncore.E, 0, 1e12, 2e11\ncore.G, 0, 1e12, 8e10\n"},
        {MODEL "*MODES\n1, 500\n2, 1300\n*SENSORS\n1, 0\n2, 0.5\n3, 1\n",
         MODEL "*MODES\n1, 500\n2, 1300\n*SENSORS\n1, 0\n2, 0.5\n3, 1\n*SHAPE, MODE=2\n3, 1\n1, -0.1, 0.03\n"},
        {MODEL "*MODES\n1, 500\n2, 1300\n",
         MODEL "*MODES\n1, 501\n2, 1300.1\n*FIT, HOLDOUT=2, DERIVATIVE=MODAL, REDUCTION=GUYAN\n"},
        {MODEL "*MODES\n1, 500\n2, 1300\n3, 2000\n*FIT, FUNCTIONAL=HYBRID, ** why\n   MODES=1,3\n",
         MODEL "*MODES\n1, 500\n2, 1300\n3, 2000\n*FIT, FUNCTIONAL=HYBRID, HOLDOUT=1,3\n"},
        {MODEL "*MODES\n1, 500\n2, 1300\n3, 2000\n*FIT, HOLDOUT=1, 3, FUNCTIONAL=HYBRID\n",
         MODEL "*MODES\n1, 500\n2, 1300\n3, 2000\n*FIT, FUNCTIONAL=HYBRID\n"},
        {MODEL, MODEL "*FIT, MODEL=SOLID\n"},
        {TWO, TWO "*CAUSE, NAME=j, TYPE=joint, BETWEEN=left,core\nflexibility, 1e-9\n*CAUSE, NAME=t, TYPE=density, GROUP=core\n"
                  "factor, 0.9\n"},
        {TWO "*SPRING\n0.1, 1e6\n0.5, 1e7, 10\n0.9, 1e6\n",
         TWO "*SPRING\n0.1, 1e6\n*SPRING, NAME=spring\n0.5, 1e7, 10\n*SPRING\n0.9, 1e6\n"
             "*CAUSE, NAME=p, TYPE=support_position, AT=spring\nshift, 0.01\n"},
        {TWO "*SPRING\n0.1, 1e6\n0.5, 1e7\n", TWO "*SPRING, NAME=spring\n0.1, 1e6\n*SPRING\n0.5, 1e7\n"
                                                  "*CAUSE, NAME=p, TYPE=support_position, AT=spring\nshift, 0.01\n"},
        {TWO "*CAUSE, NAME=s, TYPE=joint, BETWEEN=left,core, SUSPECT\n*CAUSE, NAME=m, TYPE=added_mass, SUSPECT\n",
         TWO "*CAUSE, NAME=m, TYPE=added_mass, SUSPECT\n*CAUSE, NAME=s, TYPE=joint, BETWEEN=left,core\nflexibility, 1e-9\n"
             "*IDENTIFY\ns.flexibility, 0, 1e-8, 1e-9\n"},
        {MODEL "*MODES\n1, 500\n2, 1300\n*SENSORS\n1, 0\n2, 0.5\n3, 1\n*SHAPE, MODE=1\n1, 1\n2, -0.5\n3, 1\n*NOISE, SHAPE=0.01\n",
         MODEL "*MODES\n1, 500\n2, 1300\n*SENSORS\n1, 0\n2, 0.5\n3, 1\n*SHAPE, MODE=1\n1, 1\n2, -0.5\n3, 1\n*NOISE, SHAPE=0.01\n"
               "*CAUSE, NAME=a, TYPE=sensor_gain, SENSOR=2\ngain, 1.2\n*CAUSE, NAME=b, TYPE=sensor_swap, SENSOR=1,3\n"
               "*CAUSE, NAME=c, TYPE=noise_level, AT=SHAPE\nfactor, 1.5\n"},
        {BAR UNKNOWN FREE HELD,
         BAR UNKNOWN "*CAUSE, NAME=m, TYPE=added_mass\nz, 0.4\nmass, 0.5\n*IDENTIFY\nm.mass, 0.1, 2, 0.5\n" FREE HELD},
        {BAR UNKNOWN FREE HELD,
         BAR UNKNOWN FREE "*CAUSE, NAME=m, TYPE=added_mass\nz, 0.4\nmass, 0.5\n*IDENTIFY\nm.mass, 0.1, 2, 0.5\n" HELD},
        {BAR UNKNOWN FREE HELD, BAR UNKNOWN FREE HELD "*NOISE, FREQUENCY=0.003, SHAPE=0.02\n"},
        {BAR UNKNOWN FREE HELD, BAR UNKNOWN "*FIT, HOLDOUT=3\n*STATE, NAME=free\n*MODES\n1, 225\n3, 610\n" HELD},
        {BAR UNKNOWN "*FIT, FUNCTIONAL=HYBRID_F, HOLDOUT=STATE:free\n" FREE HELD, BAR UNKNOWN
         "*FIT, FUNCTIONAL=HYBRID_F, HOLDOUT=STATE:free\n" FREE "*STATE, NAME=held, HOLDOUT=3\n*SPRING, NAME=right\nend, "
         "1e7\n*MODES\n1, 300\n3, 900\n"},
        {BAR UNKNOWN "*FIT, STATE=held\n" FREE HELD,
         BAR UNKNOWN "*FIT, STATE=held\n" FREE HELD "*CAUSE, NAME=m, TYPE=added_mass\nz, 0.4\nmass, 0.5\n"},
    };
    same_job_rounding = 1e-13;
    for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
        const struct states given = read_states(pair[i].given), meant = read_states(pair[i].meant);
        const struct states back = read_states(write_with(&given, &meant, NULL));
        for (int s = 0; s < back.nstate; s++) /* stated or not, it is the same */
            back.state[s].job.options.has_fit = meant.state[s].job.options.has_fit;
        assert_same_states(&meant, &back);
    }
    same_job_rounding = 0;
}

/* A diagnosis names the unknowns of a cause in one state as if they were of all. */
POOL_TEST(an_unknown_of_a_cause_in_one_state_is_of_that_state)
{
    const struct states given = read_states(BAR UNKNOWN FREE HELD),
                        meant = read_states(BAR UNKNOWN FREE HELD "*CAUSE, NAME=m, TYPE=added_mass\nz, 0.4\nmass, 0.5\n"
                                                                  "*IDENTIFY\nm.mass, 0.1, 2, 0.5\n");
    assert_string_equal(meant.state[1].job.unknowns.bounds[1].name, "held:m.mass");
    meant.state[1].job.unknowns.bounds[1].name = "m.mass";
    const struct states back = read_states(write_with(&given, &meant, NULL));
    meant.state[1].job.unknowns.bounds[1].name = "held:m.mass";
    assert_same_states(&meant, &back);
}

/* A group whose name is an option or holds an equals sign cannot stand behind a comma. */
POOL_TEST(names_may_be_odd)
{
    static const char *const right[] = {"SUSPECT", "a=b", "name", "2", "at", "*x", "two words", "a.b", "\xc3\xa4", "gr*"};
    for (size_t i = 0; i < sizeof right / sizeof *right; i++) {
        const char *given = pool_format(&test_pool,
                                        "*MATERIAL, NAME=*s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=1, MATERIAL=*s\n"
                                        "0.5, 0.1, 0, 9\n*SHAFT, NAME=%s, MATERIAL=*s\n0.5, 0.1, 0, 9\n",
                                        right[i]);
        const struct states a = read_states(given),
                            b = read_states(pool_format(&test_pool,
                                                        "%s*CAUSE, NAME=j=1, TYPE=joint, AT=0.5\nflexibility, 1e-9\n"
                                                        "*CAUSE, NAME=type, TYPE=density, GROUP=%s\nfactor, 0.9\n",
                                                        given, right[i]));
        const struct states back = read_states(write_with(&a, &b, NULL));
        assert_same_states(&b, &back);
    }
}

/* ------------------------------------------------------------------------------------------------ the user's words */

static int count(const char *text, const char *what)
{
    int n = 0;
    for (const char *at = text; (at = strstr(at, what)); at++)
        n++;
    return n;
}

/* Comments, units and line ends of the deck; in its units too what is new. */
POOL_TEST(what_is_new_stands_in_the_units_of_the_deck)
{
    static const char *const given =
        "** of today\r\n*HEADING\r\nin millimetres\r\n** steel\r\n*UNITS, LENGTH=MM, MASS=G, STIFFNESS=N/MM, FREQUENCY=KHZ, "
        "MODULUS=MPA\r\n*MATERIAL, NAME=s\r\n*ELASTIC\r\n210000, 0.3\r\n*DENSITY\r\n7850\r\n*SHAFT, NAME=bar, MATERIAL=s ** "
        "solid\r\n"
        "400, 30, 0, 40 ** left\r\n400, 30, 0, 40\r\n*SPRING, NAME=foam\r\n100, 0.5\r\n*MODES\r\n1, 0.2\r\n2, 0.55\r\n3, 1.07\r\n"
        "** what is sought\r\n*IDENTIFY\r\nbar.E, 1e4, 6e5, 2.1e5 ** start of a handbook\r\nfoam.k, 0.01, 100, 0.5\r\n** the "
        "end\r\n";
    const struct states first = read_states(given);
    struct states meant;
    struct segment segment[2];
    struct effect mass = {.name = "m", .kind = catalogue_find("added_mass")->effect, .target = -1, .value = {0.25, 0.3}};
    assert_int_equal(states_copy(&test_pool, &first, &meant), ROTID_OK);
    struct job *job = &meant.state->job;
    memcpy(segment, job->rotor.segment, sizeof segment);
    segment[1].elements = 60;
    job->rotor.segment = segment;
    job->rotor.effect = &mass;
    job->rotor.neffect = 1;
    for (int p = 0; p < effect_parameters(&mass); p++) /* value in the order of the cause */
        mass.value[p] = !strcmp(mass.kind->parameter[p].name, "mass") ? 0.25 : 0.3;
    static const double x[] = {2.05e11, 2000};
    const struct deck_write_options options = {.x = x};
    const char *text = write_with(&first, &meant, &options);
    assert_int_equal(count(text, "\n"), count(text, "\r\n"));
    static const char *const expected[] = {
        "** of today\r\n*HEADING",
        "** steel\r\n*UNITS",
        "MATERIAL=s ** solid\r\n400, 30, 0, 40 ** left\r\n400, 30, 0, 60\r\n",
        "bar.E, 1e4, 6e5, 205000 ** start of a handbook\r\nfoam.k, 0.01, 100, 2\r\n** the end\r\n",
        "TYPE=added_mass",
        "z, 300\r\n",
        "mass, 250\r\n"};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        if (!strstr(text, expected[i]))
            print_error("%s\nlacks %s\n", text, expected[i]);
        assert_non_null(strstr(text, expected[i]));
    }
    const struct states back = read_states(text);
    assert_close(back.bounds[0].start, 2.05e11, 1e-14, 0);
    assert_close(back.bounds[1].start, 2000, 1e-14, 0);
}

/* Tables with a column of groups, one behind the other and between groups that have names, whose elements change. */
POOL_TEST(a_table_of_groups_becomes_a_card_for_each)
{
    (void)folder_write("left.csv", "group,material,length,outer diameter,inner "
                                   "diameter,elements\na,steel,0.2,0.05,0,4\n,,0.1,0.04,0,2\nb,other,0.2,0.06,0,4\n");
    (void)folder_write("right.csv", "group,length,outer diameter,inner diameter,elements\nd,0.2,0.05,0,4\n");
    const char *path = folder_write("deck.inp", STEEL
                                    "*MATERIAL, NAME=other\n*ELASTIC\n1e11, 0.3\n*DENSITY\n7000\n*SHAFT, FILE=left.csv\n*SHAFT, "
                                    "FILE=right.csv, MATERIAL=steel\n*SHAFT, NAME=e, MATERIAL=other\n0.3, 0.05, 0, 6\n*SHAFT, "
                                    "FILE=last.csv, MATERIAL=steel\n*MODES\n1, 225\n*IDENTIFY\na.E, 1e10, 1e12, 2e11\n");
    (void)folder_write("last.csv", "group,length,outer diameter,inner diameter,elements\nf,0.2,0.05,0,4\ng,0.1,0.05,0,4\n");
    const struct states given = read_states_at(path, NULL);
    struct states meant;
    struct segment segment[7];
    assert_int_equal(states_copy(&test_pool, &given, &meant), ROTID_OK);
    assert_int_equal(meant.state->job.rotor.nsegment, 7);
    memcpy(segment, meant.state->job.rotor.segment, sizeof segment);
    for (int i = 0; i < 7; i++)
        segment[i].elements *= 2;
    meant.state->job.rotor.segment = segment;
    const char *text = write_with(&given, &meant, NULL);
    assert_null(strstr(text, "FILE"));
    assert_non_null(strstr(text, "0.1, 0.04, 0, 4\n*SHAFT, NAME=b, MATERIAL=other\n0.2, 0.06, 0, 8\n"));
    const struct states back = read_states(text);
    assert_same_states(&meant, &back);
}

/* Lines without elements, and without a bore or with an empty one, get those of a finer mesh; comments stay. */
POOL_TEST(elements_are_written_where_none_were_given)
{
    const struct states given = read_states(
        STEEL
        "*SHAFT, NAME=bar, MATERIAL=steel\n0.2, 0.05 ** solid\n0.2, 0.06,\n0.2, 0.05, , \n0.2, 0.06, 0.01\n0.2, 0.05, 0, 9\n"
        "*BEAM, NAME=flat, MATERIAL=steel\n0.2, 0.01, 0.03\n" FREE);
    struct states meant;
    struct segment segment[6];
    assert_int_equal(states_copy(&test_pool, &given, &meant), ROTID_OK);
    memcpy(segment, meant.state->job.rotor.segment, sizeof segment);
    for (int i = 0; i < 6; i++)
        segment[i].elements = 1000 + i;
    meant.state->job.rotor.segment = segment;
    const char *text = write_with(&given, &meant, NULL);
    assert_non_null(strstr(text, "0.2, 0.05, 0, 1000 ** solid\n"));
    assert_non_null(strstr(text, "0.2, 0.06, 0.01, 1003\n0.2, 0.05, 0, 1004\n"));
    assert_non_null(strstr(text, "0.2, 0.01, 0.03, 1005\n"));
    const struct states back = read_states(text);
    assert_same_states(&meant, &back);
}

/* Those of bars too, of all states and of one. */
POOL_TEST(elements_of_bars_are_written)
{
    const struct states given = read_states(
        BAR "*BARS, NAME=a, MATERIAL=steel, CENTER=0.5, LENGTH=0.4, MODEL=TUBE\n8, 0.006, 0.015, 4 ** copper\n" UNKNOWN FREE
            "*STATE, NAME=more\n*BARS, NAME=b, MATERIAL=steel, CENTER=0.5, LENGTH=0.4, MODEL=TUBE\n8, 0.006, 0.01, "
            "6\n*MODES\n1, 220\n2, 600\n");
    struct states meant;
    struct bars bars[3];
    assert_int_equal(states_copy(&test_pool, &given, &meant), ROTID_OK);
    bars[0] = given.state[0].job.rotor.bars[0];
    memcpy(bars + 1, given.state[1].job.rotor.bars, 2 * sizeof *bars);
    for (int i = 0; i < 3; i++)
        bars[i].elements *= 8;
    meant.state[0].job.rotor.bars = bars;
    meant.state[1].job.rotor.bars = bars + 1;
    const char *text = write_with(&given, &meant, NULL);
    assert_non_null(strstr(text, "8, 0.006, 0.015, 32 ** copper\n"));
    assert_non_null(strstr(text, "8, 0.006, 0.01, 48\n"));
    const struct states back = read_states(text);
    assert_same_states(&meant, &back);
}

/* A file that is included stays one where none of its cards changes; a table becomes lines where its elements change. */
POOL_TEST(files_stay_where_they_can)
{
    assert_int_equal(mkdir(folder_path("below"), 0700), 0);
    (void)folder_write("below/shaft.inc", STEEL "** the shaft\n*SHAFT, NAME=bar, MATERIAL=steel, FILE=shaft.csv\n");
    (void)folder_write("below/shaft.csv", "length,outer diameter,inner diameter,elements\n0.5,0.05,0,10\n0.5,0.04,0,10\n");
    (void)folder_write("modes.csv", "mode,frequency [Hz]\n1,225\n2,610\n");
    const char *path = folder_write("deck.inp", "*INCLUDE, FILE=below/shaft.inc\n** measured\n*MODES,\n FILE=modes.csv ** today\n"
                                                "*IDENTIFY\nbar.E, 1e10, 1e12, 2e11\n");
    const struct states given = read_states_at(path, NULL);
    const double x[] = {1.9e11};
    const struct deck_write_options options = {.x = x};
    const char *text = write_with(&given, &given, &options);
    assert_non_null(strstr(text, pool_format(&test_pool,
                                             "*INCLUDE, FILE=%s/below/shaft.inc\n** measured\n*MODES,\n FILE=%s/modes.csv "
                                             "** today\n",
                                             folder, folder)));
    assert_non_null(strstr(text, "bar.E, 1e10, 1e12, 1.9e11"));
    struct states meant;
    struct segment segment[2];
    assert_int_equal(states_copy(&test_pool, &given, &meant), ROTID_OK);
    memcpy(segment, meant.state->job.rotor.segment, sizeof segment);
    segment[1].elements = 30;
    meant.state->job.rotor.segment = segment;
    text = write_with(&given, &meant, NULL);
    assert_null(strstr(text, "*INCLUDE"));
    assert_non_null(strstr(text, "** the cards of below/shaft.inc"));
    assert_non_null(strstr(text, "** the shaft\n*SHAFT, NAME=bar, MATERIAL=steel\n0.5, 0.05, 0, 10\n0.5, 0.04, 0, 30\n"));
    const struct states back = read_states(text);
    assert_same_states(&meant, &back);
    /* beside the deck its paths are relative, elsewhere they are not */
    struct message_list notes;
    char *placed;
    message_open(&notes, &test_pool);
    assert_status(deck_place(&test_pool, path, text, folder_path("next.inp"), &notes, &placed), ROTID_OK);
    assert_non_null(strstr(placed, "*MODES,\n FILE=modes.csv ** today\n"));
    assert_status(deck_place(&test_pool, path, text, folder_path("below/next.inp"), &notes, &placed), ROTID_OK);
    assert_non_null(strstr(placed, pool_format(&test_pool, " FILE=%s/modes.csv", folder)));
    assert_status(deck_place(&test_pool, path, text, folder_path("nowhere/next.inp"), &notes, &placed), ROTID_ERROR_IO);
    assert_int_equal(unlink(folder_path("below/shaft.inc")) | unlink(folder_path("below/shaft.csv")), 0);
    assert_int_equal(rmdir(folder_path("below")), 0);
}

/* What --set said for the run stands in the deck. */
POOL_TEST(what_was_set_for_the_run_is_written)
{
    static const char *const set[] = {"FIT.REDUCTION=NONE", "FIT.HOLDOUT=2", "NOISE.FREQUENCY=0.002"};
    const char *path =
        folder_write("deck.inp", MODEL "*MODES\n1, 500\n2, 1300\n3, 2000\n** how\n*FIT, REDUCTION=GUYAN, FUNCTIONAL=HYBRID\n");
    for (size_t i = 0; i < sizeof set / sizeof *set; i++) {
        struct override override;
        assert_int_equal(override_parse(&test_pool, set[i], &override), 0);
        const struct states given = read_states_at(path, &override), back = read_states(write_with(&given, &given, NULL));
        assert_same_states(&given, &back);
    }
}

POOL_TEST(extra_lines_go_into_the_heading_and_harm_nothing)
{
    static char longest[2000];
    static const char *const extra[] = {
        "found by diagnose: joint", "*SHAFT, no card", "a ** no comment", "", "tab\tand\nend", longest};
    static const char *const expected[] = {"the deck", "found by diagnose: joint", "SHAFT, no card", "a  * no comment",
                                           "tab and end"};
    const struct deck_write_options options = {.nextra = sizeof extra / sizeof *extra, .extra = extra};
    memset(longest, 'x', 1023);
    (void)strcpy(longest + 1023, "\xc3\xa4 and more"); /* the character does not fit */
    for (int with = 0; with < 2; with++) {
        const struct states given = read_states(
            with ? "** first\n*HEADING\nthe deck\npaper error_percent = 1, 2\n\n** the model\n" MODEL : "** first\n" MODEL);
        const char *text = write_with(&given, &given, &options);
        const struct states second = read_states(text);
        const struct job *job = &second.state->job;
        assert_int_equal(strncmp(text, "** first\n*HEADING\n", 18), 0);
        assert_int_equal(job->nheading, 5 + with);
        for (int i = !with; i < 5; i++)
            assert_string_equal(job->heading[i - !with], expected[i]);
        assert_int_equal(strlen(job->heading[job->nheading - 1]), 1023);
        assert_true(!with || (job->nreference == 1 && job->reference[0].values[1] == 2));
    }
}

/* ------------------------------------------------------------------------------------------------ values */

POOL_TEST(written_at_x_the_starts_are_those_of_x)
{
    static const double x[] = {1.9e11, 3e-8, -0.07}, own[] = {1.5e11, 2e6, 2.5e11};
    struct deck_write_options options = {.x = x};
    const struct states first = read_states(
                            TWO
                            "*CAUSE, NAME=j, TYPE=joint, BETWEEN=left,core\nflexibility, 0\n"
                            "*CAUSE, NAME=t, TYPE=stiffness_gradient, GROUP=core\nslope, 0\n*MODES\n1, 500\n2, 1300\n3, 2400\n"
                            "*IDENTIFY\ncore.E, 1e10, 4e11, 2e11\nj.flexibility, 0, 1e-7, 1e-8\nt.slope, -0.5, 0.5, 0.1\n"),
                        second = read_states(write_with(&first, &first, &options));
    for (int p = 0; p < 3; p++)
        assert_true(second.bounds[p].start == x[p] && second.bounds[p].lower == first.bounds[p].lower);
    assert_true(first.state->job.unknowns.bounds[0].start == 2e11); /* untouched */
    /* of states each its own */
    const struct states states =
        read_states(BAR UNKNOWN FREE "*STATE, NAME=own\n*IDENTIFY\nleft.k, 1e3, 1e9, 1e5\nbar.E, 1e10, 1e12, 3e11\n"
                                     "*MODES\n1, 225\n2, 610\n");
    assert_int_equal(states.nparameter, 3);
    options.x = own;
    const struct states back = read_states(write_with(&states, &states, &options));
    for (int p = 0; p < 3; p++)
        assert_true(back.bounds[p].start == own[p] && !strcmp(back.bounds[p].name, states.bounds[p].name));
}

/* A start lies between its bounds and is no zero; a cause lies inside what is possible in the deck it comes into. */
POOL_TEST(what_lies_on_a_bound_is_still_a_deck)
{
    double lower, upper, x[] = {4e11, 0, 0.5};
    const struct deck_write_options options = {.x = x};
    const struct states given = read_states(TWO "*MODES\n1, 500\n2, 1300\n3, 2400\n*IDENTIFY\ncore.E, 1e10, 4e11, 2e11\n"),
                        meant = read_states(TWO "*CAUSE, NAME=j, TYPE=joint, BETWEEN=left,core\nflexibility, 0\n"
                                                "*CAUSE, NAME=t, TYPE=stiffness_gradient, GROUP=core\nslope, 0\n*MODES\n1, 500\n"
                                                "2, 1300\n3, 2400\n*IDENTIFY\ncore.E, 1e10, 4e11, 2e11\n"
                                                "j.flexibility, 0, 1e-8, 1e-9\nt.slope, -0.5, 0.5, 0.1\n");
    struct job *job = &meant.state->job;
    cause_reach(catalogue_of(job->rotor.effect), &given.state->job.rotor, job->rotor.effect, 0, &lower, &upper);
    job->unknowns.bounds[1].upper = 2 * upper; /* as it was possible with another E */
    x[1] = 2 * upper;
    for (int zero = 0; zero < 2; zero++) {
        x[2] = zero ? 0 : 0.5; /* zero is no scale */
        const struct states back = read_states(write_with(&given, &meant, &options));
        const rotid_parameter *bounds = back.state->job.unknowns.bounds;
        assert_close(bounds[1].upper, upper, 1e-12, 0);
        for (int p = 0; p < 3; p++)
            assert_true(bounds[p].start > bounds[p].lower && bounds[p].start < bounds[p].upper);
        assert_true(!zero || bounds[2].start == 0.1);
    }
}

POOL_TEST(two_modes_of_one_frequency_stay_two)
{
    const struct states given = read_states(MODEL "*MODES\n1, 500\n2, 1300\n3, 1400\n");
    struct states meant;
    double hz[] = {500, 1300, 1300}; /* as a universal file may have it */
    assert_int_equal(states_copy(&test_pool, &given, &meant), ROTID_OK);
    meant.state->job.measurement.frequency_hz = hz;
    const struct states back = read_states(write_with(&given, &meant, NULL));
    assert_true(back.state->job.measurement.frequency_hz[1] == 1300 &&
                back.state->job.measurement.frequency_hz[2] == nextafter(1300, INFINITY));
}

POOL_TEST(a_fit_runs_from_the_written_deck_to_where_it_stood)
{
    struct message_list notes;
    struct identification before, after;
    message_open(&notes, &test_pool);
    const struct states given = read_states_at(ROTID_SOURCE_DIR "/input/foam_bar.inp", NULL);
    assert_status(identify_run(&test_pool, &given.state->job, 0, NULL, &notes, &before), ROTID_OK);
    const struct deck_write_options options = {.x = before.fit->x};
    const struct states back = read_states(write_with(&given, &given, &options));
    assert_status(identify_run(&test_pool, &back.state->job, 0, NULL, &notes, &after), ROTID_OK);
    assert_close(after.fit->x[0], before.fit->x[0], 1e-7, 0);
    assert_close(after.fit->objective, before.fit->objective, 1e-9, 0);
    rotid_fit_free(before.fit);
    rotid_fit_free(after.fit);
}

/* ------------------------------------------------------------------------------------------------ what a deck cannot say */

static int status_of(const struct states *given, const struct states *meant, const char **said)
{
    struct message_list notes;
    char *text;
    message_open(&notes, &test_pool);
    int status = deck_write(&test_pool, given, meant, NULL, &notes, &text);
    assert_true((status == ROTID_OK) == (text != NULL));
    *said = notes.count ? notes.item[0].text : "";
    return status;
}

/* Another rotor than that of the text is none of what can be stated: the card is named. */
POOL_TEST(what_no_deck_can_say_is_refused)
{
    static char longest[1100];
    static const char *const names[] = {"a,b", "", " a", "a ", "a**b", "a\nb", longest, NULL};
    static const struct {
        const char *given, *meant, *card;
    } other[] = {
        {MODEL, TWO, "*SHAFT"},
        {MODEL "*DISK\n0.5, 1\n", MODEL "*DISK\n0.5, 1.0001\n", "*DISK"},
        {MODEL, MODEL "*SPRING\n0.5, 1e6\n", "*SPRING"},
        {MODEL, MODEL "*SLING, LENGTH=1\n", "*SLING"},
        {MODEL, MODEL "*PRELOAD, GROUP=core\n100\n", "*PRELOAD"},
        {MODEL "*PERFORATION, GROUP=core\n3, 0.01, 0.03\n", MODEL "*PERFORATION, GROUP=core\n4, 0.01, 0.03\n", "*PERFORATION"}};
    const char *said;
    memset(longest, 'n', sizeof longest - 1);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const struct states given = read_states(TWO),
                            meant = read_states(TWO "*CAUSE, NAME=j, TYPE=joint, BETWEEN=left,core\nflexibility, 1e-9\n");
        meant.state->job.rotor.effect[0].name = names[i];
        assert_status(status_of(&given, &meant, &said), ROTID_ERROR_ARGUMENT);
    }
    for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
        const struct states given = read_states(other[i].given), meant = read_states(other[i].meant);
        assert_status(status_of(&given, &meant, &said), ROTID_ERROR_ARGUMENT);
        if (!strstr(said, other[i].card))
            print_error("%s\n", said);
        assert_non_null(strstr(said, other[i].card));
    }
    const struct states given = read_states(MODEL "*SENSORS\n1, 0\n*MODES\n1, 500\n"),
                        meant = read_states(MODEL "*SENSORS\n1, 0\n*MODES\n1, 500\n");
    struct job *job = &meant.state->job;
    job->rotor.sensor[0].id = 0;
    assert_status(status_of(&given, &meant, &said), ROTID_ERROR_ARGUMENT);
    job->rotor.sensor[0].id = 1;
    job->measurement.frequency_hz[0] = NAN;
    assert_status(status_of(&given, &meant, &said), ROTID_ERROR_ARGUMENT);
    job->measurement.frequency_hz[0] = 500;
    job->measurement.number[0] = 1001;
    assert_status(status_of(&given, &meant, &said), ROTID_ERROR_ARGUMENT);
}

/* The text is edited by the lists that the reader finds: measured critical speeds come first in HOLDOUT. */
POOL_TEST(a_list_behind_the_run_up_is_one_option)
{
    struct deck_edit e;
    struct deck_writer w = {.pool = &test_pool};
    const struct deck_file file = {"bar.inp", "*FIT, HOLDOUT=RUNUP, 1, STATE:free, MODES=2,3\n"};
    const struct deck_origin origin = {.path = "bar.inp", .nfile = 1, .file = &file};
    assert_status(deck_edit_open(&e, &test_pool, &origin), ROTID_OK);
    assert_string_equal(deck_edit_option(&e.part[0], "HOLDOUT"), "RUNUP,1,STATE:free");
    deck_edit_set(&e, 0, "HOLDOUT", "RUNUP");
    deck_edit_text(&e, &w);
    assert_string_equal(w.text, "*FIT, HOLDOUT=RUNUP, MODES=2,3\n");
}

POOL_TEST(without_memory_nothing_is_written)
{
    const struct states given = read_states(BAR UNKNOWN FREE HELD), meant = changed(&given, 1);
    struct failing_allocator failing;
    long fail_at = 0;
    int status;
    do {
        fail_at = NEXT_FAILURE(fail_at);
        struct pool pool;
        struct message_list notes;
        char *text;
        failing_allocator_open(&failing, fail_at);
        pool_open(&pool, &failing.allocator);
        message_open(&notes, &pool);
        status = deck_write(&pool, &given, &meant, NULL, &notes, &text);
        assert_true((status == ROTID_OK) == (text != NULL) && (status == ROTID_OK || status == ROTID_ERROR_MEMORY));
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
    } while (failing.until_failure == 0);
    assert_status(status, ROTID_OK);
    assert_true(fail_at > 3);
}

TEST_GROUP(folder_make, folder_remove);
