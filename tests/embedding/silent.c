/* A host that prints nothing and lets the library meet good and bad fortune: whatever appears on its streams, the library wrote.
 * Returns 0 where every status was the expected one, else the number of the check that was not. C and C++.
 *
 * silent GOOD.inp BAD.inp */
#include <math.h>
#include <rotid.h>
#include <stddef.h>

static int call, wrong;

static void expect(int status, int expected)
{
    call++;
    if (status != expected && !wrong)
        wrong = call;
}

enum { FINE, FAILING, NOT_FINITE, NO_MASS, NO_STIFFNESS };

/* Two masses of 1 kg on springs x and joined by one of 1 N/m; and what the user may ask for instead. */
static int matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    const int *fortune = (const int *)user;
    double kg = *fortune == NO_MASS ? -1 : 1, spring = *fortune == NO_STIFFNESS ? -100 : x[0];
    double k[] = {*fortune == NOT_FINITE ? NAN : spring + 1, -1, spring + 1}, m[] = {kg, 0, kg};
    for (int i = 0; i < 3; i++) {
        stiffness->band[i] = k[i];
        mass->band[i] = m[i];
    }
    return *fortune == FAILING;
}

static void fit_with(int fortune, int expected)
{
    static const int number[] = {1, 2};
    static const double hz[] = {0.16, 0.28};
    static rotid_model model;
    rotid_parameter parameter = {NULL, NULL, 0.01, 100, 2};
    static rotid_measured measured;
    rotid_fit_options options;
    rotid_fit_result *result;
    rotid_fit_defaults(sizeof options, &options);
    options.functional = ROTID_HYBRID;
    options.reduction = ROTID_REDUCTION_NONE;
    model.size = sizeof model;
    model.n = 2;
    model.kd = 1;
    model.nparam = 1;
    model.matrices = matrices;
    model.user = &fortune;
    measured.size = sizeof measured;
    measured.nmode = 2;
    measured.number = number;
    measured.frequency_hz = hz;
    expect(rotid_fit(&model, &parameter, &measured, &options, NULL, NULL, &result), expected);
    rotid_fit_free(result);
}

static int no_residual(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    (void)user, (void)n, (void)x;
    for (int i = 0; r && i < m; i++)
        r[i] = NAN;
    for (int i = 0; jacobian && i < m * n; i++)
        jacobian[i] = NAN;
    return 0;
}

static void *no_memory(void *context, size_t bytes)
{
    (void)context, (void)bytes;
    return NULL;
}

static void nothing_to_release(void *context, void *block)
{
    (void)context, (void)block;
}

/* stops a long call after some polls */
static int soon(void *context)
{
    return ++*(int *)context > 20;
}

int main(int argc, char **argv)
{
    rotid_allocator allocator = {no_memory, nothing_to_release, NULL};
    rotid_environment poor = {sizeof poor, &allocator, NULL, NULL, NULL};
    int polls = 0;
    rotid_environment brief = {sizeof brief, NULL, soon, NULL, &polls};
    rotid_deck *deck;
    rotid_spectrum *spectrum;
    rotid_identification *found;
    rotid_diagnosis *diagnosis;
    rotid_lm_result result;
    char failure[512];
    double x[1] = {1}, r[3], jacobian[3], work[200];
    if (argc != 3)
        return 2;
    expect(rotid_deck_read(argv[1], 0, NULL, NULL, NULL, &deck), ROTID_OK);
    expect(rotid_spectrum_compute(deck, NULL, 4, NULL, NULL, &spectrum), ROTID_OK);
    rotid_spectrum_free(spectrum);
    expect(rotid_spectrum_compute(deck, NULL, -1, NULL, NULL, &spectrum), ROTID_ERROR_ARGUMENT);
    expect(rotid_identify(deck, 1, NULL, failure, &found), ROTID_OK);
    rotid_identification_free(found);
    expect(rotid_identify(deck, 1, &poor, failure, &found), ROTID_ERROR_MEMORY);
    expect(rotid_diagnose(deck, NULL, &brief, failure, &diagnosis), ROTID_OK);
    rotid_diagnosis_free(diagnosis);
    rotid_deck_free(deck);
    expect(rotid_deck_read(argv[2], 0, NULL, NULL, NULL, &deck), ROTID_ERROR_SYNTAX);
    expect(rotid_identify(deck, 0, NULL, failure, &found), ROTID_ERROR_ARGUMENT);
    rotid_deck_free(deck);
    expect(rotid_deck_read("/nowhere/rotor.inp", 0, NULL, NULL, NULL, &deck), ROTID_ERROR_IO);
    rotid_deck_free(deck);
    fit_with(FINE, ROTID_OK);
    fit_with(FAILING, ROTID_ERROR_CALLBACK);
    fit_with(NOT_FINITE, ROTID_ERROR_FINITE);
    fit_with(NO_MASS, ROTID_ERROR_MASS);
    fit_with(NO_STIFFNESS, ROTID_ERROR_STIFFNESS);
    expect(rotid_lm(3, 1, no_residual, NULL, NULL, NULL, x, r, jacobian, work, &result), ROTID_ERROR_FINITE);
    expect(rotid_lm(3, 1, NULL, NULL, NULL, NULL, x, r, jacobian, work, &result), ROTID_ERROR_ARGUMENT);
    return wrong;
}
