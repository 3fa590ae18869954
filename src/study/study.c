#include "study/study.h"

#include <string.h>

#include "study/check.h"

/* Cells of one deck and variant. */
static long cells(const struct plan *plan)
{
    return (long)plan->nmodes * plan->nsensors * plan->nnoise * plan->nhide;
}

struct study_point study_locate(const struct study *study, long run)
{
    const struct plan *plan = study->plan;
    struct study_point point = {0};
    struct study_cell *cell = &point.cell;
    while (run >= study->deck[cell->deck].first[plan->nvariant])
        cell->deck++;
    const struct study_deck *deck = &study->deck[cell->deck];
    while (run >= deck->first[cell->variant + 1])
        cell->variant++;
    run -= deck->first[cell->variant];
    point.start = run % deck->starts[cell->variant];
    run /= deck->starts[cell->variant];
    point.replicate = run % plan->replicates;
    run /= plan->replicates;
    cell->hide = (int)(run % plan->nhide);
    run /= plan->nhide;
    cell->noise = (int)(run % plan->nnoise);
    run /= plan->nnoise;
    cell->sensors = (int)(run % plan->nsensors);
    cell->modes = (int)(run / plan->nsensors);
    return point;
}

/* grid^n, or more than there may be runs. */
static long starts_of(const struct plan *plan, int nparameter)
{
    long starts = plan->grid ? 1 : plan->count;
    for (int p = 0; p < nparameter && plan->grid && starts <= STUDY_MOST_RUNS; p++)
        starts *= plan->grid;
    return starts;
}

static int count_runs(struct pool *pool, const struct check *check, struct study *study, struct message_list *messages)
{
    const struct plan *plan = study->plan;
    double runs = 0;
    for (int d = 0; d < plan->ndeck; d++) {
        struct study_deck *deck = &study->deck[d];
        deck->first = POOL_ARRAY(pool, long, plan->nvariant + 1);
        deck->starts = POOL_ARRAY(pool, long, plan->nvariant);
        if (!deck->first || !deck->starts)
            return ROTID_ERROR_MEMORY;
        for (int v = 0; v < plan->nvariant; v++) {
            deck->starts[v] = starts_of(plan, check->nparameter[v + (ptrdiff_t)d * plan->nvariant]);
            runs += (double)cells(plan) * plan->replicates * (double)deck->starts[v];
            if (runs > STUDY_MOST_RUNS) {
                message_add(messages, SEVERITY_ERROR, plan->path ? plan->path : plan->deck[0].path, 1, 1,
                            "the plan has more than %d runs, expected fewer", STUDY_MOST_RUNS);
                return ROTID_ERROR_SYNTAX;
            }
            deck->first[v] = study->runs;
            study->runs = (long)runs;
        }
        deck->first[plan->nvariant] = study->runs;
    }
    return ROTID_OK;
}

static void digest_plan(struct study *study)
{
    const struct plan *plan = study->plan;
    struct digest digest;
    digest_open(&digest);
    digest_cards(&digest, &plan->text);
    for (int d = 0; d < plan->ndeck; d++)
        digest_text(&digest, plan->deck[d].name);
    digest_letters(&digest, study->plan_digest);
    digest_open(&digest);
    for (int i = 0; i < study->noverride; i++) {
        digest_text(&digest, study->override[i].card);
        digest_text(&digest, study->override[i].option);
        digest_text(&digest, study->override[i].value);
    }
    digest_letters(&digest, study->options_digest);
}

int study_open(struct pool *pool, const struct plan *plan, int noverride, const struct override *override, unsigned long seed,
               struct message_list *messages, struct study *study)
{
    struct check check;
    *study = (struct study){.plan = plan, .noverride = noverride, .override = override, .seed = seed};
    study->deck = POOL_ARRAY(pool, struct study_deck, plan->ndeck);
    if (!study->deck)
        return ROTID_ERROR_MEMORY;
    int status = check_decks(pool, study, messages, &check);
    if (!status)
        status = count_runs(pool, &check, study, messages);
    if (status)
        return status;
    digest_plan(study);
    digest_letters(&check.decks, study->decks_digest);
    digest_letters(&check.data, study->data_digest);
    return messages->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}
