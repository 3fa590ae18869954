/* The only file that knows which BLAS and which commit this is. */
#include <cblas.h>

#include "cli/command.h"

const char *const build_commit = ROTID_COMMIT;

#ifdef OPENBLAS_VERSION
const char *build_blas(void)
{
    return openblas_get_config();
}

void build_set_threads(int threads)
{
    openblas_set_num_threads(threads);
}
#else
const char *build_blas(void)
{
    return "unknown BLAS";
}

void build_set_threads(int threads)
{
    (void)threads;
}
#endif
