/* Kernels that are worth an own version for each kind of processor. */
#ifndef ROTID_LINALG_MACHINE_H
#define ROTID_LINALG_MACHINE_H

/* Put before a function: compiled for vectors of four as well where the compiler and the loader choose at start; the numbers are the same on all machines,
 * since products and sums stay two operations. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EACH_MACHINE __attribute__((target_clones("avx", "default")))
#else
#define EACH_MACHINE
#endif

#endif
