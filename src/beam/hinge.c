#include "beam/beam.h"

static int place_of(const struct beam *beam, int target, int *end)
{
    const struct mesh *mesh = &beam->mesh;
    double from, to;
    rotor_group_span(&beam->rotor, target, &from, &to);
    int node = mesh_node_at(mesh, to), begins = 0, ends = 0;
    for (int t = 0; t < beam->rotor.ntierod; t++) {
        begins |= mesh->tierod[t].first_end == node;
        ends |= mesh->tierod[t].last_end == node;
    }
    if (node == 0 || node == mesh->end_node)
        return -1;
    *end = !(begins && !ends);
    return *end ? node - 1 : node;
}

int hinge_place(struct pool *pool, struct beam *beam)
{
    const struct rotor *rotor = &beam->rotor;
    int joints = 0;
    for (int i = 0; i < rotor->neffect; i++)
        joints += rotor->effect[i].kind->joint;
    beam->nhinge = 0;
    beam->hinge = NULL;
    if (!joints)
        return ROTID_OK;
    beam->hinge = POOL_ARRAY(pool, struct hinge, joints);
    if (!beam->hinge)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < rotor->neffect; i++) {
        struct hinge hinge = {.effect = i};
        if (!rotor->effect[i].kind->joint)
            continue;
        hinge.element = place_of(beam, rotor->effect[i].target, &hinge.end);
        if (hinge.element >= 0)
            beam->hinge[beam->nhinge++] = hinge;
    }
    return ROTID_OK;
}

int hinge_at(const struct beam *beam, int e, int end)
{
    for (int h = 0; h < beam->nhinge; h++)
        if (beam->hinge[h].element == e && beam->hinge[h].end == end)
            return 1;
    return 0;
}

int hinge_in(const struct beam *beam, int e)
{
    return hinge_at(beam, e, 0) || hinge_at(beam, e, 1);
}

/* a := T'a T with T = I - s b g': only row and column r of b take part */
static void transform(double s, int r, const double *g, double *a)
{
    double column[4], corner = a[r + 4 * r];
    memcpy(column, a + 4 * (ptrdiff_t)r, sizeof column);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            a[i + 4 * j] += s * s * corner * g[i] * g[j] - s * (g[i] * column[j] + column[i] * g[j]);
}

/* a += dT'm T + T'm dT with dT = -b h' */
static void add_turning(double s, int r, const double *g, const double *h, const double *m, double *a)
{
    double column[4]; /* T'm b */
    for (int i = 0; i < 4; i++)
        column[i] = m[i + 4 * r] - s * g[i] * m[r + 4 * r];
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            a[i + 4 * j] -= h[i] * column[j] + column[i] * h[j];
}

void hinge_apply(double c, double dc, int end, double *k, double *m, double *dk, double *dm)
{
    int r = end ? 3 : 1;
    double g[4], h[4], one = 1 + c * k[r + 4 * r], s = c / one;
    memcpy(g, k + 4 * (ptrdiff_t)r, sizeof g);
    if (dk) {
        double ds = (dc - c * c * dk[r + 4 * r]) / (one * one);
        for (int i = 0; i < 4; i++)
            h[i] = ds * g[i] + s * dk[i + 4 * r];
        transform(s, r, g, dk);
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < 4; i++)
                dk[i + 4 * j] -= dc / (one * one) * g[i] * g[j];
        transform(s, r, g, dm);
        add_turning(s, r, g, h, m, dm);
    }
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            k[i + 4 * j] -= s * g[i] * g[j];
    transform(s, r, g, m);
}

static double flexibility(const struct beam *beam, const struct hinge *hinge, int p)
{
    return p < 0 ? beam->rotor.effect[hinge->effect].value[0] : 1;
}

void hinge_condense(const struct beam *beam, int e, double *k, double *m)
{
    for (int h = 0; h < beam->nhinge; h++)
        if (beam->hinge[h].element == e)
            hinge_apply(flexibility(beam, &beam->hinge[h], -1), 0, beam->hinge[h].end, k, m, NULL, NULL);
}

void hinge_differentiate(const struct beam *beam, struct parameter parameter, int e, double *k, double *m, double *dk, double *dm)
{
    for (int h = 0; h < beam->nhinge; h++) {
        const struct hinge *hinge = &beam->hinge[h];
        if (hinge->element != e)
            continue;
        int own = parameter.kind == PARAMETER_EFFECT && parameter.index == hinge->effect;
        double dc = own ? flexibility(beam, hinge, parameter.component) : 0;
        hinge_apply(flexibility(beam, hinge, -1), dc, hinge->end, k, m, dk, dm);
    }
}
