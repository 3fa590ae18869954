#include "run/run.h"

#define BEYOND      3         /* modes of the model above the highest number that a measured shape may turn out to be */
#define ALIKE       0.5       /* MAC below which shapes are of something else than the modes */
#define SOLID_SHARE (1.0 / 3) /* of the noise: what the mesh of a solid may leave of a frequency */

int comparison_highest(const struct job *job)
{
    int highest = 0;
    for (int k = 0; k < job->measurement.nmode; k++)
        highest = job->measurement.number[k] > highest ? job->measurement.number[k] : highest;
    return highest;
}

int comparison_candidates(const struct job *job)
{
    return comparison_highest(job) + (job->measurement.shape ? BEYOND : 0);
}

static int components(const struct job *job, int mode)
{
    int count = 0;
    for (int s = 0; s < job->rotor.nsensor && job->measurement.shape; s++)
        count += isfinite(job->measurement.shape[s + (ptrdiff_t)mode * job->rotor.nsensor]);
    return count;
}

/* Correlation [nmode * candidates]; zero for modes whose shape has fewer components than there are candidates: so few cannot tell
 * them apart. */
static double *correlations(struct pool *pool, const struct job *job, const struct spectrum *spectrum, int candidates,
                            double *work)
{
    double *correlation = POOL_ARRAY(pool, double, (size_t)job->measurement.nmode *(size_t)candidates);
    for (int k = 0; k < job->measurement.nmode && correlation; k++)
        for (int j = 0; j < candidates && components(job, k) >= candidates; j++)
            correlation[k + (ptrdiff_t)j * job->measurement.nmode] =
                spectrum_correlation(spectrum, job->measurement.shape + (ptrdiff_t)k * spectrum->nmaster, j, work);
    return correlation;
}

static void say_what_is_odd(const struct job *job, const struct spectrum *spectrum, const struct comparison *c,
                            struct message_list *notes)
{
    int highest = 0, shapes = 0;
    double alike = 0;
    for (int k = 0; k < c->nmode; k++) {
        highest = c->number[k] > highest ? c->number[k] : highest;
        shapes += isfinite(c->mac[k]);
        alike = isfinite(c->mac[k]) ? fmax(alike, c->mac[k]) : alike;
        const char *odd = NULL;
        if (c->number[k] != job->measurement.number[k])
            odd = isfinite(c->nco[k]) ? "measured mode %d at %.6g Hz is mode %d of the model by its shape (NCO %.2f)"
                                      : "measured mode %d at %.6g Hz is mode %d of the model by its shape";
        else if (isfinite(c->nco[k]) && c->nco[k] < PAIRING_LEAST && components(job, k) >= comparison_candidates(job))
            odd = "measured mode %d at %.6g Hz has no partner in the model by its shape: mode %d, which has its number, "
                  "correlates by %.2f only";
        if (odd)
            message_warn(notes, odd, job->measurement.number[k], job->measurement.frequency_hz[k], c->number[k], c->nco[k]);
    }
    if (shapes > 1 && alike < ALIKE)
        message_warn(
            notes,
            "no measured shape resembles a mode of the model (MAC %.2f at most): shapes of another test, positions of the "
            "sensors from the other end or in another unit, or channels exchanged?",
            alike);
    for (int j = 1; j <= highest && j <= spectrum->count; j++) {
        int found = 0;
        for (int k = 0; k < c->nmode; k++)
            found |= c->number[k] == j;
        if (!found)
            message_warn(notes, "mode %d of the model at %.6g Hz was not measured", j, spectrum->full_hz[j - 1]);
    }
}

int comparison_make(struct pool *pool, const struct job *job, const struct spectrum *spectrum, struct message_list *notes,
                    struct comparison *c)
{
    int nmode = job->measurement.nmode, candidates = spectrum->count;
    *c = (struct comparison){.nmode = nmode};
    c->number = POOL_ARRAY(pool, int, nmode);
    c->basis = POOL_ARRAY(pool, enum pairing_basis, nmode);
    c->mac = POOL_ARRAY(pool, double, nmode);
    c->nco = POOL_ARRAY(pool, double, nmode);
    int *used = POOL_ARRAY(pool, int, candidates);
    double *work = POOL_ARRAY(pool, double, spectrum->nmaster), *correlation = NULL;
    if (!c->number || !c->basis || !c->mac || !c->nco || !used || !work)
        return ROTID_ERROR_MEMORY;
    if (job->measurement.shape && !job->measurement.paired &&
        !(correlation = correlations(pool, job, spectrum, candidates, work)))
        return ROTID_ERROR_MEMORY;
    if (nmode)
        memcpy(c->number, job->measurement.number, (size_t)nmode * sizeof *c->number);
    int clash = pair_modes(nmode, candidates, correlation, c->number, c->basis, used);
    if (clash) {
        char counted[128] = "";
        for (int j = 0; j < candidates && j < 6; j++)
            (void)snprintf(counted + strlen(counted), sizeof counted - strlen(counted), "%s%.4g", j ? ", " : "",
                           spectrum->full_hz[j]);
        c->clash = clash - 1;
        return message_refuse_at(
            notes, ROTID_ERROR_UNPAIRED, job->measured,
            "measured mode %d at %.6g Hz is left without a mode of the model: by its shape another one takes its number. "
            "The model at the start has %s Hz: expected modes that differ, numbered as these are (%s), and supports, "
            "moduli and lengths in the units of the deck",
            job->measurement.number[clash - 1], job->measurement.frequency_hz[clash - 1], counted,
            !job->measurement.numbering.nsupport ? "rigid-body motions do not count"
            : job->rotor.count_all               ? "COUNT=ALL"
                                                 : "COUNT=ELASTIC: those on the supports do not count");
    }
    for (int k = 0; k < nmode; k++) {
        const double *shape = job->measurement.shape ? job->measurement.shape + (ptrdiff_t)k * spectrum->nmaster : NULL;
        int has = shape && components(job, k) > 1 && c->number[k] <= spectrum->count;
        c->mac[k] =
            has ? rotid_mac(spectrum->nmaster, shape, spectrum->shape + (ptrdiff_t)(c->number[k] - 1) * spectrum->nmaster) : NAN;
        c->nco[k] = has && spectrum->mass ? spectrum_correlation(spectrum, shape, c->number[k] - 1, work) : NAN;
    }
    say_what_is_odd(job, spectrum, c, notes);
    return ROTID_OK;
}

void comparison_warn_of_mesh(const struct job *job, const struct spectrum *spectrum, const struct comparison *comparison,
                             struct message_list *notes)
{
    int worst = -1, solid = job->options.solid;
    if (spectrum->apart) {
        struct place place = job_part_place(job, job->rotor.ngroup + job->rotor.ntierod + job->rotor.nbars);
        message_warn(
            notes, /* notes with a place were printed when the deck was read */
            "%s:%d:%d: the mesh of the solid is not fine enough for mode %d, %.6g Hz: two meshes differ by more than 2 %% or "
            "have other shapes or another order there; expected fewer modes, thicker parts, or *FIT, MODEL=BEAM",
            place.file, place.line, place.column, spectrum->apart, spectrum->full_hz[spectrum->apart - 1]);
    }
    double largest = solid ? SOLID_SHARE : 1;
    for (int k = 0; k < comparison->nmode && job_knows_frequency_noise(job); k++) {
        int mode = comparison->number[k] - 1;
        double ratio =
            mode < spectrum->count ? fabs(spectrum->mesh_error_percent[mode]) / (100 * job->measurement.frequency_std[k]) : NAN;
        if (ratio > largest) {
            largest = ratio;
            worst = k;
        }
    }
    if (worst < 0)
        return;
    double error = spectrum->mesh_error_percent[comparison->number[worst] - 1];
    if (solid)
        message_warn(
            notes,
            "the mesh of the solid leaves measured mode %d in doubt by %.4f %%, more than a third of its noise of %.4f %%: "
            "the intervals do not allow for it",
            job->measurement.number[worst], fabs(error), 100 * job->measurement.frequency_std[worst]);
    else
        message_warn(
            notes,
            "the mesh moves measured mode %d by %+.4f %%, %.1f times its noise: give more elements, the intervals do not "
            "allow for it",
            job->measurement.number[worst], error, largest);
}

void frf_sums_add(struct frf_sums *sums, int n, const double complex *measured, const double complex *synthesised)
{
    for (int l = 0; l < n; l++) {
        double complex m = measured[l], h = synthesised[l];
        if (!isfinite(creal(m)) || !isfinite(cimag(m)) || !isfinite(creal(h)) || !isfinite(cimag(h)))
            continue;
        sums->cross += conj(h) * m;
        sums->conjugate += h * m;
        sums->measured += complex_square(m);
        sums->synthesised += complex_square(h);
        sums->lines++;
    }
}

static double ratio(const struct frf_sums *sums, double complex cross)
{
    return sums->measured > 0 && sums->synthesised > 0 ? complex_square(cross) / sums->measured / sums->synthesised : NAN;
}

double frf_sums_frac(const struct frf_sums *sums)
{
    return ratio(sums, sums->cross);
}

double frf_sums_frac_conjugate(const struct frf_sums *sums)
{
    return ratio(sums, sums->conjugate);
}

double frf_sums_scale(const struct frf_sums *sums)
{
    return sums->synthesised > 0 ? creal(sums->cross) / sums->synthesised : NAN;
}

double frf_sums_level(const struct frf_sums *sums)
{
    return sums->measured > 0 && sums->synthesised > 0 ? 10 * log10(sums->measured / sums->synthesised) : NAN;
}
