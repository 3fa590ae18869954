/* The inputs the fuzzers start from, among them those that once made a reader fail; see make fuzz. */
#include <dirent.h>

#include "fuzz_one.h"
#include "support.h"

enum { LARGEST = 1 << 20 };

/* Hands every file of a folder to a fuzzer's routine and returns how many there were. */
static int run_folder(const char *folder, void (*one)(const uint8_t *, size_t))
{
    uint8_t *bytes = malloc(LARGEST);
    DIR *directory = opendir(folder);
    int count = 0;
    assert_non_null(bytes);
    assert_non_null(directory);
    for (const struct dirent *entry; (entry = readdir(directory));) {
        char path[1024];
        if (entry->d_name[0] == '.')
            continue;
        (void)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        FILE *stream = fopen(path, "rb");
        assert_non_null(stream);
        size_t length = fread(bytes, 1, LARGEST, stream);
        assert_int_equal(fclose(stream), 0);
        one(bytes, length);
        ++count;
    }
    (void)closedir(directory);
    free(bytes);
    return count;
}

UNIT_TEST(universal_files)
{
    assert_true(run_folder(ROTID_SOURCE_DIR "/tests/fuzz/corpus/uff", fuzz_one_uff) > 10);
    assert_true(run_folder(ROTID_SOURCE_DIR "/tests/fuzz/corpus/uff", fuzz_one_import) > 10);
}

UNIT_TEST(decks)
{
    assert_true(run_folder(ROTID_SOURCE_DIR "/tests/fuzz/corpus/deck", fuzz_one_deck) > 3);
}

UNIT_TEST(tables)
{
    assert_true(run_folder(ROTID_SOURCE_DIR "/tests/fuzz/corpus/table", fuzz_one_table) > 3);
}

UNIT_TEST(suggestions)
{
    assert_true(run_folder(ROTID_SOURCE_DIR "/tests/fuzz/corpus/suggest", fuzz_one_suggest) > 2);
}

UNIT_TEST(studies)
{
    assert_true(run_folder(ROTID_SOURCE_DIR "/tests/fuzz/corpus/plan", fuzz_one_plan) > 2);
    assert_true(run_folder(ROTID_SOURCE_DIR "/tests/fuzz/corpus/results", fuzz_one_results) > 2);
}
