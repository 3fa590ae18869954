#include "fit/fit.h"

#ifndef WITH_NLOPT
#define WITH_NLOPT 1
#endif

int baseline_exists(void)
{
    return WITH_NLOPT;
}

#if !WITH_NLOPT

int baseline_count(int nparam)
{
    (void)nparam;
    return 0;
}

int baseline_run(struct pool *keep, struct joint *joint, struct joint *near, const rotid_parameter *parameter,
                 const rotid_environment *environment, double *work, rotid_baseline *out, int *count)
{
    (void)keep, (void)joint, (void)near, (void)parameter, (void)environment, (void)work, (void)out;
    *count = 0;
    return ROTID_OK;
}

#else

#include <nlopt.h>

static const struct {
    nlopt_algorithm algorithm;
    const char *name, *stage;
    int least, costly; /* parameters; takes hundreds of evaluations */
} table[] = {{NLOPT_LN_BOBYQA, "LN_BOBYQA", "NLopt LN_BOBYQA, evaluation", 2, 0},
             {NLOPT_LN_SBPLX, "LN_SBPLX", "NLopt LN_SBPLX, evaluation", 1, 1},
             {NLOPT_LD_SLSQP, "LD_SLSQP", "NLopt LD_SLSQP, evaluation", 1, 0}};

#define ALGORITHMS ((int)(sizeof table / sizeof *table))

int baseline_count(int nparam)
{
    int count = 0;
    for (int a = 0; a < ALGORITHMS; a++)
        count += nparam >= table[a].least;
    return count;
}

#define COSTLY 1e7 /* n kd^2 of a factor: an evaluation takes some 30 ms, and Sbplx four times as many as BOBYQA */

static int is_costly(const struct joint *joint)
{
    int costly = 0;
    for (int s = 0; s < joint->nstate; s++) {
        const rotid_matrix *k = &joint->part[s].functional.prediction.k;
        costly |= (double)k->n * k->kd * k->kd > COSTLY;
    }
    return costly;
}

struct problem {
    struct joint *joint;
    const rotid_parameter *parameter;
    const rotid_environment *environment;
    nlopt_opt optimiser;
    const char *stage; /* for progress */
    double *x, *r, *jacobian;
    int evaluations, cancelled;
    double unit; /* f at the start: SLSQP's first step is as long as the gradient of what it is given */
};

static double objective(unsigned n, const double *scaled, double *gradient, void *user)
{
    struct problem *problem = user;
    struct joint *joint = problem->joint;
    if (environment_cancelled(problem->environment)) {
        problem->cancelled = 1;
        (void)nlopt_force_stop(problem->optimiser);
        return HUGE_VAL; /* no point of this run is looked at again */
    }
    problem->evaluations++;
    environment_progress(problem->environment, problem->stage, problem->evaluations);
    for (unsigned p = 0; p < n; p++)
        problem->x[p] = scaled[p] * fabs(problem->parameter[p].start);
    for (unsigned p = 0; gradient && p < n; p++)
        gradient[p] = 0;
    int status = joint_residual(joint, problem->x, problem->r);
    if (!status && gradient)
        status = joint_jacobian(joint, problem->x, problem->jacobian);
    if (status)
        return HUGE_VAL;
    double sum = 0;
    for (int i = 0; i < joint->nresidual; i++)
        sum += problem->r[i] * problem->r[i];
    if (!(problem->unit > 0))
        problem->unit = sum > 0 ? sum / 2 : 1;
    for (unsigned p = 0; gradient && p < n; p++) {
        for (int i = 0; i < joint->nresidual; i++)
            gradient[p] += problem->jacobian[i + (ptrdiff_t)p * joint->nresidual] * problem->r[i];
        gradient[p] *= fabs(problem->parameter[p].start) / problem->unit;
    }
    return sum / 2 / problem->unit;
}

/* Sets up, runs and takes down one algorithm; NLopt's own codes are kept. */
static int run_one(int a, int n, struct problem *problem, double *bounds, rotid_baseline *out)
{
    double *lower = bounds, *upper = bounds + n, value = NAN;
    nlopt_opt optimiser = nlopt_create(table[a].algorithm, (unsigned)n);
    if (!optimiser)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < n; p++) {
        double unit = fabs(problem->parameter[p].start);
        lower[p] = problem->parameter[p].lower / unit;
        upper[p] = problem->parameter[p].upper / unit;
        out->x[p] = problem->parameter[p].start / unit;
    }
    problem->optimiser = optimiser;
    problem->stage = table[a].stage;
    problem->evaluations = 0;
    problem->unit = 0;
    (void)nlopt_set_lower_bounds(optimiser, lower);
    (void)nlopt_set_upper_bounds(optimiser, upper);
    (void)nlopt_set_min_objective(optimiser, objective, problem);
    /* A minimum of f is known to the square root of rounding in x, so x asks for 1e-8 and f for its last digits. */
    (void)nlopt_set_xtol_rel(optimiser, 1e-8);
    (void)nlopt_set_ftol_rel(optimiser, 1e-15);
    (void)nlopt_set_maxeval(optimiser, 5000);
    double begin = clock_seconds();
    nlopt_result result = nlopt_optimize(optimiser, out->x, &value);
    out->seconds = clock_seconds() - begin;
    nlopt_destroy(optimiser);
    for (int p = 0; p < n; p++)
        out->x[p] *= fabs(problem->parameter[p].start);
    out->algorithm = table[a].name;
    out->result = nlopt_result_to_string(result);
    out->code = result;
    out->usable = (result > 0 && result != NLOPT_MAXEVAL_REACHED) || result == NLOPT_ROUNDOFF_LIMITED;
    out->objective = value;
    out->evaluations = problem->evaluations;
    return ROTID_OK;
}

/* Value and gradient at the returned point, by us: a solver's own word is not enough. */
static void judge(int n, struct problem *problem, rotid_baseline *out)
{
    struct joint *joint = problem->joint;
    out->gradient = NAN;
    if (joint_residual(joint, out->x, problem->r) || joint_jacobian(joint, out->x, problem->jacobian)) {
        out->usable = 0;
        return;
    }
    double sum = 0;
    out->gradient = 0;
    for (int i = 0; i < joint->nresidual; i++)
        sum += problem->r[i] * problem->r[i];
    for (int p = 0; p < n; p++) {
        double g = 0, square = 0;
        for (int i = 0; i < joint->nresidual; i++) {
            double j = problem->jacobian[i + (ptrdiff_t)p * joint->nresidual];
            g += j * problem->r[i];
            square += j * j;
        }
        if (bounds_pressed(&problem->parameter[p], out->x[p]) * g >= 0 && g * g > square * (1e-6 * sum + 1e-12 * problem->unit))
            out->usable = 0; /* moving this parameter alone would lower f by a millionth: whatever the solver says, no minimum */
        out->gradient = fmax(out->gradient, fabs(g * problem->parameter[p].start));
    }
    out->objective = sum / 2;
}

int baseline_run(struct pool *keep, struct joint *joint, struct joint *near, const rotid_parameter *parameter,
                 const rotid_environment *environment, double *work, rotid_baseline *out, int *count)
{
    int n = joint->nparam, status = ROTID_OK;
    *count = 0;
    double *space = POOL_ARRAY(keep, double, 3 * n);
    if (!space)
        return ROTID_ERROR_MEMORY;
    struct problem problem = {.joint = joint,
                              .parameter = parameter,
                              .environment = environment,
                              .x = space,
                              .r = work,
                              .jacobian = work + joint->nresidual};
    for (int a = 0; a < ALGORITHMS && !status; a++) {
        if (n < table[a].least || (table[a].costly && is_costly(joint)))
            continue;
        problem.joint = near ? near : joint;
        out[*count].x = POOL_ARRAY(keep, double, n);
        status = out[*count].x ? run_one(a, n, &problem, space + n, &out[*count]) : ROTID_ERROR_MEMORY;
        if (problem.cancelled)
            return ROTID_STOP_CANCELLED;
        problem.joint = joint;
        if (!status)
            judge(n, &problem, &out[(*count)++]);
    }
    return status;
}

#endif
