/* Where to put sensors: Bayesian D-optimal design on columns of sensitivities (Chaloner and Verdinelli, Statistical Science 10,
 * 1995), beside effective independence (Kammer, J. Guidance 14, 1991).
 *
 * A design has a row for each frequency and for each shape component at any of `nplace` places, whitened by the noise. A set of
 * places S takes the frequencies and its components; the scale of each shape is free, so of mode k only the part orthogonal to
 * u_k counts, u_k the shape over its noise at S:
 *   G_ij(S) = sum c_i c_j - sum_k (u_k'c_i)(u_k'c_j)/(u_k'u_k)
 * The value of S is ln det(P + G) of the parameters, P what is known before, plus the mean over the targets t of ln(1 + q_t),
 * q_t = G_tt - G_tp (P + G_pp)^-1 G_pt: what is left of a target when the parameters follow it. */
#ifndef ROTID_SUGGEST_DESIGN_H
#define ROTID_SUGGEST_DESIGN_H

#include "base/pool.h"

struct design {
    int nmode, nplace, nparam, ntarget;
    int targets_alone; /* nonzero: the value is that of the targets */
    double *column;    /* [nrow * (nparam + ntarget)], nrow = nmode (1 + nplace): frequencies, then shapes mode by mode */
    double *scale;     /* [nplace * nmode] u_k at all places */
    double *prior;     /* [nparam * nparam] P, positive definite */
    double *largest;   /* [nplace * nmode] |shape|, largest 1: noise is stated relative to the largest component at S */
};

/* Room for a design. ROTID_OK or ROTID_ERROR_MEMORY. */
int design_new(struct pool *pool, int nmode, int nplace, int nparam, int ntarget, struct design *design);

/* What a set of places says by the first `modes` modes. */
struct information {
    double value;  /* as above, less ln det P: nothing measured is 0 */
    double target; /* mean of ln(1 + q_t) alone */
    double *gram;  /* [nparam * nparam] G_pp, or NULL: not wanted */
    double *q;     /* [ntarget], or NULL */
};

/* Of the places with taken [nplace] nonzero; taken NULL: frequencies alone. own: the noise of a shape refers to its largest
 * component at these places, as that of a measured shape does, and not to the largest along the axis. ROTID_OK or
 * ROTID_ERROR_MEMORY, ROTID_ERROR_RANK where P + G is not positive definite. */
int design_information(struct pool *pool, const struct design *design, int modes, const int *taken, int own,
                       struct information *out);

/* Half-widths of the 95 % intervals [nparam] in percent, of relative parameters: 196 sqrt((G^-1)_pp); NaN where that is above
 * 100, or G is singular. ROTID_OK or ROTID_ERROR_MEMORY. */
int design_half_widths(struct pool *pool, int nparam, const double *gram, double *half_width);

/* Adds places to `taken` [nplace] until there are n, each time the one that raises the mean value of the designs most, then
 * exchanges those that were added as long as that raises it. Places nearer than `apart` to another one are left out; fewer are
 * taken where there are no more. told (may be NULL) is called after each addition, before the exchanges. design [ndesign] have
 * the same places z [nplace]. ROTID_OK, ROTID_ERROR_MEMORY or _RANK. */
int design_choose(struct pool *pool, int ndesign, const struct design *design, int modes, const double *z, double apart, int n,
                  int (*told)(void *context, const int *taken), void *context, int *taken);

/* The exchanges alone, of all that are taken. Statuses likewise. */
int design_improve(struct pool *pool, int ndesign, const struct design *design, int modes, const double *z, double apart,
                   int *taken);

/* Mean value of the designs, likewise. */
int design_value(struct pool *pool, int ndesign, const struct design *design, int modes, const int *taken, double *value);

/* Effective independence: of the places in `taken` [nplace] the one of the least leverage phi_i'(Phi'Phi)^-1 phi_i goes, until n
 * are left. shape [nplace * modes]. ROTID_OK, ROTID_ERROR_MEMORY or _RANK (fewer places than modes). */
int effective_independence(struct pool *pool, int nplace, int modes, const double *shape, int n, int *taken);

#endif
