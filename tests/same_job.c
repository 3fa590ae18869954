#include "same_job.h"

#include "support.h"

static void assert_text(const char *a, const char *b)
{
    assert_int_equal(a == NULL, b == NULL);
    if (a)
        assert_string_equal(a, b);
}

double same_job_rounding = 0;

/* bit for bit, or within that share, but one NaN is as good as another */
static void assert_doubles(ptrdiff_t count, const double *a, const double *b)
{
    assert_int_equal(a == NULL, b == NULL);
    for (ptrdiff_t i = 0; i < count && a; i++)
        if (!(isnan(a[i]) && isnan(b[i])) && memcmp(&a[i], &b[i], sizeof *a) &&
            !(fabs(a[i] - b[i]) <= same_job_rounding * fabs(b[i]))) {
            print_error("value %td is %.17g, expected %.17g\n", i, a[i], b[i]);
            fail();
        }
}

static void assert_material(const struct material *a, const struct material *b)
{
    assert_true(a->e == b->e && a->nu == b->nu && a->rho == b->rho && a->isotropic == b->isotropic);
    assert_true(a->isotropic || a->g == b->g);
    assert_true(a->laminated == b->laminated && (!a->laminated || (a->sheet_e == b->sheet_e && a->stacking == b->stacking)));
}

static void assert_effect(const struct effect *a, const struct effect *b)
{
    assert_text(a->name, b->name);
    assert_ptr_equal(a->kind, b->kind);
    assert_true(a->target == b->target && a->variant == b->variant);
    assert_doubles(effect_parameters(a), a->value, b->value);
}

static void assert_members(const struct rotor *a, const struct rotor *b)
{
    for (int i = 0; i < a->ntierod; i++) {
        const struct tierod *s = &a->tierod[i], *t = &b->tierod[i];
        assert_text(s->name, t->name);
        assert_material(&s->material, &t->material);
        assert_true(s->from == t->from && s->to == t->to && s->model == t->model && s->self_equilibrated == t->self_equilibrated);
        assert_true(s->number == t->number && s->elements == t->elements && s->diameter == t->diameter && s->pitch == t->pitch);
        assert_true(s->tension == t->tension);
    }
    for (int i = 0; i < a->nbars; i++) {
        const struct bars *s = &a->bars[i], *t = &b->bars[i];
        assert_text(s->name, t->name);
        assert_material(&s->material, &t->material);
        assert_true(s->center == t->center && s->length == t->length && s->model == t->model && s->number == t->number);
        assert_true(s->elements == t->elements && s->diameter == t->diameter && s->pitch == t->pitch);
    }
    for (int i = 0; i < a->ndisk; i++) {
        assert_text(a->disk[i].name, b->disk[i].name);
        assert_doubles(4, &a->disk[i].position, &b->disk[i].position);
    }
    for (int i = 0; i < a->nspring; i++) {
        assert_text(a->spring[i].name, b->spring[i].name);
        assert_doubles(3, &a->spring[i].position, &b->spring[i].position);
    }
}

static void assert_rotor(const struct rotor *a, const struct rotor *b)
{
    assert_true(a->ngroup == b->ngroup && a->nsegment == b->nsegment && a->ntierod == b->ntierod && a->nbars == b->nbars);
    assert_true(a->ndisk == b->ndisk && a->nspring == b->nspring && a->nsensor == b->nsensor && a->neffect == b->neffect);
    assert_true(a->sling == b->sling);
    for (int g = 0; g < a->ngroup; g++) {
        const struct group *s = &a->group[g], *t = &b->group[g];
        assert_text(s->name, t->name);
        assert_material(&s->material, &t->material);
        assert_true(s->holes == t->holes && s->hole_diameter == t->hole_diameter && s->hole_pitch == t->hole_pitch);
        assert_true(s->preload == t->preload && s->layer_of == t->layer_of);
    }
    for (int i = 0; i < a->nsegment; i++) {
        const struct segment *s = &a->segment[i], *t = &b->segment[i];
        assert_true(s->group == t->group && s->elements == t->elements && s->rectangular == t->rectangular);
        assert_doubles(6, &s->length, &t->length); /* length to width */
    }
    assert_int_equal(a->nring, b->nring);
    for (int i = 0; i < a->nring; i++) {
        assert_true(a->ring[i].group == b->ring[i].group && a->ring[i].segment == b->ring[i].segment);
        assert_doubles(2, &a->ring[i].outer, &b->ring[i].outer);
    }
    assert_members(a, b);
    for (int s = 0; s < a->nsensor; s++)
        assert_true(a->sensor[s].id == b->sensor[s].id &&
                    fabs(a->sensor[s].position - b->sensor[s].position) <= same_job_rounding * rotor_length(a));
    for (int i = 0; i < a->neffect; i++)
        assert_effect(&a->effect[i], &b->effect[i]);
}

/* of what was measured: what *NOISE says of components that were not is nobody's business */
static void assert_shapes(ptrdiff_t count, const double *a, const double *b, const double *a_std, const double *b_std)
{
    assert_doubles(count, a, b);
    for (ptrdiff_t i = 0; i < count && a; i++)
        if (isfinite(a[i]))
            assert_doubles(1, &a_std[i], &b_std[i]);
}

static void assert_frequency_std(int count, const double *a, const double *b)
{
    for (int k = 0; k < count; k++)
        assert_true(a[k] == b[k] || nextafter(a[k], b[k]) == b[k] || (isnan(a[k]) && isnan(b[k])) ||
                    fabs(a[k] - b[k]) <= same_job_rounding * fabs(b[k]));
}

static void assert_data(const struct job *a, const struct job *b)
{
    ptrdiff_t components = (ptrdiff_t)a->rotor.nsensor * a->measurement.nmode;
    assert_true(a->measurement.nmode == b->measurement.nmode && a->measurement.ncorrection == b->measurement.ncorrection &&
                (a->measurement.raw == NULL) == (b->measurement.raw == NULL));
    for (int k = 0; k < a->measurement.nmode; k++)
        assert_true(a->measurement.number[k] == b->measurement.number[k] &&
                    a->measurement.holdout[k] == b->measurement.holdout[k]);
    assert_doubles(a->measurement.nmode, a->measurement.frequency_hz, b->measurement.frequency_hz);
    assert_doubles(a->measurement.nmode, a->measurement.damping, b->measurement.damping);
    assert_frequency_std(a->measurement.nmode, a->measurement.frequency_std, b->measurement.frequency_std);
    assert_shapes(components, a->measurement.shape, b->measurement.shape, a->measurement.shape_std, b->measurement.shape_std);
    for (int i = 0; i < a->measurement.ncorrection; i++) {
        const struct correction *s = &a->measurement.correction[i], *t = &b->measurement.correction[i];
        assert_text(s->name, t->name);
        assert_text(s->id, t->id);
        assert_text(s->block, t->block);
        assert_true(s->nsensor == t->nsensor && s->value == t->value && !memcmp(s->sensor, t->sensor, sizeof s->sensor));
    }
    if (a->measurement.raw) {
        assert_int_equal(a->measurement.raw->nsensor, b->measurement.raw->nsensor);
        for (int i = 0; i < a->measurement.raw->nsensor; i++)
            assert_true(a->measurement.raw->sensor[i].id == b->measurement.raw->sensor[i].id &&
                        a->measurement.raw->sensor[i].position == b->measurement.raw->sensor[i].position);
        assert_shapes(components, a->measurement.raw->shape, b->measurement.raw->shape, a->measurement.raw->shape_std,
                      b->measurement.raw->shape_std);
        assert_frequency_std(a->measurement.nmode, a->measurement.raw->frequency_std, b->measurement.raw->frequency_std);
    }
}

static void assert_frf(const struct frf_request *a, const struct frf_request *b)
{
    assert_text(a->file, b->file);
    assert_true(a->given == b->given && a->low_hz == b->low_hz && a->high_hz == b->high_hz && a->step_hz == b->step_hz);
    assert_true(a->nline == b->nline && a->has_quantity == b->has_quantity && a->quantity == b->quantity);
    assert_true(a->damping == b->damping && a->axis == b->axis && a->flip == b->flip && a->origin == b->origin);
    assert_int_equal(a->npair, b->npair);
    for (int i = 0; i < a->npair; i++)
        assert_true(a->pair[i].response == b->pair[i].response && a->pair[i].reference == b->pair[i].reference);
}

void assert_same_job(const struct job *a, const struct job *b)
{
    assert_int_equal(a->nheading, b->nheading);
    for (int i = 0; i < a->nheading; i++)
        assert_text(a->heading[i], b->heading[i]);
    assert_int_equal(a->nreference, b->nreference);
    for (int i = 0; i < a->nreference; i++) {
        assert_text(a->reference[i].quantity, b->reference[i].quantity);
        assert_int_equal(a->reference[i].nvalues, b->reference[i].nvalues);
        assert_doubles(a->reference[i].nvalues, a->reference[i].values, b->reference[i].values);
    }
    assert_rotor(&a->rotor, &b->rotor);
    assert_data(a, b);
    assert_int_equal(a->unknowns.nsuspect, b->unknowns.nsuspect);
    for (int i = 0; i < a->unknowns.nsuspect; i++) {
        assert_effect(&a->unknowns.suspect[i].effect, &b->unknowns.suspect[i].effect);
        assert_memory_equal(a->unknowns.suspect[i].fixed, b->unknowns.suspect[i].fixed, sizeof a->unknowns.suspect[i].fixed);
    }
    assert_int_equal(a->unknowns.nparameter, b->unknowns.nparameter);
    for (int p = 0; p < a->unknowns.nparameter; p++) {
        assert_text(a->unknowns.bounds[p].name, b->unknowns.bounds[p].name);
        assert_text(a->unknowns.bounds[p].unit, b->unknowns.bounds[p].unit);
        assert_doubles(3, &a->unknowns.bounds[p].lower, &b->unknowns.bounds[p].lower);
        assert_memory_equal(&a->unknowns.parameter[p], &b->unknowns.parameter[p], sizeof a->unknowns.parameter[p]);
    }
    assert_frf(&a->options.frf, &b->options.frf);
    assert_true(a->options.has_fit == b->options.has_fit && a->options.fit.functional == b->options.fit.functional &&
                a->options.fit.reduction == b->options.fit.reduction);
    assert_true(a->options.fit.derivative == b->options.fit.derivative);
}
