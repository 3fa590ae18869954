#include "reading.h"

#include "folder.h"
#include "support.h"

static void assert_right(int status, const char *path, const struct message_list *messages)
{
    for (size_t i = 0; i < messages->count && status; i++)
        print_error("%s:%d:%d: %s\n", path, messages->item[i].line, messages->item[i].column, messages->item[i].text);
    assert_status(status, ROTID_OK);
}

void try_path(struct reading *r, const char *path, const char *set)
{
    struct override override;
    pool_open(&r->pool, NULL);
    message_open(&r->messages, &r->pool);
    if (set)
        assert_int_equal(override_parse(&r->pool, set, &override), 0);
    r->status = deck_read(&r->pool, path, set != NULL, &override, &r->messages, &r->job);
}

void read_path(struct reading *r, const char *path, const char *set)
{
    try_path(r, path, set);
    assert_right(r->status, path, &r->messages);
    assert_int_equal(r->messages.errors, 0);
}

void read_text(struct reading *r, const char *text, const char *set)
{
    read_path(r, folder_write("deck.inp", text), set);
}

void read_job(const char *text, struct message_list *messages, struct job *job)
{
    const char *path = folder_write("deck.inp", text);
    message_open(messages, &test_pool);
    assert_right(deck_read(&test_pool, path, 0, NULL, messages, job), path, messages);
}

struct states read_states_at(const char *path, const struct override *override)
{
    struct message_list messages;
    struct states states;
    message_open(&messages, &test_pool);
    assert_right(deck_read_states(&test_pool, path, NULL, override != NULL, override, &messages, &states), path, &messages);
    return states;
}

struct states read_states(const char *text)
{
    return read_states_at(folder_write("states.inp", text), NULL);
}

rotid_deck *read_handle(const char *text, int nset, const char *const *set)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck;
    int status = rotid_deck_read_text(strlen(text), text, "deck.inp", NULL, nset, set, NULL, failure, &deck);
    if (status)
        print_error("%s\n%s\n", failure, text);
    assert_status(status, ROTID_OK);
    return deck;
}

void read_frequencies(const char *text, int type, int count, double *hz)
{
    rotid_deck *deck = read_handle(text, 0, NULL);
    rotid_spectrum *s;
    char failure[ROTID_FAILURE_LENGTH];
    int status = rotid_spectrum_of_type(deck, type, NULL, count, NULL, failure, &s);
    if (status)
        print_message("%s\n", failure);
    assert_status(status, ROTID_OK);
    assert_true(s->nmodes >= count);
    for (int j = 0; j < count; j++)
        hz[j] = s->modes[j].full_hz;
    rotid_spectrum_free(s);
    rotid_deck_free(deck);
}

const rotid_message *find_message(const struct message_list *messages, const char *words)
{
    for (size_t i = 0; i < messages->count; i++)
        if (strstr(messages->item[i].text, words))
            return &messages->item[i];
    return NULL;
}

int warns(const struct message_list *messages, const char *words)
{
    for (size_t i = 0; i < messages->count; i++)
        if (messages->item[i].severity == SEVERITY_WARNING && strstr(messages->item[i].text, words))
            return 1;
    return 0;
}
