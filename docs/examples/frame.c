/* A 3-D frame of its host's own, whose modes do not fit: rotid_diagnose_model says which member has lost stiffness, or where a
 * mass was left. The measured modes are made here, with noise, from the frame with a member at 60 % of its stiffness. C and C++.
 */
#include <math.h>
#include <rotid.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A tower of three storeys, four posts 0.40 m by 0.30 m apart, clamped at its foot; node 4 floor + post, each with u, v, w and
 * three rotations; nodes 0 to 3 are held. */
enum { FLOORS = 3, POSTS = 4, NODES = POSTS * FLOORS, N = 6 * NODES, KD = 6 * 6 - 1, MEMBERS = 9 * FLOORS, MODES = 8 };
enum { MASTERS = 2 * NODES, SUSPECTS = 5 * FLOORS, CAUSES = SUSPECTS + POSTS }; /* posts and diagonals, masses at the top */
static int ends[MEMBERS][2], members, master[MASTERS];
static double unit_k[MEMBERS][144], unit_m[MEMBERS][144]; /* of every member, for E = 1 */
static const double side[3] = {0.40, 0.30, 0.50}, area = 3e-4, bend = 3e-8, twist = 6e-8, rho = 7850, nu = 0.3;

static void place(int node, double *at)
{
    int post = node % POSTS;
    at[0] = post == 1 || post == 2 ? side[0] : 0;
    at[1] = post > 1 ? side[1] : 0;
    at[2] = side[2] * (node / POSTS);
}

/* K and M [12 * 12] of a member for E = 1, along its axis and across: rods, shafts and Timoshenko beams of a tube; turned into x,
 * y, z. */
static void member_matrices(const int *end, double *k, double *m)
{
    double a[3], b[3], t[3][3], length = 0, local[2][144];
    place(end[0], a);
    place(end[1], b);
    for (int i = 0; i < 3; i++)
        length += (b[i] - a[i]) * (b[i] - a[i]);
    length = sqrt(length);
    for (int i = 0; i < 3; i++)
        t[0][i] = (b[i] - a[i]) / length;
    int up = fabs(t[0][2]) > 0.9; /* any direction that the member has not: its section is round */
    double cross[3] = {up ? t[0][2] : t[0][1], up ? 0 : -t[0][0], up ? -t[0][0] : 0}, size = 0;
    for (int i = 0; i < 3; i++)
        size += cross[i] * cross[i];
    for (int i = 0; i < 3; i++)
        t[1][i] = cross[i] / sqrt(size);
    for (int i = 0; i < 3; i++)
        t[2][i] = t[0][(i + 1) % 3] * t[1][(i + 2) % 3] - t[0][(i + 2) % 3] * t[1][(i + 1) % 3];
    memset(local, 0, sizeof local);
    for (int c = 0; c < 2; c++) { /* along, and about the axis */
        int i = c ? 3 : 0, j = i + 6;
        double stiff = c ? twist / (2 * (1 + nu)) / length : area / length, mass = rho * (c ? twist : area) * length / 6;
        local[0][13 * i] = local[0][13 * j] = stiff;
        local[0][i + 12 * j] = local[0][j + 12 * i] = -stiff;
        local[1][13 * i] = local[1][13 * j] = 2 * mass;
        local[1][i + 12 * j] = local[1][j + 12 * i] = mass;
    }
    double stiffness[16], mass[16], shear = 0.53 * area / (2 * (1 + nu));
    rotid_element_stiffness(bend, shear, length, stiffness); /* of v1, theta1, v2, theta2, theta = -dv/dz */
    rotid_element_mass(rho * area, rho * bend, 12 * bend / (shear * length * length), length, mass);
    for (int plane = 0; plane < 2; plane++) {
        const int dof[4] = {1 + plane, 5 - plane, 7 + plane, 11 - plane};
        const double sign[4] = {1, plane ? 1. : -1., 1, plane ? 1. : -1.};
        for (int q = 0; q < 4; q++)
            for (int p = 0; p < 4; p++) {
                local[0][dof[p] + 12 * dof[q]] = sign[p] * sign[q] * stiffness[p + 4 * q];
                local[1][dof[p] + 12 * dof[q]] = sign[p] * sign[q] * mass[p + 4 * q];
            }
    }
    for (int q = 0; q < 12; q++)
        for (int p = 0; p < 12; p++) {
            double sum[2] = {0, 0};
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    for (int w = 0; w < 2; w++)
                        sum[w] += t[i][p % 3] * local[w][3 * (p / 3) + i + 12 * (3 * (q / 3) + j)] * t[j][q % 3];
            k[p + 12 * q] = sum[0];
            m[p + 12 * q] = sum[1];
        }
}

static int add_member(int member, double stiffness, double mass, rotid_matrix *k, rotid_matrix *m)
{
    double ek[144], em[144];
    int dof[12];
    for (int i = 0; i < 12; i++) {
        dof[i] = 6 * (ends[member][i / 6] - POSTS) + i % 6; /* below zero: held */
        if (dof[i] < 0)
            dof[i] = -1;
    }
    for (int i = 0; i < 144; i++) {
        ek[i] = stiffness * unit_k[member][i];
        em[i] = mass * unit_m[member][i];
    }
    int status = rotid_matrix_add_element(k, 12, dof, ek, NULL);
    return status || mass == 0 ? status : rotid_matrix_add_element(m, 12, dof, em, NULL);
}

/* Two unknowns: E of the posts, E of all other members. */
static int matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    int status = 0;
    (void)user;
    for (int i = 0; i < members && !status; i++)
        status = add_member(i, x[ends[i][1] - ends[i][0] == POSTS ? 0 : 1], 1, k, m);
    return status;
}

/* What the model may lack: a post or a diagonal without the share value[0] of its stiffness, a mass at a node of the top. */
static int suspect[CAUSES]; /* its member or its node */
static int lose(void *user, const double *x, const double *value, rotid_matrix *k, rotid_matrix *m)
{
    int member = *(int *)user;
    return add_member(member, -value[0] * x[ends[member][1] - ends[member][0] == POSTS ? 0 : 1], 0, k, m);
}

static int load(void *user, const double *x, const double *value, rotid_matrix *k, rotid_matrix *m)
{
    int first = 6 * (*(int *)user - POSTS), status = 0;
    (void)x, (void)k;
    for (int i = first; i < first + 3 && !status; i++)
        status = rotid_matrix_add(m, i, i, value[0], NULL);
    return status;
}

static void connect(int a, int b)
{
    ends[members][0] = a < b ? a : b;
    ends[members][1] = a < b ? b : a;
    member_matrices(ends[members], unit_k[members], unit_m[members]);
    members++;
}

/* Posts, the ring of each floor, one diagonal each storey. */
static void build(void)
{
    int c = 0;
    for (int f = 1; f <= FLOORS; f++) {
        for (int p = 0; p < POSTS; p++) {
            suspect[c++] = members;
            connect(POSTS * (f - 1) + p, POSTS * f + p);
            connect(POSTS * f + p, POSTS * f + (p + 1) % POSTS);
        }
        suspect[c++] = members;
        connect(POSTS * (f - 1), POSTS * f + 1);
    }
    for (int p = 0; p < POSTS; p++)
        suspect[c++] = POSTS * FLOORS + p;
    for (int i = 0; i < MASTERS; i++) /* sensors along x and y at every node */
        master[i] = 6 * (i / 2) + i % 2;
}

static double noise(void)
{
    double sum = -6;
    for (int i = 0; i < 12; i++)
        sum += (double)rand() / RAND_MAX;
    return sum;
}

/* Frequencies good to 0.05 %, shapes to 1 % of the largest component, of the frame with `share` of a member lost. */
static int measure(int c, double share, double *hz, double *shape)
{
    static double band[2][(KD + 1) * N], phi[N * MODES];
    rotid_matrix k = {N, KD, 0, NULL, band[0], NULL}, m = {N, KD, 0, NULL, band[1], NULL};
    const double x[2] = {2.05e11, 1.9e11};
    double lambda[MODES];
    int status = matrices(NULL, x, &k, &m);
    status = status ? status : lose(&suspect[c], x, &share, &k, &m);
    status = status ? status : rotid_eigenpairs(&k, &m, MODES, NULL, NULL, lambda, phi);
    for (int j = 0; j < MODES && !status; j++) {
        double largest = 0;
        hz[j] = sqrt(lambda[j]) / 6.283185307179586 * (1 + 5e-4 * noise());
        for (int s = 0; s < MASTERS; s++)
            largest = fmax(largest, fabs(phi[master[s] + N * j]));
        for (int s = 0; s < MASTERS; s++)
            shape[s + MASTERS * j] = phi[master[s] + N * j] / largest + 0.01 * noise();
    }
    return status;
}

int main(void)
{
    static double hz[MODES], hz_std[MODES], shape[MASTERS * MODES], shape_std[MASTERS * MODES];
    static rotid_host_cause cause[CAUSES];
    static int number[MODES];
    const rotid_parameter moduli[2] = {{"posts.E", "Pa", 1e11, 3e11, 2e11}, {"rings.E", "Pa", 1e11, 3e11, 2e11}};
    const rotid_parameter lost = {"share", "1", 0, 0.95, 0.1}, mass = {"mass", "kg", 0, 20, 0.5};
    const double expected[2] = {0.3, 2};
    char failure[ROTID_FAILURE_LENGTH] = "";
    rotid_model model;
    rotid_measured measured;
    rotid_host_diagnosis *found = NULL;
    build();
    if (measure(1, 0.4, hz, shape) != ROTID_OK)
        return 1;
    for (int j = 0; j < MODES; j++) {
        number[j] = j + 1;
        hz_std[j] = 5e-4;
        for (int s = 0; s < MASTERS; s++)
            shape_std[s + MASTERS * j] = 0.01;
    }
    for (int c = 0; c < CAUSES; c++) {
        cause[c].size = sizeof *cause;
        cause[c].name = c < SUSPECTS ? "member" : "mass at node";
        cause[c].nparameter = 1;
        cause[c].parameter = c < SUSPECTS ? &lost : &mass;
        cause[c].deviation = &expected[c >= SUSPECTS];
        cause[c].add = c < SUSPECTS ? lose : load;
        cause[c].user = &suspect[c];
    }
    memset(&model, 0, sizeof model);
    model.size = sizeof model;
    model.n = N;
    model.kd = KD;
    model.nparam = 2;
    model.nmaster = MASTERS;
    model.master = master;
    model.matrices = matrices;
    memset(&measured, 0, sizeof measured);
    measured.size = sizeof measured;
    measured.nmode = MODES;
    measured.number = number;
    measured.frequency_hz = hz;
    measured.frequency_std = hz_std;
    measured.shape = shape;
    measured.shape_std = shape_std;
    int status = rotid_diagnose_model(&model, moduli, &measured, CAUSES, cause, NULL, NULL, failure, &found);
    if (status != ROTID_OK) {
        fprintf(stderr, "%s: %s\n", rotid_status_text(status), failure);
        return 1;
    }
    printf("nothing %.3f, something else %.3f\n", found->nothing, found->something_else);
    for (int c = 0; c < CAUSES; c++)
        if (found->probability[c] > 0.01)
            printf("%s %d: probability %.3f\n", cause[c].name, suspect[c], found->probability[c]);
    const rotid_host_explanation *lead = found->explanation;
    for (int i = 0; i < lead->ncause; i++)
        printf("its %s: %.3f +- %.3f\n", cause[lead->cause[i]].parameter->name, lead->value[4 * i], lead->std[4 * i]);
    for (int p = 0; p < 2; p++)
        printf("%s = %.4g, 95 %% interval %.4g ... %.4g\n", moduli[p].name, found->mean[p], found->ci_lower[p],
               found->ci_upper[p]);
    rotid_host_diagnosis_free(found);
    return 0;
}
