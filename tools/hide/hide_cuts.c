/* Where the rotor is cut into uniform stretches: at everything that jumps, and evenly where the stiffness varies. */
#include <math.h>
#include <stdlib.h>

#include "hide_model.h"

static const double pi = 3.14159265358979323846;

/* Cells over a length on which an effect varies by its whole size. With compliances averaged over a cell (hide_model.c) the error
 * falls with its square: hide_solve.c cuts finer until it is small. */
#define CELLS_GROUP 24 /* over a group */
#define CELLS_WAVE  24 /* over a wave */
#define CELLS_SIGMA 4  /* over the std of a Gaussian, of which */
#define SIGMAS      5  /* count on either side: exp(-12.5) = 4e-6 is left out */
#define CELLS_CONE  20 /* from the foot of a cone to where it reaches the surface */

struct list {
    double *z;
    int count, room, failed;
    double length;
};

static void cut(struct list *list, double z)
{
    if (!(z > 0 && z < list->length))
        return;
    if (list->count == list->room) {
        int room = 2 * list->room + 64;
        double *larger = realloc(list->z, (size_t)room * sizeof *larger);
        if (!larger) {
            list->failed = 1;
            return;
        }
        list->z = larger;
        list->room = room;
    }
    list->z[list->count++] = z;
}

static void cut_evenly(struct list *list, double from, double to, int cells)
{
    for (int i = 0; i <= cells; i++)
        cut(list, from + (to - from) * i / cells);
}

static void cut_zone(struct list *list, const struct hide_effect *e, int refine)
{
    double z = hide_get(e, "z")->number, w = hide_get(e, "width")->number;
    if (hide_get(e, "shape")->index == 1 || hide_is(e, "density_zone")) {
        cut(list, z - w / 2);
        cut(list, z + w / 2);
    } else
        cut_evenly(list, z - SIGMAS * w, z + SIGMAS * w, 2 * SIGMAS * CELLS_SIGMA * refine);
}

/* From the diameter d at the foot to D at the surface in equal ratios: EI goes with the fourth power. */
static void cut_cone(struct list *list, double foot, double small, double slope, double reach, int refine)
{
    double ratio = log1p(slope * fabs(reach) / small) / (CELLS_CONE * refine);
    for (int i = 0; i <= CELLS_CONE * refine; i++)
        cut(list, foot + copysign(small / slope, reach) * expm1(ratio * i));
}

/* From every step to where its cone has come to the surface of the larger section, or of a larger one behind it. */
static void cut_steps(struct list *list, const struct hide_rotor *rotor, double angle, int refine)
{
    double slope = 2 * tan(angle * pi / 180);
    for (int i = 0; i + 1 < rotor->segments; i++) {
        const struct hide_segment *a = &rotor->segment[i], *b = a + 1;
        if (a->rectangular || b->rectangular || fabs(a->outer - b->outer) <= 1e-9)
            continue;
        double small = fmin(a->outer, b->outer), farthest = 0;
        for (int direction = -1, j; direction <= 1; direction += 2) {
            for (j = direction < 0 ? i : i + 1; j >= 0 && j < rotor->segments && !rotor->segment[j].rectangular; j += direction) {
                const struct hide_segment *s = &rotor->segment[j];
                double reach = (s->outer - small) / slope, near = direction < 0 ? a->to - s->to : s->from - a->to;
                if (reach > near)
                    farthest = direction * fmin(reach, near + (s->to - s->from));
                else if (reach <= 0)
                    break; /* a smaller section has a step and a cone of its own */
            }
            if (farthest != 0)
                cut_cone(list, a->to, small, slope, farthest, refine);
            farthest = 0;
        }
    }
}

static void cut_for(struct list *list, const struct hide_rotor *rotor, const struct hide_effect *e, int refine)
{
    int group = hide_get(e, "group")->index;
    if (hide_is(e, "stiffness_gradient") || hide_is(e, "stiffness_profile"))
        cut_evenly(list, rotor->group[group].from, rotor->group[group].to, CELLS_GROUP * refine);
    else if (hide_is(e, "sine"))
        cut_evenly(list, rotor->group[group].from, rotor->group[group].to,
                   (int)(CELLS_WAVE * (1 + hide_get(e, "waves")->number)) * refine);
    else if (hide_is(e, "step_stiffness") && hide_get(e, "angle")->number < 90)
        cut_steps(list, rotor, hide_get(e, "angle")->number, refine);
    else if (hide_is(e, "stiffness_local") || hide_is(e, "bend_only") || hide_is(e, "density_zone"))
        cut_zone(list, e, refine);
    else if (hide_is(e, "added_mass") && hide_get(e, "width")->number > 0) {
        cut(list, hide_get(e, "z")->number - hide_get(e, "width")->number / 2);
        cut(list, hide_get(e, "z")->number + hide_get(e, "width")->number / 2);
    } else if (hide_is(e, "hub_stiffness"))
        for (int i = 0; i < rotor->disks; i++) {
            double half = hide_get(e, "share")->number * rotor->disk[i].hub_length / 2;
            cut(list, rotor->disk[i].z - half);
            cut(list, rotor->disk[i].z + half);
        }
}

static int ascending(const void *left, const void *right)
{
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

double *hide_cuts(const struct hide_physics *physics, int *count)
{
    const struct hide_rotor *rotor = physics->rotor;
    struct list list = {.length = INFINITY};
    double *z, margin = 1e-7 * rotor->length;
    for (int i = 0; i < rotor->segments; i++)
        cut(&list, rotor->segment[i].to);
    list.length = rotor->length;
    for (int i = 0; i < rotor->ties; i++) { /* where the compression begins and ends */
        cut(&list, rotor->tie[i].from);
        cut(&list, rotor->tie[i].to);
    }
    for (int i = 0; i < physics->effects; i++)
        cut_for(&list, rotor, &physics->effect[i], physics->refine);
    z = list.failed ? NULL : malloc(((size_t)list.count + 1) * sizeof *z);
    if (z) {
        qsort(list.z, (size_t)list.count, sizeof *list.z, ascending);
        z[0] = 0;
        *count = 1;
        for (int i = 0; i < list.count; i++)
            if (list.z[i] - z[*count - 1] > margin)
                z[(*count)++] = list.z[i];
        z[*count - 1] = rotor->length;
    }
    free(list.z);
    return z;
}
