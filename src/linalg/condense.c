/* Condensation of a host's matrices. */
#include <math.h>

#include "linalg/linalg.h"

static int check(int count, const rotid_matrix *const *a, int nmaster, const int *master, int kind, const double *k_out,
                 const double *m_out, char *failure)
{
    int status = matrices_check(count, a, failure);
    if (status)
        return status;
    if (nmaster < 1)
        return refuse(failure, "nmaster is %d, expected 1 ... %d (n)", nmaster, a[0]->n);
    if (kind != ROTID_GUYAN && kind != ROTID_IRS)
        return refuse(failure, "kind is %d, expected ROTID_GUYAN (%d) or ROTID_IRS (%d)", kind, ROTID_GUYAN, ROTID_IRS);
    if (!k_out || !m_out)
        return refuse(failure, "the %s to be written is NULL, expected room for nmaster x nmaster entries",
                      k_out ? "mass" : "stiffness");
    return indices_check("master", nmaster, master, a[0]->n, failure);
}

/* Entries near the ends of the doubles leave none behind. */
static int are_numbers(size_t count, const double *a)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(a[i]))
            return 0;
    return 1;
}

static int condense(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int nmaster, const int *master, int kind,
                    double *kc, double *mc, double *t)
{
    struct reduction r;
    size_t square = (size_t)nmaster * (size_t)nmaster;
    int status = reduction_new(pool, kind, k, nmaster, master, &r);
    if (!status)
        status = reduction_compute(&r, k, m);
    if (status)
        return status;
    memcpy(kc, r.kc, square * sizeof *kc);
    memcpy(mc, r.mc, square * sizeof *mc);
    if (t)
        memcpy(t, r.t, (size_t)k->n * (size_t)nmaster * sizeof *t);
    return are_numbers(square, kc) && are_numbers(square, mc) && are_numbers((size_t)k->n * (size_t)nmaster, r.t)
               ? ROTID_OK
               : ROTID_ERROR_FINITE;
}

int rotid_condense(const rotid_matrix *k, const rotid_matrix *m, int nmaster, const int *master, int kind,
                   const rotid_environment *environment, char *failure, double *kc, double *mc, double *t)
{
    const rotid_matrix *all[] = {k, m};
    struct entry entry;
    int status = entry_open(&entry, environment, failure);
    if (!status)
        status = check(2, all, nmaster, master, kind, kc, mc, failure);
    if (!status)
        status = condense(&entry.scratch, k, m, nmaster, master, kind, kc, mc, t);
    return entry_close(&entry, status);
}

/* Symmetric but for rounding */
static void symmetrise(int n, double *a)
{
    for (int j = 0; j < n; j++)
        for (int i = 0; i < j; i++)
            a[i + (ptrdiff_t)j * n] = a[j + (ptrdiff_t)i * n] = (a[i + (ptrdiff_t)j * n] + a[j + (ptrdiff_t)i * n]) / 2;
}

static int differentiate(struct pool *pool, const rotid_matrix *const *a, int nmaster, const int *master, int kind, double *dkc,
                         double *dmc)
{
    struct reduction r;
    int status = reduction_new(pool, kind, a[0], nmaster, master, &r);
    double *unit = POOL_ARRAY(pool, double, nmaster);
    double *work = POOL_ARRAY(pool, double, 3 * (size_t)a[0]->n + (size_t)nmaster);
    if (!status && (!unit || !work))
        status = ROTID_ERROR_MEMORY;
    if (!status)
        status = reduction_compute(&r, a[0], a[1]);
    for (int c = 0; c < nmaster && !status; c++) {
        ptrdiff_t column = (ptrdiff_t)c * nmaster;
        unit[c] = 1;
        reduction_derivative_multiply(&r, a[2], a[3], unit, dkc + column, dmc + column, work);
        unit[c] = 0;
    }
    if (!status) {
        symmetrise(nmaster, dkc);
        symmetrise(nmaster, dmc);
    }
    size_t square = (size_t)nmaster * (size_t)nmaster;
    return !status && !(are_numbers(square, dkc) && are_numbers(square, dmc)) ? ROTID_ERROR_FINITE : status;
}

int rotid_condense_derivative(const rotid_matrix *k, const rotid_matrix *m, const rotid_matrix *dk, const rotid_matrix *dm,
                              int nmaster, const int *master, int kind, const rotid_environment *environment, char *failure,
                              double *dkc, double *dmc)
{
    const rotid_matrix *all[] = {k, m, dk, dm};
    struct entry entry;
    int status = entry_open(&entry, environment, failure);
    if (!status)
        status = check(4, all, nmaster, master, kind, dkc, dmc, failure);
    if (!status)
        status = differentiate(&entry.scratch, all, nmaster, master, kind, dkc, dmc);
    return entry_close(&entry, status);
}
