/* What the program offers beside what the manual page and the completions of the shells say of it. With --write (make tables):
 * writes what the tables of options and cards give. */
#include <ctype.h>

#include "cli/cli.h"
#include "deck/deck_row.h"
#include "diagnose/causes/causes.h"
#include "shell.h"
#include "support.h"
#include "tables/generated.h"

#define MOST   200
#define MANUAL ROTID_SOURCE_DIR "/docs/rotid.1"
#define BASH   ROTID_SOURCE_DIR "/completions/rotid.bash"

/* A set of words. */
struct words {
    int count;
    const char *word[MOST];
};

static int has(const struct words *words, const char *word)
{
    for (int i = 0; i < words->count; i++)
        if (strcmp(words->word[i], word) == 0)
            return 1;
    return 0;
}

/* Of letters, digits and hyphens: how many from here on. */
static int span(const char *at)
{
    int length = 0;
    while (isalnum((unsigned char)at[length]) || at[length] == '-')
        length++;
    return length;
}

static void add(struct words *words, const char *beginning, const char *at, int length)
{
    const char *word = pool_format(&test_pool, "%s%.*s", beginning, length, at);
    assert_non_null(word);
    if (has(words, word))
        return;
    assert_true(words->count < MOST);
    words->word[words->count++] = word;
}

/* Every word behind `mark`, which a blank or another character that is no letter stands before, with `beginning` before it. */
static void find_behind(struct words *words, const char *text, const char *mark, const char *beginning)
{
    for (const char *at = strstr(text, mark); at; at = strstr(at + 1, mark)) {
        const char *word = at + strlen(mark);
        if ((at == text || span(at - 1) == 0 || isspace((unsigned char)mark[0])) && islower((unsigned char)*word))
            add(words, beginning, word, span(word));
    }
}

/* Long options anywhere in a text. */
static void find_options(struct words *words, const char *text)
{
    for (const char *at = strstr(text, "--"); at; at = strstr(at + 2, "--"))
        if ((at == text || !(isalnum((unsigned char)at[-1]) || at[-1] == '-')) && islower((unsigned char)at[2]))
            add(words, "", at, span(at));
}

static void assert_same_words(const struct words *a, const char *name_a, const struct words *b, const char *name_b)
{
    for (int i = 0; i < a->count; i++)
        if (!has(b, a->word[i]))
            fail_msg("%s of %s is missing in %s", a->word[i], name_a, name_b);
    for (int i = 0; i < b->count; i++)
        if (!has(a, b->word[i]))
            fail_msg("%s of %s is missing in %s", b->word[i], name_b, name_a);
}

/* What `rotid --help` lists: lines of two blanks, a word and its text, up to the first empty line behind them. */
static struct words commands_of_the_program(void)
{
    struct words commands = {0};
    const char *line = strstr(shell(&test_pool, "%s --help", ROTID_PROGRAM), "\n\n");
    assert_non_null(line);
    for (line += 2; line[0] == ' ' && line[1] == ' ' && islower((unsigned char)line[2]); line += strcspn(line, "\n") + 1)
        add(&commands, "", line + 2, span(line + 2));
    assert_true(commands.count >= 8);
    return commands;
}

/* The help of all commands together. */
static struct words options_of_the_program(void)
{
    struct words options = {0}, commands = commands_of_the_program();
    find_options(&options, shell(&test_pool, "%s --help", ROTID_PROGRAM));
    for (int i = 0; i < commands.count; i++)
        find_options(&options, shell(&test_pool, "%s %s --help", ROTID_PROGRAM, commands.word[i]));
    assert_true(options.count >= 30);
    return options;
}

/* What the completion of bash offers behind these words, the last of which is completed. */
static struct words offered(const char *words)
{
    struct words found = {0};
    const char *text = shell(&test_pool,
                             "bash -c '. %s; COMP_WORDS=(%s); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _rotid; "
                             "printf \"%%s\\n\" \"${COMPREPLY[@]}\"'",
                             BASH, words);
    for (; *text; text += strcspn(text, "\n") + 1)
        if (*text != '\n')
            add(&found, "", text, (int)strcspn(text, "\n"));
    return found;
}

POOL_TEST(the_manual_names_the_commands_and_no_other_option)
{
    struct words commands = commands_of_the_program(), options = options_of_the_program(), named = {0}, listed = {0};
    char *text = pool_copy_text(&test_pool, shell_file(&test_pool, MANUAL)), *end = text;
    assert_non_null(text);
    for (const char *at = text; *at; at++) /* \- is a hyphen that is not broken at */
        if (*at != '\\')
            *end++ = *at;
    *end = 0;
    find_behind(&listed, text, "\n.It Ic ", "");
    assert_same_words(&commands, "rotid --help", &listed, "docs/rotid.1");
    find_behind(&named, text, "Fl -", "--");
    find_options(&named, text);
    assert_same_words(&options, "rotid --help", &named, "docs/rotid.1");
}

POOL_TEST(bash_offers_every_command_and_option)
{
    struct words commands = commands_of_the_program(), options = options_of_the_program(), listed = offered("rotid \"\""),
                 all = {0};
    assert_same_words(&commands, "rotid --help", &listed, "rotid.bash");
    for (int i = 0; i < commands.count; i++) {
        struct words found = offered(pool_format(&test_pool, "rotid %s --", commands.word[i]));
        for (int j = 0; j < found.count; j++)
            add(&all, "", found.word[j], (int)strlen(found.word[j]));
    }
    assert_same_words(&options, "rotid --help", &all, "rotid.bash");
}

/* A value for each option that takes one, of a command or of all; the file is not there, which is said only when the options are
 * in order. */
static const char *value_of(const char *command, const char *option)
{
    static const char *const values[][2] = {{"export --format", "dmig"},
                                            {"--json", "-"},
                                            {"--threads", "1"},
                                            {"--seed", "1"},
                                            {"--set", "FIT.MODES=1"},
                                            {"--at", "core.E"},
                                            {"--step", "0.1"},
                                            {"--range", "0.1"},
                                            {"--points", "2"},
                                            {"--extended", "/x/y"},
                                            {"--changed", "before,after"},
                                            {"--csv", "/x/y"},
                                            {"--interval", "2"},
                                            {"--sensors", "8"},
                                            {"--modes", "5"},
                                            {"--frequency-noise", "0.1"},
                                            {"--shape-noise", "1"},
                                            {"--set-up-cost", "20"},
                                            {"--output", "/x/y"},
                                            {"-o", "/x/y"},
                                            {"--band", "1,2"},
                                            {"--method", "lscf"},
                                            {"--order", "4"},
                                            {"--pick", "1,2"},
                                            {"--reference", "1"},
                                            {"--averages", "3"},
                                            {"--estimator", "H1"},
                                            {"--exponential", "0.1"},
                                            {"--force-window", "1"},
                                            {"--block", "1"},
                                            {"--pretrigger", "0.1"},
                                            {"--trigger-level", "0.1"},
                                            {"--shard", "1/2"},
                                            {"--state", "a"},
                                            {"--timeout", "1"},
                                            {"--speeds", "0:100"},
                                            {"--for", "speed:1"},
                                            {"--harmonic", "2"},
                                            {"--draws", "10"},
                                            {"--type", "torsion"},
                                            {"--campbell", "/x/y"},
                                            {"--response", "/x/z"},
                                            {NULL, NULL}};
    const char *of_command = pool_format(&test_pool, "%s %s", command, option);
    int i = 0;
    while (values[i][0] && strcmp(values[i][0], of_command) != 0 && strcmp(values[i][0], option) != 0)
        i++;
    return values[i][0] ? values[i][1] : "";
}

/* What a command does not go without. */
static const char *needs_of(const char *command, const char *option)
{
    if (strcmp(command, "export") == 0)
        return "--format dmig -o /x/y";
    if (strcmp(command, "report") == 0)
        return "-o /x/y";
    if (strcmp(command, "test") == 0)
        return "/nowhere/file";
    return strcmp(command, "study") == 0 && strcmp(option, "--summary") != 0 ? "-o /x/y" : "";
}

POOL_TEST(bash_offers_what_a_command_takes)
{
    struct words commands = commands_of_the_program();
    for (int i = 0; i < commands.count; i++) {
        struct words options = offered(pool_format(&test_pool, "rotid %s -", commands.word[i]));
        assert_true(options.count > 4);
        for (int j = 0; j < options.count; j++) {
            const char *output, *command = commands.word[i], *option = options.word[j];
            if (strcmp(option, "--help") == 0 || strcmp(option, "-h") == 0 || strcmp(option, "-V") == 0 ||
                strcmp(option, "--version") == 0)
                continue;
            const char *all =
                pool_format(&test_pool, "%s %s %s %s", command, needs_of(command, option), option, value_of(command, option));
            int code = shell_code(&test_pool, &output, "%s %s /nowhere/file", ROTID_PROGRAM, all);
            if ((code != 2 && code != 3) || strstr(output, "rotid: --") || strstr(output, "option") ||
                !strstr(output, "/nowhere/file"))
                fail_msg("rotid %s: exit code %d, %s", all, code, output);
        }
    }
}

/* expected: separated by bars. */
static void assert_offered(const char *words, const char *expected)
{
    struct words found = offered(words), wanted = {0};
    for (const char *at = expected; *at; at += strcspn(at, "|") + (at[strcspn(at, "|")] == '|'))
        add(&wanted, "", at, (int)strcspn(at, "|"));
    assert_same_words(&wanted, "what is expected", &found, words);
}

POOL_TEST(bash_completes_values_and_files)
{
    char folder[] = "/tmp/test_manual_XXXXXX";
    assert_non_null(mkdtemp(folder));
    (void)shell(&test_pool,
                "cd %s && mkdir 'a b' data empty && touch one.inp two.INP 'with blank.inp' r.json modes.unv rec.UFF notes.txt",
                folder);
    const char *at = pool_format(&test_pool, "rotid identify %s", folder);
    assert_offered("rotid dia", "diagnose");
    assert_offered("rotid --quiet --json r.json che", "check");
    assert_offered("rotid --json = r.json che", "check");
    assert_offered("rotid ema --method \"\"", "lscf|quadrature");
    assert_offered("rotid ema --method = q", "quadrature");
    assert_offered("rotid ema --method =", "lscf|quadrature");
    assert_offered("rotid identify --set FIT.REDUCTION = G", "GUYAN");
    assert_offered("rotid identify --thr", "--threads");
    assert_offered("rotid identify --threads \"\"", "");
    assert_offered("rotid identify a.inp \"\"", "");
    assert_offered(pool_format(&test_pool, "%s/o", at), pool_format(&test_pool, "%s/one.inp", folder));
    assert_offered(pool_format(&test_pool, "%s/t", at), pool_format(&test_pool, "%s/two.INP", folder));
    assert_offered(pool_format(&test_pool, "%s/n", at), pool_format(&test_pool, "%s/notes.txt", folder)); /* no deck begins so */
    assert_offered(pool_format(&test_pool, "%s/d", at), pool_format(&test_pool, "%s/data", folder));
    assert_offered(
        pool_format(&test_pool, "rotid ema %s/", folder),
        pool_format(&test_pool, "%s/modes.unv|%s/rec.UFF|%s/data|%s/empty|%s/a b", folder, folder, folder, folder, folder));
    (void)shell(&test_pool, "rm -r %s", folder);
}

static const char *path_of(const struct generated *part)
{
    return pool_format(&test_pool, ROTID_SOURCE_DIR "/%s", part->path);
}

POOL_TEST(generated_parts_are_those_of_the_tables)
{
    for (const struct generated *part = generated_parts; part->path; part++) {
        const char *text = shell_file(&test_pool, path_of(part));
        char *wanted = generated_text(part, text);
        assert_non_null(wanted);
        if (strcmp(text, wanted) != 0)
            fail_msg("%s is not what its table gives, expected it after make tables", part->path);
        free(wanted);
    }
}

/* One page: no command, card or cause is missing, and what is there stands in one screen of a wide window each. */
POOL_TEST(the_reference_card_has_every_command_card_and_cause)
{
    const char *text = shell_file(&test_pool, ROTID_SOURCE_DIR "/docs/reference.md");
    struct words commands = commands_of_the_program();
    int cards = 0, lines = 0;
    for (int i = 0; i < commands.count; i++)
        assert_non_null(strstr(text, pool_format(&test_pool, "\n| `%s FILE", commands.word[i])));
    for (const struct option_row *row = option_table; row->name; row++)
        assert_non_null(strstr(text, pool_format(&test_pool, "--%s", row->name)));
    for (const struct deck_card *card = deck_card_table; card->name; card++, cards++) {
        const char *line = strstr(text, pool_format(&test_pool, "\n| `*%s` |", card->name));
        if (!line)
            fail_msg("*%s is not on the reference card", card->name);
        for (const struct deck_row *row = card->row; !deck_row_is_last(row); row++)
            if (row->option) {
                const char *at = strstr(line + 1, pool_format(&test_pool, "`%s", row->option));
                assert_true(at && at < line + 1 + strcspn(line + 1, "\n"));
            }
    }
    assert_true(cards > 25);
    for (int i = 0; i < catalogue_count(); i++)
        assert_non_null(strstr(text, pool_format(&test_pool, "\n| `%s` |", catalogue_item(i)->id)));
    for (const char *at = text; *at; at++)
        lines += *at == '\n';
    assert_true(lines < 150);
}

/* Words for people, names for getopt: what the compiler does not see in a row. */
POOL_TEST(rows_are_sound)
{
    struct words commands = commands_of_the_program();
    for (const struct option_row *row = option_table; row->name; row++) {
        struct words of = {0};
        for (const char *at = row->commands; at && *at; at += strspn(at, " ")) {
            add(&of, "", at, span(at));
            at += span(at);
        }
        for (int i = 0; i < of.count; i++)
            assert_true(has(&commands, of.word[i]));
        assert_true(row->help && row->help[strlen(row->help) - 1] != '.');
        assert_int_equal(row->kind > OPTION_SWITCH, row->value || row->words);
        if (row->kind == OPTION_WHOLE || row->kind == OPTION_REAL || row->kind == OPTION_SEED)
            assert_true(row->least < row->most &&
                        (row->standard == 0 || (row->least <= row->standard && row->standard <= row->most)));
        for (const struct option_row *other = row + 1; other->name; other++)
            if (strcmp(row->name, other->name) == 0) { /* of other commands, else the same */
                assert_true(row->kind == other->kind && row->offset == other->offset && row->letter == other->letter);
                for (int i = 0; i < of.count; i++)
                    assert_false(option_of(other, of.word[i]));
            }
    }
}

POOL_TEST(an_option_of_another_command_is_refused)
{
    struct words commands = commands_of_the_program();
    for (const struct option_row *row = option_table; row->name; row++)
        for (int i = 0; i < commands.count; i++) {
            const char *output;
            if (option_find(row->name, commands.word[i]))
                continue;
            int code = shell_code(&test_pool, &output, "%s %s --%s %s /nowhere/file", ROTID_PROGRAM, commands.word[i], row->name,
                                  row->kind > OPTION_SWITCH ? "1" : "");
            if (code != 2 || !strstr(output, pool_format(&test_pool, "--%s is ", row->name)) || !strstr(output, "option of"))
                fail_msg("rotid %s --%s: exit code %d, %s", commands.word[i], row->name, code, output);
        }
}

POOL_TEST(an_old_name_is_taken)
{
    const char *output;
    for (const struct option_row *row = option_table; row->name; row++)
        if (row->alias) {
            (void)shell_code(&test_pool, &output, "%s %.*s --%s x /nowhere/file", ROTID_PROGRAM, span(row->commands),
                             row->commands, row->alias);
            assert_non_null(strstr(output, pool_format(&test_pool, "--%s x: expected", row->name)));
        }
}

static int write_files(void)
{
    int code = 0;
    for (const struct generated *part = generated_parts; part->path; part++) {
        char *text = generated_text(part, shell_file(&test_pool, path_of(part)));
        FILE *out = text ? fopen(path_of(part), "w") : NULL;
        if (!out || fputs(text, out) < 0 || fclose(out)) {
            print_error("cannot write %s\n", part->path);
            code = 1;
        }
        free(text);
    }
    return code;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--write") == 0) {
        void *state = NULL;
        int code = open_test_pool(&state) || write_files();
        return close_test_pool(&state) || code;
    }
    return test_main(argc, argv);
}
