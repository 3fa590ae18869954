#include "export/remark.h"
#include "export/ross_parts.h"
#include "rotor/effects.h"

struct ross_needs ross_needs(const struct ross_model *ross)
{
    const struct beam *beam = &ross->discrete->discrete.beam;
    struct ross_needs needs = {.tierods = beam->rotor.ntierod > 0, .matrices = beam->nhinge > 0};
    for (int i = 0; i < beam->rotor.nspring; i++)
        needs.rotational_springs |= beam->rotor.spring[i].rotational > 0;
    for (struct lumped lumped = {.i = -1}; lumped_next(beam, &lumped);)
        needs.matrices |= ross_mass_node(beam, &lumped) < 0;
    return needs;
}

static void put_square(FILE *stream, const char *name, const double *a)
{
    char number[32];
    (void)fprintf(stream, "        \"%s\": [\n", name);
    for (int i = 0; i < 4; i++) {
        (void)fputs("            [", stream);
        for (int j = 0; j < 4; j++)
            (void)fprintf(stream, "%s%s", j ? ", " : "", remark_number(a[i + 4 * j], number));
        (void)fputs("],\n", stream);
    }
    (void)fputs("        ],\n", stream);
}

int ross_put_matrices(struct pool *pool, FILE *stream, const struct ross_model *ross)
{
    const struct beam *beam = &ross->discrete->discrete.beam;
    struct remark remark = {stream, "    # ", 120};
    struct ross_matrices matrices;
    int status;
    (void)fputs(
        "\n# Elements whose bending is not that of their section alone, in the order x, beta = dx/dz left, x, beta right.\n"
        "MATRICES = {\n",
        stream);
    for (int e = 0; e < beam->mesh.nelement; e++) {
        char number[32];
        status = ross_matrices(pool, beam, e, &matrices);
        if (status < 0)
            return status;
        if (!status)
            continue;
        remark_put(&remark, "%s", matrices.why);
        (void)fprintf(stream, "    %d: {\n", e);
        put_square(stream, "stiffness", matrices.k);
        put_square(stream, "mass", matrices.m);
        put_square(stream, "rotary", matrices.rotary);
        (void)fprintf(stream, "        \"added\": %s,\n    },\n", remark_number(matrices.added, number));
    }
    (void)fputs("}\n", stream);
    return ROTID_OK;
}

static int put_disk(FILE *stream, struct ross_names *names, const char *name, int node, double mass, double diametral,
                    double polar)
{
    char number[3][32];
    const char *tag = ross_name(names, name, "disk");
    if (!tag)
        return ROTID_ERROR_MEMORY;
    (void)fprintf(stream, "    rs.DiskElement(n=%d, m=%s, Id=%s, Ip=%s, tag=\"%s\"),\n", node, remark_number(mass, number[0]),
                  remark_number(diametral, number[1]), remark_number(polar, number[2]), tag);
    return ROTID_OK;
}

/* A spring that stays at its node: one that is moved is in the matrices of its element. */
static struct effect_point at_node(const struct rotor *rotor, int spring)
{
    struct effect_point point = {.z = 0};
    if (!effects_move_spring(rotor, spring))
        effects_on_spring(rotor, spring, &point);
    return point;
}

static int put_disks(FILE *stream, struct ross_names *names, const struct beam *beam)
{
    const struct rotor *rotor = &beam->rotor;
    int status = ROTID_OK, node;
    (void)fputs("\nDISKS = [\n", stream);
    for (int i = 0; i < rotor->ndisk && !status; i++) {
        const struct disk *disk = &rotor->disk[i];
        status = put_disk(stream, names, disk->name, beam->mesh.disk_node[i], disk->mass, disk->diametral, disk->polar);
    }
    for (struct lumped lumped = {.i = -1}; !status && lumped_next(beam, &lumped);)
        if ((node = ross_mass_node(beam, &lumped)) >= 0)
            status = put_disk(stream, names, lumped_name(beam, &lumped), node, lumped.point.mass, lumped.point.inertia, 0);
    for (int i = 0; i < rotor->nspring && !status; i++) {
        char number[32];
        double stiffness = at_node(rotor, i).rotational;
        const char *tag = stiffness > 0 ? ross_name(names, rotor->spring[i].name, "spring") : "";
        if (stiffness > 0 && tag)
            (void)fprintf(stream, "    RotationalSpring(n=%d, stiffness=%s, tag=\"%s\"),\n", beam->mesh.spring_node[i],
                          remark_number(stiffness, number), tag);
        status = tag ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    (void)fputs("]\n", stream);
    return status;
}

static int put_springs(FILE *stream, struct ross_names *names, const struct beam *beam)
{
    const struct rotor *rotor = &beam->rotor;
    (void)fputs("\nSPRINGS = [\n", stream);
    for (int i = 0; i < rotor->nspring; i++) {
        char number[32];
        double stiffness = at_node(rotor, i).lateral;
        if (stiffness == 0)
            continue;
        const char *tag = ross_name(names, rotor->spring[i].name, "spring");
        if (!tag)
            return ROTID_ERROR_MEMORY;
        (void)fprintf(stream, "    rs.BearingElement(n=%d, kxx=%s, cxx=0.0, tag=\"%s\"),\n", beam->mesh.spring_node[i],
                      remark_number(stiffness, number), tag);
    }
    (void)fputs("]\n", stream);
    return ROTID_OK;
}

int ross_put_attached(struct pool *pool, FILE *stream, const struct ross_model *ross)
{
    struct ross_names names = {.pool = pool}; /* tags: one of each in a rotor of ROSS */
    int status = put_disks(stream, &names, &ross->discrete->discrete.beam);
    return status ? status : put_springs(stream, &names, &ross->discrete->discrete.beam);
}
