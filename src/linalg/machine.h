/* Kernels that are worth an own version for each kind of processor. */
#ifndef ROTID_LINALG_MACHINE_H
#define ROTID_LINALG_MACHINE_H

/* Put before a static function (a loader would export the choice of any other one): it is compiled for vectors of four as well,
 * where compiler and loader can choose between versions. The numbers are the same on all machines, since a product and a sum stay
 * two operations. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) &&                                 \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define EACH_MACHINE __attribute__((target_clones("avx", "default")))
#else
#define EACH_MACHINE
#endif

/* Four numbers in a row, at any address of a double, and those that begin at one */
typedef double four __attribute__((vector_size(32), aligned(8), may_alias));
#define FOUR(from) (*(const four *)(from))

#endif
