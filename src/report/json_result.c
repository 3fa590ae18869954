#include "report/json_result.h"

static int add_references(struct pool *pool, const struct job *job, struct result_head *head)
{
    head->references = POOL_ARRAY(pool, rotid_reference, job->nreference);
    head->nreferences = job->nreference;
    for (int i = 0; i < job->nreference && head->references; i++) {
        const struct reference *reference = &job->reference[i];
        head->references[i] = (rotid_reference){reference->quantity, reference->count, reference->value};
    }
    return head->references != NULL;
}

static int add_warnings(struct pool *pool, const struct message_list *notes, struct result *result)
{
    result->warnings = POOL_ARRAY(pool, const char *, notes->count);
    for (size_t i = 0; i < notes->count && result->warnings; i++)
        if (notes->item[i].severity == SEVERITY_WARNING)
            result->warnings[result->nwarnings++] = notes->item[i].text;
    return result->warnings != NULL;
}

char *json_result(struct pool *pool, const struct provenance *provenance, const struct job *job, const struct message_list *notes,
                  struct result *result)
{
    result->head = (struct result_head){.schema = 1,
                                        .rotid = provenance->version,
                                        .commit = provenance->commit,
                                        .blas = provenance->blas,
                                        .seed = (double)provenance->seed,
                                        .threads = provenance->threads,
                                        .command = provenance->command,
                                        .deck = job ? job->deck : NULL,
                                        .nheading = job ? job->nheading : 0,
                                        .heading = job ? job->heading : NULL};
    int whole = (!job || add_references(pool, job, &result->head)) && (!notes || add_warnings(pool, notes, result));
    char *text = whole ? result_json(result) : NULL;
    pool_close(pool);
    return text;
}
