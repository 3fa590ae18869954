#include "uff_fixture.h"

#include <unistd.h>

void uff_write_bytes(char path[512], const void *bytes, size_t length)
{
    const char *directory = getenv("TMPDIR");
    (void)snprintf(path, 512, "%s/test_uff_XXXXXX", directory ? directory : "/tmp");
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    FILE *stream = fdopen(descriptor, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, length, stream), length);
    assert_int_equal(fclose(stream), 0);
}

void uff_fixture_bytes(struct uff_fixture *fixture, const void *bytes, size_t length)
{
    uff_write_bytes(fixture->path, bytes, length);
    pool_open(&fixture->pool, NULL);
    message_open(&fixture->messages, &fixture->pool);
    assert_int_equal(uff_open(&fixture->pool, fixture->path, &fixture->messages, &fixture->reader), ROTID_OK);
}

void uff_fixture_text(struct uff_fixture *fixture, const char *text)
{
    uff_fixture_bytes(fixture, text, strlen(text));
}

void uff_fixture_close(struct uff_fixture *fixture)
{
    uff_close(fixture->reader);
    pool_close(&fixture->pool);
    (void)unlink(fixture->path);
}

static void print_messages(const struct uff_fixture *fixture)
{
    for (size_t i = 0; i < fixture->messages.count; ++i)
        print_message("%d:%d: %s\n", fixture->messages.item[i].line, fixture->messages.item[i].column,
                      fixture->messages.item[i].text);
}

struct uff_set uff_fixture_next(struct uff_fixture *fixture, int number)
{
    struct uff_set set;
    int status = uff_next(fixture->reader, &set);
    if (status != ROTID_OK)
        print_messages(fixture);
    assert_int_equal(status, ROTID_OK);
    assert_int_equal(set.number, number);
    return set;
}

void uff_fixture_refuses(struct uff_fixture *fixture, int status, int line, int column, const char *part)
{
    assert_status(status, ROTID_ERROR_SYNTAX);
    assert_true(fixture->messages.count > 0);
    const rotid_message *last = &fixture->messages.item[fixture->messages.count - 1];
    if (last->severity != SEVERITY_ERROR || last->line != line || (column && last->column != column) ||
        !strstr(last->text, part)) {
        print_messages(fixture);
        fail_msg("expected %d:%d: ... %s", line, column, part);
    }
}

void uff_fixture_is_quiet(const struct uff_fixture *fixture)
{
    if (fixture->messages.count)
        print_messages(fixture);
    assert_int_equal(fixture->messages.count, 0);
}

void uff_fixture_warns(const struct uff_fixture *fixture, const char *part)
{
    if (fixture->messages.count != 1 || fixture->messages.errors || !strstr(fixture->messages.item[0].text, part))
        print_messages(fixture);
    assert_int_equal(fixture->messages.count, 1);
    assert_int_equal(fixture->messages.item[0].severity, SEVERITY_WARNING);
    assert_non_null(strstr(fixture->messages.item[0].text, part));
}
