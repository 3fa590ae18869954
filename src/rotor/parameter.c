#include "rotor/rotor.h"

enum owner { OF_GROUP, OF_TIEROD, OF_SPRING, OF_DISK };

static const struct {
    enum parameter_kind kind;
    enum owner owner;
    const char *suffix, *unit;
} table[] = {
    {PARAMETER_E, OF_GROUP, "E", "Pa"},           {PARAMETER_G, OF_GROUP, "G", "Pa"},
    {PARAMETER_NU, OF_GROUP, "nu", "1"},          {PARAMETER_RHO, OF_GROUP, "rho", "kg/m3"},
    {PARAMETER_TIEROD_E, OF_TIEROD, "E", "Pa"},   {PARAMETER_TENSION, OF_TIEROD, "tension", "N"},
    {PARAMETER_SPRING_K, OF_SPRING, "k", "N/m"},  {PARAMETER_SPRING_K_ROT, OF_SPRING, "k_rot", "N.m/rad"},
    {PARAMETER_DISK_MASS, OF_DISK, "mass", "kg"}, {PARAMETER_DISK_INERTIA, OF_DISK, "inertia", "kg.m2"},
};

static int count_of(const struct rotor *rotor, enum owner owner)
{
    return owner == OF_GROUP    ? rotor->ngroup
           : owner == OF_TIEROD ? rotor->ntierod
           : owner == OF_SPRING ? rotor->nspring
                                : rotor->ndisk;
}

static const char *name_of(const struct rotor *rotor, enum owner owner, int index)
{
    return owner == OF_GROUP    ? rotor->group[index].name
           : owner == OF_TIEROD ? rotor->tierod[index].name
           : owner == OF_SPRING ? rotor->spring[index].name
                                : rotor->disk[index].name;
}

/* the names of objects and suffixes are compared without case, as everything in a deck */
static int same(const char *a, const char *b, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        char x = a[i], y = b[i];
        x = x >= 'A' && x <= 'Z' ? (char)(x - 'A' + 'a') : x;
        y = y >= 'A' && y <= 'Z' ? (char)(y - 'A' + 'a') : y;
        if (x != y)
            return 0;
    }
    return 1;
}

static int find_in_effects(const struct rotor *rotor, const char *name, size_t length, const char *suffix,
                           struct parameter *parameter, const char **unit, int result)
{
    for (int i = 0; i < rotor->neffect; i++) {
        const struct effect *effect = &rotor->effect[i];
        if (!effect->name || strlen(effect->name) != length || !same(effect->name, name, length))
            continue;
        result = 2;
        for (int p = 0; p < effect_parameters(effect); p++) {
            const struct effect_parameter_name *own = &effect->kind->parameter[p];
            if (same_text(own->name, suffix)) {
                *parameter = (struct parameter){PARAMETER_EFFECT, i, p, 0, NULL};
                *unit = own->unit;
                return 0;
            }
        }
    }
    return result;
}

int parameter_find(const struct rotor *rotor, const char *name, struct parameter *parameter, const char **unit)
{
    const char *dot = strrchr(name, '.');
    if (!dot)
        return 1;
    size_t length = (size_t)(dot - name);
    int result = 1;
    for (size_t t = 0; t < sizeof table / sizeof *table; t++)
        for (int i = 0; i < count_of(rotor, table[t].owner); i++) {
            const char *owner = name_of(rotor, table[t].owner, i);
            if (!owner || strlen(owner) != length || !same(owner, name, length))
                continue;
            result = 2;
            if (same_text(table[t].suffix, dot + 1)) {
                *parameter = (struct parameter){table[t].kind, i, 0, 0, NULL};
                *unit = table[t].unit;
                return 0;
            }
        }
    return find_in_effects(rotor, name, length, dot + 1, parameter, unit, result);
}

struct listing {
    struct pool *pool;
    const char *text, *of; /* of: an object alone, or NULL */
    int count;
};

static void list(struct listing *l, const char *owner, const char *suffix)
{
    size_t length = l->of ? strcspn(l->of, ".") : 0;
    if (!owner || !*owner || !l->text || (l->of && (strlen(owner) != length || !same(owner, l->of, length))))
        return;
    if (l->count++ < PARAMETERS_LISTED)
        l->text = pool_format(l->pool, "%s%s%s.%s", l->text, *l->text ? ", " : "", owner, suffix);
}

const char *parameter_list(struct pool *pool, const struct rotor *rotor, const char *of)
{
    struct listing l = {.pool = pool, .text = "", .of = of};
    for (enum owner owner = OF_GROUP; owner <= OF_DISK; owner++)
        for (int i = 0; i < count_of(rotor, owner); i++)
            for (size_t t = 0; t < sizeof table / sizeof *table; t++)
                if (table[t].owner == owner)
                    list(&l, name_of(rotor, owner, i), table[t].suffix);
    for (int i = 0; i < rotor->neffect; i++)
        for (int p = 0; p < effect_parameters(&rotor->effect[i]); p++)
            list(&l, rotor->effect[i].name, rotor->effect[i].kind->parameter[p].name);
    if (!l.count && of)
        return parameter_list(pool, rotor, NULL);
    if (l.text && l.count > PARAMETERS_LISTED)
        l.text = pool_format(pool, "%s and %d more", l.text, l.count - PARAMETERS_LISTED);
    return l.text;
}

double *parameter_starts(struct pool *pool, int n, const rotid_parameter *bounds)
{
    double *x = POOL_ARRAY(pool, double, n);
    for (int p = 0; p < n && x; p++)
        x[p] = bounds[p].start;
    return x;
}

double *parameter_value(const struct rotor *rotor, struct parameter parameter)
{
    const enum parameter_kind kind = parameter.kind;
    int i = parameter.index;
    return kind == PARAMETER_E              ? &rotor->group[i].material.e
           : kind == PARAMETER_G            ? &rotor->group[i].material.g
           : kind == PARAMETER_NU           ? &rotor->group[i].material.nu
           : kind == PARAMETER_RHO          ? &rotor->group[i].material.rho
           : kind == PARAMETER_TIEROD_E     ? &rotor->tierod[i].material.e
           : kind == PARAMETER_TENSION      ? &rotor->tierod[i].tension
           : kind == PARAMETER_SPRING_K     ? &rotor->spring[i].lateral
           : kind == PARAMETER_SPRING_K_ROT ? &rotor->spring[i].rotational
           : kind == PARAMETER_DISK_MASS    ? &rotor->disk[i].mass
           : kind == PARAMETER_EFFECT       ? &rotor->effect[i].value[parameter.component]
                                            : &rotor->disk[i].diametral;
}

const char *parameter_next_name(const char *names, char name[PARAMETER_NAME])
{
    const char *end = strchr(names, PARAMETER_SHARED_BY);
    size_t length = end ? (size_t)(end - names) : strlen(names);
    while (length && names[length - 1] == ' ')
        length--;
    length = length < PARAMETER_NAME ? length : PARAMETER_NAME - 1;
    memcpy(name, names, length);
    name[length] = 0;
    return end ? end + 1 + strspn(end + 1, " ") : NULL;
}

int parameter_is_of_spring(const struct parameter *parameter)
{
    return parameter->kind == PARAMETER_SPRING_K || parameter->kind == PARAMETER_SPRING_K_ROT;
}

int parameter_is_of_group(const struct parameter *parameter, int group)
{
    int is = parameter->kind <= PARAMETER_RHO && parameter->index == group;
    for (int i = 0; i < parameter->nalso; i++)
        is |= parameter->also[i] == group;
    return is;
}

int parameters_overlap(const struct parameter *a, const struct parameter *b)
{
    int same = a->index == b->index;
    for (int i = 0; i < a->nalso; i++)
        same |= parameter_is_of_group(b, a->also[i]);
    for (int i = 0; i < b->nalso; i++)
        same |= parameter_is_of_group(a, b->also[i]);
    return same && a->kind == b->kind && a->component == b->component;
}

void parameters_set(const struct rotor *rotor, int n, const struct parameter *parameter, const double *x)
{
    for (int p = 0; p < n; p++) {
        struct parameter one = parameter[p];
        *parameter_value(rotor, one) = x[p];
        for (int i = 0; i < parameter[p].nalso; i++) {
            one.index = parameter[p].also[i];
            *parameter_value(rotor, one) = x[p];
        }
    }
}

void parameter_state(const struct rotor *rotor, const struct parameter *parameter, double value)
{
    for (int i = -1; i < parameter->nalso && parameter->kind == PARAMETER_G; i++)
        rotor->group[i < 0 ? parameter->index : parameter->also[i]].material.isotropic = 0;
    parameters_set(rotor, 1, parameter, &value);
}
