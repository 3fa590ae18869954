/* docs/schema stands there as the tables and comments of the structs give it. */
#include "compilers.h"
#include "shell.h"
#include "support.h"

POOL_TEST(the_schemas_are_those_of_the_tables)
{
    const char *folder = make_folder(&test_pool);
    (void)shell(&test_pool, "cd '%s' && '%s/schema' '%s' " ROTID_SCHEMA_HEADERS " && diff -r docs/schema '%s'", ROTID_SOURCE_DIR,
                ROTID_BUILD, folder, folder);
    remove_folder(&test_pool, folder);
}
