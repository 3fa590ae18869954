#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "export/ross_saved.h"
#include "rotid.h"

#define TOUCH 1e-9 /* relative: as layers of a deck */

struct making {
    struct pool *pool;
    const char *path;
    const struct ross_saved *saved;
    struct message_list *messages;
    struct rotor *rotor;
    int first, last; /* nodes of the shaft */
    double *z;       /* [last - first + 1] */
    int cones, masses;
    int nname;
    const char **name; /* taken already */
};

static int wrong(struct making *m, const char *text, const char *tag, int n)
{
    message_add(m->messages, SEVERITY_ERROR, m->path, 1, 1, "%s at node %d: %s", *tag ? tag : "an element", n, text);
    return ROTID_ERROR_SYNTAX;
}

/* A name of a deck: without what cards are made of, and not taken. NULL without memory. */
static const char *free_name(struct making *m, const char *wanted)
{
    char plain[64];
    size_t length = 0;
    for (const char *c = wanted; *c && length + 1 < sizeof plain; c++) {
        int usable = (unsigned char)*c > ' ' && (unsigned char)*c < 127 && !strchr(",*=.:\"", *c);
        if (usable || (length && plain[length - 1] != '_'))
            plain[length++] = usable ? *c : '_';
    }
    plain[length] = 0;
    const char *name = pool_copy_text(m->pool, length ? plain : "part");
    for (int suffix = 2, taken = 1; taken && name; suffix++) {
        taken = 0;
        for (int i = 0; i < m->nname && !taken; i++)
            taken = same_text(m->name[i], name);
        if (taken)
            name = pool_format(m->pool, "%s_%d", length ? plain : "part", suffix);
    }
    if (name)
        m->name[m->nname++] = name;
    return name;
}

static int near_to(double a, double b)
{
    return fabs(a - b) <= TOUCH * fmax(fabs(a), fabs(b));
}

static int same_material(const struct material *a, const struct material *b)
{
    return same_text(a->name, b->name) && a->e == b->e && a->g == b->g && a->rho == b->rho;
}

/* The elements at one node: the first lies on the axis, the others are rings around it. */
static int count_at(const struct ross_saved *saved, int e)
{
    int count = 1;
    while (e + count < saved->nelement && saved->element[e + count].n == saved->element[e].n)
        count++;
    return count;
}

static int is_cone(const struct ross_shaft_element *e)
{
    return !near_to(e->outer[0], e->outer[1]) || (!near_to(e->inner[0], e->inner[1]) && fmax(e->inner[0], e->inner[1]) > 0);
}

static int check_station(struct making *m, int e, int count)
{
    const struct ross_shaft_element *at = &m->saved->element[e];
    for (int i = 1; i < count; i++) {
        if (!near_to(at[i].length, at[0].length))
            return wrong(m, "it is not as long as the one that it lies around, expected the same length", at[i].tag, at[i].n);
        if (is_cone(&at[i]) || is_cone(&at[0]))
            return wrong(m, "cones that lie around each other have no deck, expected cylinders", at[i].tag, at[i].n);
        if (!near_to(at[i].inner[0], at[i - 1].outer[0]))
            return wrong(m, "it does not touch the one within, expected its inner diameter to be the outer one of that",
                         at[i].tag, at[i].n);
    }
    return ROTID_OK;
}

/* Checks all stations, and where their nodes lie. */
static int place_nodes(struct making *m)
{
    const struct ross_saved *saved = m->saved;
    m->first = saved->element[0].n;
    m->last = saved->element[saved->nelement - 1].n + 1;
    m->z = POOL_ARRAY(m->pool, double, m->last - m->first + 1);
    if (!m->z)
        return ROTID_ERROR_MEMORY;
    int node = m->first;
    for (int e = 0, count; e < saved->nelement; e += count, node++) {
        count = count_at(saved, e);
        if (saved->element[e].n != node)
            return wrong(m, "the elements leave a gap before it, expected one at every node up to it", saved->element[e].tag,
                         saved->element[e].n);
        int status = check_station(m, e, count);
        if (status)
            return status;
        m->z[node + 1 - m->first] = m->z[node - m->first] + saved->element[e].length;
    }
    return ROTID_OK;
}

/* Whether two stations are of one group: the same materials from the axis outwards, and the same force. */
static int same_group(const struct ross_saved *saved, int a, int count, int b, int others)
{
    double force_a = 0, force_b = 0;
    int same = count == others;
    for (int i = 0; i < count && same; i++) {
        same = same_material(&saved->element[a + i].material, &saved->element[b + i].material);
        force_a += saved->element[a + i].force;
        force_b += saved->element[b + i].force;
    }
    return same && force_a == force_b;
}

/* Whether a station goes on with the section of the one before. */
static int same_section(const struct ross_saved *saved, int a, int count, int b)
{
    int same = near_to(saved->element[a].length, saved->element[b].length);
    for (int i = 0; i < count && same; i++)
        same = saved->element[a + i].outer[0] == saved->element[b + i].outer[0] &&
               saved->element[a + i].inner[0] == saved->element[b + i].inner[0] && !is_cone(&saved->element[a + i]) &&
               !is_cone(&saved->element[b + i]);
    return same;
}

static void add_cone(struct making *m, const struct ross_shaft_element *e, int group)
{
    for (int i = 0; i < ROSS_CONE_STEPS; i++) {
        double at = (i + 0.5) / ROSS_CONE_STEPS;
        struct segment *s = &m->rotor->segment[m->rotor->nsegment++];
        *s = (struct segment){.group = group, .elements = 1, .length = e->length / ROSS_CONE_STEPS};
        s->outer = s->stiff_outer = (1 - at) * e->outer[0] + at * e->outer[1];
        s->inner = (1 - at) * e->inner[0] + at * e->inner[1];
    }
    m->cones++;
}

static void add_section(struct making *m, int e, int count, int group, int layer)
{
    const struct ross_shaft_element *at = &m->saved->element[e];
    struct rotor *rotor = m->rotor;
    int segment = rotor->nsegment++;
    rotor->segment[segment] = (struct segment){.group = group,
                                               .elements = 1,
                                               .length = at->length,
                                               .outer = at->outer[0],
                                               .inner = at->inner[0],
                                               .stiff_outer = at->outer[0]};
    for (int i = 1; i < count; i++)
        rotor->ring[rotor->nring++] = (struct ring){layer + i - 1, segment, at[i].outer[0], at[i - 1].outer[0]};
}

/* A station more of the last section. */
static void extend_section(struct making *m, int e)
{
    struct segment *s = &m->rotor->segment[m->rotor->nsegment - 1];
    int node = m->saved->element[e].n + 1 - m->first;
    s->elements++;
    s->length = m->z[node] - m->z[node - s->elements];
}

/* The group of the axis that begins with a station, and its layers. */
static int add_groups(struct making *m, int e, int count, int group, int layer)
{
    const struct ross_shaft_element *at = &m->saved->element[e];
    struct group *of = m->rotor->group;
    for (int i = 0; i < count; i++) {
        int g = i ? layer + i - 1 : group;
        of[g] = (struct group){.name = free_name(m, at[i].material.name), .material = at[i].material, .layer_of = i ? group : -1};
        of[group].preload += at[i].force;
        if (!of[g].name)
            return ROTID_ERROR_MEMORY;
    }
    m->rotor->ngroup += count;
    return ROTID_OK;
}

static int count_axis_groups(const struct ross_saved *saved)
{
    int groups = 0, before = 0, before_count = 0;
    for (int e = 0, count; e < saved->nelement; e += count) {
        count = count_at(saved, e);
        groups += !e || !same_group(saved, before, before_count, e, count);
        before = e;
        before_count = count;
    }
    return groups;
}

static int add_shaft(struct making *m)
{
    const struct ross_saved *saved = m->saved;
    int group = -1, layer = count_axis_groups(saved), before = 0, before_count = 1, status = ROTID_OK;
    for (int e = 0, count; e < saved->nelement && !status; e += count) {
        count = count_at(saved, e);
        int is_new = !e || !same_group(saved, before, before_count, e, count);
        if (is_new) {
            layer += before_count - 1;
            status = add_groups(m, e, count, ++group, layer);
        }
        if (!is_new && same_section(saved, before, count, e))
            extend_section(m, e);
        else if (is_cone(&saved->element[e]))
            add_cone(m, &saved->element[e], group);
        else
            add_section(m, e, count, group, layer);
        before = e;
        before_count = count;
    }
    return status;
}

static int is_on_shaft(const struct making *m, int n)
{
    return n >= m->first && n <= m->last;
}

static int add_disks(struct making *m)
{
    const struct ross_saved *saved = m->saved;
    for (int i = 0; i < saved->ndisk; i++) {
        const struct ross_disk *d = &saved->disk[i];
        int supports = 0;
        for (int b = 0; b < saved->nbearing; b++)
            supports |= saved->bearing[b].link == d->n;
        if (!is_on_shaft(m, d->n) && supports) {
            m->masses++;
            continue;
        }
        if (!is_on_shaft(m, d->n))
            return wrong(m, "it stands at no node of the shaft, expected one", d->tag, d->n);
        struct disk *disk = &m->rotor->disk[m->rotor->ndisk++];
        *disk = (struct disk){free_name(m, d->tag), m->z[d->n - m->first], d->mass, d->diametral, d->polar, 0, 0};
        if (!disk->name)
            return ROTID_ERROR_MEMORY;
    }
    return ROTID_OK;
}

/* What the shaft feels of a bearing on a support: both springs in series. */
static double stiffness_of(const struct ross_saved *saved, const struct ross_bearing *b)
{
    double support = 0;
    for (int i = 0; i < saved->nbearing && b->link >= 0; i++)
        support += saved->bearing[i].n == b->link ? saved->bearing[i].kxx : 0;
    return b->link < 0 ? b->kxx : b->kxx + support > 0 ? b->kxx * support / (b->kxx + support) : 0;
}

static int add_springs(struct making *m)
{
    const struct ross_saved *saved = m->saved;
    for (int i = 0; i < saved->nbearing; i++) {
        const struct ross_bearing *b = &saved->bearing[i];
        int supports = 0;
        for (int o = 0; o < saved->nbearing; o++)
            supports |= saved->bearing[o].link == b->n;
        if (!is_on_shaft(m, b->n) && supports)
            continue; /* taken with the bearing on it */
        if (!is_on_shaft(m, b->n))
            return wrong(m, "it stands at no node of the shaft, expected one", b->tag, b->n);
        if (b->link >= 0 && is_on_shaft(m, b->link))
            return wrong(m, "it joins two nodes of the shaft, expected a support", b->tag, b->n);
        double k = stiffness_of(saved, b);
        if (!(k > 0))
            continue;
        struct spring *spring = &m->rotor->spring[m->rotor->nspring++];
        *spring = (struct spring){free_name(m, b->tag), m->z[b->n - m->first], k, 0};
        if (!spring->name)
            return ROTID_ERROR_MEMORY;
    }
    return ROTID_OK;
}

int ross_saved_rotor(struct pool *pool, const char *path, const struct ross_saved *saved, struct message_list *messages,
                     struct rotor *rotor)
{
    struct making m = {.pool = pool, .path = path, .saved = saved, .messages = messages, .rotor = rotor};
    int parts = saved->nelement + saved->ndisk + saved->nbearing;
    *rotor = (struct rotor){.group = POOL_ARRAY(pool, struct group, saved->nelement),
                            .segment = POOL_ARRAY(pool, struct segment, ROSS_CONE_STEPS * (size_t)saved->nelement),
                            .ring = POOL_ARRAY(pool, struct ring, saved->nelement),
                            .disk = POOL_ARRAY(pool, struct disk, saved->ndisk),
                            .spring = POOL_ARRAY(pool, struct spring, saved->nbearing)};
    m.name = POOL_ARRAY(pool, const char *, parts);
    if (!rotor->group || !rotor->segment || !rotor->ring || !rotor->disk || !rotor->spring || !m.name)
        return ROTID_ERROR_MEMORY;
    int status = place_nodes(&m);
    if (!status)
        status = add_shaft(&m);
    if (!status)
        status = add_disks(&m);
    if (!status)
        status = add_springs(&m);
    if (m.cones)
        message_add(messages, SEVERITY_WARNING, NULL, 0, 0, "%d conical elements become %d cylinders each", m.cones,
                    ROSS_CONE_STEPS);
    if (m.masses)
        message_add(messages, SEVERITY_WARNING, NULL, 0, 0, "%d masses on supports of bearings are left out", m.masses);
    return status;
}
