/* The only file that knows which BLAS this is. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS. NOLINT(bugprone-reserved-identifier) */

#include <cblas.h>
#include <sys/mman.h>
#include <unistd.h>

#include "cli/cli.h"

#if ROTID_OPENBLAS

/* OpenBLAS maps this much for each thread that calls it (BUFFER_SIZE of x86-64 and arm64), and where it cannot have that it tries
 * again, for ever: its own threads as soon as it is loaded, the others in their first call. */
#define BUFFER    ((size_t)128 << 20)
#define LEFT_OVER ((size_t)32 << 20) /* left for what the program itself asks for */
#define THREAD    ((size_t)96 << 20) /* the stack of a thread and the heap that glibc reserves for it, 64 MiB */
#define ALONE     "OPENBLAS_NUM_THREADS="

const char *build_blas(void)
{
    return openblas_get_config();
}

void build_set_threads(int threads)
{
    openblas_set_num_threads(threads);
}

/* For how many threads, up to `wanted`, there is room now: under the limits of address space and data, and where the system
 * promises no more memory than it has. Each piece is mapped as OpenBLAS does it, since limits and promises tell mappings of one
 * kind from another; no page of them is touched. */
static int room_for(int wanted)
{
    void *piece[THREADS_MOST];
    int count = 0;
    while (count < wanted && count < THREADS_MOST) {
        size_t size = BUFFER + (count ? THREAD : LEFT_OVER);
        piece[count] = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (piece[count] == MAP_FAILED)
            break;
        count++;
    }
    for (int i = 0; i < count; i++)
        (void)munmap(piece[i], BUFFER + (i ? THREAD : LEFT_OVER));
    return count;
}

/* Where the threads that OpenBLAS starts when it is loaded have no room, the program begins once more and tells it to start none:
 * what it needs of them it says itself, by build_set_threads. Called before any library is set up, by .preinit_array, since
 * afterwards these threads hold even the end of the program; from there the environment can be changed in no other way. */
static void begin(int argc, char **argv, char **environment)
{
    char path[4096];
    int count = 0, processors = (int)sysconf(_SC_NPROCESSORS_CONF), most = 2 * processors; /* with as many of a diagnosis */
    (void)argc;
    if (processors < 2 || room_for(most) >= (most < THREADS_MOST ? most : THREADS_MOST))
        return;
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    while (environment[count] && strcmp(environment[count], ALONE "1"))
        count++;
    if (length < 0 || environment[count])
        return;
    path[length] = 0;
    char *changed[count + 2];
    changed[0] = (char[]){ALONE "1"};
    for (int i = 0, kept = 1; i <= count; i++)
        if (!environment[i] || strncmp(environment[i], ALONE, strlen(ALONE)))
            changed[kept++] = environment[i];
    (void)execve(path, argv, changed);
}

__attribute__((section(".preinit_array"), used)) static void (*const begin_first)(int, char **, char **) = begin;

int build_make_room(int wanted, int asked)
{
    double one = 1, other = 1, product = 0;
    /* its own threads may have their buffers, or not yet */
    int others = openblas_get_num_threads() - 1, room = room_for(wanted + others) - others;
    if (room < 1)
        return terminal_end(
            0,
            "rotid: too little address space: OpenBLAS needs %zu MiB in one piece, and the program some beside it; "
            "expected more (ulimit -v, ulimit -d)\n",
            BUFFER >> 20);
    if (room < wanted && asked)
        return terminal_end(
            0, "rotid: --threads %d: there is address space for %d, expected no more than these, or more of it (ulimit -v)\n",
            wanted, room);
    /* the buffer of this thread is taken now, before anything else takes its room */
    cblas_dsymm(CblasColMajor, CblasLeft, CblasLower, 1, 1, 1, &one, 1, &other, 1, 0, &product, 1);
    return room;
}

#else

const char *build_blas(void)
{
    return ROTID_BLAS;
}

void build_set_threads(int threads)
{
    (void)threads;
}

int build_make_room(int wanted, int asked)
{
    (void)asked;
    return wanted;
}

#endif
