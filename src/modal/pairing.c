#include "modal/modal.h"

/* The two best candidates of a mode. */
static void best_two(int nmode, int ncandidate, const double *correlation, int mode, int *best, double *first, double *second)
{
    *best = -1;
    *first = *second = 0;
    for (int j = 0; j < ncandidate; j++) {
        double c = correlation[mode + j * nmode];
        if (c > *first) {
            *second = *first;
            *first = c;
            *best = j;
        } else if (c > *second) {
            *second = c;
        }
    }
}

int pair_modes(int nmode, int ncandidate, const double *correlation, int *number, enum pairing_basis *basis, int *used)
{
    memset(used, 0, (size_t)ncandidate * sizeof *used);
    for (int k = 0; k < nmode; k++)
        basis[k] = PAIRED_BY_NUMBER;
    for (int round = 0; correlation && round < nmode; round++) {
        int mode = -1, partner = -1, best;
        double strongest = 0, first, second;
        for (int k = 0; k < nmode; k++) {
            if (basis[k] == PAIRED_BY_SHAPE)
                continue;
            best_two(nmode, ncandidate, correlation, k, &best, &first, &second);
            if (best >= 0 && !used[best] && first >= PAIRING_LEAST && second <= 0.5 * first && first > strongest) {
                strongest = first;
                mode = k;
                partner = best;
            }
        }
        if (mode < 0)
            break;
        basis[mode] = PAIRED_BY_SHAPE;
        number[mode] = partner + 1;
        used[partner] = 1;
    }
    for (int k = 0; k < nmode; k++) {
        if (basis[k] == PAIRED_BY_SHAPE || number[k] < 1 || number[k] > ncandidate)
            continue;
        if (used[number[k] - 1]++)
            return k + 1;
    }
    return 0;
}
