/* docs/tutorial.md: its commands are run in their order, what they print is what stands there, and every number of its text is
 * one of what is typed or printed. README.md and the tutorial ask for no step that is not there. */
#include <ctype.h>

#include "shell.h"
#include "support.h"

#define MOST_BLOCKS 40
#define TUTORIAL    ROTID_SOURCE_DIR "/docs/tutorial.md"

struct block {
    int kind;            /* 's' commands, 't' what they print */
    const char *text;    /* without the fences */
    const char *printed; /* by the commands before it */
};

static struct block block[MOST_BLOCKS];
static int nblock;
static const char *prose; /* what stands outside of blocks, headings and targets of links */

/* Appends to a text on the pool. */
static const char *with(const char *text, const char *more, size_t length)
{
    const char *both = pool_format(&test_pool, "%s%.*s", text, (int)length, more);
    assert_non_null(both);
    return both;
}

static void read_tutorial(const char *text)
{
    int kind = 0;
    nblock = 0;
    prose = "";
    while (*text) {
        size_t length = strcspn(text, "\n") + (strchr(text, '\n') != NULL);
        if (!strncmp(text, "```", 3)) {
            kind = kind ? 0 : !strncmp(text, "```sh\n", 6) ? 's' : !strncmp(text, "```text\n", 8) ? 't' : 'x';
            if (kind == 's' || kind == 't') {
                assert_true(nblock < MOST_BLOCKS);
                block[nblock++] = (struct block){kind, "", ""};
            }
        } else if (kind == 's' || kind == 't') {
            block[nblock - 1].text = with(block[nblock - 1].text, text, length);
        } else if (!kind && *text != '#') {
            prose = with(prose, text, length);
        }
        text += length;
    }
    assert_int_equal(kind, 0);
}

/* One unit in the last place of a number as it is written: 0.01 of "3.49", 1e8 of "1.20e+10". */
static double last_place(const char *word, const char *end)
{
    const char *point = memchr(word, '.', (size_t)(end - word)), *e = word;
    while (e < end && *e != 'e')
        e++;
    return pow(10, (e < end ? strtod(e + 1, NULL) : 0) - (point ? (double)(e - point - 1) : 0));
}

static size_t blanks(const char *text)
{
    return strspn(text, " \t");
}

/* Whether two lines say the same: words equal, numbers to a unit in their last place; " ..." at the end of b for any rest. */
static int same_line(const char *a, const char *b)
{
    for (int first = 1;; first = 0) {
        int apart = blanks(a) > 0, also = blanks(b) > 0;
        a += blanks(a);
        b += blanks(b);
        if ((!*a || *a == '\n') && (!*b || *b == '\n'))
            return 1;
        if (!*a || *a == '\n' || !*b || *b == '\n' || (apart != also && !first))
            return 0;
        if (!strncmp(b, "...\n", 4))
            return 1;
        char *end_a, *end_b;
        int number = isdigit((unsigned char)a[strspn(a, "+-") == 1]) && isdigit((unsigned char)b[strspn(b, "+-") == 1]);
        double x = number ? strtod(a, &end_a) : 0, y = number ? strtod(b, &end_b) : 0;
        if (number) {
            if (fabs(x - y) > 1.01 * fmax(last_place(a, end_a), last_place(b, end_b)))
                return 0;
            a = end_a;
            b = end_b;
        } else if (*a++ != *b++) {
            return 0;
        }
    }
}

static const char *next_line(const char *text)
{
    text += strcspn(text, "\n");
    return text + (*text == '\n');
}

/* The line of `printed` that says what `line` does, from there on; NULL where there is none. */
static const char *find_line(const char *printed, const char *line)
{
    for (; *printed; printed = next_line(printed))
        if (same_line(printed, line))
            return printed;
    return NULL;
}

/* ... stands for any lines; else line follows line. The first line of a block may be anywhere. */
static void assert_printed(const char *printed, const char *text)
{
    const char *at = printed;
    int gap = 1;
    for (const char *line = text; *line; line = next_line(line)) {
        if (!strncmp(line, "...\n", 4)) {
            gap = 1;
            continue;
        }
        const char *found = gap ? find_line(at, line) : same_line(at, line) ? at : NULL;
        if (!found)
            fail_msg("not printed: %.*s\n%s", (int)strcspn(line, "\n"), line, printed);
        at = next_line(found);
        gap = 0;
    }
}

static void run_tutorial(void)
{
    const char *folder = shell(&test_pool, "mktemp -d | tr -d '\\n'"), *script = "set -e\n";
    for (int i = 0; i < nblock; i++)
        if (block[i].kind == 's')
            script = pool_format(&test_pool, "%s{\n%s} > '%s/out.%d' 2>&1 || [ $? = 1 ]\n", script, block[i].text, folder, i);
    (void)shell(&test_pool, "cd '%s' && mkdir build && ln -s '%s' build/rotid && ln -s '%s/hammer' build/hammer", folder,
                ROTID_PROGRAM, ROTID_BUILD);
    FILE *file = fopen(pool_format(&test_pool, "%s/all.sh", folder), "w");
    assert_non_null(file);
    assert_true(fputs(script, file) >= 0 && fclose(file) == 0);
    if (shell_code(&test_pool, NULL, "cd '%s' && OPENBLAS_NUM_THREADS=1 sh all.sh", folder))
        fail_msg("%s", shell(&test_pool, "tail -n 5 '%s'/out.*", folder));
    const char *printed = "";
    for (int i = 0; i < nblock; i++) {
        if (block[i].kind == 's')
            printed = shell_file(&test_pool, pool_format(&test_pool, "%s/out.%d", folder, i));
        block[i].printed = printed;
    }
    const char *page = shell_file(&test_pool, pool_format(&test_pool, "%s/build/tutorial/page.html", folder));
    static const char *const says[] = {"Named: added mass", "<section id=\"poles\">", "Identification of better.inp",
                                       "<section id=\"causes\">", "<section id=\"provenance\">"};
    for (size_t i = 0; i < sizeof says / sizeof *says; i++)
        assert_non_null(strstr(page, says[i]));
    (void)shell(&test_pool, "rm -r '%s'", folder);
}

POOL_TEST(what_is_printed_stands_there)
{
    read_tutorial(shell_file(&test_pool, TUTORIAL));
    run_tutorial();
    int compared = 0;
    for (int i = 0; i < nblock; i++)
        if (block[i].kind == 't') {
            assert_printed(block[i].printed, block[i].text);
            compared++;
        }
    assert_true(compared >= 5);
    /* and the numbers of the text are among them */
    const char *all = "";
    for (int i = 0; i < nblock; i++)
        all = pool_format(&test_pool, "%s\n%s", all, block[i].text);
    int numbers = 0;
    for (const char *at = prose; *at; at++) {
        if (!isdigit((unsigned char)*at) || (at > prose && (isalnum((unsigned char)at[-1]) || strchr("._-/", at[-1]))))
            continue;
        char *end;
        double value = strtod(at, &end);
        int found = 0;
        for (const char *word = all; *word && !found; word++)
            if (isdigit((unsigned char)*word) && !isdigit((unsigned char)word[-1]) && word[-1] != '.' && word[-1] != 'e')
                found = fabs(strtod(word, NULL) - value) <= 1e-9 * fabs(value);
        if (!found)
            fail_msg("docs/tutorial.md: %.*s is a number of the text that nothing there types or prints", (int)(end - at), at);
        numbers++;
        at = end - 1;
    }
    assert_true(numbers >= 8);
}

POOL_TEST(lines_are_compared_as_they_should_be)
{
    assert_true(same_line("core.E  1.20001e+11 Pa\n", "core.E 1.20002e+11  Pa"));
    assert_false(same_line("core.E  1.20001e+11 Pa\n", "core.E 1.20003e+11  Pa"));
    assert_false(same_line("core.E  1.2 Pa\n", "core.G 1.2 Pa"));
    assert_false(same_line("core.E  1.2 Pa\n", "core.E 1.2 Pa s"));
    assert_true(same_line("4 modes\n", "4 modes\n"));
    assert_false(same_line("0.60 -0.29", "0.60 +0.29"));
    assert_true(same_line("gradient 8.8e-11 here", "gradient ...\n"));
    assert_false(same_line("gradients 8.8e-11", "gradient ...\n"));
}

/* The commands of a block: lines up to an empty one, without those of make. */
static const char *commands_of(const char *text, const char **output)
{
    const char *commands = "";
    while (*text && *text != '\n') {
        if (strncmp(text, "make ", 5) != 0)
            commands = with(commands, text, strcspn(text, "\n") + 1);
        text = next_line(text);
    }
    *output = *text ? text + 1 : text;
    return commands;
}

POOL_TEST(what_the_readme_prints_is_printed)
{
    static const char *const begins[] = {"```\nbuild/rotid identify input/paper_rotor.inp\n",
                                         "```\nbuild/rotid identify input/strip_states.inp\n", "```\nmake build/hammer\n"};
    const char *readme = shell_file(&test_pool, ROTID_SOURCE_DIR "/README.md"),
               *folder = shell(&test_pool, "mktemp -d | tr -d '\\n'");
    (void)shell(&test_pool,
                "cd '%s' && ln -s '%s/input' && mkdir build && ln -s '%s' build/rotid && ln -s '%s/hammer' build/hammer", folder,
                ROTID_SOURCE_DIR, ROTID_PROGRAM, ROTID_BUILD);
    for (size_t i = 0; i < sizeof begins / sizeof *begins; i++) {
        const char *block_text = strstr(readme, begins[i]), *output;
        if (!block_text)
            fail_msg("README.md has no %s", begins[i] + 4);
        block_text = next_line(block_text);
        block_text = pool_format(&test_pool, "%.*s", (int)(strstr(block_text, "```") - block_text), block_text);
        const char *commands = commands_of(block_text, &output);
        const char *printed = shell(&test_pool, "cd '%s' && { %s}", folder, commands);
        assert_true(strlen(output) > 100);
        assert_printed(printed, output);
    }
    assert_string_equal(shell(&test_pool, "ls '%s'", folder), "build\ninput\n"); /* nothing is left in the root of the sources */
    /* the deck that is called complete */
    const char *deck = strstr(readme, "*MATERIAL, NAME=steel");
    assert_non_null(deck);
    FILE *file = fopen(pool_format(&test_pool, "%s/my.inp", folder), "w");
    assert_non_null(file);
    assert_true(fprintf(file, "%.*s", (int)(strstr(deck, "```") - deck), deck) > 0 && fclose(file) == 0);
    assert_non_null(strstr(shell(&test_pool, "cd '%s' && build/rotid identify my.inp", folder), "converged"));
    (void)shell(&test_pool, "rm -r '%s'", folder);
}

/* An accelerometer of 50 g that goes round is felt, and its frequencies are taken point by point without being asked for; one
 * without mass is not. */
POOL_TEST(a_roving_accelerometer_is_taken_point_by_point)
{
    const char *folder = shell(&test_pool, "mktemp -d | tr -d '\\n'");
    read_tutorial(shell_file(&test_pool, TUTORIAL));
    const char *rig = NULL;
    for (int i = 0; i < nblock && !rig; i++)
        rig = strstr(block[i].text, "cat > rig.inp") ? block[i].text : NULL;
    assert_non_null(rig);
    FILE *file = fopen(pool_format(&test_pool, "%s/rig.inp", folder), "w");
    assert_non_null(file);
    rig = next_line(rig);
    assert_true(fprintf(file, "%.*s", (int)(strstr(rig, "\nend\n") + 1 - rig), rig) > 0 && fclose(file) == 0);
    static const char *const mass[] = {"0.05", "0"};
    for (int i = 0; i < 2; i++) {
        (void)shell(&test_pool,
                    "cd '%s' && %s/hammer rig.inp -o rec.unv --noise 0.02 --force-noise 1e-4 --floor 1e-5 --sensor-mass %s",
                    folder, ROTID_BUILD, mass[i]);
        const char *said;
        (void)shell_code(&test_pool, &said, "cd '%s' && " ROTID_PROGRAM " ema rec.unv --band 100,3200 -o modes.unv 2>&1", folder);
        const char *sets = shell(&test_pool, "cd '%s' && grep -c 'ROTID FREQUENCY AT POINT' modes.unv || true", folder);
        assert_int_equal(strtol(sets, NULL, 10), i ? 0 : 4);
        assert_int_equal(strstr(said, "they are taken at each point as well (--per-point)") != NULL, !i);
    }
    (void)shell(&test_pool, "rm -r '%s'", folder);
}

/* Every deck of the page is read without an error, and weighs something. */
POOL_TEST(decks_of_the_page_which_card_are_complete)
{
    const char *page = shell_file(&test_pool, ROTID_SOURCE_DIR "/docs/which_card.md"),
               *folder = shell(&test_pool, "mktemp -d | tr -d '\\n'");
    int decks = 0;
    for (const char *at = page; (at = strstr(at, "```\n*MATERIAL")) != NULL; at += 4, decks++) {
        FILE *file = fopen(pool_format(&test_pool, "%s/rotor.inp", folder), "w");
        assert_non_null(file);
        assert_true(fprintf(file, "%.*s", (int)(strstr(at + 4, "```") - at - 4), at + 4) > 0 && fclose(file) == 0);
        const char *said = shell(&test_pool, ROTID_PROGRAM " check '%s/rotor.inp' 2>&1", folder);
        assert_non_null(strstr(said, "\nmass "));
        assert_null(strstr(said, "warning"));
    }
    assert_int_equal(decks, 4);
    (void)shell(&test_pool, "rm -r '%s'", folder);
}

/* Both ways into the project are two commands, each of one line. */
POOL_TEST(no_third_step_is_asked_for)
{
    const char *readme = shell_file(&test_pool, ROTID_SOURCE_DIR "/README.md");
    assert_non_null(strstr(readme, "./tools/setup && make demo"));
    assert_non_null(strstr(readme, "./tools/setup && make test"));
    assert_non_null(strstr(readme, "docs/tutorial.md"));
    assert_non_null(strstr(readme, "docs/reference.md"));
    assert_non_null(strstr(shell_file(&test_pool, TUTORIAL), "./tools/setup && make"));
}
