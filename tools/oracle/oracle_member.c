/* Exact matrices of one uniform member.
 *
 * The energies of oracle.h are stationary where
 *     Q' = -lambda rhoS v,                        Q = kGS (v' + theta) + F v',
 *     M' = kGS (v' + theta) - lambda rhoI theta,  M = EI theta',
 * Q and M being what the boundary terms of the variation leave at the right end of a part. Solved for the derivatives, with
 * g = kGS/(kGS + F), since v' + theta = (Q + F theta)/(kGS + F):
 *     v' = Q/(kGS + F) - g theta,   theta' = M/EI,   Q' = -lambda rhoS v,   M' = g Q + (g F - lambda rhoI) theta. */
#include <math.h>
#include <string.h>

#include "oracle_model.h"

void oracle_multiply(const double a[16], const double b[16], double product[16])
{
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++)
            product[4 * i + j] = a[4 * i] * b[j] + a[4 * i + 1] * b[4 + j] + a[4 * i + 2] * b[8 + j] + a[4 * i + 3] * b[12 + j];
    }
}

/* exp(a) by the series on a/2^m and m squarings. With the norm of a/2^m at most 1/2, the first neglected term, 0.5^15/15! =
 * 2e-17, is below rounding. */
static void exponential(const double a[16], double result[16])
{
    double norm = 0.0, scaled[16], next[16];
    int squarings = 0;

    for (int i = 0; i < 4; i++)
        norm = fmax(norm, fabs(a[4 * i]) + fabs(a[4 * i + 1]) + fabs(a[4 * i + 2]) + fabs(a[4 * i + 3]));
    while (norm > 0.5 && squarings < 60) {
        norm *= 0.5;
        squarings++;
    }
    for (int i = 0; i < 16; i++) {
        scaled[i] = ldexp(a[i], -squarings);
        result[i] = i % 5 == 0 ? 1.0 : 0.0;
    }
    for (int term = 14; term > 0; term--) { /* Horner: I + a/1 (I + a/2 (I + ...)) */
        oracle_multiply(scaled, result, next);
        for (int i = 0; i < 16; i++)
            result[i] = next[i] / term + (i % 5 == 0 ? 1.0 : 0.0);
    }
    for (; squarings > 0; squarings--) {
        oracle_multiply(result, result, next);
        memcpy(result, next, sizeof(next));
    }
}

/* Scales the state further so that rows and columns of a come to the same size (Osborne), which makes its norm small: about beta
 * l of a slender member instead of (beta l)^4. Every squaring that is saved saves the rounding that it would have doubled. By
 * powers of two, without rounding. */
static void balance(double a[16], double scale[4])
{
    for (int sweep = 0; sweep < 2; sweep++) {
        for (int i = 0; i < 4; i++) {
            double row = 0.0, column = 0.0, factor;
            for (int j = 0; j < 4; j++) {
                row += fabs(a[4 * i + j]);
                column += fabs(a[4 * j + i]);
            }
            if (row == 0.0 || column == 0.0)
                continue;
            factor = ldexp(1.0, (ilogb(row) - ilogb(column)) / 2);
            for (int j = 0; j < 4; j++) {
                a[4 * i + j] /= factor;
                a[4 * j + i] *= factor;
            }
            scale[i] *= factor;
        }
    }
}

/* In x = z/l the state is scaled to (v/(l h), theta, Q l^2 h/EI, M l/EI) with h = sqrt(1 + s), s = EI/(l^2 (kGS + F)), the ratio
 * of the shear to the bending flexibility. All entries then stay moderate, both for long members (s -> 0) and for slivers (s
 * -> infinity), where a scaling without h would call for needless squarings. */
void oracle_transfer(const struct oracle_segment *segment, double length, double lambda, double transfer[16])
{
    double a[16] = {0};
    double bending = segment->bending, force = bending / (length * length), g = 1.0 / (1.0 + segment->axial / segment->shear);
    double s = force / (segment->shear + segment->axial), h = sqrt(1.0 + s);
    double scale[4] = {length * h, 1.0, force / h, bending / length};

    if (length <= 0.0) {
        for (int i = 0; i < 16; i++)
            transfer[i] = i % 5 == 0 ? 1.0 : 0.0;
        return;
    }
    a[1] = -g / h;
    a[2] = s / (1.0 + s);
    a[7] = 1.0;
    a[8] = -lambda * segment->mass * length * length / force * (1.0 + s);
    a[13] = (g * segment->axial - lambda * segment->inertia) / force;
    a[14] = g / h;
    balance(a, scale);
    exponential(a, transfer);
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++)
            transfer[4 * i + j] *= scale[i] / scale[j];
    }
}

/* With u = (v, theta), p = (Q, M) and the transfer matrix in blocks, u2 = Tuu u1 + Tup p1 and p2 = Tpu u1 + Tpp p1. The end
 * forces are -p1 and p2, hence
 *     D11 = Tup^-1 Tuu,   D12 = -Tup^-1,   D22 = Tpp Tup^-1,   D21 = D12' (reciprocity).
 * Tup is singular exactly where the clamped member resonates; a statically loaded member is far from that: det Tup =
 * l^4/(12 EI^2) + l^2/(kGS EI), from which the terms differ by a factor of three at most, so nothing is lost by cancellation. */
int oracle_dynamic_stiffness(const double transfer[16], double stiffness[16])
{
    const double *t = transfer;
    double determinant = t[2] * t[7] - t[3] * t[6];
    double inverse[4];

    if (determinant == 0.0 || !isfinite(determinant))
        return ORACLE_ERROR_ARGUMENT;
    inverse[0] = t[7] / determinant;
    inverse[1] = -t[3] / determinant;
    inverse[2] = -t[6] / determinant;
    inverse[3] = t[2] / determinant;
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            stiffness[4 * i + j] = inverse[2 * i] * t[j] + inverse[2 * i + 1] * t[4 + j];
            stiffness[4 * i + j + 2] = -inverse[2 * i + j];
            stiffness[4 * (j + 2) + i] = -inverse[2 * i + j];
            stiffness[4 * (i + 2) + j + 2] = t[4 * (i + 2) + 2] * inverse[j] + t[4 * (i + 2) + 3] * inverse[2 + j];
        }
    }
    stiffness[1] = stiffness[4] = 0.5 * (stiffness[1] + stiffness[4]); /* equal but for rounding */
    stiffness[11] = stiffness[14] = 0.5 * (stiffness[11] + stiffness[14]);
    return ORACLE_OK;
}

/* The same with u1 and p2 as the independent ones: with p1 = Tpp^-1 (p2 - Tpu u1), the end forces are the derivatives of
 *     1/2 u1' A u1 + p2' (u2 - B u1) - 1/2 p2' C p2,   A = Tpp^-1 Tpu, B' = Tpp^-1, C = Tup Tpp^-1,
 * where u1 and u2 are to be varied, and p2 as well, which gives u2. Tpp is singular where the member resonates with end 1 clamped
 * and end 2 free; below that C, the flexibility at the free end, is positive definite. */
int oracle_mixed_member(const double transfer[16], double matrix[36])
{
    const double *t = transfer;
    double determinant = t[10] * t[15] - t[11] * t[14];
    double inverse[4], a[4], c[4];

    if (determinant == 0.0 || !isfinite(determinant))
        return ORACLE_ERROR_ARGUMENT;
    inverse[0] = t[15] / determinant;
    inverse[1] = -t[11] / determinant;
    inverse[2] = -t[14] / determinant;
    inverse[3] = t[10] / determinant;
    memset(matrix, 0, 36 * sizeof(matrix[0]));
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            a[2 * i + j] = inverse[2 * i] * t[8 + j] + inverse[2 * i + 1] * t[12 + j];
            c[2 * i + j] = t[4 * i + 2] * inverse[j] + t[4 * i + 3] * inverse[2 + j];
        }
    }
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            matrix[6 * i + j] = 0.5 * (a[2 * i + j] + a[2 * j + i]); /* equal but for rounding */
            matrix[6 * (i + 4) + j + 4] = -0.5 * (c[2 * i + j] + c[2 * j + i]);
            matrix[6 * i + j + 4] = matrix[6 * (j + 4) + i] = -inverse[2 * i + j];
        }
        matrix[6 * (i + 2) + i + 4] = matrix[6 * (i + 4) + i + 2] = 1.0;
    }
    return ORACLE_OK;
}
