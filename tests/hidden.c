#include "hidden.h"
#include "one_state.h"

#include "deck/deck.h"

char *hidden_read(const char *path)
{
    FILE *file = fopen(path, "rb");
    size_t room = 1 << 20, length = 0;
    char *text = file ? calloc(1, room) : NULL;
    if (text)
        length = fread(text, 1, room, file);
    if (file)
        fclose(file);
    if (text && length && length < room)
        return text;
    free(text);
    return NULL;
}

static int write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    int bad = !file || fputs(text, file) < 0;
    if (file)
        bad |= fclose(file) != 0;
    return bad;
}

/* What each of two effects is worth alone, on the same rotor: the lesser of both. */
static int measure_each(struct pool *pool, const struct hidden_case *c, const struct diagnosis *d, const struct job *job,
                        const cJSON *truth, struct hidden_score *s)
{
    struct hide_request one = c->request;
    char message[300], *deck, *text;
    const cJSON *effect;
    double drop;
    int status = ROTID_OK;
    one.random = NULL;
    one.effects = 1;
    cJSON_ArrayForEach(effect, cJSON_GetObjectItem(truth, "effects"))
    {
        const char *spec = cJSON_GetStringValue(cJSON_GetObjectItem(effect, "spec"));
        one.effect = &spec;
        if (hide_case(&one, &deck, &text, message, sizeof message))
            return ROTID_OK; /* the rotor buckles with one of them, say */
        cJSON *alone = cJSON_Parse(text);
        status = alone ? hidden_drop(pool, d, job, alone, &drop) : ROTID_ERROR_MEMORY;
        cJSON_Delete(alone);
        free(deck);
        free(text);
        if (status)
            return status;
        s->lesser = isfinite(s->lesser) ? fmin(s->lesser, drop) : drop;
    }
    return status;
}

static int diagnose(struct pool *pool, const struct hidden_case *c, const char *path, const rotid_environment *environment,
                    hidden_look *look, void *context, const char *truth, struct hidden_score *s)
{
    struct message_list messages;
    struct job job;
    struct diagnosis d;
    const struct diagnose_options options = {.threads = 1};
    message_open(&messages, pool);
    int status = deck_read(pool, path, 0, NULL, &messages, &job);
    double begin = clock_seconds();
    if (!status)
        status = diagnose_run(pool, &job, &options, environment, &messages, &d);
    s->seconds = clock_seconds() - begin;
    if (status) {
        for (size_t i = 0; i < messages.count && !s->failure[0]; i++)
            if (messages.item[i].severity == SEVERITY_ERROR)
                snprintf(s->failure, sizeof s->failure, "%s: %s", rotid_status_name(status), messages.item[i].text);
        return status;
    }
    if (d.result.interrupted) {
        diagnose_free(&d);
        return ROTID_STOP_CANCELLED;
    }
    cJSON *json = cJSON_Parse(truth); /* not before the diagnosis is done */
    status = json ? hidden_score_make(pool, &d, &job, json, s) : ROTID_ERROR_SYNTAX;
    if (!status && s->class == HIDDEN_PAIR)
        status = measure_each(pool, c, &d, &job, json, s);
    if (!status && look)
        look(context, c, &d, json, s);
    cJSON_Delete(json);
    diagnose_free(&d);
    return status;
}

int hidden_run(const struct hidden_case *c, const rotid_environment *environment, hidden_look *look, void *context,
               struct hidden_score *s)
{
    char path[1000], other[1000], *deck = NULL, *truth = NULL;
    struct pool pool;
    int status;
    *s = hidden_score_none();
    if (hide_case(&c->request, &deck, &truth, s->failure, sizeof s->failure))
        return ROTID_OK;
    s->failure[0] = 0;
    snprintf(path, sizeof path, "%s/case_%d.inp", c->directory, c->number);
    snprintf(other, sizeof other, "%s/case_%d.json", c->directory, c->number);
    pool_open(&pool, NULL);
    status = write_text(path, deck) || (c->keep && write_text(other, truth))
                 ? ROTID_ERROR_IO
                 : diagnose(&pool, c, path, environment, look, context, truth, s);
    if (!c->keep)
        remove(path);
    pool_close(&pool);
    free(deck);
    free(truth);
    if (status == ROTID_STOP_CANCELLED)
        return status;
    if (status) {
        s->outcome = HIDDEN_FAILED;
        if (!s->failure[0])
            snprintf(s->failure, sizeof s->failure, "%s", rotid_status_name(status));
    }
    return ROTID_OK;
}
