#include <math.h>
#include <string.h>

#include "export/remark.h"
#include "export/ross_parts.h"

#define SAME 1e-13 /* relative: materials that differ by rounding are one */

struct shaft_material {
    int group; /* -1: of tie rods */
    struct ross_section section;
    const char *name;
};

struct shaft {
    struct pool *pool;
    const struct beam *beam;
    struct ross_names names;
    int nmaterial;
    struct shaft_material *material; /* [nelement + ntierod] */
    struct ross_section *section;    /* [nelement + ntierod] */
    int *used;                       /* [nelement + ntierod] material of each */
    struct stretch *stretch;         /* [ntierod] */
};

static int near_to(double a, double b)
{
    return fabs(a - b) <= SAME * fabs(b);
}

static int same_material(const struct ross_section *a, const struct ross_section *b)
{
    if (strcmp(a->equivalent ? a->equivalent : "", b->equivalent ? b->equivalent : "") != 0)
        return 0;
    return near_to(a->e, b->e) && near_to(a->g, b->g) && near_to(a->nu, b->nu) && near_to(a->rho, b->rho);
}

/* Gives section i a material: one that is there, or a new one. */
static int take_material(struct shaft *shaft, int i, int group, const char *wanted)
{
    const struct ross_section *section = &shaft->section[i];
    for (int m = shaft->nmaterial - 1; m >= 0; m--)
        if (shaft->material[m].group == group && same_material(&shaft->material[m].section, section)) {
            shaft->used[i] = m;
            return ROTID_OK;
        }
    const char *name = ross_name(&shaft->names, wanted, "shaft");
    shaft->used[i] = shaft->nmaterial;
    shaft->material[shaft->nmaterial++] = (struct shaft_material){group, *section, name};
    return name ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int collect(struct shaft *shaft)
{
    const struct beam *beam = shaft->beam;
    const struct rotor *rotor = &beam->rotor;
    int nelement = beam->mesh.nelement, status = ROTID_OK;
    for (int e = 0; e < nelement && !status; e++) {
        int group = rotor->segment[beam->mesh.segment[e]].group;
        const char *wanted = rotor->group[group].name;
        status = ross_axis_section(shaft->pool, beam, e, &shaft->section[e]);
        if (!status && shaft->section[e].equivalent && !(wanted = pool_format(shaft->pool, "%s_%d", wanted, e)))
            return ROTID_ERROR_MEMORY;
        if (!status)
            status = take_material(shaft, e, group, wanted);
    }
    for (int t = 0; t < rotor->ntierod && !status; t++) {
        ross_tierod_section(beam, t, &shaft->section[nelement + t], &shaft->stretch[t]);
        status = take_material(shaft, nelement + t, -1, rotor->tierod[t].name);
    }
    return status;
}

/* , "name=value" of a call */
static void put_keyword(FILE *stream, const char *name, double value)
{
    char number[32];
    (void)fprintf(stream, ", %s=%s", name, remark_number(value, number));
}

static void put_materials(FILE *stream, const struct shaft *shaft)
{
    struct remark remark = {stream, "    # ", 120};
    (void)fputs("MATERIAL = {\n", stream);
    for (int m = 0; m < shaft->nmaterial; m++) {
        const struct shaft_material *material = &shaft->material[m];
        if (material->section.equivalent)
            remark_put(&remark, "equivalent: %s", material->section.equivalent);
        if (material->group < 0)
            remark_put(&remark, "all rods of the bundle in one");
        (void)fprintf(stream, "    \"%s\": material(\"%s\"", material->name, material->name);
        put_keyword(stream, "E", material->section.e);
        put_keyword(stream, "G", material->section.g);
        put_keyword(stream, "nu", material->section.nu);
        put_keyword(stream, "rho", material->section.rho);
        (void)fputs("),\n", stream);
    }
    (void)fputs("}\n\n", stream);
}

/* length, diameters, material and force of section i: the arguments that an element begins with */
static void put_row(FILE *stream, const struct shaft *shaft, int i, double length, double force)
{
    char number[4][32];
    const struct ross_section *s = &shaft->section[i];
    (void)fprintf(stream, "%s, %s, %s, \"%s\", %s", remark_number(length, number[0]), remark_number(s->outer, number[1]),
                  remark_number(s->inner, number[2]), shaft->material[shaft->used[i]].name, remark_number(force, number[3]));
}

static void put_elements(FILE *stream, const struct shaft *shaft)
{
    const struct beam *beam = shaft->beam;
    struct remark remark = {stream, "    # ", 120};
    (void)fputs("# Node n is at the left end of row n: length, outer and inner diameter [m], material, axial force [N] (tension "
                "positive).\nSHAFT = [\n",
                stream);
    for (int e = 0, last = -1; e < beam->mesh.nelement; e++) {
        struct element element;
        int group = beam->rotor.segment[beam->mesh.segment[e]].group;
        if (group != last)
            remark_put(&remark, "%s", beam->rotor.group[group].name);
        last = group;
        axis_quantities(beam, e, &element);
        (void)fputs("    (", stream);
        put_row(stream, shaft, e, element.length, element.force);
        (void)fputs("),\n", stream);
    }
    (void)fputs("]\n", stream);
}

static void put_tierods(FILE *stream, const struct shaft *shaft)
{
    const struct beam *beam = shaft->beam;
    struct remark remark = {stream, "    # ", 120};
    if (!beam->rotor.ntierod)
        return;
    (void)fputs(
        "\n# Rods between two nodes: those nodes, what SHAFT says of an element, stretch [N.m/rad], ring [kg.m2].\nTIERODS = [\n",
        stream);
    for (int t = 0; t < beam->rotor.ntierod; t++) {
        const struct chain *chain = &beam->mesh.tierod[t];
        const struct tierod *rod = &beam->rotor.tierod[t];
        double length = beam->mesh.z[chain->last_end] - beam->mesh.z[chain->first_end];
        struct element element;
        struct stretch unused;
        char number[2][32];
        tierod_quantities(beam, t, length, &element, &unused);
        remark_put(&remark, "%s: %d rods of %g m at a pitch radius of %g m, %s", rod->name, rod->number, rod->diameter,
                   rod->pitch, shaft->stretch[t].stiffness > 0 ? "as rods" : "as the equivalent tube");
        (void)fprintf(stream, "    (%d, %d, ", chain->first_end, chain->last_end);
        put_row(stream, shaft, beam->mesh.nelement + t, length, element.force);
        (void)fprintf(stream, ", %s, %s),\n", remark_number(shaft->stretch[t].stiffness, number[0]),
                      remark_number(shaft->stretch[t].inertia, number[1]));
    }
    (void)fputs("]\n", stream);
}

int ross_put_shaft(struct pool *pool, FILE *stream, const struct ross_model *ross)
{
    const struct beam *beam = &ross->discrete->discrete.beam;
    int most = beam->mesh.nelement + beam->rotor.ntierod;
    struct shaft shaft = {.pool = pool,
                          .beam = beam,
                          .names = {.pool = pool},
                          .material = POOL_ARRAY(pool, struct shaft_material, most),
                          .section = POOL_ARRAY(pool, struct ross_section, most),
                          .used = POOL_ARRAY(pool, int, most),
                          .stretch = POOL_ARRAY(pool, struct stretch, beam->rotor.ntierod)};
    if (!shaft.material || !shaft.section || !shaft.used || !shaft.stretch)
        return ROTID_ERROR_MEMORY;
    int status = collect(&shaft);
    if (status)
        return status;
    put_materials(stream, &shaft);
    put_elements(stream, &shaft);
    put_tierods(stream, &shaft);
    return ROTID_OK;
}
