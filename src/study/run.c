#include "study/run.h"

#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "diagnose/diagnose.h"
#include "result/json_tree.h"
#include "study/experiment.h"
#include "study/line.h"

static int is_cancelled(const rotid_environment *environment)
{
    return environment && environment->cancelled && environment->cancelled(environment->context);
}

/* Why a run failed, in one line: the errors that say something of their own, else what the status says. */
static const char *reason(struct pool *pool, int status, const struct message_list *notes)
{
    const char *text = NULL;
    for (size_t i = 0; i < notes->count; i++) {
        if (notes->item[i].severity != SEVERITY_ERROR)
            continue;
        const char *longer = text ? pool_format(pool, "%s; %s", text, notes->item[i].text) : notes->item[i].text;
        text = longer ? longer : text;
    }
    return text ? text : rotid_status_text(status);
}

static char *identify(struct pool *pool, const struct study *study, const struct line *line, struct experiment *experiment,
                      const rotid_environment *environment, struct message_list *notes, int *status)
{
    struct identification *result = POOL_ARRAY(pool, struct identification, experiment->states.nstate);
    rotid_fit_result *fit = NULL;
    char *text = NULL;
    *status = ROTID_ERROR_MEMORY;
    if (result)
        *status = identify_states_bare(pool, &experiment->states, study->plan->baseline, environment, notes, result, &fit);
    if (*status)
        return NULL;
    if (fit->status == ROTID_STOP_CANCELLED)
        *status = ROTID_STOP_CANCELLED;
    else
        text = line_identified(line, experiment, result, fit, notes);
    rotid_fit_free(fit);
    return text;
}

static char *diagnose(struct pool *pool, const struct study *study, const struct line *line, struct experiment *experiment,
                      const rotid_environment *environment, struct message_list *notes, int *status)
{
    const struct diagnose_options options = {.threads = 1, .seed = study->seed, .replicates = study->plan->bootstrap};
    struct diagnosis result;
    char *text = NULL;
    *status = diagnose_states(pool, &experiment->states, &options, environment, notes, &result);
    if (*status)
        return NULL;
    if (result.result.interrupted)
        *status = ROTID_STOP_CANCELLED;
    else
        text = line_diagnosed(line, experiment, &result, notes);
    diagnose_free(&result);
    return text;
}

int study_run(struct jobs *jobs, long run, const rotid_environment *environment, char **text)
{
    const struct study *study = jobs->study;
    const struct study_point point = study_locate(study, run);
    const struct line line = {study, run, point, clock_seconds()};
    const char *error = study->deck[point.cell.deck].error;
    struct pool pool;
    struct message_list notes;
    struct experiment experiment;
    int status = ROTID_OK;
    *text = NULL;
    pool_open(&pool, NULL);
    message_open(&notes, &pool);
    if (!error) {
        status = experiment_make(&pool, jobs, &point, &notes, &experiment);
        if (!status)
            *text = (study->plan->command == PLAN_DIAGNOSE ? diagnose : identify)(&pool, study, &line, &experiment, environment,
                                                                                  &notes, &status);
        if (is_cancelled(environment)) /* what came behind the last look at it may be incomplete */
            status = ROTID_STOP_CANCELLED;
        error = status < 0 ? reason(&pool, status, &notes) : NULL;
    }
    if (status == ROTID_STOP_CANCELLED) {
        json_free(*text);
        *text = NULL;
    } else if (error) {
        *text = line_failed(&line, error, clock_seconds() - line.begin);
        status = ROTID_OK;
    }
    pool_close(&pool);
    return status == ROTID_STOP_CANCELLED || *text ? status : ROTID_ERROR_MEMORY;
}

char *study_run_failed(const struct study *study, long run, const char *error, double seconds)
{
    const struct line line = {study, run, study_locate(study, run), 0};
    return line_failed(&line, error, seconds);
}
