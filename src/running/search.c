#include "running/running.h"

#define BEYOND      1.3 /* times the running range, or the third critical speed */
#define FARTHEST    10  /* times that, and as many more as the square of the number of the critical speed: a measured one */
#define FARTHER     1.6 /* the range where too few were found within it */
#define MODES_FIRST 14
#define MODES_MOST  48
#define REACH       2.5 /* the highest mode of the basis over the highest speed, at least */
#define BOTH_HALVES 2.1 /* times the frequency of a mode of the lower half of a basis: its highest one */
#define COUPLED     10
#define RESOLVED    1e6 /* times the highest frequency of the basis: damping */
#define ATTEMPTS    4
#define TURN        0.35  /* of the speed, and */
#define STRIDE      0.025 /* of the highest one: steps at which modes are followed, at most */
#define ROWS        0.002 /* of the highest one: at those of tables that lie apart by more */
#define LOWEST      1e-3  /* of the highest one: the first of them */

static int refuse_system(const struct search *s, int status, int failed, struct message_list *notes)
{
    if (status == ROTID_ERROR_STIFFNESS)
        message_at(notes, SEVERITY_ERROR, s->machine->place,
                   "the bearings do not hold the rotor, expected two *BEARING with stiffness, or more");
    if (status == ROTID_ERROR_SECTION) {
        struct place place = job_part_place(s->job, failed);
        message_at(notes, SEVERITY_ERROR, place, "%s",
                   discrete_refusal(s->job->options.solid ? AS_SOLID : AS_BEAM, &s->job->rotor, failed));
    }
    return status;
}

/* Whether the bearings are stronger than the magnetic pull: the symmetric part of the stiffness at standstill is positive
 * definite.
 */
static int is_held(struct pool *pool, struct system *s, int npull)
{
    struct pool scratch;
    int held = 0, n = s->size;
    if (!npull)
        return 1;
    pool_open(&scratch, pool->allocator);
    double *k = POOL_ARRAY(&scratch, double, (size_t)n *(size_t)n);
    system_at(s, 0);
    for (int j = 0; j < n && k; j++)
        for (int i = 0; i < n; i++)
            k[i + (ptrdiff_t)n * j] = (s->stiff[i + (ptrdiff_t)n * j] + s->stiff[j + (ptrdiff_t)n * i]) / 2;
    held = k && !cholesky_factor(n, k);
    pool_close(&scratch);
    return held;
}

/* Whether the damping leaves digits of the frequencies: eigenvalues have those of the largest one, some C/M. */
static int is_resolved(struct system *s, double highest)
{
    double most = 0;
    for (int at = 0; at < 2; at++) {
        system_at(s, at * highest);
        for (int i = 0; i < s->size; i++)
            most = fmax(most, fabs(s->c[i + (ptrdiff_t)s->size * i] / s->mass[i + (ptrdiff_t)s->size * i]));
    }
    return most <= RESOLVED * s->highest;
}

/* With a basis that reaches far enough beyond the highest speed, as far as the model has so many modes. */
static int build(struct pool *pool, struct search *s, double highest, struct message_list *notes)
{
    int status, failed;
    s->basis = (struct basis_size){MODES_FIRST, COUPLED, 1};
    for (;; s->basis.modes += s->basis.modes / 2) {
        status = system_build(pool, s->machine, s->job, &s->values, NULL, &s->basis, &s->system, &failed);
        if (status)
            return refuse_system(s, status, failed, notes);
        if (!is_held(pool, &s->system, s->machine->npull))
            return message_refuse_at(
                notes, ROTID_ERROR_STIFFNESS, s->machine->place,
                "the magnetic pull is stronger than the bearings, which draws the rotor to the stator: expected a *PULL "
                "below their stiffness");
        if (!is_resolved(&s->system, highest))
            return message_refuse_at(notes, ROTID_ERROR_STIFFNESS, s->machine->place,
                                     "bearings or losses damp so much that no digits of the frequencies are left: expected the "
                                     "stiffness of what holds the rotor in place of its damping");
        if (s->system.highest >= REACH * highest || s->basis.modes >= s->system.n || s->basis.modes >= MODES_MOST)
            return ROTID_OK;
    }
}

/* The first speed between two of which a table has a row, `least` behind the first of them; the second where there is none. */
static double row_between(const struct coefficients *all, double from, double least, double to)
{
    int i = 0;
    while (i < all->count && all->speed[i] < from + least)
        i++;
    return i < all->count ? fmin(to, all->speed[i]) : to;
}

/* The speeds at which modes are followed: those that are asked for, and between them as many more as keep two loci apart. A locus
 * turns by a share of the speed, and the lowest critical speeds lie far below the highest speed. At a row of a table it bends: a
 * mode may fall below the speed on one side and rise above it on the other. */
static int between_speeds(struct pool *pool, const struct search *s, double to, int *count, double **speed)
{
    *count = 0;
    for (int i = 0; i < s->count; i++)
        for (double at = i ? s->speed[i - 1] : s->speed[0], end = s->speed[i], next = at; next < end || (!i && !*count);
             at = next) {
            next = fmax(LOWEST * to, at + fmin(TURN * at, STRIDE * to));
            next = next < end - (next - at) / 4 && i ? next : end;
            for (int b = 0; b < s->machine->nbearing; b++) {
                next = row_between(&s->machine->bearing[b].film, at, ROWS * to, next);
                next = row_between(&s->machine->bearing[b].pedestal, at, ROWS * to, next);
            }
            next = next > at ? next : end; /* shares of the highest speed that are below the doubles */
            if (POOL_ADD(pool, *speed, *count, &next))
                return ROTID_ERROR_MEMORY;
        }
    return ROTID_OK;
}

/* Of the modes at all speeds those at the speeds that are asked for. */
static int thin(struct pool *pool, const struct search *s, const struct tracks *all, struct tracks *t)
{
    *t = (struct tracks){.nspeed = s->count, .nmode = all->nmode, .room = all->room, .speed = s->speed};
    t->pair = POOL_ARRAY(pool, struct pair, (size_t)s->count * (size_t)all->room);
    for (int i = 0, at = 0; i < s->count && t->pair; i++) {
        while (all->speed[at] < s->speed[i])
            at++;
        for (int m = 0; m < all->nmode; m++)
            *track_at(t, m, i) = *track_at(all, m, at);
    }
    return t->pair ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int find(struct pool *pool, struct search *s, double to)
{
    int count;
    double *speed = NULL;
    s->speed = POOL_ARRAY(pool, double, s->count);
    for (int i = 0; i < s->count && s->speed; i++)
        s->speed[i] = fmax(STANDSTILL * to, s->given       ? s->given[i]
                                            : s->count > 1 ? s->from + (to - s->from) * i / (s->count - 1)
                                                           : to);
    int status = s->speed ? between_speeds(pool, s, to, &count, &speed) : ROTID_ERROR_MEMORY;
    if (!status)
        status = tracks_make(pool, &s->system, count, speed, 2 * to * fmax(1, s->harmonic), &s->followed);
    if (!status)
        status = criticals_find(pool, &s->system, &s->followed, s->harmonic, &s->ncritical, &s->critical, &s->missed);
    return status ? status : thin(pool, s, &s->followed, &s->tracks);
}

/* A basis in whose upper half a mode grows gives way to one in whose lower half that mode lies. */
int search_within(struct pool *pool, double to, struct message_list *notes, struct search *s)
{
    double highest = to * fmax(1, s->harmonic);
    int status = ROTID_OK, more = 1;
    while (!status && more) {
        status = build(pool, s, highest, notes);
        if (!status)
            status = find(pool, s, to);
        more = !status && s->followed.beyond > 0 && s->basis.modes < s->system.n && s->basis.modes < MODES_MOST;
        highest = fmax(highest, BOTH_HALVES * s->followed.beyond / REACH);
    }
    return status;
}

int search_count(const struct search *s, int backward)
{
    int count = 0;
    for (int i = 0; i < s->ncritical; i++)
        count += (pair_whirl(&s->system, s->critical[i].pair.u) == WHIRL_BACKWARD) == backward;
    return count;
}

const struct critical *search_find(const struct search *s, int number, int backward)
{
    for (int i = 0; i < s->ncritical; i++) {
        number -= (pair_whirl(&s->system, s->critical[i].pair.u) == WHIRL_BACKWARD) == backward;
        if (!number)
            return &s->critical[i];
    }
    return NULL;
}

int search_until(struct pool *pool, double least, int forward, int backward, struct message_list *notes, struct search *s)
{
    int status = build(pool, s, 0, notes), count;
    struct pair *all = status ? NULL : POOL_ARRAY(pool, struct pair, s->system.size);
    for (int i = 0; i < s->system.size && all; i++)
        if (pair_new(pool, s->system.size, &all[i]))
            return ROTID_ERROR_MEMORY;
    if (status || !all)
        return status ? status : ROTID_ERROR_MEMORY;
    status = pairs_all(pool, &s->system, STANDSTILL * s->system.highest, &count, all, NULL);
    if (!status && !count)
        return ROTID_ERROR_EIGEN;
    double third = status ? 0 : BEYOND * cimag(all[count > 6 ? 5 : count - 1].lambda) / s->harmonic, to = fmax(least, third);
    double most = third * (FARTHEST + fmax(forward * forward, backward * backward));
    if (!status && least > most) /* it takes minutes */
        status = message_refuse_at(notes, ROTID_ERROR_ARGUMENT, s->machine->runup->place,
                                   "speeds up to %.6g rpm, expected at most %.3g rpm for this machine", least / RPM, most / RPM);
    for (int attempt = 0; attempt < ATTEMPTS && !status; attempt++, to *= FARTHER) {
        status = search_within(pool, to, notes, s);
        if (!status && search_count(s, 0) >= forward && search_count(s, 1) >= backward)
            break;
    }
    return status;
}
