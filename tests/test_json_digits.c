/* Arrays of nine digits: the same characters as printf's %.9g, in every range and at every tie. */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/base.h"
#include "result/result.h"

static void same_as_printf(double value)
{
    char expected[80];
    struct json_tree tree;
    json_open(&tree);
    json_digits(&tree, tree.root, "a", 1, &value);
    char *text = json_close_line(&tree);
    assert_non_null(text);
    (void)snprintf(expected, sizeof expected, "{\"a\":[%.9g]}\n", value);
    assert_string_equal(text, expected);
    json_free(text);
}

UNIT_TEST(test_digits)
{
    static const double number[] = {
        0,           -0.0,     1,           -1,          0.1,         0.5,         9.99999999949, 9.9999999995,
        999999999,   1e9,      999999999.5, 999999999.4, 100000000.5, 123456789.5, 1e-4,          9.99999999e-5,
        99999.99995, 1e-5,     1e-13,       1e-14,       1e29,        1e30,        5e-324,        1.7976931348623157e308,
        1.5,         1024.125, 1e22,        1e23,        123456,      -0.000123456};
    struct random_stream stream = {1};
    for (size_t i = 0; i < sizeof number / sizeof *number; i++)
        same_as_printf(number[i]);
    for (int i = 0; i < 100000; i++)
        same_as_printf(random_normal(&stream) * pow(10, i % 60 - 30));
    for (int i = 0; i < 20000; i++) /* numbers with few digits, and halves of the ninth */
        same_as_printf((double)(i * 7919L % 1000003) * pow(10, i % 20 - 12) + (i % 2 ? 0.5 : 0.0));
    for (int i = -12; i < 30; i++) {
        same_as_printf(pow(10, i));
        same_as_printf(nextafter(pow(10, i), 0));
        same_as_printf(nextafter(pow(10, i), INFINITY));
    }
}

UNIT_TEST(test_rows_and_gaps)
{
    const double value[] = {1, NAN, 3.25, INFINITY};
    struct json_tree tree;
    json_open(&tree);
    json_digit_rows(&tree, tree.root, "a", 2, 2, value);
    char *text = json_close_line(&tree);
    assert_string_equal(text, "{\"a\":[[1,3.25],[null,null]]}\n");
    json_free(text);
}
