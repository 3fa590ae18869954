/* The diagnosis of a deck, for hosts. */
#include <math.h>

#include "api/deck_handle.h"
#include "api/diagnosis_parts.h"
#include "api/identification.h"
#include "base/parallel.h"
#include "base/sized.h"
#include "deck/deck_extended.h"
#include "diagnose/diagnose.h"

_Static_assert((int)VERDICT_ADEQUATE == ROTID_ADEQUATE && (int)VERDICT_NAMED == ROTID_NAMED &&
                   (int)VERDICT_AMBIGUOUS == ROTID_AMBIGUOUS && (int)VERDICT_UNEXPLAINED == ROTID_UNEXPLAINED,
               "verdicts of the header");

/* Without a fit or a verdict nothing is known of it. */
static rotid_quality quality(int known, const struct fit_quality *q)
{
    if (!known)
        return (rotid_quality){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    return (rotid_quality){.frequency_rms_percent = q->frequency_rms_percent,
                           .frequency_max_percent = q->frequency_max_percent,
                           .shape_rms = q->shape_rms,
                           .chi2_per_dof = q->chi2_per_dof,
                           .nco_min = q->nco_min,
                           .holdout_frequency_rms_percent = q->holdout_frequency_rms_percent,
                           .holdout_shape_rms = q->holdout_shape_rms,
                           .mode_out_frequency_rms_percent = q->mode_out_frequency_rms_percent,
                           .mode_out_shape_rms = q->mode_out_shape_rms,
                           .sensor_out_shape_rms = q->sensor_out_shape_rms};
}

/* The deck is written on the scratch of the call. */
static int make_result(struct holding *holding, struct call *call, const char *path, struct diagnosis *d,
                       rotid_diagnosis **result)
{
    rotid_diagnosis *r = holding ? POOL_NEW(&holding->pool, rotid_diagnosis) : NULL;
    char *text = NULL;
    int status = r ? ROTID_OK : ROTID_ERROR_MEMORY, known = d->sentence != NULL, has_base = d->base.fit != NULL,
        has_extended = d->extended.fit != NULL;
    if (!status && known && has_base)
        status = deck_write_extended(&call->entry.scratch, d, path, &text);
    if (status == ROTID_ERROR_MEMORY)
        return status;
    *r = (rotid_diagnosis){.kind = known ? (int)d->kind : -1,
                           .adequate_after = d->adequate_after,
                           .interrupted = d->interrupted,
                           .p_value = known ? d->p_value : NAN,
                           .sentence = holding_text(holding, d->sentence),
                           .next_measurement = holding_text(holding, d->next_measurement),
                           .ncause = d->ncause,
                           .nalternative = d->nalternative,
                           .cause = diagnosis_causes(holding, d->ncause, d->cause),
                           .alternative = diagnosis_causes(holding, d->nalternative, d->alternative),
                           .ndata_finding = d->ndata_finding,
                           .nnumerical_finding = d->nnumerical_finding,
                           .data_finding = diagnosis_data_findings(holding, d),
                           .numerical_finding = diagnosis_numerical_findings(holding, d),
                           .before = quality(known && has_base, &d->before),
                           .after = quality(known && has_extended, &d->after),
                           .nlocal = d->nlocal,
                           .local_z = HOLDING_COPY(holding, d->local_z, d->nlocal),
                           .local = HOLDING_COPY(holding, d->local, d->nlocal),
                           .ndetectable = d->ndetectable,
                           .detectable = diagnosis_detectable(holding, d),
                           .extended_deck = holding_text(holding, text),
                           .nmessage = (int)call->notes.count,
                           .message = holding_messages(holding, &call->notes),
                           .memory = holding};
    r->candidate = diagnosis_candidates(holding, d, &r->ncandidate);
    if (has_base)
        r->base = identification_new(holding, 0, &d->job, &d->base);
    if (has_extended)
        r->extended = identification_new(holding, 1, &d->extended_job, &d->extended);
    if (holding->missing)
        return ROTID_ERROR_MEMORY;
    *result = r;
    return ROTID_OK;
}

/* 0 takes the default. */
static int take_options(const rotid_diagnose_options *given, char *failure, struct diagnose_options *options)
{
    rotid_diagnose_options o = {0};
    int status = given ? sized_take(SIZED_DIAGNOSE_OPTIONS, given, failure, &o) : ROTID_OK;
    if (status)
        return status;
    if (o.threads < 0)
        return refuse(failure, "options->threads is %d, expected 0 or more", o.threads);
    if (o.replicates < 0)
        return refuse(failure, "options->replicates is %d, expected 0 or more", o.replicates);
    if (o.seed < 0)
        return refuse(failure, "options->seed is %ld, expected 0 or more", o.seed);
    *options = (struct diagnose_options){
        .threads = o.threads ? o.threads : 1, .seed = o.seed ? (unsigned long)o.seed : 1, .replicates = o.replicates};
    if (options->threads > PARALLEL_MOST)
        options->threads = PARALLEL_MOST;
    return ROTID_OK;
}

static int diagnose(struct call *call, const rotid_deck *deck, const rotid_diagnose_options *given, rotid_diagnosis **result)
{
    struct diagnose_options options;
    struct diagnosis d;
    const struct job *job = deck_job(deck, call);
    int status = job ? take_options(given, call->entry.failure, &options) : ROTID_ERROR_ARGUMENT;
    if (status)
        return status;
    status = diagnose_run(&call->entry.scratch, job, &options, &call->environment, &call->notes, &d);
    if (status)
        return status;
    struct holding *holding = holding_new(&call->environment);
    status = make_result(holding, call, deck->path, &d, result);
    if (status)
        holding_free(holding);
    diagnose_free(&d); /* what did not go over into the result */
    return status;
}

int rotid_diagnose(const rotid_deck *deck, const rotid_diagnose_options *options, const rotid_environment *environment,
                   char *failure, rotid_diagnosis **result)
{
    struct call call;
    int status = call_open(&call, environment, failure, result, "result");
    if (result)
        *result = NULL;
    if (!status)
        status = diagnose(&call, deck, options, result);
    return call_close(&call, status);
}

void rotid_diagnosis_free(rotid_diagnosis *result)
{
    if (result)
        holding_free(result->memory);
}

const char *rotid_verdict_name(int kind)
{
    return kind >= ROTID_ADEQUATE && kind <= ROTID_UNEXPLAINED ? verdict_name((enum verdict_kind)kind) : "unknown verdict";
}
