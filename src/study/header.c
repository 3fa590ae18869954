#include "study/study.h"

#include <stdio.h>
#include <string.h>

#include "result/result.h"

struct header header_of(const struct study *study, const char *version, const char *commit, int shard, int shards)
{
    return (struct header){.version = version,
                           .commit = commit,
                           .plan = study->plan->path,
                           .studies = plan_commands[study->plan->command],
                           .plan_digest = study->plan_digest,
                           .decks_digest = study->decks_digest,
                           .data_digest = study->data_digest,
                           .options_digest = study->options_digest,
                           .seed = study->seed,
                           .runs = study->runs,
                           .shard = shard,
                           .shards = shards,
                           .input = study->input};
}

char *header_text(const struct header *header)
{
    struct json_tree tree;
    char shard[32];
    (void)snprintf(shard, sizeof shard, "%d/%d", header->shard, header->shards);
    const struct study_header line = {.schema = 1,
                                      .rotid = header->version,
                                      .commit = header->commit,
                                      .command = "study",
                                      .plan = header->plan,
                                      .studies = header->studies,
                                      .digest = {.plan = header->plan_digest,
                                                 .decks = header->decks_digest,
                                                 .data = header->data_digest,
                                                 .options = header->options_digest},
                                      .seed = (double)header->seed,
                                      .runs = (int)header->runs,
                                      .shard = header->shards > 1 ? shard : NULL};
    json_open(&tree);
    record_write(&tree, tree.root, &study_header_record, &line);
    return json_close_line(&tree);
}

int results_header_read(struct pool *pool, const cJSON *object, struct header *header)
{
    struct message_list unheard; /* the caller says what was expected */
    struct reader reader = {.pool = pool, .messages = &unheard, .file = ""};
    const struct json_place place = {.reader = &reader, .json = object};
    struct study_header line = {0};
    int shard = 1, shards = 1, end = 0;
    message_open(&unheard, pool);
    *header = (struct header){.shard = 1, .shards = 1};
    if (!cJSON_IsObject(object))
        return ROTID_ERROR_SYNTAX;
    record_read(&place, &study_header_record, &line);
    if (reader.status)
        return reader.status;
    const char *const needed[] = {line.rotid,        line.studies,     line.digest.plan,
                                  line.digest.decks, line.digest.data, line.digest.options};
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++)
        if (!*needed[i]) /* null */
            return ROTID_ERROR_SYNTAX;
    if (line.schema != 1 || strcmp(line.command, "study") != 0 || !(line.seed <= 4294967295.0) || line.runs > STUDY_MOST_RUNS ||
        (line.shard &&
         (sscanf(line.shard, "%9d/%9d%n", &shard, &shards, &end) != 2 || line.shard[end] || shard < 1 || shard > shards)))
        return ROTID_ERROR_SYNTAX;
    *header = (struct header){.version = line.rotid,
                              .commit = line.commit,
                              .plan = line.plan,
                              .studies = line.studies,
                              .plan_digest = line.digest.plan,
                              .decks_digest = line.digest.decks,
                              .data_digest = line.digest.data,
                              .options_digest = line.digest.options,
                              .seed = (unsigned long)line.seed,
                              .runs = line.runs,
                              .shard = shard,
                              .shards = shards};
    return ROTID_OK;
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
        if (here->input && (parts[i].here == here->decks_digest || parts[i].here == here->data_digest))
            continue; /* its run is computed again */
        else if (strcmp(parts[i].file, parts[i].here) != 0 && !(other_options && parts[i].here == here->data_digest))
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
