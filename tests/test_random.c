/* The random stream against its published reference and the moments of what it draws. */
#include "support.h"

UNIT_TEST(the_stream_is_splitmix64)
{
    /* first outputs of the authors' C code for the seed 1234567 */
    const uint64_t expected[] = {6457827717110365317u, 3203168211198807973u, 9817491932198370423u, 4593380528125082431u,
                                 16408922859458223821u};
    struct random_stream stream = {1234567};
    for (int i = 0; i < 5; i++)
        assert_close(random_uniform(&stream), ((double)(expected[i] >> 11) + 0.5) / 9007199254740992.0, 0, 0);
}

UNIT_TEST(a_seed_repeats_and_another_does_not)
{
    struct random_stream one = {42}, two = {42}, other = {43};
    int same = 0;
    for (int i = 0; i < 1000; i++) {
        double x = random_normal(&one);
        assert_close(random_normal(&two), x, 0, 0);
        same += random_normal(&other) == x;
    }
    assert_int_equal(same, 0);
}

/* Moments within five standard deviations of their own; N = 4e6. */
UNIT_TEST(random_numbers_have_their_moments)
{
    enum { count = 4000000 };
    struct random_stream stream = {7};
    double u1 = 0, u2 = 0, least = 1, most = 0, m1 = 0, m2 = 0, m3 = 0, m4 = 0, lag = 0, previous = 0;
    int beyond = 0;
    for (int i = 0; i < count; i++) {
        double u = random_uniform(&stream);
        u1 += u - 0.5;
        u2 += (u - 0.5) * (u - 0.5);
        least = fmin(least, u);
        most = fmax(most, u);
    }
    assert_true(least > 0 && least < 5e-6 && most < 1 && most > 1 - 5e-6);
    assert_close(u1 / count, 0, 0, 5 * sqrt(1.0 / 12 / count));
    assert_close(u2 / count, 1.0 / 12, 0, 5 * sqrt(1.0 / 180 / count));
    for (int i = 0; i < count; i++) {
        double x = random_normal(&stream);
        m1 += x;
        m2 += x * x;
        m3 += x * x * x;
        m4 += x * x * x * x;
        lag += x * previous;
        previous = x;
        beyond += fabs(x) > 3;
    }
    assert_close(m1 / count, 0, 0, 5 * sqrt(1.0 / count));
    assert_close(m2 / count, 1, 0, 5 * sqrt(2.0 / count));
    assert_close(m3 / count, 0, 0, 5 * sqrt(15.0 / count));
    assert_close(m4 / count, 3, 0, 5 * sqrt(96.0 / count));
    assert_close(lag / count, 0, 0, 5 * sqrt(1.0 / count));
    assert_close((double)beyond / count, 0.0026997960632601890, 0, 5 * sqrt(0.0027 / count));
}
