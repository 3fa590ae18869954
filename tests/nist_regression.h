/* Nonlinear regression problems with certified values of the National Institute of Standards and Technology, Statistical
 * Reference Datasets, https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml (a work of the United States government, in the
 * public domain): data, models, both starts and certified values as printed there, in NIST's order of difficulty. */
#ifndef ROTID_TESTS_NIST_REGRESSION_H
#define ROTID_TESTS_NIST_REGRESSION_H

#define NIST_MOST_OBSERVATIONS 250
#define NIST_MOST_PARAMETERS   9

struct nist_problem {
    const char *name;
    int m, n;
    double (*model)(const double *b, const double *t, double *slope); /* the value at t; its derivatives [n] into slope */
    const double *data;                                               /* [m * 2] y, t, row by row; Nelson's [m * 3] y, t1, t2 */
    double start[2][NIST_MOST_PARAMETERS];
    double certified[NIST_MOST_PARAMETERS], std[NIST_MOST_PARAMETERS];
    double sum; /* of squares, certified */
};

extern const struct nist_problem nist_problems[];
extern const int nist_count;

/* rotid_residual, model less data, of the problem that `user` points to; nonzero where a value is not finite. */
int nist_residual(void *user, int m, int n, const double *b, double *r, double *jacobian);

/* 1 where a sum of squares is the certified one to 1e-8; Lanczos1, whose data are exact but for their 14 digits, below 1e-20: at
 * the certified point its residuals are rounding. */
int nist_solved(const struct nist_problem *problem, double sum);

#endif
