/* Things of a rotor by their names. */
#include <stdlib.h>
#include <string.h>

#include "hide_rotor.h"

double hide_shear_modulus(const struct hide_material *material)
{
    return material->isotropic ? material->e / 2 / (1 + material->nu) : material->g;
}

int hide_find_group(const struct hide_rotor *rotor, const char *name)
{
    for (int i = 0; i < rotor->groups; i++)
        if (hide_same(rotor->group[i].name, name))
            return i;
    return -1;
}

int hide_find_tie(const struct hide_rotor *rotor, const char *name)
{
    for (int i = 0; i < rotor->ties; i++)
        if (hide_same(rotor->tie[i].name, name))
            return i;
    return -1;
}

int hide_find_spring(const struct hide_rotor *rotor, const char *name)
{
    char *end;
    long number = strtol(name, &end, 10);
    for (int i = 0; i < rotor->springs; i++)
        if (*name && hide_same(rotor->spring[i].name, name))
            return i;
    return end != name && !*end && number >= 1 && number <= rotor->springs ? (int)number - 1 : -1;
}

int hide_find_disk(const struct hide_rotor *rotor, const char *name)
{
    char *end;
    long number = strtol(name, &end, 10);
    for (int i = 0; i < rotor->disks; i++)
        if (*name && hide_same(rotor->disk[i].name, name))
            return i;
    return end != name && !*end && number >= 1 && number <= rotor->disks ? (int)number - 1 : -1;
}

int hide_find_sensor(const struct hide_rotor *rotor, long id)
{
    for (int i = 0; i < rotor->sensors; i++)
        if (rotor->sensor[i].id == id)
            return i;
    return -1;
}

int hide_position(const struct hide_rotor *rotor, const char *text, double *z)
{
    const char *dot = strrchr(text, '.');
    double slack = 1e-5 * rotor->length; /* as docs/deck.md has it */
    char name[HIDE_NAME];
    if (hide_read_number(text, z)) {
        if (!(*z >= -slack && *z <= rotor->length + slack))
            return 0;
        *z = *z < 0 ? 0 : *z > rotor->length ? rotor->length : *z;
        return 1;
    }
    int at_end = hide_same(dot ? dot + 1 : text, "end");
    if (!at_end && !hide_same(dot ? dot + 1 : text, "start"))
        return 0;
    if (!dot) {
        *z = at_end ? rotor->length : 0;
        return 1;
    }
    if ((size_t)(dot - text) >= sizeof name)
        return 0;
    memcpy(name, text, (size_t)(dot - text));
    name[dot - text] = 0;
    int group = hide_find_group(rotor, name);
    if (group < 0)
        return 0;
    *z = at_end ? rotor->group[group].to : rotor->group[group].from;
    return 1;
}
