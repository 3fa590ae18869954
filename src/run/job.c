#include "run/run.h"

struct place job_part_place(const struct job *job, int failed)
{
    const struct rotor *rotor = &job->rotor;
    if (!job->part)
        return (struct place){job->deck, 1, 1};
    return job->part[failed < rotor->ngroup + rotor->ntierod + rotor->nbars ? failed : 0];
}

struct place job_sensor_place(const struct job *job, int sensor)
{
    const struct rotor *rotor = &job->rotor;
    return job->part ? job->part[rotor->ngroup + rotor->ntierod + rotor->nbars + sensor] : (struct place){job->deck, 1, 1};
}

int job_knows_frequency_noise(const struct job *job)
{
    return job->measurement.nmode > 0 && all_finite(job->measurement.nmode, job->measurement.frequency_std);
}

int job_knows_shape_noise(const struct job *job)
{
    ptrdiff_t components = (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode;
    if (!job->measurement.shape)
        return 0;
    for (ptrdiff_t i = 0; i < components; i++)
        if (isfinite(job->measurement.shape[i]) && !isfinite(job->measurement.shape_std[i]))
            return 0;
    return 1;
}

int job_fits_shapes(const struct job *job)
{
    return job->measurement.shape && job_knows_shape_noise(job);
}

enum discretisation job_discretisation(const struct job *job)
{
    static const enum discretisation of[][2] = {[MODE_BENDING] = {AS_BEAM, AS_SOLID},
                                                [MODE_TORSION] = {AS_TORSION, AS_SOLID_TORSION},
                                                [MODE_AXIAL] = {AS_AXIAL, AS_SOLID_AXIAL}};
    return of[job->options.type][job->options.solid != 0];
}

int job_of_type(struct pool *pool, const struct job *job, enum mode_type type, struct job *other)
{
    *other = *job;
    if (type == job->options.type)
        return ROTID_OK;
    other->options.type = type;
    other->measurement = (struct job_measurement){0};
    other->rotor.settled_rigid = other->rotor.count_all = 0;
    other->models = models_as(pool, job_discretisation(other));
    return other->models ? ROTID_OK : ROTID_ERROR_MEMORY;
}

struct states states_of(const struct job *job, struct state *state)
{
    *state = (struct state){.job = *job};
    return (struct states){.nstate = 1, .state = state, .nparameter = job->unknowns.nparameter, .bounds = job->unknowns.bounds};
}

int state_unknown(const struct state *state, int q)
{
    return state->unknown ? state->unknown[q] : q;
}

double *state_values(struct pool *pool, const struct state *state, const double *x)
{
    int n = state->job.unknowns.nparameter;
    double *own = POOL_ARRAY(pool, double, n);
    for (int q = 0; q < n && own; q++)
        own[q] = x[state_unknown(state, q)];
    return own;
}

int job_fitted(const struct job *job, const int *holdout)
{
    int fitted = 0;
    for (int k = 0; k < job->measurement.nmode; k++)
        fitted += !holdout[k];
    return fitted;
}

int states_modes(const struct states *states, int count)
{
    int modes = 0;
    for (int s = 0; s < count; s++)
        modes += states->state[s].job.measurement.nmode;
    return modes;
}

int states_copy(struct pool *pool, const struct states *from, struct states *to)
{
    struct state *state = POOL_COPY(pool, from->state, from->nstate, 0);
    *to = *from;
    to->state = state;
    return state ? ROTID_OK : ROTID_ERROR_MEMORY;
}

void states_refuse(const struct states *states, const char *deck, struct message_list *notes)
{
    char list[256] = "";
    for (int s = 0; s < states->nstate && strlen(list) + 3 < sizeof list; s++)
        (void)snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", s ? ", " : "", states->state[s].name);
    message_add(notes, SEVERITY_ERROR, deck, 1, 1,
                "the deck has %d states and this works on one, expected one of %s as FIT.STATE: --set FIT.STATE=%s",
                states->nstate, list, states->state[0].name);
}

int states_refuse_types(const struct states *states, const char *what, struct message_list *notes)
{
    for (int s = 0; s < states->nstate; s++) {
        const struct job *job = &states->state[s].job;
        if (job->options.type == MODE_BENDING)
            continue;
        return message_refuse_at(notes, ROTID_ERROR_ARGUMENT, job->measured,
                                 "%s is of bending, expected no *MODES, TYPE=%s, or another state by --set FIT.STATE=NAME", what,
                                 mode_type_words[job->options.type]);
    }
    return ROTID_OK;
}

#define CONTRAST 1e12 /* of stiffnesses: rounding of the higher one is a thousandth of the lower one */
#define HEAVIER  1e8  /* of densities: solids fail from 1e9 */
#define ALIKE    1.45 /* so much may wrong moduli move one mode against another */

static const struct {
    double ratio;
    const char *name, *cure;
} mistake[] = {
    {TWO_PI, "2 pi", "frequencies in rad/s? *MODES expects hertz, or *UNITS, FREQUENCY=RAD/S"},
    {0.15915494309189535, "1/(2 pi)", "hertz taken for rad/s and divided once too often?"},
    {1e3, "1000", "lengths of the model in mm, or E in MPa? The deck is in SI units, or says *UNITS, LENGTH=MM"},
    {1e-3, "1/1000", "frequencies in kHz? *MODES expects hertz, or *UNITS, FREQUENCY=KHZ"},
    {31.622776601683793, "the root of 1000", "a density 1000 times too large, or moduli 1000 times too small?"},
    {0.03162277660168379, "1 over the root of 1000",
     "a density in kg/dm3? The deck is in SI units, or says *UNITS, DENSITY=KG/DM3"},
};

double check_units(const struct job *job, const struct spectrum *spectrum, int refused, struct message_list *notes)
{
    double least = INFINITY, most = 0, sum = 0;
    int count = 0;
    for (int k = 0; k < job->measurement.nmode; k++) {
        int j = job->measurement.number[k] - 1;
        if (j >= spectrum->count || !(spectrum->full_hz[j] > 0))
            continue;
        double ratio = job->measurement.frequency_hz[k] / spectrum->full_hz[j];
        least = fmin(least, ratio);
        most = fmax(most, ratio);
        sum += log(ratio);
        count++;
    }
    if (!count || most > ALIKE * ALIKE * least)
        return 0;
    double middle = exp(sum / count);
    for (size_t i = 0; i < sizeof mistake / sizeof *mistake; i++)
        if (fabs(log(middle / mistake[i].ratio)) < log(ALIKE)) {
            int error = refused != 0;
            message_add(notes, error ? SEVERITY_ERROR : SEVERITY_WARNING, error ? job->deck : NULL, error, error,
                        "the measured frequencies are %.3g times those of the model in every mode (%.3g to %.3g), which is near "
                        "%s: %s",
                        middle, least, most, mistake[i].name, mistake[i].cure);
            return mistake[i].ratio;
        }
    return 0;
}

const char *job_value_text(struct pool *pool, const struct job_units *units, int digits, double value, const char *unit)
{
    double in_si = 1;
    if (!strcmp(unit, "m") && units->length) {
        in_si = units->si[0];
        unit = units->length;
    } else if (!strcmp(unit, "Hz") && units->frequency) {
        in_si = units->si[JOB_QUANTITIES - 1];
        unit = units->frequency;
    } else if (!strcmp(unit, "Pa") && fabs(value) >= 1e6) {
        in_si = fabs(value) < 1e9 ? 1e6 : 1e9;
        unit = fabs(value) < 1e9 ? "MPa" : "GPa";
    }
    return pool_text(pool, strcmp(unit, "1") ? "%.*g %s" : "%.*g", digits, value / in_si, unit);
}

#define STEP_TOLD 0.01

const char *doubt_steps(struct pool *pool, const struct job *job)
{
    double z = 0, ratio = 1, error = job_discretisation(job) == AS_BEAM ? rotor_step_error(&job->rotor, &z, &ratio) : 0;
    for (int e = 0; e < job->rotor.neffect; e++)
        if (job->rotor.effect[e].kind->section)
            return NULL;
    return error < STEP_TOLD ? NULL
                             : pool_format(pool,
                                           "a beam is some %.2g %% too stiff (in frequency) at the step of the diameter by 1 : "
                                           "%.2g at %s; *FIT, MODEL=SOLID takes the same deck",
                                           100 * error, ratio, job_value_text(pool, &job->units, 4, z, "m"));
}

/* EI/L^3 of the stiffest element and of the softest section, where rounding of the one is not small beside the other; densities
 * likewise */
void check_sections(const struct job *job, int status, struct message_list *notes)
{
    const struct rotor *rotor = &job->rotor;
    double least = INFINITY, most = 0;
    int soft = 0, hard = 0, light = 0, heavy = 0;
    if (notes->errors || (status != ROTID_ERROR_EIGEN && status != ROTID_ERROR_STIFFNESS && status != ROTID_ERROR_MASS &&
                          status != ROTID_ERROR_SLAVE))
        return;
    for (int g = 0; g < rotor->ngroup; g++) {
        light = rotor->group[g].material.rho < rotor->group[light].material.rho ? g : light;
        heavy = rotor->group[g].material.rho > rotor->group[heavy].material.rho ? g : heavy;
    }
    for (int s = 0; s < rotor->nsegment; s++) {
        const struct segment *segment = &rotor->segment[s];
        struct section section;
        if (section_of_segment(rotor, s, &section))
            continue;
        double ei = rotor->group[segment->group].material.e * section.stiff_inertia, length = segment->length;
        double element = length / (segment->elements > 0 ? segment->elements : 1);
        double of_section = ei / (length * length * length), of_element = ei / (element * element * element);
        soft = of_section < least ? segment->group : soft;
        hard = of_element > most ? segment->group : hard;
        least = fmin(least, of_section);
        most = fmax(most, of_element);
    }
    struct place place = job_part_place(job, soft);
    double densest = rotor->group[heavy].material.rho, rho = rotor->group[light].material.rho;
    if (most > CONTRAST * least)
        message_at(notes, SEVERITY_ERROR, place,
                   "%s: a section of %s has EI/L^3 = %.2g N/m beside %.2g N/m of an element of %s, expected at most %.0e times "
                   "as much: lengths and diameters nearer to each other, or fewer elements",
                   rotid_status_text(status), rotor->group[soft].name, least, most, rotor->group[hard].name, CONTRAST);
    else if (densest > HEAVIER * rho)
        message_at(
            notes, SEVERITY_ERROR, job_part_place(job, heavy),
            "%s: the density of %s is %.3g kg/m3 beside %.3g kg/m3 of %s, expected at most %.0e times as much: one of them "
            "in another unit?",
            rotid_status_text(status), rotor->group[heavy].name, densest, rho, rotor->group[light].name, HEAVIER);
    else
        message_at(notes, SEVERITY_ERROR, place, "%s", rotid_status_text(status));
}
