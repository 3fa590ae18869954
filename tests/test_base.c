/* Pool, messages, statuses. */
#include "support.h"

#include <limits.h>

/* ---- an allocator that hands out dirty memory and sees writes behind a block */

#define GUARD 64

struct guarded {
    rotid_allocator allocator;
    int until_failure, in_use, overwritten; /* until_failure as in support.h */
};

static void *guarded_allocate(void *context, size_t bytes)
{
    struct guarded *guarded = context;
    if (guarded->until_failure > 0 && --guarded->until_failure == 0)
        return NULL;
    char *block = malloc(sizeof(max_align_t) + bytes + GUARD);
    if (!block)
        return NULL;
    memcpy(block, &bytes, sizeof bytes);
    memset(block + sizeof(max_align_t), 0xA5, bytes + GUARD);
    guarded->in_use++;
    return block + sizeof(max_align_t);
}

static void guarded_release(void *context, void *payload)
{
    struct guarded *guarded = context;
    char *block = (char *)payload - sizeof(max_align_t);
    size_t bytes;
    memcpy(&bytes, block, sizeof bytes);
    for (int i = 0; i < GUARD; i++)
        guarded->overwritten += (unsigned char)((char *)payload)[bytes + (size_t)i] != 0xA5;
    guarded->in_use--;
    free(block);
}

static void guarded_open(struct guarded *guarded, int fail_at)
{
    *guarded = (struct guarded){{guarded_allocate, guarded_release, guarded}, fail_at, 0, 0};
}

/* ---- pool */

UNIT_TEST(blocks_are_zeroed_aligned_and_apart)
{
    struct guarded guarded;
    struct pool pool;
    guarded_open(&guarded, 0);
    pool_open(&pool, &guarded.allocator);
    unsigned char *block[40];
    for (size_t i = 0; i < 40; i++) {
        block[i] = pool_get(&pool, i, 3);
        assert_non_null(block[i]);
        assert_int_equal((uintptr_t)block[i] % _Alignof(max_align_t), 0);
        for (size_t b = 0; b < 3 * i; b++)
            assert_int_equal(block[i][b], 0);
        memset(block[i], (int)i, 3 * i);
    }
    for (size_t i = 0; i < 40; i++)
        for (size_t b = 0; b < 3 * i; b++)
            assert_int_equal(block[i][b], i);
    pool_close(&pool);
    assert_int_equal(guarded.in_use, 0);
    assert_int_equal(guarded.overwritten, 0);
    pool_close(&pool); /* a closed pool is an empty one */
}

UNIT_TEST(a_product_that_overflows_asks_for_nothing)
{
    struct failing_allocator failing;
    struct pool pool;
    failing_allocator_open(&failing, 0);
    pool_open(&pool, &failing.allocator);
    assert_null(pool_get(&pool, SIZE_MAX, 2));
    assert_null(pool_get(&pool, 2, SIZE_MAX));
    assert_null(pool_get(&pool, SIZE_MAX, 1)); /* no room for the pool's own header */
    assert_null(pool_get(&pool, SIZE_MAX / 8 + 1, 8));
    assert_null(POOL_ARRAY(&pool, double, -1)); /* a negative count is a huge one */
    size_t capacity = SIZE_MAX / 2 + 1;
    int element = 7;
    assert_null(pool_grow(&pool, &element, capacity, &capacity, 1)); /* twice that wraps to zero */
    assert_int_equal(capacity, SIZE_MAX / 2 + 1);
    assert_int_equal(failing.served, 0);
    assert_non_null(pool_get(&pool, SIZE_MAX, 0));
    assert_int_equal(failing.served, 1);
    pool_close(&pool);
    assert_int_equal(failing.in_use, 0);
}

UNIT_TEST(a_growing_array_keeps_its_elements)
{
    struct guarded guarded;
    struct pool pool;
    guarded_open(&guarded, 0);
    pool_open(&pool, &guarded.allocator);
    long *array = NULL;
    size_t capacity = 0, copies = 0;
    for (size_t count = 0; count < 1000; count++) {
        long *grown = pool_grow(&pool, array, count, &capacity, sizeof *array);
        assert_non_null(grown);
        copies += grown != array;
        array = grown;
        assert_true(count < capacity);
        array[count] = (long)(count * count);
    }
    for (size_t i = 0; i < 1000; i++)
        assert_int_equal(array[i], i * i);
    assert_true(copies <= 10); /* it doubles: 8 ... 1024 are eight copies, a step of one would be a thousand */
    pool_close(&pool);
    assert_int_equal(guarded.overwritten, 0);
}

UNIT_TEST(an_array_that_cannot_grow_stays_valid)
{
    struct failing_allocator failing;
    struct pool pool;
    failing_allocator_open(&failing, 2);
    pool_open(&pool, &failing.allocator);
    size_t capacity = 0;
    int *array = pool_grow(&pool, NULL, 0, &capacity, sizeof *array);
    assert_non_null(array);
    for (size_t i = 0; i < capacity; i++)
        array[i] = (int)i;
    size_t before = capacity;
    assert_null(pool_grow(&pool, array, capacity, &capacity, sizeof *array));
    assert_int_equal(capacity, before);
    for (size_t i = 0; i < capacity; i++)
        assert_int_equal(array[i], i);
    pool_close(&pool);
    assert_int_equal(failing.in_use, 0);
}

UNIT_TEST(texts_are_copied_and_formatted_at_any_length)
{
    struct pool pool;
    char source[] = "core.E", longest[5000];
    pool_open(&pool, NULL);
    char *copy = pool_copy_text(&pool, source);
    source[0] = 'x';
    assert_string_equal(copy, "core.E");
    assert_string_equal(pool_copy_text(&pool, ""), "");
    assert_string_equal(pool_format(&pool, "%s = %d", "n", -3), "n = -3");
    assert_string_equal(pool_format(&pool, "%s", ""), "");
    memset(longest, 'q', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    assert_string_equal(pool_format(&pool, "%s", longest), longest);
    pool_close(&pool);
}

/* Everything a pool does, to its end or to the first failure. Returns whether it reached the end. */
static int use_pool(struct pool *pool)
{
    size_t capacity = 0;
    int *array = NULL;
    if (!pool_get(pool, 100, 8) || !pool_get(pool, 0, 8) || !pool_copy_text(pool, "text") || !pool_format(pool, "%d", 12345))
        return 0;
    for (size_t count = 0; count < 50; count++) {
        int *grown = pool_grow(pool, array, count, &capacity, sizeof *array);
        if (!grown)
            return 0;
        array = grown;
        array[count] = 1;
    }
    return 1;
}

UNIT_TEST(nothing_is_left_behind_whichever_allocation_fails)
{
    int completed = 0, failures = 0;
    for (long n = 1; !completed; n++) {
        struct failing_allocator failing;
        struct pool pool;
        failing_allocator_open(&failing, n);
        pool_open(&pool, &failing.allocator);
        completed = use_pool(&pool);
        failures += !completed;
        assert_int_equal(failing.in_use, completed ? failing.served : n - 1);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
    }
    assert_int_equal(failures, 8); /* four blocks, arrays of 8, 16, 32, 64 */
}

/* ---- messages */

UNIT_TEST(messages_are_kept_in_order_with_their_place)
{
    struct pool pool;
    struct message_list list;
    char file[] = "deck.inp", word[] = "MESH";
    pool_open(&pool, NULL);
    message_open(&list, &pool);
    message_add(&list, SEVERITY_ERROR, file, 12, 3, "%s: %d values", word, 4);
    message_add(&list, SEVERITY_WARNING, NULL, 0, 0, "warned");
    message_add(&list, SEVERITY_NOTE, file, 13, 0, "noted");
    file[0] = word[0] = 'X'; /* the list has its own copies */
    assert_int_equal(list.count, 3);
    assert_int_equal(list.errors, 1);
    assert_int_equal(pool.out_of_memory, 0);
    assert_int_equal(list.item[0].severity, SEVERITY_ERROR);
    assert_string_equal(list.item[0].file, "deck.inp");
    assert_string_equal(list.item[0].text, "MESH: 4 values");
    assert_int_equal(list.item[0].line, 12);
    assert_int_equal(list.item[0].column, 3);
    assert_int_equal(list.item[1].severity, SEVERITY_WARNING);
    assert_null(list.item[1].file);
    assert_int_equal(list.item[2].severity, SEVERITY_NOTE);
    assert_string_equal(list.item[2].text, "noted");
    pool_close(&pool);
}

UNIT_TEST(messages_past_the_limit_are_counted_only)
{
    struct failing_allocator failing;
    struct pool pool;
    struct message_list list;
    failing_allocator_open(&failing, 0);
    pool_open(&pool, &failing.allocator);
    message_open(&list, &pool);
    for (int i = 0; i < 2 * MESSAGE_LIMIT; i++)
        message_add(&list, i % 2 ? SEVERITY_ERROR : SEVERITY_WARNING, "f", i, 0, "number %d", i);
    long served = failing.served;
    for (int i = 0; i < 1000; i++)
        message_add(&list, i % 4 ? SEVERITY_ERROR : SEVERITY_NOTE, "f", i, 0, "too many");
    assert_int_equal(list.count, 2 * MESSAGE_LIMIT);
    assert_int_equal(list.errors, MESSAGE_LIMIT + 750);
    assert_int_equal(failing.served, served); /* a binary file must not fill the memory */
    for (int i = 0; i < 2 * MESSAGE_LIMIT; i++)
        assert_int_equal(list.item[i].line, i);
    assert_string_equal(list.item[2 * MESSAGE_LIMIT - 1].text, "number 399");
    message_open(&list, &pool);
    for (int i = 0; i < 1000; i++)
        message_add(&list, SEVERITY_WARNING, "f", i, 0, "doubtful");
    message_add(&list, SEVERITY_ERROR, "f", 1000, 0, "why it is refused");
    assert_int_equal(list.count, MESSAGE_LIMIT + 1);
    assert_string_equal(list.item[MESSAGE_LIMIT].text, "why it is refused");
    pool_close(&pool);
}

UNIT_TEST(a_long_message_is_cut_not_overrun)
{
    struct pool pool;
    struct message_list list;
    char text[3000];
    memset(text, 'w', sizeof text - 1);
    text[sizeof text - 1] = 0;
    pool_open(&pool, NULL);
    message_open(&list, &pool);
    message_add(&list, SEVERITY_NOTE, NULL, 0, 0, "%s", text);
    size_t length = strlen(list.item[0].text);
    assert_true(length > 100 && length < 3000);
    assert_int_equal(strspn(list.item[0].text, "w"), length);
    pool_close(&pool);
}

/* Memory that fails once and comes back: the list stays sound, keeps what it can and says that something is missing. */
UNIT_TEST(messages_survive_a_failed_allocation)
{
    for (int n = 1; n <= 45; n++) {
        struct guarded guarded;
        struct pool pool;
        struct message_list list;
        guarded_open(&guarded, n);
        pool_open(&pool, &guarded.allocator);
        message_open(&list, &pool);
        for (int i = 0; i < 20; i++) /* 20 * 2 texts and the arrays of 8, 16, 32 */
            message_add(&list, SEVERITY_ERROR, "f", i, 0, "number %d", i);
        int failed = guarded.until_failure == 0;
        assert_int_equal(failed, n <= 43);
        assert_int_equal(list.errors, 20);
        assert_int_equal(pool.out_of_memory, failed);
        assert_int_equal(list.count, failed ? 19 : 20);
        for (size_t k = 0; k < list.count; k++) {
            char expected[32];
            (void)snprintf(expected, sizeof expected, "number %d", list.item[k].line);
            assert_string_equal(list.item[k].text, expected);
        }
        pool_close(&pool);
        assert_int_equal(guarded.overwritten, 0);
        assert_int_equal(guarded.in_use, 0);
    }
}

/* ---- statuses */

struct status {
    int value;
    const char *name, *text;
};

static const struct status statuses[] = {
#define STATUS_ROW(name, value, text) {name, #name, text},
    ROTID_STATUS_LIST(STATUS_ROW)
#undef STATUS_ROW
};

enum { nstatus = sizeof statuses / sizeof *statuses };

UNIT_TEST(every_status_has_its_own_name_and_text)
{
    assert_int_equal(ROTID_OK, 0);
    for (int i = 0; i < nstatus; i++) {
        assert_string_equal(rotid_status_name(statuses[i].value), statuses[i].name);
        assert_string_equal(rotid_status_text(statuses[i].value), statuses[i].text);
        assert_true((strncmp(statuses[i].name, "ROTID_ERROR_", 12) == 0) == (statuses[i].value < 0));
        assert_true((strncmp(statuses[i].name, "ROTID_STOP_", 11) == 0) == (statuses[i].value > 0));
        for (int j = 0; j < i; j++) {
            assert_int_not_equal(statuses[i].value, statuses[j].value);
            assert_string_not_equal(statuses[i].text, statuses[j].text);
        }
    }
}

UNIT_TEST(three_statuses_tell_a_minimum)
{
    for (int i = 0; i < nstatus; i++)
        assert_int_equal(rotid_status_converged(statuses[i].value), statuses[i].value >= 1 && statuses[i].value <= 3);
}

UNIT_TEST(other_values_are_unknown_statuses)
{
    const int value[] = {INT_MIN, -1000, -16, 7, 1000, INT_MAX};
    for (size_t i = 0; i < sizeof value / sizeof *value; i++) {
        assert_string_equal(rotid_status_text(value[i]), "unknown status");
        assert_string_equal(rotid_status_name(value[i]), "unknown status");
    }
}

UNIT_TEST(the_median_is_the_middle_one_or_the_mean_of_the_middle_two)
{
    double odd[] = {7, -1, 3}, even[] = {10, 1, 2, 4};
    assert_true(median_of(3, odd) == 3 && median_of(4, even) == 3 && isnan(median_of(0, odd)));
}
