#include <math.h>
#include <stdio.h>
#include <string.h>

#include "diagnose/decide.h"
#include "page/diagnosis.h"

static const struct told_value *value_of(const struct told_cause *cause, const char *name)
{
    for (int p = 0; p < cause->nvalue; p++)
        if (!strcmp(cause->value[p].name, name))
            return &cause->value[p];
    return NULL;
}

static int at_group(const struct geometry *geometry, const char *target, struct told_place *place)
{
    size_t length = strcspn(target, "|"); /* of an interface: the group before it ends there */
    for (int g = 0; g < geometry->ngroup; g++) {
        const struct drawn_group *group = &geometry->group[g];
        if (strlen(group->name) != length || strncmp(group->name, target, length) != 0)
            continue;
        *place = (struct told_place){target[length] ? group->to : group->from, group->to, {NAN, NAN}};
        return 1;
    }
    return 0;
}

static int at_member(const struct geometry *geometry, const char *target, struct told_place *place)
{
    double z;
    for (int b = 0; b < geometry->nbundle; b++)
        if (!strcmp(geometry->bundle[b].name, target)) {
            *place = (struct told_place){geometry->bundle[b].from, geometry->bundle[b].to, {NAN, NAN}};
            return 1;
        }
    for (int s = 0; s < geometry->nspring; s++)
        if (geometry->spring[s].name && !strcmp(geometry->spring[s].name, target)) {
            *place = (struct told_place){geometry->spring[s].z, geometry->spring[s].z, {NAN, NAN}};
            return 1;
        }
    if (sscanf(target, "at %lf m", &z) != 1 || !isfinite(z)) /* of a spring without a name */
        return 0;
    *place = (struct told_place){z, z, {NAN, NAN}};
    return 1;
}

int diagnosis_place(const struct geometry *geometry, const struct told_cause *cause, struct told_place *place)
{
    const struct told_value *z = value_of(cause, "z"), *width = value_of(cause, "width");
    double half = width && isfinite(width->value) ? width->value : 0;
    *place = (struct told_place){NAN, NAN, {NAN, NAN}};
    if (!geometry)
        return 0;
    if (z && isfinite(z->value)) {
        *place = (struct told_place){fmax(z->value - half, 0), fmin(z->value + half, geometry->length), {z->ci[0], z->ci[1]}};
        return place->from <= place->to;
    }
    return *cause->target && (at_group(geometry, cause->target, place) || at_member(geometry, cause->target, place));
}

static int searched(const struct evidence *c)
{
    int count = 0;
    for (int p = 0; p < c->cause.nvalue; p++)
        count += !c->cause.value[p].fixed;
    return count;
}

double diagnosis_lead(const struct evidence *a, const struct evidence *b)
{
    return a->chi2_drop - b->chi2_drop - PARAMETER_PENALTY * (searched(a) - searched(b));
}

/* The result has the reasons as sentences alone. */
int diagnosis_is_rival(const struct evidence *c)
{
    const char *why = c->rejected_because;
    return c->refitted && isfinite(c->chi2_drop) &&
           (!why || !strncmp(why, "loses to ", 9) || !strncmp(why, "gains no more ", 14));
}

void diagnosis_leaders(const struct evidence_round *round, int *first, int *second)
{
    *first = round->nset ? 0 : -1; /* whatever fits better was refused, and says why */
    *second = -1;
    for (int i = 0; i < round->ncandidate; i++) {
        const struct evidence *c = &round->candidate[i];
        if (!diagnosis_is_rival(c) || i == *first)
            continue;
        if (*second < 0 || diagnosis_lead(c, &round->candidate[*second]) > 0)
            *second = i;
    }
}
