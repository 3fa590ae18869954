/* docs/schema stands there as the tables and comments of the structs give it. */
#include "compilers.h"
#include "shell.h"
#include "support.h"

static void the_schemas_are_those_of_the_tables(void **state)
{
    (void)state;
    const char *folder = make_folder(&test_pool);
    (void)shell(&test_pool, "cd '%s' && '%s/schema' '%s' " ROTID_SCHEMA_HEADERS " && diff -r docs/schema '%s'", ROTID_SOURCE_DIR,
                ROTID_BUILD, folder, folder);
    remove_folder(&test_pool, folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_schemas_are_those_of_the_tables, open_test_pool, close_test_pool),
    };
    return cmocka_run_group_tests_name("schema", tests, NULL, NULL);
}
