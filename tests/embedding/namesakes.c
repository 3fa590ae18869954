/* A host whose own routines have the names of rotid's internal ones: they must not meet, neither when this is linked nor when it
 * runs. Prints "ok" and returns 0 where both do what they are for. */
#include <math.h>
#include <stdio.h>

#include "rotid.h"

struct pool;
static int called;
void *pool_open(struct pool *pool, const void *allocator);
void *pool_get(struct pool *pool, size_t count, size_t size);
int matrix_add(int a, int b);
int fit(void);
void sort_doubles(int count, double *x);
int deck_read_states(void);

void *pool_open(struct pool *pool, const void *allocator)
{
    (void)pool, (void)allocator;
    called++;
    return NULL;
}

void *pool_get(struct pool *pool, size_t count, size_t size)
{
    (void)pool, (void)count, (void)size;
    called++;
    return NULL;
}

int matrix_add(int a, int b)
{
    called++;
    return a + b;
}

int fit(void)
{
    called++;
    return 7;
}

void sort_doubles(int count, double *x)
{
    (void)count, (void)x;
    called++;
}

int deck_read_states(void)
{
    called++;
    return 8;
}

/* Two masses of 2 kg between springs x[0] and x[1]. */
static int matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    (void)user;
    k->band[0] = x[0] + x[1];
    k->band[1] = -x[1];
    k->band[2] = x[1];
    m->band[0] = m->band[2] = 2;
    return 0;
}

int main(void)
{
    const int number[] = {1, 2};
    /* of x = {1e4, 1e4} */
    const double hz[] = {sqrt(2500 * (3 - sqrt(5))) / (8 * atan(1)), sqrt(2500 * (3 + sqrt(5))) / (8 * atan(1))};
    rotid_model model = {.size = sizeof model, .n = 2, .kd = 1, .nparam = 2, .matrices = matrices};
    rotid_parameter parameter[] = {{"ground", "N/m", 1e3, 1e6, 1.5e4}, {"joint", "N/m", 1e3, 1e6, 8e3}};
    rotid_measured measured = {.size = sizeof measured, .nmode = 2, .number = number, .frequency_hz = hz};
    rotid_fit_options options = {.size = sizeof options, .functional = ROTID_HYBRID, .reduction = ROTID_REDUCTION_NONE};
    rotid_fit_result *result = NULL;
    int status = rotid_fit(&model, parameter, &measured, &options, NULL, NULL, &result);
    if (status || called) {
        printf("%s, %d calls of the host's own routines\n", rotid_status_name(status), called);
        return 1;
    }
    double product = result->x[0] * result->x[1]; /* the determinant of K, so of 4 w1^2 w2^2: both solutions of the fit have it */
    rotid_fit_free(result);
    if (!(fabs(product / 1e8 - 1) < 1e-9)) {
        printf("the stiffnesses multiply to %.10g instead of 1e8\n", product);
        return 1;
    }
    pool_open(NULL, NULL);
    pool_get(NULL, 1, 1);
    sort_doubles(0, NULL);
    if (matrix_add(2, 3) != 5 || fit() != 7 || deck_read_states() != 8 || called != 6)
        return 2;
    printf("ok %s\n", rotid_version());
    return 0;
}
