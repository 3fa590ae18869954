/* Which impacts are found and used, and that it does not matter how they are spread over records. */
#include "support.h"

#include "signal/signal.h"
#include "struck.h"

static const struct struck_mode modes[] = {{40, 0.05, 0.5}, {90, 0.04, -0.3}, {170, 0.03, 0.4}};
static const struct struck hammer = {3, modes, FRF_ACCELERATION, 0.004, 12800};

static struct transfer compute(int nrecord, const struct time_record *record, const struct transfer_options *options)
{
    struct transfer out;
    int bad;
    assert_status(transfer_compute(&test_pool, nrecord, record, hammer.rate, hammer.quantity, options, 1, &out, &bad), ROTID_OK);
    assert_int_equal(bad, -1);
    return out;
}

static struct time_record hits(double seconds, int count, const double *start, const double *peak)
{
    struct time_record record = struck_record((long long)(seconds * hammer.rate));
    for (int k = 0; k < count; k++)
        struck_hit(&hammer, start[k], peak ? peak[k] : 100, record.count, struck_force(&record), struck_response(&record));
    return record;
}

static void assert_truth(const struct transfer *out, double tolerance)
{
    double worst = 0, largest = 0;
    for (int l = 0; l < out->set.nline && out->set.frequency_hz[l] < 200; l++) {
        double complex exact = struck_transfer(&hammer, CMPLX(out->set.window_decay, 2 * PI * out->set.frequency_hz[l]));
        worst = fmax(worst, cabs(out->set.frf[0].h[l] - exact));
        largest = fmax(largest, cabs(exact));
    }
    assert_true(worst < tolerance * largest);
}

POOL_TEST(an_impact_is_where_its_pulse_is)
{
    static const double start[] = {0.1}, peak[] = {250};
    for (int sign = -1; sign <= 1; sign += 2)
        for (int offset = -1; offset <= 1; offset++) {
            struct time_record record = hits(2, 1, start, peak);
            for (long long j = 0; j < record.count; j++)
                struck_force(&record)[j] = sign * record.force[j] + 30 * offset;
            struct transfer out = compute(1, &record, &(struct transfer_options){0});
            assert_int_equal(out.nimpact, 1);
            const struct impact *impact = &out.impact[0];
            /* half-sine: the middle at 2 ms, a tenth of the peak from asin(0.1)/pi to its mirror image */
            assert_int_equal(impact->sample, lround(0.102 * hammer.rate));
            assert_close((double)impact->onset, (0.1 + 0.004 * asin(0.1) / PI) * hammer.rate, 0, 1);
            assert_close(impact->width, 0.004 * (1 - 2 * asin(0.1) / PI), 0, 1.5 / hammer.rate);
            assert_close(impact->peak, 250 * sign, 0.002, 0);
            assert_true(impact->used && !impact->is_double && !impact->is_cut && !impact->is_clipped);
            for (int l = 0; l < out.set.nline; l++)
                out.set.frf[0].h[l] *= sign;
            assert_truth(&out, 1e-3);
        }
}

/* Records of one impact each, and the same impacts in one record, in two, in three. */
POOL_TEST(spreading_impacts_over_records_changes_nothing)
{
    enum { IMPACTS = 12, LENGTH = 12800 };
    static const double start[] = {0.1};
    struct transfer_options options = {.block = 0.8, .force_window = 0.02};
    struct time_record each[IMPACTS], joined = struck_record((long long)IMPACTS * LENGTH);
    uint64_t seed = 4;
    for (int k = 0; k < IMPACTS; k++) {
        each[k] = hits(1, 1, start, NULL);
        struck_noise(&seed, 0.5, LENGTH, struck_response(&each[k]));
        memcpy(struck_force(&joined) + (ptrdiff_t)k * LENGTH, each[k].force, LENGTH * sizeof(double));
        memcpy(struck_response(&joined) + (ptrdiff_t)k * LENGTH, each[k].response, LENGTH * sizeof(double));
    }
    struct transfer one = compute(IMPACTS, each, &options);
    assert_int_equal(one.nimpact, IMPACTS);
    assert_int_equal(one.set.frf[0].averages, IMPACTS);
    for (int parts = 1; parts <= 3; parts++) {
        struct time_record record[3];
        for (int p = 0; p < parts; p++) {
            record[p] = joined;
            record[p].count = joined.count / parts;
            record[p].force += p * record[p].count;
            record[p].response += p * record[p].count;
        }
        struct transfer many = compute(parts, record, &options);
        assert_int_equal(many.nimpact, IMPACTS);
        assert_int_equal(many.set.nline, one.set.nline);
        size_t n = (size_t)one.set.nline;
        assert_memory_equal(many.set.frf[0].h, one.set.frf[0].h, n * sizeof(double complex));
        assert_memory_equal(many.set.frf[0].variance, one.set.frf[0].variance, n * sizeof(double));
        assert_memory_equal(many.set.frf[0].coherence, one.set.frf[0].coherence, n * sizeof(double));
        assert_memory_equal(many.single, one.single, IMPACTS * n * sizeof(double complex));
    }
    assert_truth(&one, 0.05);
}

/* The second impact bounces: left out, or kept and then nothing wrong either, since the response belongs to both pulses. */
POOL_TEST(double_hits_are_told_from_the_next_impact)
{
    static const double start[] = {0.1, 1.6, 1.65, 3.1}, peak[] = {100, 90, 40, 110};
    for (int keep = 0; keep < 2; keep++)
        for (int given = 0; given < 2; given++) {
            struct time_record record = hits(4.6, 4, start, peak);
            struct transfer out = compute(1, &record, &(struct transfer_options){.double_hits = keep, .block = given ? 1.4 : 0});
            assert_int_equal(out.nimpact, 3);
            for (int k = 0; k < 3; k++) {
                assert_int_equal(out.impact[k].is_double, k == 1);
                assert_int_equal(out.impact[k].used, k != 1 || keep);
                assert_int_equal(out.impact[k].record, 0);
            }
            assert_int_equal(out.set.frf[0].averages, keep ? 3 : 2);
            assert_truth(&out, 1e-3);
        }
}

/* Behind an anti-alias filter the force swings on by 0.3 of the pulse, above the threshold, on both sides of its base line. */
POOL_TEST(ringing_of_a_filter_is_no_double_hit)
{
    static const double start[] = {0.1};
    for (int bounce = 0; bounce < 2; bounce++) {
        struct time_record record = hits(2, 1, start, NULL);
        double *force = struck_force(&record);
        for (long long j = 0; j < record.count; j++) {
            double t = (double)j / hammer.rate - 0.104;
            if (t > 0)
                force[j] -= 30 * exp(-t / 0.001) * sin(2 * PI * 1500 * t);
            if (bounce && t > 0.03 && t < 0.033)
                force[j] += 30 * sin(PI * (t - 0.03) / 0.003);
        }
        struct transfer out = compute(1, &record, &(struct transfer_options){.double_hits = 1});
        assert_int_equal(out.nimpact, 1);
        assert_int_equal(out.impact[0].is_double, bounce);
        assert_close(out.impact[0].width, 0.004 * (1 - 2 * asin(0.1) / PI), 0, 1.5 / hammer.rate);
    }
}

/* Half a second is no bounce, however long the record goes on: there the first impact has too little room. */
POOL_TEST(a_quick_second_impact_is_no_double_hit)
{
    static const double start[] = {0.1, 0.6};
    struct time_record record = hits(8, 2, start, NULL);
    struct transfer out = compute(1, &record, &(struct transfer_options){0});
    assert_int_equal(out.nimpact, 2);
    assert_true(!out.impact[0].is_double && out.impact[0].is_cut && !out.impact[0].used);
    assert_true(!out.impact[1].is_double && out.impact[1].used);
    assert_int_equal(compute(1, &record, &(struct transfer_options){.block = 0.48}).set.frf[0].averages, 2);
}

/* The last impact comes just before the record ends, one has no time before it: neither shortens the blocks. */
POOL_TEST(impacts_without_room_are_left_out)
{
    static const double start[] = {-0.002, 1.5, 3, 4.5, 5.9};
    struct time_record record = hits(6, 5, start, NULL);
    struct transfer out = compute(1, &record, &(struct transfer_options){0});
    assert_int_equal(out.nimpact, 5);
    for (int k = 0; k < 5; k++) {
        assert_int_equal(out.impact[k].is_cut, k == 0 || k == 4);
        assert_int_equal(out.impact[k].used, k > 0 && k < 4);
    }
    double length = 1 / out.set.frequency_hz[0]; /* the three have 1.4 ... 1.5 s */
    assert_true(length > 1.2 && length <= 1.41);
    assert_truth(&out, 1e-3);
}

POOL_TEST(all_records_share_the_shortest_block)
{
    static const double start[] = {0.1};
    struct time_record record[] = {hits(3, 1, start, NULL), hits(1, 1, start, NULL), hits(2, 1, start, NULL)};
    for (int r = 0; r < 3; r++)
        record[r].response_node = r;
    struct transfer out = compute(3, record, &(struct transfer_options){.low_hz = 20, .high_hz = 400});
    assert_int_equal(out.set.nfrf, 3);
    double step = out.set.frequency_hz[1] - out.set.frequency_hz[0];
    assert_true(1 / step <= 0.91 && 1 / step > 0.85);
    assert_true(out.set.frequency_hz[0] >= 20 && out.set.frequency_hz[0] < 20 + step);
    assert_true(out.set.frequency_hz[out.set.nline - 1] <= 400 && out.set.frequency_hz[out.set.nline - 1] > 400 - step);
    for (int f = 0; f < 3; f++)
        assert_memory_equal(out.set.frf[f].h, out.set.frf[0].h, (size_t)out.set.nline * sizeof(double complex));
}

POOL_TEST(overload_of_either_channel_is_found)
{
    static const double start[] = {0.1, 1.6}, level[] = {0.5, 0.8, 0.95};
    for (int l = 0; l < 3; l++)
        for (int channel = 0; channel < 2; channel++) {
            struct time_record record = hits(3, 2, start, (const double[]){100, 40});
            double *x = channel ? struck_response(&record) : struck_force(&record), largest = 0;
            for (long long j = 0; j < record.count; j++)
                largest = fmax(largest, fabs(x[j]));
            for (long long j = 0; j < record.count; j++)
                x[j] = fmax(-level[l] * largest, fmin(level[l] * largest, x[j]));
            struct transfer out = compute(1, &record, &(struct transfer_options){0});
            assert_int_equal(out.nimpact, 2);
            assert_true(out.impact[0].is_clipped && !out.impact[0].used);
            assert_true(!out.impact[1].is_clipped && out.impact[1].used);
            assert_truth(&out, 1e-3);
        }
}

/* A converter that resolves the swing in no more than 50 steps makes flat tops, which are no overload. */
POOL_TEST(coarse_steps_are_no_overload)
{
    static const double start[] = {0.1};
    static const int steps[] = {50, 300, 5000, 100000};
    for (int s = 0; s < 4; s++) {
        struct time_record record = hits(2, 1, start, NULL);
        for (int channel = 0; channel < 2; channel++) {
            double *x = channel ? struck_response(&record) : struck_force(&record), largest = 0;
            for (long long j = 0; j < record.count; j++)
                largest = fmax(largest, fabs(x[j]));
            for (long long j = 0; j < record.count; j++)
                x[j] = round(x[j] / largest * steps[s]) * largest / steps[s];
        }
        struct transfer out = compute(1, &record, &(struct transfer_options){0});
        assert_true(!out.impact[0].is_clipped && out.impact[0].used);
    }
}

/* Noise before, during and after the pulse, of 2 % of the peak, makes no second pulse, and the force window takes its energy. */
POOL_TEST(noise_makes_no_impacts)
{
    static const double start[] = {0.1, 1.6, 3.1};
    struct time_record record = hits(4.6, 3, start, NULL);
    uint64_t seed = 77;
    struck_noise(&seed, 2, record.count, struck_force(&record));
    struct transfer with = compute(1, &record, &(struct transfer_options){0});
    struct transfer without = compute(1, &record, &(struct transfer_options){.force_window = -1});
    assert_int_equal(with.nimpact, 3);
    double sum[2] = {0, 0};
    for (int k = 0; k < 3; k++)
        assert_true(with.impact[k].used && !with.impact[k].is_double);
    for (int l = 0; l < with.set.nline; l++) { /* far above the pulse's spectrum there is only noise */
        sum[0] += with.set.frequency_hz[l] > 3000 ? with.single_force[l] : 0;
        sum[1] += with.set.frequency_hz[l] > 3000 ? without.single_force[l] : 0;
    }
    double kept = 0.0457 / 1.4; /* pretrigger, ten widths, 3/8 of the fade, of the block */
    print_message("noise of the force: %.4f of its energy left, %.4f expected\n", sum[0] / sum[1], kept);
    assert_close(sum[0] / sum[1], kept, 0.25, 0);
}

/* An offset of either channel and a window that would let it leak into all lines: taken off by the mean before the impact. */
POOL_TEST(offsets_do_not_leak)
{
    static const double start[] = {0.1};
    struct transfer_options options = {.exponential = 1e-3, .block = 0.8};
    for (int noisy = 0; noisy < 2; noisy++) {
        struct time_record record = hits(2, 1, start, NULL);
        uint64_t seed = 6;
        for (long long j = 0; j < record.count; j++) {
            struck_force(&record)[j] += 20;
            struck_response(&record)[j] -= 500; /* five times the motion */
        }
        struck_noise(&seed, noisy ? 0.01 : 0, record.count, struck_response(&record));
        struct transfer out = compute(1, &record, &options);
        assert_truth(&out, noisy ? 3e-3 : 1e-3);
    }
}

POOL_TEST(the_tail_tells_a_block_that_ends_too_early)
{
    static const double start[] = {0.1};
    struct time_record record = hits(2, 1, start, NULL);
    assert_true(compute(1, &record, &(struct transfer_options){0}).impact[0].tail < 1e-6);
    assert_true(compute(1, &record, &(struct transfer_options){.block = 0.1}).impact[0].tail > 0.2);
    assert_true(compute(1, &record, &(struct transfer_options){.block = 0.1, .exponential = 1e-3}).impact[0].tail < 0.05);
}

UNIT_TEST(spacing_is_that_of_impacts_not_of_bounces)
{
    struct impact pulse[6];
    double work[6];
    memset(pulse, 0, sizeof pulse);
    for (int k = 0; k < 6; k++) { /* each one bounces after 30 samples */
        pulse[k].onset = 100 + 1000 * (k / 2) + 30 * (k % 2);
        pulse[k].width = 0.005;
    }
    assert_int_equal(impact_spacing(6, pulse, 3100, work), 970);
    assert_int_equal(impact_merge(6, pulse, 1000, 97), 3);
    for (int k = 0; k < 3; k++) {
        assert_true(pulse[k].is_double);
        assert_int_equal(pulse[k].onset, 100 + 1000 * k);
        assert_int_equal(impact_room(3, pulse, k, 1000, pulse[k].onset - 10, 3100), k < 2 ? 1005 : 1010);
    }
}
