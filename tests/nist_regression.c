#include "nist_regression.h"

#include <math.h>
#include <stddef.h>

#include "nist_data.h"

static const double pi = 3.14159265358979323846;

static double saturation(const double *b, const double *t, double *slope)
{
    double e = exp(-b[1] * *t);
    slope[0] = 1 - e;
    slope[1] = b[0] * *t * e;
    return b[0] * (1 - e);
}

static double decay_over_line(const double *b, const double *t, double *slope)
{
    double line = b[1] + b[2] * *t, y = exp(-b[0] * *t) / line;
    slope[0] = -*t * y;
    slope[1] = -y / line;
    slope[2] = -*t * y / line;
    return y;
}

static double three_decays(const double *b, const double *t, double *slope)
{
    double y = 0;
    for (int k = 0; k < 6; k += 2) {
        double e = exp(-b[k + 1] * *t);
        slope[k] = e;
        slope[k + 1] = -*t * b[k] * e;
        y += b[k] * e;
    }
    return y;
}

static double two_peaks(const double *b, const double *t, double *slope)
{
    double e = exp(-b[1] * *t), y = b[0] * e;
    slope[0] = e;
    slope[1] = -*t * y;
    for (int k = 2; k < 8; k += 3) {
        double z = (*t - b[k + 1]) / b[k + 2];
        e = exp(-z * z);
        slope[k] = e;
        slope[k + 1] = 2 * b[k] * e * z / b[k + 2];
        slope[k + 2] = 2 * b[k] * e * z * z / b[k + 2];
        y += b[k] * e;
    }
    return y;
}

static double power(const double *b, const double *t, double *slope)
{
    slope[0] = pow(*t, b[1]);
    slope[1] = b[0] * slope[0] * log(*t);
    return b[0] * slope[0];
}

static double misra1b(const double *b, const double *t, double *slope)
{
    double u = 1 + b[1] * *t / 2;
    slope[0] = 1 - 1 / (u * u);
    slope[1] = b[0] * *t / (u * u * u);
    return b[0] * slope[0];
}

static double misra1c(const double *b, const double *t, double *slope)
{
    double u = 1 + 2 * b[1] * *t;
    slope[0] = 1 - 1 / sqrt(u);
    slope[1] = b[0] * *t / (u * sqrt(u));
    return b[0] * slope[0];
}

static double misra1d(const double *b, const double *t, double *slope)
{
    double u = 1 + b[1] * *t;
    slope[0] = b[1] * *t / u;
    slope[1] = b[0] * *t / (u * u);
    return b[0] * slope[0];
}

/* (b0 + b1 t + ... b_d t^d) / (1 + b_(d+1) t + ... b_2d t^d) */
static double ratio(int degree, const double *b, double t, double *slope)
{
    double above = b[degree], below = b[2 * degree], part = 1;
    for (int k = degree - 1; k >= 0; k--) {
        above = above * t + b[k];
        below = below * t + (k ? b[degree + k] : 1);
    }
    for (int k = 0; k <= degree; k++, part *= t) {
        slope[k] = part / below;
        if (k)
            slope[degree + k] = -above / below * part / below;
    }
    return above / below;
}

static double quadratic_ratio(const double *b, const double *t, double *slope)
{
    return ratio(2, b, *t, slope);
}

static double cubic_ratio(const double *b, const double *t, double *slope)
{
    return ratio(3, b, *t, slope);
}

/* of log y: nist_residual takes the logarithm of the data */
static double nelson(const double *b, const double *t, double *slope)
{
    double e = t[0] * exp(-b[2] * t[1]);
    slope[0] = 1;
    slope[1] = -e;
    slope[2] = b[1] * t[1] * e;
    return b[0] - b[1] * e;
}

static double two_decays(const double *b, const double *t, double *slope)
{
    slope[0] = 1;
    slope[1] = exp(-*t * b[3]);
    slope[2] = exp(-*t * b[4]);
    slope[3] = -*t * b[1] * slope[1];
    slope[4] = -*t * b[2] * slope[2];
    return b[0] + b[1] * slope[1] + b[2] * slope[2];
}

static double roszman(const double *b, const double *t, double *slope)
{
    double u = *t - b[3], square = u * u + b[2] * b[2];
    slope[0] = 1;
    slope[1] = -*t;
    slope[2] = -u / square / pi;
    slope[3] = -b[2] / square / pi;
    return b[0] - b[1] * *t - atan(b[2] / u) / pi;
}

static double enso(const double *b, const double *t, double *slope)
{
    double y = b[0], turn = 2 * pi * *t;
    slope[0] = 1;
    slope[1] = cos(turn / 12);
    slope[2] = sin(turn / 12);
    y += b[1] * slope[1] + b[2] * slope[2];
    for (int k = 3; k < 9; k += 3) {
        double c = cos(turn / b[k]), s = sin(turn / b[k]);
        slope[k] = (b[k + 1] * s - b[k + 2] * c) * turn / (b[k] * b[k]);
        slope[k + 1] = c;
        slope[k + 2] = s;
        y += b[k + 1] * c + b[k + 2] * s;
    }
    return y;
}

static double kowalik_osborne(const double *b, const double *t, double *slope)
{
    double above = *t * *t + *t * b[1], below = *t * *t + *t * b[2] + b[3];
    slope[0] = above / below;
    slope[1] = b[0] * *t / below;
    slope[2] = -b[0] * above * *t / (below * below);
    slope[3] = -b[0] * above / (below * below);
    return b[0] * above / below;
}

static double meyer(const double *b, const double *t, double *slope)
{
    double u = *t + b[2], e = exp(b[1] / u);
    slope[0] = e;
    slope[1] = b[0] * e / u;
    slope[2] = -b[0] * e * b[1] / (u * u);
    return b[0] * e;
}

static double peak(const double *b, const double *t, double *slope)
{
    double z = (*t - b[2]) / b[1], e = exp(-z * z / 2) / b[1];
    slope[0] = e;
    slope[1] = b[0] * e * (z * z - 1) / b[1];
    slope[2] = b[0] * e * z / b[1];
    return b[0] * e;
}

static double logistic(const double *b, const double *t, double *slope)
{
    double e = exp(b[1] - b[2] * *t), u = 1 + e;
    slope[0] = 1 / u;
    slope[1] = -b[0] * e / (u * u);
    slope[2] = b[0] * e * *t / (u * u);
    return b[0] / u;
}

static double richards(const double *b, const double *t, double *slope)
{
    double e = exp(b[1] - b[2] * *t), u = 1 + e, root = pow(u, 1 / b[3]), y = b[0] / root;
    slope[0] = 1 / root;
    slope[1] = -y * e / u / b[3];
    slope[2] = y * e / u * *t / b[3];
    slope[3] = y * log(u) / (b[3] * b[3]);
    return y;
}

static double bennett(const double *b, const double *t, double *slope)
{
    double u = b[1] + *t, e = pow(u, -1 / b[2]);
    slope[0] = e;
    slope[1] = -b[0] * e / (u * b[2]);
    slope[2] = b[0] * e * log(u) / (b[2] * b[2]);
    return b[0] * e;
}

/* clang-format off: three lines a problem are read more easily than ten */
const struct nist_problem nist_problems[] = {
    {"Misra1a",
     14,
     2,
     saturation,
     data_of_misra1a,
     {{5e2, 0.0001}, {2.5e2, 0.0005}},
     {238.94212918, 0.00055015643181},
     {2.7070075241, 7.2668688436e-6},
     0.12455138894},
    {"Chwirut2",
     54,
     3,
     decay_over_line,
     data_of_chwirut2,
     {{0.1, 0.01, 0.02}, {0.15, 0.008, 0.01}},
     {0.16657666537, 0.0051653291286, 0.012150007096},
     {0.03830328681, 0.00066621605126, 0.0015304234767},
     513.04802941},
    {"Chwirut1",
     214,
     3,
     decay_over_line,
     data_of_chwirut1,
     {{0.1, 0.01, 0.02}, {0.15, 0.008, 0.01}},
     {0.1902781837, 0.0061314004477, 0.010530908399},
     {0.021938557035, 0.00034500025051, 0.00079281847748},
     2384.4771393},
    {"Lanczos3",
     24,
     6,
     three_decays,
     data_of_lanczos3,
     {{1.2, 0.3, 5.6, 5.5, 6.5, 7.6}, {0.5, 0.7, 3.6, 4.2, 4, 6.3}},
     {0.086816414977, 0.95498101505, 0.84400777463, 2.9515951832, 1.5825685901, 4.9863565084},
     {0.017197908859, 0.097041624475, 0.041488663282, 0.10766312506, 0.058371576281, 0.034436403035},
     1.6117193594e-8},
    {"Gauss1",
     250,
     8,
     two_peaks,
     data_of_gauss1,
     {{97, 0.009, 1e2, 65, 2e1, 7e1, 178, 16.5}, {94, 0.0105, 99, 63, 25, 71, 1.8e2, 2e1}},
     {98.778210871, 0.010497276517, 100.48990633, 67.481111276, 23.12977336, 71.994503004, 178.99805021, 18.389389025},
     {0.5752731273, 0.00011406289017, 0.58831775752, 0.10460593412, 0.17439951146, 0.62622793913, 0.12436988217, 0.20134312832},
     1315.8222432},
    {"Gauss2",
     250,
     8,
     two_peaks,
     data_of_gauss2,
     {{96, 0.009, 103, 106, 18, 72, 151, 18}, {98, 0.0105, 103, 105, 2e1, 73, 1.5e2, 2e1}},
     {99.018328406, 0.010994945399, 101.88022528, 107.03095519, 23.578584029, 72.045589471, 153.27010194, 19.525972636},
     {0.53748766879, 0.00013335306766, 0.59217315772, 0.15006798316, 0.22695595067, 0.61721965884, 0.19466674341, 0.26416549393},
     1247.5282092},
    {"DanWood",
     6,
     2,
     power,
     data_of_danwood,
     {{1, 5}, {0.7, 4}},
     {0.76886226176, 3.8604055871},
     {0.01828197386, 0.051726610913},
     0.0043173084083},
    {"Misra1b",
     14,
     2,
     misra1b,
     data_of_misra1b,
     {{5e2, 0.0001}, {3e2, 0.0002}},
     {337.99746163, 0.00039039091287},
     {3.1643950207, 4.2547321834e-6},
     0.075464681533},
    {"Kirby2",
     151,
     5,
     quadratic_ratio,
     data_of_kirby2,
     {{2, -0.1, 0.003, -0.001, 1e-5}, {1.5, -0.15, 0.0025, -0.0015, 2e-5}},
     {1.6745063063, -0.13927397867, 0.0025961181191, -0.001724181187, 2.1664802578e-5},
     {0.087989634338, 0.0041182041386, 4.1856520458e-5, 5.8931897355e-5, 2.0129761919e-7},
     3.9050739624},
    {"Hahn1",
     236,
     7,
     cubic_ratio,
     data_of_hahn1,
     {{1e1, -1, 0.05, -1e-5, -0.05, 0.001, -1e-6}, {1, -0.1, 0.005, -1e-6, -0.005, 0.0001, -1e-7}},
     {1.0776351733, -0.12269296921, 0.004086375061, -1.4262662514e-6, -0.0057609940901, 0.00024053735503, -1.2314450199e-7},
     {0.17070154742, 0.012000289189, 0.00022508314937, 2.7578037666e-7, 0.00024712888219, 1.0449373768e-5, 1.3027335327e-8},
     1.5324382854},
    {"Nelson",
     128,
     3,
     nelson,
     data_of_nelson,
     {{2, 0.0001, -0.01}, {2.5, 5e-9, -0.05}},
     {2.5906836021, 5.6177717026e-9, -0.057701013174},
     {0.019149996413, 6.112409654e-9, 0.0039572366543},
     3.7976833176},
    {"MGH17",
     33,
     5,
     two_decays,
     data_of_mgh17,
     {{5e1, 1.5e2, -1e2, 1, 2}, {0.5, 1.5, -1, 0.01, 0.02}},
     {0.37541005211, 1.9358469127, -1.4646871366, 0.01286753464, 0.022122699662},
     {0.0020723153551, 0.22031669222, 0.22175707739, 0.00044861358114, 0.00089471996575},
     5.4648946975e-5},
    {"Lanczos1",
     24,
     6,
     three_decays,
     data_of_lanczos1,
     {{1.2, 0.3, 5.6, 5.5, 6.5, 7.6}, {0.5, 0.7, 3.6, 4.2, 4, 6.3}},
     {0.095100000027, 1.0000000001, 0.86070000013, 3.0000000002, 1.5575999998, 5.0000000001},
     {5.3347304234e-11, 2.7473038179e-10, 1.3576062225e-10, 3.3308253069e-10, 1.8815731448e-10, 1.1057500538e-10},
     1.4307867721e-25},
    {"Lanczos2",
     24,
     6,
     three_decays,
     data_of_lanczos2,
     {{1.2, 0.3, 5.6, 5.5, 6.5, 7.6}, {0.5, 0.7, 3.6, 4.2, 4, 6.3}},
     {0.096251029939, 1.0057332849, 0.86424689056, 3.0078283915, 1.5529016879, 5.00287981},
     {0.00066770575477, 0.0033989646176, 0.0017185846685, 0.0041707005856, 0.0023744381417, 0.0013958787284},
     2.2299428125e-11},
    {"Gauss3",
     250,
     8,
     two_peaks,
     data_of_gauss3,
     {{94.9, 0.009, 90.1, 113, 2e1, 73.8, 1.4e2, 2e1}, {96, 0.0096, 8e1, 1.1e2, 25, 74, 139, 25}},
     {98.94036897, 0.010945879335, 100.69553078, 111.63619459, 23.300500029, 73.705031418, 147.76164251, 19.66822123},
     {0.53005192833, 0.00012554058911, 0.81256587317, 0.35317859757, 0.36584783023, 1.2091239082, 0.40488183351, 0.37806634336},
     1244.484636},
    {"Misra1c",
     14,
     2,
     misra1c,
     data_of_misra1c,
     {{5e2, 0.0001}, {6e2, 0.0002}},
     {636.42725809, 0.00020813627256},
     {4.6638326572, 1.7728423155e-6},
     0.040966836971},
    {"Misra1d",
     14,
     2,
     misra1d,
     data_of_misra1d,
     {{5e2, 0.0001}, {4.5e2, 0.0003}},
     {437.36970754, 0.00030227324449},
     {3.6489174345, 2.9334354479e-6},
     0.056419295283},
    {"Roszman1",
     25,
     4,
     roszman,
     data_of_roszman1,
     {{0.1, -1e-5, 1e3, -1e2}, {0.2, -5e-6, 1.2e3, -1.5e2}},
     {0.20196866396, -6.1953516256e-6, 1204.4556708, -181.34269537},
     {0.019172666023, 3.2058931691e-6, 74.050983057, 49.573513849},
     0.00049484847331},
    {"ENSO",
     168,
     9,
     enso,
     data_of_enso,
     {{11, 3, 0.5, 4e1, -0.7, -1.3, 25, -0.3, 1.4}, {1e1, 3, 0.5, 44, -1.5, 0.5, 26, -0.1, 1.5}},
     {10.510749193, 3.0762128085, 0.53280138227, 44.3110887, -1.6231428586, 0.52554493756, 26.88761444, 0.21232288488,
      1.4966870418},
     {0.17488832467, 0.24310052139, 0.24354686618, 0.94408025976, 0.28078369611, 0.48073701119, 0.4161293913, 0.51460022911,
      0.25434468893},
     788.53978668},
    {"MGH09",
     11,
     4,
     kowalik_osborne,
     data_of_mgh09,
     {{25, 39, 41.5, 39}, {0.25, 0.39, 0.415, 0.39}},
     {0.19280693458, 0.19128232873, 0.12305650693, 0.13606233068},
     {0.011435312227, 0.19633220911, 0.080842031232, 0.090025542308},
     0.00030750560385},
    {"Thurber",
     37,
     7,
     cubic_ratio,
     data_of_thurber,
     {{1e3, 1e3, 4e2, 4e1, 0.7, 0.3, 0.03}, {1.3e3, 1.5e3, 5e2, 75, 1, 0.4, 0.05}},
     {1288.13968, 1491.0792535, 583.23836877, 75.416644291, 0.96629502864, 0.39797285797, 0.049727297349},
     {4.6647963344, 39.571156086, 28.698696102, 5.567537027, 0.031333340687, 0.014984928198, 0.0065842344623},
     5642.7082397},
    {"BoxBOD",
     6,
     2,
     saturation,
     data_of_boxbod,
     {{1, 1}, {1e2, 0.75}},
     {213.80940889, 0.54723748542},
     {12.354515176, 0.10455993237},
     1168.0088766},
    {"Rat42",
     9,
     3,
     logistic,
     data_of_rat42,
     {{1e2, 1, 0.1}, {75, 2.5, 0.07}},
     {72.462237576, 2.6180768402, 0.067359200066},
     {1.7340283401, 0.088295217536, 0.0034465663377},
     8.0565229338},
    {"MGH10",
     16,
     3,
     meyer,
     data_of_mgh10,
     {{2, 4e5, 2.5e4}, {0.02, 4e3, 2.5e2}},
     {0.005609636471, 6181.3463463, 345.22363462},
     {0.00015687892471, 23.309021107, 0.78486103508},
     87.945855171},
    {"Eckerle4",
     35,
     3,
     peak,
     data_of_eckerle4,
     {{1, 1e1, 5e2}, {1.5, 5, 4.5e2}},
     {1.5543827178, 4.0888321754, 451.54121844},
     {0.015408051163, 0.046803020753, 0.046800518816},
     0.0014635887487},
    {"Rat43",
     15,
     4,
     richards,
     data_of_rat43,
     {{1e2, 1e1, 1, 1}, {7e2, 5, 0.75, 1.3}},
     {699.6415127, 5.2771253025, 0.75962938329, 1.2792483859},
     {16.302297817, 2.0828735829, 0.19566123451, 0.68761936385},
     8786.404908},
    {"Bennett5",
     154,
     3,
     bennett,
     data_of_bennett5,
     {{-2e3, 5e1, 0.8}, {-1.5e3, 45, 0.85}},
     {-2523.5058043, 46.736564644, 0.93218483193},
     {297.15175411, 1.2448871856, 0.020272299378},
     0.00052404744073},
};
/* clang-format on */
const int nist_count = sizeof nist_problems / sizeof *nist_problems;

int nist_residual(void *user, int m, int n, const double *b, double *r, double *jacobian)
{
    const struct nist_problem *problem = user;
    int width = problem->model == nelson ? 3 : 2, bad = 0;
    for (int i = 0; i < m; i++) {
        const double *row = problem->data + (ptrdiff_t)i * width;
        double slope[NIST_MOST_PARAMETERS], value = problem->model(b, row + 1, slope);
        if (r) {
            r[i] = value - (width == 3 ? log(row[0]) : row[0]);
            bad |= !isfinite(r[i]);
        }
        for (int j = 0; jacobian && j < n; j++) {
            jacobian[i + j * m] = slope[j];
            bad |= !isfinite(slope[j]);
        }
    }
    return bad;
}

int nist_solved(const struct nist_problem *problem, double sum)
{
    return problem->sum < 1e-20 ? sum < 1e-20 : fabs(sum - problem->sum) <= 1e-8 * problem->sum;
}
