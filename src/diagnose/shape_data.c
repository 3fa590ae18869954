#include "diagnose/diagnose.h"

double shape_data_model(const struct shape_data *data, int k, double z)
{
    const double *x = data->axis_z, *y = data->axis_shape + (ptrdiff_t)k * data->naxis;
    int low = 0, high = data->naxis - 1, points = data->naxis < 4 ? data->naxis : 4;
    double sum = 0;
    while (high - low > 1) {
        int mid = (low + high) / 2;
        if (x[mid] <= z)
            low = mid;
        else
            high = mid;
    }
    int first = low - 1 > 0 ? low - 1 : 0;
    if (first + points > data->naxis)
        first = data->naxis - points;
    for (int i = first; i < first + points; i++) {
        double product = y[i];
        for (int j = first; j < first + points; j++)
            if (j != i)
                product *= (z - x[j]) / (x[i] - x[j]);
        sum += product;
    }
    return sum;
}
