#include "hide_parameter.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SPREAD 0.15
#define INSIDE 0.02 /* of the width between the bounds: a truth at a bound would make every interval one-sided */

/* Where the quantity of a group stands. */
static double *of_group(struct hide_group *group, const char *quantity)
{
    struct hide_material *m = &group->material;
    group->free_modulus |= hide_same(quantity, "E") || hide_same(quantity, "G") || hide_same(quantity, "nu");
    group->free_density |= hide_same(quantity, "rho");
    if (hide_same(quantity, "G")) { /* an identified G is a modulus of its own */
        m->g = hide_shear_modulus(m);
        m->isotropic = 0;
        return &m->g;
    }
    return hide_same(quantity, "E") ? &m->e : hide_same(quantity, "nu") ? &m->nu : hide_same(quantity, "rho") ? &m->rho : NULL;
}

static double *find(struct hide_rotor *rotor, const char *parameter)
{
    char name[HIDE_NAME];
    const char *dot = strrchr(parameter, '.'), *quantity = dot ? dot + 1 : "";
    if (!dot || (size_t)(dot - parameter) >= sizeof name)
        return NULL;
    snprintf(name, sizeof name, "%.*s", (int)(dot - parameter), parameter);
    int i = hide_find_group(rotor, name);
    if (i >= 0)
        return of_group(&rotor->group[i], quantity);
    i = hide_find_tie(rotor, name);
    if (i >= 0)
        return hide_same(quantity, "E")         ? &rotor->tie[i].material.e
               : hide_same(quantity, "tension") ? &rotor->tie[i].tension
                                                : NULL;
    for (i = 0; i < rotor->springs; i++)
        if (hide_same(rotor->spring[i].name, name))
            return hide_same(quantity, "k")       ? &rotor->spring[i].lateral
                   : hide_same(quantity, "k_rot") ? &rotor->spring[i].rotational
                                                  : NULL;
    for (i = 0; i < rotor->disks; i++)
        if (hide_same(rotor->disk[i].name, name))
            return hide_same(quantity, "mass")      ? &rotor->disk[i].mass
                   : hide_same(quantity, "inertia") ? &rotor->disk[i].inertia
                                                    : NULL;
    return NULL;
}

static struct hide_parameter *parameter_of(struct hide_rotor *rotor, const char *name, size_t length)
{
    char copy[2 * HIDE_NAME];
    snprintf(copy, sizeof copy, "%.*s", (int)length, name);
    for (int i = 0; i < rotor->parameters; i++)
        if (hide_same(rotor->parameter[i].name, copy))
            return &rotor->parameter[i];
    return NULL;
}

static double draw(const struct hide_parameter *p, double deck, struct hide_random *random)
{
    double margin = INSIDE * (p->upper - p->lower);
    double value = (deck != 0 ? deck : p->start) * (1 + hide_between(random, -SPREAD, SPREAD));
    return fmin(fmax(value, p->lower + margin), p->upper - margin);
}

int hide_parameters_set(int truths, const char *const *truth, struct hide_random *random, struct hide_rotor *rotor,
                        const struct hide_message *message)
{
    double *place[HIDE_MOST_PARAMETERS];
    for (int i = 0; i < rotor->parameters; i++) {
        place[i] = find(rotor, rotor->parameter[i].name);
        if (!place[i])
            return hide_fail(message, HIDE_INPUT, "*IDENTIFY: %s is not known, expected a parameter of docs/deck.md",
                             rotor->parameter[i].name);
    }
    for (int i = 0; i < rotor->parameters; i++) /* all are drawn, so that a given one leaves the others as they were */
        rotor->parameter[i].truth = draw(&rotor->parameter[i], *place[i], random);
    for (int i = 0; i < truths; i++) {
        const char *equals = strchr(truth[i], '=');
        struct hide_parameter *p = equals ? parameter_of(rotor, truth[i], (size_t)(equals - truth[i])) : NULL;
        if (!p)
            return hide_fail(message, HIDE_INPUT, "--true %s: expected NAME=VALUE with a parameter of *IDENTIFY", truth[i]);
        if (!hide_read_number(equals + 1, &p->truth) || !(p->truth > p->lower && p->truth < p->upper))
            return hide_fail(message, HIDE_INPUT, "--true %s: expected a value between its bounds %g and %g", truth[i], p->lower,
                             p->upper);
    }
    for (int i = 0; i < rotor->parameters; i++)
        *place[i] = rotor->parameter[i].truth;
    return HIDE_OK;
}
