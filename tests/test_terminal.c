/* Texts of decks, universal files, results and arguments that would steer a terminal, through every command: what arrives on both
 * streams is text, and so is what goes into files. */
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cJSON.h>

#include "report/report.h"
#include "shell.h"
#include "study/study.h"
#include "support.h"

/* Colour, window title, backspace, DEL, C1 as a character and as a byte, controls of direction, separators, no UTF-8. */
#define STEERS                                                                                                                   \
    "\x1b[31m\x1b]0;t\x07\b\r\x7f\xc2\x9b"                                                                                       \
    "1m\xd8\x9c\xe2\x80\x8e\xe2\x80\x8f\xe2\x80\xa8\xe2\x80\xa9\xe2\x80\xaa\xe2\x80\xae\xe2\x81\xa6\xe2\x81\xa9"
#define RAW     "\x9b\x90\xff\xc3\xe2\x82"             /* what a deck may have: it is no character, so it controls none */
#define LETTERS "\xc3\xa4\xe2\x82\xac\xf0\x9d\x84\x9e" /* a umlaut, euro, clef: they stay */
#define HOSTILE STEERS RAW LETTERS

#define DECK                                                                                                                     \
    "*HEADING\nrotor " RAW LETTERS "\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"                            \
    "*SHAFT, NAME=co" RAW LETTERS "re, MATERIAL=steel\n1, 0.1, 0, 20\n*SENSORS\n1, 0\n2, 0.2\n3, 0.4\n4, 0.6\n5, 0.8\n6, 1\n"    \
    "*MODES\n1, 448, 0.002\n2, 1184, 0.002\n3, 2199, 0.002\n*NOISE, FREQUENCY=0.002\n*FIT, REDUCTION=NONE\n"                     \
    "*IDENTIFY\nco" RAW LETTERS "re.E, 1e11, 4e11, 2e11\nco" RAW LETTERS "re.G, 1e10, 4e11, 8e10\n"                              \
    "*FRF, LOW=100, HIGH=3000, LINES=1201\n1, 6\n2, 6\n3, 6\n4, 6\n5, 6\n6, 6\n"

static char folder[] = "/tmp/test_terminal_XXXXXX";
static char said[2][1 << 20]; /* on standard output and standard error, of the last command */

static const char *in_folder(const char *name)
{
    return pool_format(&test_pool, "%s/%s", folder, name);
}

static void write_file(const char *name, const char *text)
{
    FILE *stream = fopen(in_folder(name), "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0 && fclose(stream) == 0);
}

static size_t read_file(const char *name, char *text, size_t room)
{
    FILE *stream = fopen(in_folder(name), "rb");
    if (!stream)
        fail_msg("%s is not there", name);
    size_t length = fread(text, 1, room - 1, stream);
    assert_true(length < room - 1);
    text[length] = 0;
    (void)fclose(stream);
    return length;
}

static int setup(void **state)
{
    (void)strcpy(folder + sizeof folder - 7, "XXXXXX");
    return open_test_pool(state) || !mkdtemp(folder);
}

static int teardown(void **state)
{
    (void)shell_code(&test_pool, NULL, "rm -rf %s", folder);
    return close_test_pool(state);
}

/* Every byte belongs to a character that is shown, but for line feeds and tabs. latin: bytes from a0 may be letters of Latin-1.
 */
static void assert_text(const char *what, const char *text, size_t length, int latin)
{
    for (const char *c = text; c < text + length;) {
        size_t bytes = text_visible(c);
        if (!bytes && *c != '\n' && *c != '\t' && !(latin && !text_utf8(c) && (unsigned char)*c >= 0xa0))
            fail_msg("%s has byte %02x at %zd, behind \"%.*s\"", what, (unsigned)(unsigned char)*c, c - text,
                     (int)(c - text < 60 ? c - text : 60), c - (c - text < 60 ? c - text : 60));
        c += bytes ? bytes : 1;
    }
}

/* Runs the program in the folder; both its streams must be text. Returns its exit code. */
static int run(const char *first, ...)
{
    char *arguments[24] = {ROTID_PROGRAM, (char *)first};
    const char *line = first;
    va_list list;
    int status;
    va_start(list, first);
    for (int i = 2; (arguments[i] = va_arg(list, char *)); i++)
        line = pool_format(&test_pool, "%s %s", line, arguments[i]);
    va_end(list);
    pid_t child = fork();
    if (!child) {
        const int mode = O_WRONLY | O_CREAT | O_TRUNC;
        if (!chdir(folder) && dup2(open("out", mode, 0600), 1) == 1 && dup2(open("err", mode, 0600), 2) == 2)
            (void)execv(ROTID_PROGRAM, arguments);
        _exit(127);
    }
    assert_true(waitpid(child, &status, 0) == child && WIFEXITED(status));
    for (int s = 0; s < 2; s++)
        assert_text(line, said[s], read_file(s ? "err" : "out", said[s], sizeof said[s]), 0);
    return WEXITSTATUS(status);
}

#define RUN(...) run(__VA_ARGS__, (char *)NULL)

static void assert_run(int code, int expected)
{
    if (code != expected)
        fail_msg("exit code %d, expected %d; standard error: %s", code, expected, said[1]);
}

static void assert_json(void)
{
    cJSON *json = cJSON_ParseWithOpts(said[0], NULL, 1);
    if (!cJSON_IsObject(json))
        fail_msg("no JSON: %.300s; standard error: %s", said[0], said[1]);
    cJSON_Delete(json);
}

static void assert_text_file(const char *name, int latin)
{
    static char text[1 << 22];
    assert_text(name, text, read_file(name, text, sizeof text), latin);
}

/* ---- decks */

FIXTURE_TEST(decks_and_their_names, setup, teardown)
{
    static const char *const commands[] = {"check", "modes", "sensitivity", "identify", "diagnose", "frf"};
    char *deck = HOSTILE ".inp";
    write_file(deck, DECK);
    for (size_t c = 0; c < sizeof commands / sizeof *commands; c++) {
        assert_int_not_equal(RUN(commands[c], deck, "--verbose"), 2);
        assert_non_null(strstr(said[0], LETTERS)); /* letters arrive */
        assert_non_null(strstr(said[0], "\xef\xbf\xbd"));
        assert_int_not_equal(RUN(commands[c], deck, "--json", "-"), 2);
        assert_json();
    }
    assert_int_not_equal(RUN("diagnose", deck, "--extended", "extended.inp"), 2);
    static const char *const formats[] = {"matrix-market", "dmig"};
    for (size_t f = 0; f < 2; f++)
        assert_run(RUN("export", deck, "--format", formats[f], "-o", HOSTILE), 0);
    assert_run(RUN("export", deck, "--format", "dmig", "-o", "x.bdf", "--json", "-"), 0);
    assert_json();
    assert_text_file("x.bdf", 0);
}

/* What says one thing to a reader and another one to the program is refused where it stands, in comments too. */
FIXTURE_TEST(decks_with_control_characters, setup, teardown)
{
    static const struct {
        const char *text, *says;
    } table[] = {{"\x1b[2J", "byte 0x1b is not text"},
                 {"\x7f", "character U+007F does not stand for itself"},
                 {"\xc2\x85", "character U+0085"},
                 {"\xd8\x9c", "character U+061C"},
                 {"\xe2\x80\x8f", "character U+200F"},
                 {"\xe2\x80\xa8", "character U+2028"},
                 {"\xe2\x80\xae", "character U+202E"},
                 {"\xe2\x81\xa6", "character U+2066"},
                 {"** \xe2\x80\xae", "a.inp:2:8: character U+202E"}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        write_file("a.inp", pool_format(&test_pool, "*HEADING\nrow %s" DECK, table[i].text));
        assert_run(RUN("check", "a.inp"), 2);
        assert_non_null(strstr(said[1], table[i].says));
        assert_non_null(strstr(said[1], "a.inp:2:"));
    }
    /* through --set they reach neither the terminal nor a deck that is written */
    write_file("b.inp", DECK);
    assert_run(RUN("check", "b.inp", "--set", "SHAFT.NAME=" HOSTILE), 2);
    (void)RUN("diagnose", "b.inp", "--set", "FRF.FILE=" HOSTILE, "--extended", "c.inp");
    assert_int_equal(access(in_folder("c.inp"), F_OK), -1);
}

/* A heading in Latin-1 is cleaned in a deck that is written; a name in it, which may be that of a file, stays. */
FIXTURE_TEST(extended_decks, setup, teardown)
{
    static char text[1 << 16];
    write_file("a.inp",
               "*HEADING\nL\xe4nge \x96 \xff " LETTERS "\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
               "*SHAFT, NAME=L\xe4ufer, MATERIAL=steel\n1, 0.1, 0, 20\n*MODES\n1, 430\n2, 1150\n3, 2150\n4, 3380\n5, 4700\n"
               "*NOISE, FREQUENCY=0.002\n*DISK, NAME=d\n0.3, 2, 0.01\n*IDENTIFY\nL\xe4ufer.E, 1e11, 4e11, 2e11\n");
    (void)RUN("diagnose", "a.inp", "--extended", "b.inp");
    assert_text_file("b.inp", 1);
    (void)read_file("b.inp", text, sizeof text);
    assert_non_null(strstr(text, "L\xe4nge \xef\xbf\xbd \xff " LETTERS)); /* the words of the user, but for a control */
    assert_non_null(strstr(text, "NAME=L\xe4ufer"));
    assert_run(RUN("check", "b.inp"), 0);
}

/* A deck from standard input, and one that is made of it: files are relative to where the program runs. */
FIXTURE_TEST(a_deck_may_come_from_standard_input, setup, teardown)
{
    static char text[1 << 16];
    const char *output;
    write_file("modes.csv", "mode,frequency [Hz]\n1,430\n2,1150\n3,2150\n4,3380\n");
    write_file("a.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n"
                        "1, 0.1, 0, 20\n** of today\n*MODES, FILE=modes.csv\n*NOISE, FREQUENCY=0.002\n"
                        "*IDENTIFY\nbar.E, 1e11, 4e11, 2e11\n");
    assert_int_equal(
        shell_code(&test_pool, &output, "cd %s && %s diagnose - --quiet --extended b.inp < a.inp", folder, ROTID_PROGRAM), 0);
    (void)read_file("b.inp", text, sizeof text);
    assert_non_null(strstr(text, "** of today\n*MODES, FILE=modes.csv\n"));
    assert_non_null(strstr(text, "from -, verdict"));
    assert_int_equal(shell_code(&test_pool, &output, "cd %s && %s check - < /dev/null", folder, ROTID_PROGRAM), 2);
    assert_non_null(strstr(output, "-:1:1: the deck is empty"));
}

/* ---- universal files */

static const char *replaced(const char *text, const char *old, const char *new)
{
    const char *all = "", *at;
    assert_non_null(strstr(text, old));
    for (; (at = strstr(text, old)); text = at + strlen(old))
        all = pool_format(&test_pool, "%s%.*s%s", all, (int)(at - text), text, new);
    return pool_format(&test_pool, "%s%s", all, text);
}

FIXTURE_TEST(universal_files, setup, teardown)
{
    static char text[1 << 20];
    char *file = HOSTILE ".uff";
    write_file("a.inp", DECK);
    assert_run(RUN("frf", "a.inp", "-o", "a.uff"), 0);
    assert_text_file("a.uff", 0);
    (void)read_file("a.uff", text, sizeof text);
    const char *changed = replaced(text, "rotid frf", "\x1b[31m\x9b\x7f\xe2\x80\xae model");
    changed = replaced(changed, "         1SI  ", "         1\x1b[\x9b");
    changed = replaced(changed, "synthesised", "\x1b]0;\x9b\xc2\x9b");
    changed = replaced(changed, "NONE\n", "\x1b[1m\x07\xff" LETTERS "\n");
    write_file(file, changed);
    assert_int_not_equal(RUN("uff", file), 2);
    assert_int_not_equal(RUN("uff", file, "--verbose"), 2);
    assert_int_not_equal(RUN("uff", file, "--verbose", "--json", "-"), 2);
    assert_json();
    assert_non_null(strstr(said[0], "\\u001b[31m"));
    (void)RUN("ema", file, "--verbose");
    (void)RUN("ema", file, "--json", "-", "-o", "modes.uff");
    assert_json();
    assert_text_file("modes.uff", 0);
    (void)RUN("ema", file, "--pick", HOSTILE, "-o", HOSTILE "/x");
    write_file("cut.uff", pool_format(&test_pool, "    -1\n    58\n" HOSTILE "\n    -1\n    -1\n   %s\n    -1\n", HOSTILE));
    (void)RUN("uff", "cut.uff");
    (void)RUN("ema", "cut.uff");
    write_file("b.inp", pool_format(&test_pool, "%s*MEASURED, FILE=cut.uff\n", DECK));
    (void)RUN("check", "b.inp");
}

/* ---- results: JSON that somebody else may have written */

/* Keys of words: another text than one of them is refused before anything is shown. */
static int is_word(const char *key)
{
    static const char *const words[] = {"command", "status", "functional", "reduction", "quantity", "unit", "damping_from"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (key && !strcmp(key, words[i]))
            return 1;
    return 0;
}

/* JSON with a text in every place of free texts. */
static void poison(cJSON *json)
{
    for (; json; json = json->next) {
        if (cJSON_IsString(json) && !is_word(json->string))
            assert_non_null(cJSON_SetValuestring(json, HOSTILE "\nrotid: a line of its own"));
        poison(json->child);
    }
}

FIXTURE_TEST(results_of_commands, setup, teardown)
{
    static const char *const commands[] = {"check", "modes", "identify", "diagnose", "frf"};
    int pages = 0;
    write_file("a.inp", DECK);
    for (size_t c = 0; c < sizeof commands / sizeof *commands; c++) {
        (void)RUN(commands[c], "a.inp", "--json", "-");
        cJSON *json = cJSON_Parse(said[0]);
        poison(json);
        char *text = cJSON_Print(json);
        write_file("a.json", text); /* raw where cJSON leaves it so */
        cJSON_free(text);
        cJSON_Delete(json);
        (void)RUN("report", "a.json", "-o", HOSTILE);
        if (RUN("report", "a.json", "-o", "page", "--quiet") == 0) {
            const char *files = shell(&test_pool, "cd %s && find page -name '*.gp' -o -name '*.html'", folder);
            for (const char *line = files; *line; line += strcspn(line, "\n") + 1)
                assert_text_file(pool_format(&test_pool, "%.*s", (int)strcspn(line, "\n"), line), 0);
            pages++;
        }
        write_file("b.json", pool_format(&test_pool, "{\"command\": \"%s\", " HOSTILE "}", commands[c]));
        assert_run(RUN("report", "b.json", "-o", "b"), 2);
    }
    assert_true(pages >= 2); /* of others the words of other keys are refused */
}

FIXTURE_TEST(results_of_studies, setup, teardown)
{
    static char text[1 << 20];
    char study[DIGEST_LETTERS + 1], *deck = HOSTILE ".inp", *results = HOSTILE ".jsonl";
    struct study_header header;
    write_file(deck, DECK);
    write_file("wrong.inp", "*SHAFT, NAME=" RAW "\n");
    assert_run(RUN("study", deck, "wrong.inp", "-o", results, "--json", "-"), 1);
    assert_json();
    assert_text_file(results, 0);
    assert_run(RUN("study", "--summary", results), 1);
    assert_run(RUN("study", "--merge", results, "-o", HOSTILE ".all"), 1);
    (void)RUN("study", HOSTILE ".plan", "-o", HOSTILE);
    /* a line with the right digest */
    (void)read_file(results, text, sizeof text);
    char *end = strchr(text, '\n') + 1;
    assert_int_equal(results_header_read(&test_pool, text, (size_t)(end - text), &header), 0);
    stamp_study(&header, study);
    char *failed = stamp_line(study, "{\"run\":0,\"cell\":{\"deck\":\"" HOSTILE
                                     "\\nrotid: a line\",\"variant\":null,\"modes\":null,\"sensors\":null,"
                                     "\"noise_frequency\":null,\"noise_shape\":null,\"hide\":null},\"replicate\":0,\"start\":0,"
                                     "\"status\":\"failed\",\"error\":\"" HOSTILE "\\u001b[1m\\u009b\\u202e\",\"seconds\":0}\n");
    write_file("forged.jsonl", pool_format(&test_pool, "%.*s%s", (int)(end - text), text, failed));
    free(failed);
    assert_run(RUN("study", "--summary", "forged.jsonl"), 1);
    assert_null(strstr(said[0], "\nrotid: a line"));
    assert_run(RUN("study", "--summary", "forged.jsonl", "--json", "-"), 1);
    assert_json();
    (void)RUN("report", "forged.jsonl", "-o", "page");
}

/* ---- arguments */

FIXTURE_TEST(arguments, setup, teardown)
{
    static const char *const options[] = {"--set",     "--at",        "--step",    "--points", "--threads",   "--seed",
                                          "--format",  "--band",      "--method",  "--pick",   "--reference", "--shard",
                                          "--timeout", "--json",      "--output",  "--range",  "--order",     "--exponential",
                                          "--block",   "--estimator", "--extended"};
    static const char *const commands[] = {"check", "sensitivity", "diagnose", "frf", "ema", "export", "uff", "report", "study"};
    write_file("a.inp", DECK);
    for (size_t o = 0; o < sizeof options / sizeof *options; o++)
        for (size_t c = 0; c < sizeof commands / sizeof *commands; c++)
            (void)RUN(commands[c], "a.inp", options[o], HOSTILE "/\nrotid: forged");
    static const char *const words[] = {HOSTILE, "--" HOSTILE, "-" HOSTILE, "--json=" HOSTILE, "--quiet=" HOSTILE, "--s" HOSTILE};
    for (size_t w = 0; w < sizeof words / sizeof *words; w++) {
        assert_run(RUN("check", "a.inp", words[w]), w == 3 ? 0 : 2);
        (void)RUN(words[w], "a.inp");
        (void)RUN("check", words[w]);
    }
    /* a line feed in a word makes no line of its own */
    assert_run(RUN("check", "nowhere\nrotid: forged"), 2);
    assert_null(strstr(said[1], "\nrotid: forged"));
}

/* ---- the filter */

static const char *cell_of(int width, const char *text)
{
    char *cell = NULL;
    size_t length;
    FILE *stream = open_memstream(&cell, &length);
    text_cell(stream, width, text);
    (void)fputc('|', stream);
    (void)fclose(stream);
    const char *kept = pool_copy_text(&test_pool, cell);
    free(cell);
    return kept;
}

FIXTURE_TEST(names_along_the_axis_keep_their_columns, setup, teardown)
{
    char *text = NULL;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    struct strip strip = strip_open(1, 21);
    strip_name(&strip, 0, 0.5,
               LETTERS "\x1b"
                       "bcdefghijk");
    strip_name(&strip, 0.5, 1, "\xc3\xa4\xc3\xa4");
    strip_print(&strip, stream, 2, "z");
    (void)fclose(stream);
    assert_string_equal(text, "z |" LETTERS "\xef\xbf\xbd"
                              "bcdef|\xc3\xa4\xc3\xa4\n");
    free(text);
}

/* One column for one character or one byte that is none, so that rows stay in line. */
FIXTURE_TEST(cells_keep_their_width, setup, teardown)
{
    assert_string_equal(cell_of(5, "abc"), "abc  |");
    assert_string_equal(cell_of(5, LETTERS), LETTERS "  |");
    assert_string_equal(cell_of(5, "a\x1b\xc2\x9b"
                                   "b"),
                        "a\xef\xbf\xbd\xef\xbf\xbd"
                        "b |");
    assert_string_equal(cell_of(5, "\x9b\xff\xe2\x82"), "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd |");
    assert_string_equal(cell_of(3, "\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4"), "\xc3\xa4\xc3\xa4~|");
    assert_string_equal(cell_of(3, "a\nb"), "a\xef\xbf\xbd"
                                            "b|");
}

FIXTURE_TEST(every_character, setup, teardown)
{
    for (unsigned u = 1; u < 0x3000; u++) {
        char text[4] = {0};
        unsigned code;
        if (u < 0x80)
            text[0] = (char)u;
        else if (u < 0x800)
            (void)snprintf(text, sizeof text, "%c%c", (int)(0xc0 | u >> 6), (int)(0x80 | (u & 0x3f)));
        else
            (void)snprintf(text, sizeof text, "%c%c%c", (int)(0xe0 | u >> 12), (int)(0x80 | (u >> 6 & 0x3f)),
                           (int)(0x80 | (u & 0x3f)));
        int is_control = u < 0x20 || (u >= 0x7f && u <= 0x9f) || u == 0x61c || u == 0x200e || u == 0x200f || u == 0x2028 ||
                         u == 0x2029 || (u >= 0x202a && u <= 0x202e) || (u >= 0x2066 && u <= 0x2069);
        assert_int_equal(text_is_control(text, &code), is_control);
        assert_int_equal(code, u);
        assert_int_equal(text_visible(text), is_control ? 0 : strlen(text));
    }
}
