/* The worked cases of docs/diagnosis_reference.md: their commands are run, and every line that is printed there is one that they
 * print, in that order. */
#include "folder.h"
#include "shell.h"
#include "support.h"

#define FIRST "## Worked cases\n"
#define LAST  "## Practising\n"
#define FENCE "```\n"

/* `text` with every `old` replaced. */
static const char *replaced(const char *text, const char *old, const char *new)
{
    const char *out = "", *at;
    for (; (at = strstr(text, old)); text = at + strlen(old))
        out = pool_format(&test_pool, "%s%.*s%s", out, (int)(at - text), text, new);
    return pool_format(&test_pool, "%s%s", out, text);
}

/* A fit that leaves a parameter open is as good an answer as another one. */
static const char *run(const char *command)
{
    const char *output;
    command = replaced(command, "input/", ROTID_SOURCE_DIR "/input/");
    command = replaced(command, "build/rotid", ROTID_PROGRAM);
    int code = shell_code(&test_pool, &output, "cd %s && %s --threads 1", folder, command);
    if (code > 1)
        fail_msg("%s: exit code %d\n%s", command, code, output);
    return output;
}

/* Behind the line, or NULL where the output has no such line any more. */
static const char *behind(const char *output, const char *line, size_t length)
{
    for (const char *at = output; *at; at += strcspn(at, "\n") + 1)
        if (strcspn(at, "\n") == length && !strncmp(at, line, length))
            return at + length + 1;
    return NULL;
}

/* One block: commands, an empty line, what they print; a line of three dots stands for others. */
static void check_block(const char *block, size_t size)
{
    const char *output = "", *end = block + size, *pending = "";
    int printed = 0;
    for (const char *line = block; line < end; line += strcspn(line, "\n") + 1) {
        size_t length = strcspn(line, "\n");
        const char *text = pool_format(&test_pool, "%.*s", (int)length, line);
        if (!length || !strcmp(text, "...")) {
            printed |= !length;
        } else if (!printed && strncmp(text, "build/rotid", 11) != 0) { /* what makes a deck for the next command */
            pending = pool_format(&test_pool, "%s && ", text);
        } else if (!printed) {
            output = pool_format(&test_pool, "%s%s", output, run(pool_format(&test_pool, "%s%s", pending, text)));
            pending = "";
        } else {
            output = behind(output, line, length);
            if (!output)
                fail_msg("is not printed, or not in this order: %s", text);
        }
    }
    assert_true(printed);
}

POOL_TEST(what_is_printed_is_what_the_program_prints)
{
    const char *text = shell_file(&test_pool, ROTID_SOURCE_DIR "/docs/diagnosis_reference.md"), *at = strstr(text, FIRST),
               *last = strstr(text, LAST);
    int blocks = 0;
    (void)folder_path("roller.inp"); /* what the commands leave there */
    assert_true(at && last && at < last);
    while ((at = strstr(at, "\n" FENCE)) && at < last) {
        const char *block = at + 1 + strlen(FENCE), *end = strstr(block, FENCE);
        const char *solid = strstr(block, "MODEL=SOLID");
        assert_non_null(end);
        if (!solid || solid > end || getenv("ROTID_LONG")) /* the diagnosis of a solid takes as long as all the others */
            check_block(block, (size_t)(end - block));
        at = end + strlen(FENCE) - 1;
        blocks++;
    }
    assert_int_equal(blocks, 5);
}

TEST_GROUP(folder_make, folder_remove);
