#include "running/running.h"

int machine_nominal(struct pool *pool, const struct machine *machine, const double *x, struct machine_values *values)
{
    int count = 2 * machine->nbearing + machine->nloss + machine->npull + machine->nchange;
    double *one = POOL_ARRAY(pool, double, count);
    for (int i = 0; i < count && one; i++)
        one[i] = 1;
    *values = (struct machine_values){.x = x, .bearing_k = one};
    if (!one)
        return ROTID_ERROR_MEMORY;
    values->bearing_c = one + machine->nbearing;
    values->loss = values->bearing_c + machine->nbearing;
    values->pull = values->loss + machine->nloss;
    values->change = values->pull + machine->npull;
    return ROTID_OK;
}

int machine_unknowns(const struct machine *machine, const struct job *job)
{
    return job->unknowns.nparameter + machine->nunknown;
}

const rotid_parameter *machine_bounds(const struct machine *machine, const struct job *job, int p)
{
    int own = p - job->unknowns.nparameter;
    return own < 0 ? &job->unknowns.bounds[p] : &machine->unknown[own].bounds;
}

int machine_by_logarithm(const struct machine *machine, const struct job *job, int p)
{
    return machine_bounds(machine, job, p)->lower > 0;
}

double machine_covariance(const struct machine *machine, const struct job *job, const rotid_fit_result *fit, int p, int q)
{
    return fit->covariance[p + (ptrdiff_t)fit->n * q] / (machine_by_logarithm(machine, job, p) ? fit->x[p] : 1) /
           (machine_by_logarithm(machine, job, q) ? fit->x[q] : 1);
}

double machine_bearing_factor(const struct machine *machine, const struct machine_values *values, int i, int damping)
{
    int p = machine->bearing[i].unknown[damping];
    return (damping ? values->bearing_c[i] : values->bearing_k[i]) * (p < 0 ? 1 : values->x[p]);
}

int machine_fit(struct pool *pool, const struct states *states, const rotid_fit_result *fit, rotid_fit_result *own)
{
    const struct state *state = &states->state[0];
    int at_rest = state->job.unknowns.nparameter, n = machine_unknowns(states->machine, &state->job), all = fit ? fit->n : 0;
    double *x = POOL_ARRAY(pool, double, (size_t)n *(size_t)(n + 2));
    if (!x)
        return ROTID_ERROR_MEMORY;
    *own = fit ? *fit : (rotid_fit_result){0};
    own->n = n;
    own->x = x;
    own->std = x + n;
    own->covariance = x + 2 * (ptrdiff_t)n;
    for (int p = 0; p < n; p++) {
        int i = p < at_rest ? state_unknown(state, p) : states->nparameter + p - at_rest, is_fitted = fit && i < all;
        own->x[p] = is_fitted ? fit->x[i] : machine_bounds(states->machine, &state->job, p)->start;
        own->std[p] = is_fitted ? fit->std[i] : (double)NAN;
        for (int q = 0; q < n; q++) {
            int j = q < at_rest ? state_unknown(state, q) : states->nparameter + q - at_rest;
            own->covariance[p + (ptrdiff_t)n * q] = is_fitted && j < all ? fit->covariance[i + (ptrdiff_t)all * j] : (double)NAN;
        }
    }
    return ROTID_OK;
}

int effect_is_of_test(const struct effect *effect, const struct rotor *rotor)
{
    struct effect_point point = {.z = 0};
    if (effect->kind->spring || effect->kind->at_sensor)
        return 1;
    return effect->kind->point && effect->kind->point(effect, rotor, 0, -1, &point) &&
           (point.lateral != 0 || point.rotational != 0);
}

/* By its name, or with the disk that it belongs to. */
static int is_gone(const struct machine *machine, const struct rotor *rotor, int effect)
{
    const struct effect *own = &rotor->effect[effect];
    return machine->without_effect[effect] || (own->kind->at_disk && machine->without_disk[own->target]);
}

int machine_has(const struct machine *machine, const struct rotor *rotor, struct parameter parameter)
{
    int spring = parameter_is_of_spring(&parameter), cause = parameter.kind == PARAMETER_EFFECT,
        disk = parameter.kind == PARAMETER_DISK_MASS || parameter.kind == PARAMETER_DISK_INERTIA;
    return !(spring && machine->without_spring[parameter.index]) && !(disk && machine->without_disk[parameter.index]) &&
           !(cause && is_gone(machine, rotor, parameter.index));
}

int machine_has_unknown(const struct machine *machine, const struct job *job, int p)
{
    return p >= job->unknowns.nparameter || machine_has(machine, &job->rotor, job->unknowns.parameter[p]);
}

/* A cause that is gone. */
static const struct effect_kind nothing = {.id = "none"};

/* What was left at the test stays in its list without stiffness or mass, so that parameters keep their indices. */
static int add_parts(struct pool *pool, const struct machine *machine, struct rotor *rotor)
{
    int more = machine->nbearing + machine->nunbalance + machine->nprobe, disks = rotor->ndisk, springs = rotor->nspring;
    struct disk *disk = POOL_ARRAY(pool, struct disk, disks + machine->ndisk);
    struct spring *spring = POOL_ARRAY(pool, struct spring, springs + more);
    if (!disk || !spring)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < disks; i++) {
        disk[i] = rotor->disk[i];
        if (machine->without_disk[i])
            disk[i] = (struct disk){.name = disk[i].name, .position = disk[i].position};
    }
    for (int i = 0; i < machine->ndisk; i++)
        disk[disks + i] = machine->disk[i];
    for (int i = 0; i < springs; i++) {
        spring[i] = rotor->spring[i];
        if (machine->without_spring[i])
            spring[i] = (struct spring){.name = spring[i].name, .position = spring[i].position};
    }
    for (int i = 0; i < machine->nbearing; i++)
        spring[springs++].position = machine->bearing[i].z;
    for (int i = 0; i < machine->nunbalance; i++)
        spring[springs++].position = machine->unbalance[i].z;
    for (int i = 0; i < machine->nprobe; i++)
        spring[springs++].position = machine->probe[i].z;
    for (int i = 0; i < rotor->neffect; i++)
        if (is_gone(machine, rotor, i))
            rotor->effect[i].kind = &nothing; /* which keeps its place and its parameters */
    rotor->disk = disk;
    rotor->ndisk = disks + machine->ndisk;
    rotor->spring = spring;
    rotor->nspring = springs;
    if (machine->without_sling)
        rotor->sling = 0;
    return ROTID_OK;
}

int machine_rotor(struct pool *pool, const struct machine *machine, const struct job *job, const struct machine_values *values,
                  struct rotor *rotor)
{
    struct rotor at_rest = job->rotor;
    if (machine->without_sling)
        at_rest.sling = 0; /* or the copy would have its springs */
    int status = rotor_copy(pool, &at_rest, rotor), nspring = job->rotor.nspring;
    if (status)
        return status;
    for (int p = 0; p < job->unknowns.nparameter; p++)
        parameters_set(rotor, 1, &job->unknowns.parameter[p], &values->x[p]);
    for (int i = 0; i < machine->nchange; i++) {
        double now = *parameter_value(rotor, machine->change[i].parameter) * machine->change[i].factor * values->change[i];
        parameters_set(rotor, 1, &machine->change[i].parameter, &now);
    }
    rotor->nspring = nspring; /* those of a sling come again when it is discretised */
    return add_parts(pool, machine, rotor);
}

void coefficients_at(const struct coefficients *all, double speed, double k[4], double c[4], double dk[4], double dc[4])
{
    int last = all->count - 1, i = 0;
    while (i < last && speed >= all->speed[i + 1])
        i++;
    int inside = last > 0 && i < last && speed > all->speed[0]; /* else constant, from row i */
    double step = inside ? all->speed[i + 1] - all->speed[i] : 1, part = inside ? speed - all->speed[i] : 0;
    for (int j = 0; j < 4; j++) {
        const double *own_k = all->k + 4 * (ptrdiff_t)i + j, *own_c = all->c + 4 * (ptrdiff_t)i + j;
        double rise_k = inside ? (own_k[4] - *own_k) / step : 0, rise_c = inside ? (own_c[4] - *own_c) / step : 0;
        k[j] = *own_k + part * rise_k;
        c[j] = *own_c + part * rise_c;
        if (dk) {
            dk[j] = rise_k;
            dc[j] = rise_c;
        }
    }
}

double bearing_on_pedestal(const struct bearing *bearing, double speed, double k)
{
    double under[4], c[4];
    if (!bearing->pedestal.count || !(k > 0))
        return k;
    coefficients_at(&bearing->pedestal, speed, under, c, NULL, NULL);
    double mean = (under[XX] + under[YY]) / 2;
    return mean > 0 ? k * mean / (k + mean) : k; /* above a resonance of its own: as on rigid ground */
}

/* The loss of a group from the damping of a test: the damping ratio of mode k is half of what its group loses of the elastic
 * energy, 2 zeta_k = eta a_k,  2 zeta_k = s w_k a_k,  a_k = (E d lambda/dE + G d lambda/dG)/lambda with a_k the share of the
 * group in the energy of the mode. What supports and air take is counted as the group's. */

#define LEAST_SHARE 0.02 /* of the energy: a mode with less says nothing of the group */

int loss_of_test(struct pool *pool, const struct job *job, int group, struct loss_of_test *out)
{
    const struct job_measurement *measured = &job->measurement;
    const struct material *material = &job->rotor.group[group].material;
    const struct parameter parameter[2] = {{.kind = PARAMETER_E, .index = group}, {.kind = PARAMETER_G, .index = group}};
    const double x[2] = {material->e, material->g};
    int n = material->isotropic ? 1 : 2, highest = 0;
    struct prediction p;
    *out = (struct loss_of_test){0};
    for (int k = 0; k < measured->nmode; k++)
        highest = isfinite(measured->damping[k]) && measured->number[k] > highest ? measured->number[k] : highest;
    if (!highest)
        return ROTID_OK;
    int status = elastic_rates(pool, NULL, &job->rotor, n, parameter, ROTID_REDUCTION_NONE, x, highest, &p);
    double sum[2] = {0, 0}, square[2] = {0, 0};
    for (int k = 0; k < measured->nmode && !status; k++) {
        int pair = p.count - highest + measured->number[k] - 1;
        double share = 0;
        for (int q = 0; q < n && isfinite(measured->damping[k]); q++)
            share += x[q] * p.dlambda[pair + (ptrdiff_t)p.count * q] / p.lambda[pair];
        if (share < LEAST_SHARE)
            continue;
        const double loss[2] = {2 * measured->damping[k] / share, 2 * measured->damping[k] / share / sqrt(p.lambda[pair])};
        for (int i = 0; i < 2; i++) {
            sum[i] += loss[i];
            square[i] += loss[i] * loss[i];
        }
        out->count++;
    }
    for (int i = 0; i < 2 && out->count; i++) {
        out->value[i] = sum[i] / out->count;
        out->std[i] = out->count > 1 ? sqrt(fmax(0, square[i] - sum[i] * sum[i] / out->count) / (out->count - 1)) : 0;
    }
    return status;
}
