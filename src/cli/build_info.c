/* The only file that knows which commit this is. */
#include "cli/cli.h"

const char *const build_commit = ROTID_COMMIT;
