#include "solid/solid.h"

void shape_of_element(double x, double y, double *n, double *by_x, double *by_y)
{
    static const int cx[4] = {-1, 1, 1, -1}, cy[4] = {-1, -1, 1, 1};
    for (int c = 0; c < 4; c++) {
        double u = 1 + cx[c] * x, v = 1 + cy[c] * y, w = cx[c] * x + cy[c] * y - 1;
        n[c] = u * v * w / 4;
        by_x[c] = cx[c] * v * (w + u) / 4;
        by_y[c] = cy[c] * u * (w + v) / 4;
    }
    for (int side = 0; side < 2; side++) {
        int s = 2 * side - 1, across = 4 + 2 * side, beside = side ? 5 : 7; /* y = s, x = s */
        n[across] = (1 - x * x) * (1 + s * y) / 2;
        by_x[across] = -x * (1 + s * y);
        by_y[across] = s * (1 - x * x) / 2;
        n[beside] = (1 + s * x) * (1 - y * y) / 2;
        by_x[beside] = s * (1 - y * y) / 2;
        by_y[beside] = -y * (1 + s * x);
    }
}

void shape_of_edge(const double *edge, double place, double *n, double *by_place)
{
    /* place = middle + half x + bend x^2 */
    double half = (edge[2] - edge[0]) / 2, bend = (edge[0] + edge[2]) / 2 - edge[1], c = edge[1] - place;
    double x = -2 * c / (half + sqrt(fmax(half * half - 4 * bend * c, 0)));
    double slope = half + 2 * bend * x;
    n[0] = x * (x - 1) / 2;
    n[1] = 1 - x * x;
    n[2] = x * (x + 1) / 2;
    if (by_place) {
        by_place[0] = (x - 0.5) / slope;
        by_place[1] = -2 * x / slope;
        by_place[2] = (x + 0.5) / slope;
    }
}
