#include <errno.h>
#ifdef __linux__
#include <malloc.h>
#endif

#include "cli/cli.h"

/* glibc raises the size from which a block is pages of its own to that of the largest block freed so far: matrices then stay in
 * the heap after their use and are cleared by hand where new pages are zero. The rest of the heap is kept: its end would come and
 * go with each pool. */
static void keep_large_blocks_apart(void)
{
#ifdef __GLIBC__
    (void)mallopt(M_MMAP_THRESHOLD, 1 << 20);
    (void)mallopt(M_TRIM_THRESHOLD, 1 << 26);
#endif
}

int main(int argc, char **argv)
{
    keep_large_blocks_apart();
    command_set_signals();
    if (terminal_open())
        return EXIT_INTERNAL;
    int code = command_line(argc, argv);
    if (terminal_flush())
        code = terminal_end(EXIT_INTERNAL, "rotid: cannot write to standard output: %s\n", strerror(errno));
    return code;
}
