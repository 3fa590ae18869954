/* Residuals of the problems of more_garbow_hillstrom.h with their analytic Jacobians, of the type rotid_residual; nonzero where
 * one overflows, and the values are written all the same. The number is that of the paper. */
#ifndef ROTID_TESTS_MGH_RESIDUALS_H
#define ROTID_TESTS_MGH_RESIDUALS_H

#define RESIDUAL(name) int name(void *user, int m, int n, const double *x, double *r, double *jacobian)
#define J(i, j)        jacobian[(i) + (j)*m]

/* What an overflow looks like to a caller: no residual there. */
int mgh_unusable(int count, const double *values);

/* functions: mgh_functions.c */
RESIDUAL(mgh_rosenbrock);          /* 1 */
RESIDUAL(mgh_freudenstein_roth);   /* 2 */
RESIDUAL(mgh_powell_badly_scaled); /* 3 */
RESIDUAL(mgh_brown_badly_scaled);  /* 4 */
RESIDUAL(mgh_beale);               /* 5 */
RESIDUAL(mgh_helical_valley);      /* 7: theta runs through a quarter turn at x1 = 0 */
RESIDUAL(mgh_powell_singular);     /* 13: the Jacobian is singular at the minimum */
RESIDUAL(mgh_wood);                /* 14 */
RESIDUAL(mgh_watson);              /* 20 */
RESIDUAL(mgh_brown_almost_linear); /* 27 */
RESIDUAL(mgh_linear_full_rank);    /* 32 */
RESIDUAL(mgh_linear_rank_one);     /* 33 */
RESIDUAL(mgh_chebyquad);           /* 35 */

/* fits to data: mgh_data_fits.c */
RESIDUAL(mgh_jennrich_sampson); /* 6 */
RESIDUAL(mgh_bard);             /* 8 */
RESIDUAL(mgh_gaussian);         /* 9 */
RESIDUAL(mgh_meyer);            /* 10 */
RESIDUAL(mgh_gulf);             /* 11 */
RESIDUAL(mgh_box);              /* 12 */
RESIDUAL(mgh_kowalik_osborne);  /* 15 */
RESIDUAL(mgh_brown_dennis);     /* 16 */
RESIDUAL(mgh_osborne_1);        /* 17 */
RESIDUAL(mgh_biggs);            /* 18 */
RESIDUAL(mgh_osborne_2);        /* 19 */

#endif
