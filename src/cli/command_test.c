/* `rotid test`: ema, identify, diagnose, report, one after the other, each as the command that a user could type. */
#include "cli/cli.h"

#define WORDS_MOST 64

/* The arguments of a step. */
struct step {
    struct command *test;
    int count, failed;
    char *word[WORDS_MOST + 1];
};

static void add(struct step *step, const char *word)
{
    char *copy = word && step->count < WORDS_MOST ? pool_copy_text(&step->test->pool, word) : NULL;
    step->failed |= !copy;
    if (copy)
        step->word[step->count++] = copy;
}

/* Options of `test` that the command of the step has as well: but for the file that is written, which is the page. */
static void add_given(struct step *step, const char *name)
{
    for (int i = 0; i < step->test->ngiven; i++) {
        const struct given_option *given = &step->test->given[i];
        if (!strcmp(given->name, "output") || !option_find(given->name, name))
            continue;
        add(step, pool_format(&step->test->pool, "--%s", given->name));
        if (*given->value)
            add(step, given->value);
    }
}

static struct step step_open(struct command *test, const char *name)
{
    struct step step = {.test = test};
    add(&step, "rotid");
    add(&step, name);
    return step;
}

/* As a shell takes it: in quotes where it is not only of letters and the like, a quote inside as '\\''. */
static void print_word(const char *word)
{
    int plain = *word && !word[strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=,+-%@")];
    (void)fputs(plain ? " " : " '", terminal_out());
    for (const char *c = word; *c; c++)
        (void)fprintf(terminal_out(), *c == '\'' ? "'\\''" : "%c", *c);
    (void)fputs(plain ? "" : "'", terminal_out());
}

/* Says the command, then runs it. Its exit code. */
static int step_run(struct step *step, int first)
{
    if (step->failed)
        return command_fail(step->test, ROTID_ERROR_MEMORY);
    if (!step->test->quiet) {
        (void)fputs(first ? "$" : "\n$", terminal_out());
        for (int i = 0; i < step->count; i++)
            print_word(step->word[i]);
        (void)fputc('\n', terminal_out());
    }
    return command_line(step->count, step->word);
}

int command_test(struct command *command)
{
    static const char *const fits[] = {"identify", "diagnose"};
    struct pool *pool = &command->pool;
    const char *records = command->file[0], *deck = command->nfile == 2 ? command->file[1] : NULL, *page = command->output;
    if (!deck)
        return arguments_wrong("%s: expected two files, the records of the test and the deck of the rotor", command->name);
    if (!page)
        page = pool_format(pool, "%.*s.html", (int)(strrchr(deck, '.') ? strrchr(deck, '.') - deck : (long)strlen(deck)), deck);
    size_t length = page ? strlen(page) : 0;
    int stem = (int)(length > 5 && !strcmp(page + length - 5, ".html") ? length - 5 : length);
    const char *modes = pool_format(pool, "%.*s_modes.unv", stem, page), *json[3] = {0};
    struct step step = step_open(command, "ema");
    add(&step, records);
    add_given(&step, "ema");
    add(&step, "-o");
    add(&step, modes);
    add(&step, "--json");
    add(&step, json[0] = pool_format(pool, "%.*s_ema.json", stem, page));
    int code = step_run(&step, 1), worst = code;
    for (int i = 0; i < 2 && code <= EXIT_DOUBTFUL && !command_cancelled(NULL); i++) {
        step = step_open(command, fits[i]);
        add(&step, deck);
        add(&step, "--set");
        add(&step, pool_format(pool, "MEASURED.FILE=%s", modes));
        add_given(&step, fits[i]);
        add(&step, "--json");
        add(&step, json[1 + i] = pool_format(pool, "%.*s_%s.json", stem, page, fits[i]));
        code = step_run(&step, 0);
        worst = code > worst ? code : worst;
    }
    if (code > EXIT_DOUBTFUL || command_cancelled(NULL))
        return worst;
    step = step_open(command, "report");
    for (int i = 0; i < 3; i++)
        add(&step, json[i]);
    add(&step, "-o");
    add(&step, page);
    code = step_run(&step, 0);
    return code > worst ? code : worst;
}
