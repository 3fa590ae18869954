#include "study/header.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "result/json_tree.h"

struct header header_of(const struct study *study, const char *version, const char *commit, int shard, int shards)
{
    return (struct header){.version = version,
                           .commit = commit,
                           .plan = study->plan->path,
                           .studies = study->plan->command == PLAN_DIAGNOSE ? "diagnose" : "identify",
                           .plan_digest = study->plan_digest,
                           .decks_digest = study->decks_digest,
                           .data_digest = study->data_digest,
                           .options_digest = study->options_digest,
                           .seed = study->seed,
                           .runs = study->runs,
                           .shard = shard,
                           .shards = shards};
}

char *header_text(const struct header *header)
{
    struct json_tree tree;
    char shard[32];
    json_open(&tree);
    json_number(&tree, tree.root, "schema", 1);
    json_text(&tree, tree.root, "rotid", header->version);
    json_text(&tree, tree.root, "commit", header->commit);
    json_text(&tree, tree.root, "command", "study");
    json_text(&tree, tree.root, "plan", header->plan);
    json_text(&tree, tree.root, "studies", header->studies);
    cJSON *digest = json_object(&tree, tree.root, "digest");
    json_text(&tree, digest, "plan", header->plan_digest);
    json_text(&tree, digest, "decks", header->decks_digest);
    json_text(&tree, digest, "data", header->data_digest);
    json_text(&tree, digest, "options", header->options_digest);
    json_number(&tree, tree.root, "seed", (double)header->seed);
    json_number(&tree, tree.root, "runs", (double)header->runs);
    (void)snprintf(shard, sizeof shard, "%d/%d", header->shard, header->shards);
    json_text(&tree, tree.root, "shard", header->shards > 1 ? shard : NULL);
    return json_close_line(&tree);
}

/* NULL where there is none, with *failed set unless it may be null. */
static const char *text_of(struct pool *pool, const cJSON *object, const char *key, int may_be_null, int *failed)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    const char *text = cJSON_GetStringValue(item);
    char *copy = text ? pool_copy_text(pool, text) : NULL;
    *failed |= !copy && !(may_be_null && cJSON_IsNull(item));
    return copy;
}

static double number_of(const cJSON *object, const char *key, double least, double most, int *failed)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    int good = cJSON_IsNumber(item) && item->valuedouble >= least && item->valuedouble <= most &&
               item->valuedouble == floor(item->valuedouble);
    *failed |= !good;
    return good ? item->valuedouble : least;
}

int results_header_read(struct pool *pool, const cJSON *object, struct header *header)
{
    const cJSON *digest = cJSON_GetObjectItemCaseSensitive(object, "digest");
    int failed = !cJSON_IsObject(object), end = 0;
    const char *command = text_of(pool, object, "command", 0, &failed);
    *header = (struct header){.shard = 1, .shards = 1};
    failed |= !command || strcmp(command, "study") != 0;
    (void)number_of(object, "schema", 1, 1, &failed);
    header->version = text_of(pool, object, "rotid", 0, &failed);
    header->commit = text_of(pool, object, "commit", 0, &failed);
    header->plan = text_of(pool, object, "plan", 1, &failed);
    header->studies = text_of(pool, object, "studies", 0, &failed);
    header->plan_digest = text_of(pool, digest, "plan", 0, &failed);
    header->decks_digest = text_of(pool, digest, "decks", 0, &failed);
    header->data_digest = text_of(pool, digest, "data", 0, &failed);
    header->options_digest = text_of(pool, digest, "options", 0, &failed);
    header->seed = (unsigned long)number_of(object, "seed", 0, 4294967295.0, &failed);
    header->runs = (long)number_of(object, "runs", 1, STUDY_MOST_RUNS, &failed);
    const char *shard = text_of(pool, object, "shard", 1, &failed);
    if (shard && (sscanf(shard, "%9d/%9d%n", &header->shard, &header->shards, &end) != 2 || shard[end] || header->shard < 1 ||
                  header->shard > header->shards))
        failed = 1;
    return failed ? ROTID_ERROR_SYNTAX : ROTID_OK;
}

int header_difference(struct pool *pool, const struct header *file, const struct header *here, const char **text)
{
    const char *changed = "";
    const struct {
        const char *file, *here, *what;
    } parts[] = {{file->plan_digest, here->plan_digest, "the plan"},
                 {file->decks_digest, here->decks_digest, "a deck"},
                 {file->data_digest, here->data_digest, "the measured data"},
                 {file->options_digest, here->options_digest, "--set"}};
    *text = NULL;
    int other_options = strcmp(file->options_digest, here->options_digest) != 0; /* they may change the data as well */
    for (size_t i = 0; i < sizeof parts / sizeof *parts && changed; i++)
        if (strcmp(parts[i].file, parts[i].here) != 0 && !(other_options && parts[i].here == here->data_digest))
            changed = pool_format(pool, "%s%s%s", changed, *changed ? " and " : "", parts[i].what);
    if (!changed)
        return ROTID_ERROR_MEMORY;
    if (strcmp(file->version, here->version) != 0 || strcmp(file->commit, here->commit) != 0)
        *text = pool_format(pool, "it was begun by rotid %s (%s), this is %s (%s)", file->version, file->commit, here->version,
                            here->commit);
    else if (file->seed != here->seed)
        *text = pool_format(pool, "its seed is %lu, not %lu", file->seed, here->seed);
    else if (*changed)
        *text = pool_format(pool, "%s %s changed since it was begun", changed, strstr(changed, " and ") ? "have" : "has");
    else if (file->runs != here->runs || strcmp(file->studies, here->studies) != 0)
        *text = pool_format(pool, "it has %ld runs of %s, not %ld of %s", file->runs, file->studies, here->runs, here->studies);
    else
        return ROTID_OK;
    return *text ? ROTID_OK : ROTID_ERROR_MEMORY;
}
