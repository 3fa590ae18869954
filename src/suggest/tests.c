#include "suggest/suggest.h"

const char *test_id(enum test_kind kind)
{
    static const char *const id[] = {"again", "modes",         "sensors", "shapes",       "noise",
                                     "mass",  "stiff_support", "free",    "moved_support"};
    return id[kind];
}

const char *test_text(struct pool *pool, const struct job *job, const struct test *t)
{
    const char *name = t->kind == TEST_MOVED ? job->rotor.spring[t->spring].name : NULL;
    switch (t->kind) {
    case TEST_AGAIN:
        return "the same test again";
    case TEST_MODES:
        return pool_format(pool, "the same test with modes up to %d", t->number[t->modes - 1]);
    case TEST_SENSORS:
        return pool_format(pool, "the same test at %d points", t->nsensor);
    case TEST_SHAPES:
        return pool_format(pool, "the same test with shapes at %d points", t->nsensor);
    case TEST_NOISE:
        return pool_format(pool, "the same test, each point measured %d times", t->averages);
    case TEST_MASS:
        return pool_format(pool, "with a known mass of %.3g kg at z = %s", t->mass,
                           job_value_text(pool, &job->units, 4, t->z, "m"));
    case TEST_STIFF:
        return pool_format(pool, "on supports about %g times as stiff", TEST_STIFFER);
    case TEST_FREE:
        return "free, on supports too soft to matter";
    case TEST_MOVED:
        return pool_format(pool, "with the support%s%s at z = %s", name ? " " : "", name ? name : "",
                           job_value_text(pool, &job->units, 4, t->z, "m"));
    }
    return "";
}

static int add_mass(struct pool *pool, const struct test *t, struct rotor *rotor)
{
    struct disk *disk = POOL_COPY(pool, rotor->disk, rotor->ndisk, 1);
    if (!disk)
        return ROTID_ERROR_MEMORY;
    disk[rotor->ndisk++] = (struct disk){.position = t->z, .mass = t->mass};
    rotor->disk = disk;
    return ROTID_OK;
}

static int change_springs(struct pool *pool, const struct test *t, struct job *to, double *x, int *own)
{
    struct rotor *rotor = &to->rotor;
    struct spring *spring = POOL_COPY(pool, rotor->spring, rotor->nspring, 0);
    double factor = t->kind == TEST_STIFF ? TEST_STIFFER : t->kind == TEST_FREE ? TEST_SOFTER : 1;
    if (!spring)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < rotor->nspring; s++) {
        spring[s].lateral *= factor;
        spring[s].rotational *= factor;
    }
    if (t->kind == TEST_MOVED)
        spring[t->spring].position = t->z;
    for (int p = 0; p < to->unknowns.nparameter; p++) {
        const struct parameter *parameter = &to->unknowns.parameter[p];
        if (!parameter_is_of_spring(parameter) || (t->kind == TEST_MOVED && parameter->index != t->spring))
            continue;
        own[p] = 1;
        x[p] *= factor;
    }
    rotor->spring = spring;
    return ROTID_OK;
}

int test_apply(struct pool *pool, const struct test *t, const struct job *job, const double *x, struct job *to, double *x_test,
               int *own)
{
    int status = planned_sensors(pool, job, t->nsensor, t->sensor, to);
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        x_test[p] = x[p];
        own[p] = 0;
    }
    if (!status && t->kind == TEST_MASS)
        status = add_mass(pool, t, &to->rotor);
    if (!status && (t->kind == TEST_STIFF || t->kind == TEST_FREE || t->kind == TEST_MOVED))
        status = change_springs(pool, t, to, x_test, own);
    return status;
}
