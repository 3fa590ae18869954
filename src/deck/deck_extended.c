#include "deck/deck_extended.h"

#include "deck/deck_write.h"

/* The job to write and the values of its parameters: the base model where nothing was named. */
static const struct job *extended_job(const struct diagnosis *d, const double **x)
{
    const struct job *job = d->extended_job.deck ? &d->extended_job : &d->job;
    const rotid_fit_result *fit = d->extended.fit ? d->extended.fit : d->base.fit;
    *x = fit && fit->n == job->unknowns.nparameter ? fit->x : NULL;
    return job;
}

int deck_write_extended(struct pool *pool, const struct diagnosis *d, const char *from, char **text)
{
    int lines = 2 + d->nalternative;
    const char **extra = POOL_ARRAY(pool, const char *, lines);
    *text = NULL;
    if (!extra)
        return ROTID_ERROR_MEMORY;
    extra[0] = pool_format(pool, "rotid %s from %s, verdict %s", ROTID_VERSION, from, rotid_verdict_name(d->result.verdict.kind));
    extra[1] = d->result.verdict.sentence;
    for (int i = 0; i < d->nalternative; i++) {
        const struct candidate *other = &d->alternative[i];
        const char *word = i && other->set && other->set == other[-1].set ? "together with" : "cannot be told apart:";
        extra[2 + i] = pool_format(pool, "%s %s%s%s", word, other->cause->id, other->target && *other->target ? " " : "",
                                   other->target ? other->target : "");
    }
    for (int i = 0; i < lines; i++)
        if (!extra[i])
            return ROTID_ERROR_MEMORY;
    struct deck_write_options options = {.nextra = lines, .extra = extra};
    const struct job *job = extended_job(d, &options.x);
    return deck_write(pool, job, &options, text);
}
