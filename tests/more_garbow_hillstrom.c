#include "more_garbow_hillstrom.h"

#include <math.h>

#include "mgh_residuals.h"

#define OSBORNE_2                                                                                                                \
    {                                                                                                                            \
        1.3, 0.65, 0.65, 0.7, 0.6, 3, 5, 7, 2, 4.5, 5.5                                                                          \
    }

const struct mgh_problem mgh_problems[] = {
    {"Rosenbrock", 2, 2, mgh_rosenbrock, {-1.2, 1}, 2, {0}, 1, {21, 8, 6}, {0}},
    {"Freudenstein-Roth", 2, 2, mgh_freudenstein_roth, {0.5, -2}, 2, {48.9842, 0}, 2, {21, 24, 26}, {0}},
    {"Powell badly", 2, 2, mgh_powell_badly_scaled, {0, 1}, 2, {0}, 1, {19, 0, 0}, {0, 1.01388e-08, 1}},
    {"Brown badly", 3, 2, mgh_brown_badly_scaled, {1, 1}, 2, {0}, 1, {16, 17, 20}, {0}},
    {"Beale", 3, 2, mgh_beale, {1, 1}, 2, {0}, 1, {10, 0, 0}, {0, 0.452009, 0.452009}},
    {"Jennrich-Sampson", 10, 2, mgh_jennrich_sampson, {0.3, 0.4}, 2, {124.362}, 1, {28, 0, 0}, {0, 259.58, NAN}},
    {"helical valley", 3, 3, mgh_helical_valley, {-1, 0, 0}, 3, {0}, 1, {12, 21, 19}, {0}},
    {"Bard", 15, 3, mgh_bard, {1, 1, 1}, 3, {8.21487e-3, 17.4286}, 2, {7, 66, 43}, {0}},
    {"Gaussian", 15, 3, mgh_gaussian, {0.4, 1, 0}, 3, {1.12793e-8}, 1, {4, 14, 73}, {0}},
    {"Meyer", 16, 3, mgh_meyer, {0.02, 4000, 250}, 3, {87.9458}, 1, {129, 1826, 289}, {0}},
    {"Gulf", 99, 3, mgh_gulf, {5, 2.5, 0.15}, 3, {0}, 1, {24, 2, 0}, {0, 0, 32.835}},
    {"Box 3D", 10, 3, mgh_box, {0, 10, 20}, 3, {0}, 1, {8, 0, 0}, {0, 0.0755887, 0.0755887}},
    {"Powell singular", 4, 4, mgh_powell_singular, {3, -1, 0, 1}, 4, {0}, 1, {58, 70, 65}, {0}},
    {"Wood", 6, 4, mgh_wood, {-3, -1, -3, -1}, 4, {0}, 1, {70, 71, 82}, {0}},
    {"Kowalik-Osborne",
     11,
     4,
     mgh_kowalik_osborne,
     {0.25, 0.39, 0.415, 0.39},
     4,
     {3.07505e-4, 1.02734e-3},
     2,
     {28, 107, 505},
     {0}},
    {"Brown-Dennis", 20, 4, mgh_brown_dennis, {25, 5, -5, -1}, 4, {85822.2}, 1, {351, 89, 414}, {0}},
    {"Osborne 1", 33, 5, mgh_osborne_1, {0.5, 1.5, -1, 0.01, 0.02}, 5, {5.46489e-5}, 1, {19, 87, 595}, {0}},
    {"Biggs EXP6", 13, 6, mgh_biggs, {1, 2, 1, 1, 1, 1}, 6, {0, 5.65565e-3}, 2, {40, 79, 0}, {0, 0, 0.306367}},
    {"Osborne 2", 65, 11, mgh_osborne_2, OSBORNE_2, 11, {4.01377e-2}, 1, {19, 0, 0}, {0, 1.78981, 1.78981}},
    {"Watson 6", 31, 6, mgh_watson, {0}, 1, {2.28767e-3}, 1, {10, 16, 18}, {0}},
    {"Watson 9", 31, 9, mgh_watson, {0}, 1, {1.39976e-6}, 1, {9, 21, 21}, {0}},
    {"Watson 12", 31, 12, mgh_watson, {0}, 1, {4.72238e-10}, 1, {13, 16, 37}, {0}},
    {"Brown almost 10", 10, 10, mgh_brown_almost_linear, {0.5}, 1, {0, 1}, 2, {15, 14, 22}, {0}},
    {"Brown almost 40", 40, 40, mgh_brown_almost_linear, {0.5}, 1, {0, 1}, 2, {19, 49, 0}, {0, 0, 4.28818e+23}},
    {"linear full rank", 10, 5, mgh_linear_full_rank, {1}, 1, {5}, 1, {3, 3, 3}, {0}},
    {"linear rank one", 10, 5, mgh_linear_rank_one, {1}, 1, {2.14286}, 1, {4, 7, 10}, {0}},
    {"Chebyquad 7", 7, 7, mgh_chebyquad, {0}, 0, {0}, 1, {10, 0, 0}, {0, NAN, NAN}},
    {"Chebyquad 8", 8, 8, mgh_chebyquad, {0}, 0, {3.51687e-3}, 1, {53, 0, 0}, {0, NAN, NAN}},
    {"Chebyquad 9", 9, 9, mgh_chebyquad, {0}, 0, {0}, 1, {13, 0, 0}, {0, NAN, NAN}},
    {"Chebyquad 10", 10, 10, mgh_chebyquad, {0}, 0, {6.50395e-3}, 1, {34, 0, 0}, {0, NAN, NAN}},
};

const int mgh_count = (int)(sizeof mgh_problems / sizeof *mgh_problems);

const double mgh_factors[3] = {1, 10, 100};

void mgh_start(const struct mgh_problem *problem, double factor, double *x)
{
    int zero = 1;
    for (int j = 0; j < problem->n; j++) {
        x[j] = factor * (problem->given ? problem->start[problem->given == 1 ? 0 : j] : (j + 1.0) / (problem->n + 1));
        zero &= x[j] == 0;
    }
    for (int j = 0; zero && factor > 1 && j < problem->n; j++)
        x[j] = factor;
}

int mgh_reached(const struct mgh_problem *problem, double sum_of_squares)
{
    double x[MGH_MOST_PARAMETERS], r[MGH_MOST_RESIDUALS], at_start = 0;
    mgh_start(problem, 1, x);
    (void)problem->residual(NULL, problem->m, problem->n, x, r, NULL);
    for (int i = 0; i < problem->m; i++)
        at_start += r[i] * r[i];
    for (int k = 0; k < problem->nminimum; k++) {
        double known = problem->minimum[k];
        if (known > 0 ? fabs(sum_of_squares / known - 1) < 1e-5 : sum_of_squares < 1e-22 * at_start)
            return k;
    }
    return -1;
}
