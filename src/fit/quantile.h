/* Tail probabilities that intervals and tests need. */
#ifndef ROTID_FIT_QUANTILE_H
#define ROTID_FIT_QUANTILE_H

/* The t with P(|T| <= t) = 0.95 for Student's distribution with dof >= 1 degrees of freedom; dof 0: the normal distribution. */
double quantile_student_95(int dof);

/* The t with P(|T| > t) = outside, 0 < outside < 1, dof >= 1. */
double quantile_student(double outside, int dof);

/* P(chi2 >= x) with dof >= 1 degrees of freedom. */
double chi_square_tail(double x, int dof);

/* The x with P(chi2 > x) = outside, 0 < outside < 1, dof >= 1. */
double chi_square_limit(double outside, int dof);

#endif
