/* The public header beside the snapshot of it that hosts may have been compiled with, include/rotid.abi. With --write this
 * program writes the snapshot anew (make abi); --unreleased: also where hosts of the old one would break. */
#include "abi.h"
#include "support.h"

#define HEADER   ROTID_SOURCE_DIR "/include/rotid.h"
#define SNAPSHOT ROTID_SOURCE_DIR "/include/rotid.abi"

static const char heading[] =
    "# What hosts of this major version rely on, from rotid.h: written by `make abi`, see CONTRIBUTING.md.\n";

/* What stands below the heading of the snapshot, or NULL. */
static const char *read_snapshot(struct pool *pool)
{
    enum { MOST = 1 << 20 };
    FILE *stream = fopen(SNAPSHOT, "r");
    char *text = pool_get(pool, MOST, 1);
    size_t length = stream && text ? fread(text, 1, MOST - 1, stream) : 0;
    if (stream)
        (void)fclose(stream);
    return length && text[0] == '#' ? text + strcspn(text, "\n") + 1 : NULL;
}

static const char *text_of(struct pool *pool, const char *source)
{
    struct header header;
    if (header_parse(pool, source, &header)) {
        print_error("line %d: %s\n", header.line, header.error);
        return NULL;
    }
    return abi_text(pool, &header);
}

POOL_TEST(hosts_of_this_major_version_still_run)
{
    struct header header;
    const char *report, *snapshot = read_snapshot(&test_pool);
    if (header_read(&test_pool, HEADER, &header))
        fail_msg("rotid.h:%d: %s", header.line, header.error);
    if (!snapshot || strtol(snapshot + strlen("major "), NULL, 10) != abi_major(&header))
        fail_msg("include/rotid.abi is not of version %ld: write it with `make abi`", abi_major(&header));
    switch (abi_compare(&test_pool, snapshot, abi_text(&test_pool, &header), &report)) {
    case ABI_BROKEN:
        fail_msg(
            "hosts that were compiled before break:\n%s"
            "Raise ROTID_VERSION_MAJOR (and ROTID_VERSION with it), which changes the soname of the shared library, then `make "
            "abi`. Where no release has had the old interface: `make abi UNRELEASED=1`.",
            report);
        break;
    case ABI_ADDED:
        fail_msg("the interface has grown:\n%sAdd that to include/rotid.abi with `make abi`.", report);
        break;
    default:
        break;
    }
}

POOL_TEST(all_version_numbers_agree)
{
    struct header header;
    char *end;
    assert_int_equal(header_read(&test_pool, HEADER, &header), 0);
    assert_int_equal(strtol(ROTID_VERSION, &end, 10), ROTID_VERSION_MAJOR);
    assert_int_equal(*end, '.');
    assert_int_equal(abi_major(&header), ROTID_VERSION_MAJOR);
    assert_string_equal(pool_format(&test_pool, "%d.%d.%d", ROTID_VERSION_MAJOR, ROTID_VERSION_MINOR, ROTID_VERSION_PATCH),
                        ROTID_VERSION);
    assert_string_equal(rotid_version(), ROTID_VERSION);
}

POOL_TEST(structs_that_may_grow_are_handed_out_one_at_a_time)
{
    struct header header;
    const char *why;
    int count = 0;
    assert_int_equal(header_read(&test_pool, HEADER, &header), 0);
    for (int i = 0; i < header.nstruct; i++) {
        const char *name = header.structure[i].name;
        count += abi_may_grow(name);
        if (abi_may_grow(name) && abi_cannot_grow(&header, name, &why))
            fail_msg("%s cannot grow: %s", name, why);
    }
    assert_int_equal(count, 9); /* all of the list are there */
    assert_int_equal(abi_cannot_grow(&header, "rotid_verdict", &why), 1);
    assert_string_equal(why, "it stands in another struct by value");
    assert_int_equal(abi_cannot_grow(&header, "rotid_lm_options", &why), 1);
    assert_string_equal(why, "no routine hands it out by its address");
}

/* What a host fills says its size, or it stands in the list of what never grows. */
POOL_TEST(structs_of_hosts_say_their_size)
{
    static const char *const fixed[] = {"rotid_allocator", "rotid_parameter", "rotid_matrix", "rotid_lm_result"};
    static const char *const sized[] = {
        "rotid_environment", "rotid_diagnose_options", "rotid_suggest_options", "rotid_speeds_options",
        "rotid_model",       "rotid_measured",         "rotid_state",           "rotid_fit_options",
        "rotid_lm_options",  "rotid_host_cause",       "rotid_host_options"};
    struct header header;
    int count = 0;
    assert_int_equal(header_read(&test_pool, HEADER, &header), 0);
    for (int i = 0; i < header.nstruct; i++)
        count += abi_says_its_size(&header.structure[i]);
    assert_int_equal(count, sizeof sized / sizeof *sized);
    for (size_t i = 0; i < sizeof sized / sizeof *sized; i++) {
        const char *why;
        assert_true(abi_says_its_size(header_struct(&header, sized[i])));
        (void)abi_cannot_grow(&header, sized[i], &why);
        assert_string_equal(why, "no routine hands it out by its address"); /* nor does it stand in another one */
    }
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
        assert_false(abi_says_its_size(header_struct(&header, fixed[i])));
}

/* A small interface, and what becomes of it. */
static const char small[] = "#define ROTID_VERSION_MAJOR 0\n#define ROTID_MOST 5\n"
                            "enum { ROTID_A, ROTID_B };\n"
                            "typedef struct rotid_deck { int n; const double *x; void *memory; } rotid_deck;\n"
                            "typedef struct rotid_options { int n; double y[2]; } rotid_options;\n"
                            "typedef struct rotid_sized { size_t size; double y[2]; } rotid_sized;\n"
                            "typedef int (*rotid_call)(void *user, int n);\n"
                            "ROTID_API int rotid_run(const rotid_options *options, rotid_deck **deck);\n"
                            "ROTID_API void rotid_free(rotid_deck *deck);\n";

/* The source with the first `old` in it replaced. */
static const char *changed(const char *old, const char *new)
{
    const char *at = strstr(small, old);
    assert_non_null(at);
    return pool_format(&test_pool, "%.*s%s%s", (int)(at - small), small, new, at + strlen(old));
}

POOL_TEST(every_kind_of_change_is_told)
{
    static const struct {
        const char *old, *new;
        enum abi_change change;
        const char *report;
    } edit[] = {
        {"int n", "int  n", ABI_SAME, ""},
        {"void *user, int n", "void *, int count", ABI_SAME, ""},
        {"ROTID_MOST 5", "ROTID_MOST 6", ABI_BROKEN, "changed: constant ROTID_MOST = 5, now constant ROTID_MOST = 6\n"},
        {"ROTID_A, ROTID_B", "ROTID_B, ROTID_A", ABI_BROKEN,
         "changed: constant ROTID_A = 0, now constant ROTID_A = 1\nchanged: constant ROTID_B = 1, now constant ROTID_B = 0\n"},
        {"ROTID_B", "ROTID_B, ROTID_C", ABI_ADDED, "added: constant ROTID_C = 2\n"},
        {"const double *x", "double *x", ABI_BROKEN,
         "changed: member rotid_deck.x = 2: const double *, now member rotid_deck.x = 2: double *\n"},
        {"void *memory", "void *memory; int more", ABI_ADDED, "added: member rotid_deck.more = 4: int\n"},
        {"void *memory", "int more; void *memory", ABI_BROKEN,
         "changed: member rotid_deck.memory = 3: void *, now member rotid_deck.memory = 4: void *\n"
         "added: member rotid_deck.more = 3: int\n"},
        {"int n; double y[2]", "double y[2]; int n", ABI_BROKEN,
         "changed: member rotid_options.n = 1: int, now member rotid_options.n = 2: int\n"
         "changed: member rotid_options.y = 2: double [2], now member rotid_options.y = 1: double [2]\n"},
        {"y[2]", "y[3]", ABI_BROKEN,
         "changed: member rotid_options.y = 2: double [2], now member rotid_options.y = 2: double [3]\n"},
        {"double y[2];", "double y[2]; int more;", ABI_BROKEN,
         "added to a struct that hosts have by value or in arrays: member rotid_options.more = 3: int\n"},
        {"size_t size; double y[2];", "size_t size; double y[2]; int more;", ABI_ADDED,
         "added: member rotid_sized.more = 3: int\n"},
        {"size_t size; double y[2];", "size_t size; int more; double y[2];", ABI_BROKEN,
         "changed: member rotid_sized.y = 2: double [2], now member rotid_sized.y = 3: double [2]\n"
         "added: member rotid_sized.more = 2: int\n"},
        {"size_t size; ", "", ABI_BROKEN,
         "changed: struct rotid_sized = sized, now struct rotid_sized = fixed\n"
         "removed: member rotid_sized.size = 1: size_t\n"
         "changed: member rotid_sized.y = 2: double [2], now member rotid_sized.y = 1: double [2]\n"},
        {" double y[2];", "", ABI_BROKEN, "removed: member rotid_options.y = 2: double [2]\n"},
        {"int n);", "long n);", ABI_BROKEN,
         "changed: callback rotid_call = int (*)(void *, int), now callback rotid_call = int (*)(void *, long)\n"},
        {"const rotid_options *options", "const rotid_options *options, int n", ABI_BROKEN,
         "changed: function rotid_run = int (const rotid_options *, rotid_deck **), now function rotid_run = int (const "
         "rotid_options *, int, rotid_deck **)\n"},
        {"ROTID_API int rotid_run", "ROTID_API int rotid_start", ABI_BROKEN,
         "removed: function rotid_run = int (const rotid_options *, rotid_deck **)\n"
         "added: function rotid_start = int (const rotid_options *, rotid_deck **)\n"},
        {"ROTID_API void", "typedef struct rotid_new { int n; } rotid_new;\nROTID_API void", ABI_ADDED,
         "added: struct rotid_new = fixed\nadded: member rotid_new.n = 1: int\n"},
        {"ROTID_API void rotid_free(rotid_deck *deck);\n", "", ABI_BROKEN,
         "removed: function rotid_free = void (rotid_deck *)\n"},
    };
    const char *before = text_of(&test_pool, small), *report;
    assert_non_null(before);
    for (size_t i = 0; i < sizeof edit / sizeof *edit; i++) {
        const char *now = text_of(&test_pool, changed(edit[i].old, edit[i].new));
        assert_non_null(now);
        enum abi_change change = abi_compare(&test_pool, before, now, &report);
        assert_string_equal(report, edit[i].report);
        assert_int_equal(change, edit[i].change);
    }
}

/* Returns the exit code. */
static int write_snapshot(int unreleased)
{
    struct pool pool;
    struct header header;
    pool_open(&pool, NULL);
    if (header_read(&pool, HEADER, &header)) {
        (void)fprintf(stderr, "rotid.h:%d: %s\n", header.line, header.error);
        return 1;
    }
    const char *now = abi_text(&pool, &header), *before = read_snapshot(&pool), *report = "";
    if (now && before && strtol(before + strlen("major "), NULL, 10) == abi_major(&header) &&
        abi_compare(&pool, before, now, &report) == ABI_BROKEN && !unreleased) {
        (void)fprintf(stderr,
                      "hosts that were compiled before break:\n%s"
                      "Raise ROTID_VERSION_MAJOR first, or, where no release has had the old interface: make abi UNRELEASED=1\n",
                      report);
        return 1;
    }
    FILE *stream = now ? fopen(SNAPSHOT, "w") : NULL;
    int written = stream && fputs(heading, stream) >= 0 && fputs(now, stream) >= 0;
    if (!stream || fclose(stream) != 0 || !written) {
        perror(SNAPSHOT);
        return 1;
    }
    (void)printf("%sinclude/rotid.abi is written\n", report);
    pool_close(&pool);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--write") == 0)
        return write_snapshot(argc > 2 && strcmp(argv[2], "--unreleased") == 0);
    return test_main(argc, argv);
}
