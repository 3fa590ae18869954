#include "export/ross_model.h"

#include <math.h>
#include <stdio.h>

#include "rotor/effects.h"

#define SAME_SHAPE    0.9 /* MAC of modes that are one */
#define NEAR_SCRIPT   0.2 /* of a frequency, beyond which they are not */
#define MOST_OWN      100 /* modes of rods and bars that are looked through */
#define MOST_ELEMENTS 500 /* that ROSS solves in about a minute */

/* The rotor without inner nodes of rods and bars; 1 where that changes it, 0 where not, or a negative status. */
static int simplify(struct pool *pool, const struct export_model *model, struct rotor *rotor, struct message_list *notes)
{
    const struct beam *beam = &model->discrete->discrete.beam;
    int changed = 0;
    *rotor = model->job->rotor;
    struct tierod *tierod = POOL_ARRAY(pool, struct tierod, rotor->ntierod);
    struct disk *disk = POOL_ARRAY(pool, struct disk, rotor->ndisk + rotor->nbars);
    if (!tierod || !disk)
        return ROTID_ERROR_MEMORY;
    for (int t = 0; t < rotor->ntierod; t++) {
        tierod[t] = rotor->tierod[t];
        if (tierod[t].elements > 1) {
            message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                        "tie rods %s: one element from end to end in the script, which leaves out modes of the rods themselves",
                        tierod[t].name);
            tierod[t].elements = 1;
            changed = 1;
        }
    }
    for (int d = 0; d < rotor->ndisk; d++)
        disk[d] = rotor->disk[d];
    for (int b = 0; b < rotor->nbars; b++) {
        const struct bars *bars = &rotor->bars[b];
        struct element element;
        double l = bars->length, inertia;
        bars_quantities(beam, b, l, &element, &inertia);
        double own = element.rhoi * l + inertia; /* of the bars about their own diameter, half of what they have about the axis */
        disk[rotor->ndisk + b] = (struct disk){.name = bars->name,
                                               .position = bars->center,
                                               .mass = element.rhos * l,
                                               .diametral = element.rhos * l * l * l / 12 + own,
                                               .polar = 2 * own};
        message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                    "bars %s: a disk of the same mass and inertia in the script, which leaves out their own bending", bars->name);
        changed = 1;
    }
    rotor->tierod = tierod;
    rotor->disk = disk;
    rotor->ndisk += rotor->nbars;
    rotor->nbars = 0;
    return changed;
}

/* For each mode of the script the one of the deck with its shape, of several the nearest. Among those of the deck are more, of
 * rods and bars. */
static int find_partners(struct pool *pool, const double *x, int nparameter, struct ross_model *ross)
{
    const struct job *job = ross->model->job;
    const struct mesh *mesh = &ross->model->discrete->discrete.beam.mesh;
    const struct spectrum *script = ross->spectrum;
    struct spectrum deck;
    int inner = 2 * (mesh->nnode - mesh->naxis), count = script->count + (inner < MOST_OWN ? inner : MOST_OWN);
    int status =
        spectrum_compute(pool, job->models, &job->rotor, nparameter, job->unknowns.parameter, x, ROTID_GUYAN, count, &deck);
    double *hz = POOL_ARRAY(pool, double, script->count);
    if (status || !hz)
        return status ? status : ROTID_ERROR_MEMORY;
    for (int j = 0; j < script->count; j++) {
        double nearest = NEAR_SCRIPT * script->full_hz[j];
        hz[j] = NAN;
        for (int i = 0; i < deck.count; i++) {
            double distance = fabs(deck.full_hz[i] - script->full_hz[j]);
            if (distance < nearest && rotid_mac(deck.nmaster, script->shape + (ptrdiff_t)j * script->nmaster,
                                                deck.shape + (ptrdiff_t)i * deck.nmaster) > SAME_SHAPE) {
                hz[j] = deck.full_hz[i];
                nearest = distance;
            }
        }
    }
    ross->deck_hz = hz;
    return ROTID_OK;
}

static void say_shifts(const struct ross_model *ross, struct message_list *notes)
{
    char text[1024] = "";
    int length = 0;
    for (int j = 0; j < ross->spectrum->count && length >= 0 && length < (int)sizeof text - 32; j++)
        length += isfinite(ross->deck_hz[j]) ? snprintf(text + length, 32, "%s %+.3f", j ? "," : "",
                                                        100 * (ross->spectrum->full_hz[j] / ross->deck_hz[j] - 1))
                                             : snprintf(text + length, 32, "%s none alike", j ? "," : "");
    message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                "what the script leaves out moves its bending modes against those of the deck by [%%]%s", text);
}

static void say_limits(const struct export_model *model, struct message_list *notes)
{
    const struct rotor *rotor = &model->job->rotor;
    int elements = model->discrete->discrete.beam.mesh.nelement;
    for (int s = 0; s < rotor->nsegment; s++)
        if (rotor->segment[s].rectangular && (!s || rotor->segment[s - 1].group != rotor->segment[s].group))
            message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                        "%s is rectangular: ROSS has round sections only, so the script holds at rest and in the measured plane",
                        rotor->group[rotor->segment[s].group].name);
    for (int d = 0; d < rotor->ndisk; d++)
        if (rotor->disk[d].diametral > 0 && rotor->disk[d].polar == 0)
            message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                        "disk %s has no polar inertia in the deck: at speed its gyroscopic moment is missing in the script",
                        rotor->disk[d].name ? rotor->disk[d].name : "(without a name)");
    if (elements > MOST_ELEMENTS)
        message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                    "ROSS solves dense matrices: %d elements take some %.1f GB there, expected a few hundred", elements,
                    3 * 8e-9 * pow(12.0 * (elements + 1), 2));
}

int ross_open(struct pool *pool, const struct export_model *model, struct message_list *notes, struct ross_model *ross)
{
    const struct job *job = model->job;
    int failed, nparameter = model->identified ? job->unknowns.nparameter : 0;
    const double *x = model->identified ? model->identified->fit->x : NULL;
    struct rotor rotor;
    *ross = (struct ross_model){.model = model, .discrete = model->discrete, .spectrum = &model->spectrum};
    say_limits(model, notes);
    int changed = simplify(pool, model, &rotor, notes);
    if (changed <= 0)
        return changed;
    struct spectrum *spectrum = POOL_NEW(pool, struct spectrum);
    ross->discrete = POOL_NEW(pool, struct rotor_model);
    if (!spectrum || !ross->discrete)
        return ROTID_ERROR_MEMORY;
    ross->spectrum = spectrum;
    int status = model_open(pool, job->models, &rotor, nparameter, job->unknowns.parameter, 1, ross->discrete, &failed);
    if (!status)
        status = spectrum_compute(pool, job->models, &rotor, nparameter, job->unknowns.parameter, x, ROTID_GUYAN,
                                  model->spectrum.count, spectrum);
    if (status)
        return status;
    model_set(ross->discrete, x);
    status = find_partners(pool, x, nparameter, ross);
    if (!status)
        say_shifts(ross, notes);
    return status;
}
