/* A parameter that ends at a bound of *IDENTIFY: the diagnosis gets off it again, and says what the bound may do. */
#include "folder.h"
#include "one_state.h"
#include "support.h"

#include <unistd.h>

#include "deck/deck.h"
#include "diagnose/diagnose.h"
#include "hidden.h"

#define INPUT ROTID_SOURCE_DIR "/input/"

/* The text with `old` replaced, to be freed. */
static char *replaced(const char *text, const char *old, const char *new)
{
    char *out = malloc(strlen(text) + strlen(new) + 1);
    const char *at = strstr(text, old);
    assert_non_null(out);
    assert_non_null(at);
    (void)sprintf(out, "%.*s%s%s", (int)(at - text), text, new, at + strlen(old));
    return out;
}

static void assert_says(const char *text, const char *words)
{
    if (!strstr(text, words))
        fail_msg("'%s' lacks '%s'", text, words);
}

/* Nothing that contains the model before it may fit worse, and no name or rival rests on what does. */
static void assert_nested(const struct diagnosis *d)
{
    for (int r = 0; r < d->nround; r++)
        for (int i = 0; i < d->round[r].ncandidate; i++) {
            const struct candidate *c = &d->round[r].candidate[i];
            if (c->result.chi2_drop < -0.01 && (c->cause->effect->nparameter || c->result.probability > 0.01))
                fail_msg("round %d: %s %s changes chi2 by %+g", r + 1, c->cause->id, c->target, -c->result.chi2_drop);
        }
}

struct run {
    struct pool pool;
    struct message_list messages;
    struct job job;
    struct diagnosis d;
};

static void diagnose(const char *text, struct run *r)
{
    const struct diagnose_options options = {.threads = 2};
    const char *path = folder_write("deck.inp", text);
    pool_open(&r->pool, NULL);
    message_open(&r->messages, &r->pool);
    assert_status(deck_read(&r->pool, path, 0, NULL, &r->messages, &r->job), ROTID_OK);
    message_open(&r->messages, &r->pool);
    assert_status(diagnose_run(&r->pool, &r->job, &options, NULL, &r->messages, &r->d), ROTID_OK);
    print_message("%s\n", r->d.result.verdict.sentence);
    assert_true(r->d.base.fit->at_bound[0]);
    assert_nested(&r->d);
    int noted = 0;
    for (size_t i = 0; i < r->messages.count; i++)
        noted |= strstr(r->messages.item[i].text, "core.E ends at its lower bound") != NULL;
    assert_true(noted);
}

static void close_run(struct run *r)
{
    diagnose_free(&r->d);
    pool_close(&r->pool);
}

/* The cause is one, and with it the bound is no matter any more. */
static void assert_named(const struct diagnosis *d, const char *id)
{
    assert_string_equal(rotid_verdict_name(d->result.verdict.kind), "named");
    assert_int_equal(d->ncause, 1);
    assert_string_equal(d->cause[0].cause->id, id);
    assert_false(d->extended.fit->any_at_bound);
    assert_null(strstr(d->result.verdict.sentence, "bound"));
}

/* Data of the paper's rotor with an effect in it, and other bounds of core.E. */
static void diagnose_paper(const char *bounds, uint64_t seed, const char *truth, const char *effect, struct run *r)
{
    char *text = hidden_read(INPUT "paper_rotor.inp"), *deck = NULL, *true_values = NULL, message[300] = "";
    const char *const truths[1] = {truth}, *const effects[1] = {effect};
    struct hide_request request = hide_request_default();
    assert_non_null(text);
    request.deck = text;
    request.name = "paper_rotor.inp";
    request.seed = seed;
    request.truth = truths;
    request.truths = 1;
    request.effect = effects;
    request.effects = effect != NULL;
    (void)hide_case(&request, &deck, &true_values, message, sizeof message);
    assert_string_equal(message, "");
    char *changed = replaced(deck, "core.E, 1e6, 2.3e11, 0.6e11", bounds);
    diagnose(changed, r);
    free(changed);
    free(true_values);
    free(deck);
    free(text);
}

/* What the corners take of the stiffness has to come out of E, which the bound does not allow. */
UNIT_TEST(a_modulus_at_a_tight_bound_gets_off_it_with_the_cause)
{
    static const char *const bounds[] = {"core.E, 9.7e10, 1e12, 1.2e11", "core.E, 9.9e10, 2.3e11, 1.2e11"};
    for (size_t b = 0; b < sizeof bounds / sizeof *bounds; b++) {
        struct run r;
        diagnose_paper(bounds[b], 1, "core.E=1.05e11", "step_stiffness:angle=30", &r);
        assert_named(&r.d, "step_stiffness");
        const rotid_fit_result *fit = r.d.extended.fit;
        assert_true(fit->ci_lower[0] < 1.05e11 && 1.05e11 < fit->ci_upper[0]);
        assert_int_equal(fit->n, 3);
        assert_true(fit->ci_lower[2] < 30 && 30 < fit->ci_upper[2]); /* of the angle */
        close_run(&r);
    }
}

/* Its flexibility takes more of E than the bound allows. */
UNIT_TEST(a_very_soft_joint_is_named_although_E_ends_at_a_bound)
{
    struct run r;
    diagnose_paper("core.E, 9e10, 1e12, 1.2e11", 1, "core.E=1.012e11", "joint:at=core.end,flexibility=1e-8", &r);
    assert_named(&r.d, "joint");
    assert_close(r.d.cause[0].effect.value[0], 1e-8, 0.03, 0);
    close_run(&r);
}

/* Nothing is wrong but the bound, and causes that would do some of the work are there. */
UNIT_TEST(a_bound_that_keeps_the_truth_out_is_no_cause)
{
    struct run r;
    diagnose_paper("core.E, 1.1e11, 2.3e11, 1.5e11", 12, "core.E=1.0e11", NULL, &r);
    assert_true(r.d.result.verdict.kind == ROTID_AMBIGUOUS || r.d.result.verdict.kind == ROTID_UNEXPLAINED);
    assert_says(r.d.result.verdict.sentence, "core.E ends at its lower bound 110 GPa, which may be the cause itself: widen it");
    close_run(&r);
}

TEST_GROUP(folder_make, folder_remove);
