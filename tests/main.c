/* Of the test programs that have no main of their own: runs all, or those whose names match the pattern given. */
#include "support.h"

int main(int argc, char **argv)
{
    return test_main(argc, argv);
}
