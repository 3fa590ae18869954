/* The tests of a program, as their definitions enter them before main begins. */
#include "support.h"

#define MOST 200 /* of one program */

static struct CMUnitTest cases[MOST];
static size_t count;
static CMFixtureFunction group_setup, group_teardown;

void test_enter(const char *name, CMUnitTestFunction test, CMFixtureFunction setup, CMFixtureFunction teardown)
{
    if (count == MOST)
        abort();
    cases[count++] = (struct CMUnitTest){name, test, setup, teardown, NULL};
}

void test_enter_group(CMFixtureFunction setup, CMFixtureFunction teardown)
{
    group_setup = setup;
    group_teardown = teardown;
}

int test_main(int argc, char **argv)
{
    const char *slash = strrchr(argv[0], '/');
    if (argc > 1)
        cmocka_set_test_filter(argv[1]);
    return _cmocka_run_group_tests(slash ? slash + 1 : argv[0], cases, count, group_setup, group_teardown);
}
