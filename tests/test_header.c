/* The reader of rotid.h that the comparisons of the interface rest on: what it reads, and that it passes nothing over. */
#include "header.h"
#include "support.h"

POOL_TEST(declarations_are_read_as_c_means_them)
{
    static const char text[] =
        "#ifndef H\n#define H\n#define H_TEXT \"a /* \\\" b\" /* no */ /* more */\n#define H_COUNT 3 // three\n"
        "#define H_LIST(X) \\\n    X(H_ONE, 1, \"it, 1\") \\\n  X(H_TWO, -2, \"\")\n"
        "#if defined(__GNUC__)\n#define ROTID_API __attribute__((x))\n#else\n#define H_NOT 1\n#endif\n"
        "#ifdef __cplusplus\nextern \"C\" {\n#define H_NOT 2\n#endif\n"
        "enum {\n#define E(name, value, text) name = (value),\n    H_LIST(E)\n#undef E\n};\n"
        "enum { A, B = 7, C, };\ntypedef struct later later;\n"
        "typedef struct pair { const char *name, *const unit; double box[H_COUNT], **deep;\n"
        "    void *(*get)(void *, size_t bytes); /* int gone; */ struct pair *next; unsigned long count;\n} pair;\n"
        "ROTID_API const char *h_name(void);\n"
        "ROTID_API void h_all(int const n, const char *const *x, const later *y);\n"
        "typedef int (*h_call)(void *user, int m);\nstruct later { int a; };\n#endif\n";
    struct header header;
    if (header_parse(&test_pool, text, &header))
        fail_msg("line %d: %s", header.line, header.error);
    static const struct {
        const char *name;
        int kind;
        long value;
    } constant[] = {{"H_TEXT", HEADER_TEXT, 0},   {"H_COUNT", HEADER_DEFINE, 3}, {"H_ONE", HEADER_STATUS, 1},
                    {"H_TWO", HEADER_STATUS, -2}, {"A", HEADER_ENUM, 0},         {"B", HEADER_ENUM, 7},
                    {"C", HEADER_ENUM, 8}};
    assert_int_equal(header.nconstant, 7);
    for (int i = 0; i < header.nconstant; i++) {
        assert_string_equal(header.constant[i].name, constant[i].name);
        assert_int_equal(header.constant[i].kind, constant[i].kind);
        assert_int_equal(header.constant[i].value, constant[i].value);
    }
    assert_string_equal(header.constant[0].text, "a /* \\\" b");
    assert_string_equal(header.constant[2].text, "it, 1");
    assert_int_equal(header.constant[6].line, 22);

    static const char *const members[] = {
        "const char *name", "const char *const unit", "double box[3]", "double **deep", "void *(*get)(void *, size_t bytes)",
        "pair *next",       "unsigned long count"};
    assert_int_equal(header.nstruct, 2);
    assert_string_equal(header.structure[0].name, "later");
    assert_int_equal(header.structure[0].complete, 1);
    assert_int_equal(header.structure[0].nmember, 1);
    const struct header_struct *pair = header_struct(&header, "pair");
    assert_int_equal(pair->nmember, 7);
    for (int i = 0; i < 7; i++)
        assert_string_equal(header_variable_text(&test_pool, &pair->member[i]), members[i]);
    assert_int_equal(pair->member[1].type.constant, 3);
    assert_int_equal(pair->member[3].type.pointers, 2);
    assert_int_equal(pair->member[4].callback->nparameter, 2);
    assert_int_equal(pair->member[5].line, 25);

    assert_int_equal(header.nfunction, 2);
    assert_string_equal(header_function_text(&test_pool, &header.function[0]), "const char *h_name(void)");
    assert_string_equal(header_function_text(&test_pool, header_function(&header, "h_all")),
                        "void h_all(const int n, const char *const *x, const later *y)");
    assert_int_equal(header.ncallback, 1);
    assert_string_equal(header_function_text(&test_pool, header_callback(&header, "h_call")), "int h_call(void *user, int m)");
    assert_null(header_function(&header, "h_call"));
}

POOL_TEST(what_is_not_understood_is_named)
{
    static const struct {
        const char *text, *error;
        int line;
    } bad[] = {
        {"\n/*\n*/ int f(void);", "expected a declaration with ROTID_API, not int", 3},
        {"ROTID_API int f(void)\n;\nROTID_API int g(int a", "expected ), not the end", 3},
        {"typedef struct a { int b : 3; } a;", "expected ;, not :", 1},
        {"typedef struct a { union { int b; } c; } a;", "expected a name, not {", 1},
        {"typedef struct a { int b; } c;", "the typedef of struct a has another name", 1},
        {"struct a { int b; };\nstruct a { int b; };", "struct a is declared twice", 2},
        {"typedef int a;", "a typedef of neither a struct nor a pointer to a function", 1},
        {"ROTID_API int a[3];", "neither a type nor a function", 1},
        {"enum { A = x };", "expected a whole number, not x", 1},
        {"enum { L(E) };", "L is no list of this header", 1},
        {"#define L(X) \\\n X(A, 1)\nenum { L(E) };", "expected ,, not )", 2},
        {"#define N 1 +\n", "expected the end of the line, not +", 1},
        {"\n#if 1\n", "#if without its #endif", 3},
        {"#endif\n", "#endif without its #if", 1},
        {"ROTID_API int f(void); /* ", "a comment without its end", 1},
        {"#define T \"x\n", "a text without its closing quote", 1},
        {"struct a { int b[0]; };", "an array of an unusual length", 1},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct header header;
        if (!header_parse(&test_pool, bad[i].text, &header))
            fail_msg("read without an error: %s", bad[i].text);
        assert_string_equal(header.error, bad[i].error);
        assert_int_equal(header.line, bad[i].line);
    }
    struct header header;
    assert_int_equal(header_read(&test_pool, "/nowhere/rotid.h", &header), -1);
    assert_non_null(header.error);
}

/* The same list, made by the compiler. */
POOL_TEST(every_status_of_the_public_header_is_found)
{
    static const struct {
        const char *name, *text;
        int value;
    } status[] = {
#define ENTRY(name, value, text) {#name, text, value},
        ROTID_STATUS_LIST(ENTRY)};
    struct header header;
    if (header_read(&test_pool, ROTID_SOURCE_DIR "/include/rotid.h", &header))
        fail_msg("rotid.h:%d: %s", header.line, header.error);
    int count = 0;
    for (int i = 0; i < header.nconstant; i++)
        count += header.constant[i].kind == HEADER_STATUS;
    assert_int_equal(count, sizeof status / sizeof *status);
    for (int i = 0; i < count; i++) {
        const struct header_constant *constant = header_constant(&header, status[i].name);
        assert_non_null(constant);
        assert_int_equal(constant->value, status[i].value);
        assert_string_equal(constant->text, status[i].text);
    }
    assert_string_equal(header_constant(&header, "ROTID_VERSION")->text, ROTID_VERSION);
    for (int i = 0; i < header.nstruct; i++)
        assert_int_equal(header.structure[i].complete, 1);
}

/* Every declaration is written out and read again: nothing is lost, and the spelling is C. */
POOL_TEST(what_is_written_out_reads_the_same)
{
    struct header header, again;
    assert_int_equal(header_read(&test_pool, ROTID_SOURCE_DIR "/include/rotid.h", &header), 0);
    assert_true(header.nfunction > 20 && header.nstruct > 10 && header.ncallback > 0);
    for (int i = 0; i < header.nfunction; i++) {
        const char *text = header_function_text(&test_pool, &header.function[i]);
        assert_int_equal(header_parse(&test_pool, pool_format(&test_pool, "ROTID_API %s;", text), &again), 0);
        assert_string_equal(header_function_text(&test_pool, &again.function[0]), text);
    }
    for (int i = 0; i < header.nstruct; i++)
        for (int j = 0; j < header.structure[i].nmember; j++) {
            const char *text = header_variable_text(&test_pool, &header.structure[i].member[j]);
            assert_int_equal(header_parse(&test_pool, pool_format(&test_pool, "struct a { %s; };", text), &again), 0);
            assert_string_equal(header_variable_text(&test_pool, &again.structure[0].member[0]), text);
        }
}

POOL_TEST(memory_that_runs_out_is_an_error)
{
    static const char text[] =
        "#define L(X) X(A, 1, \"a\")\nenum { L(E) };\ntypedef struct a { unsigned long b; int (*f)(int c); } a;\n"
        "ROTID_API int f(const a *b);\n";
    for (long n = 1;; n++) {
        struct failing_allocator failing;
        struct header header;
        struct pool pool;
        failing_allocator_open(&failing, n);
        pool_open(&pool, &failing.allocator);
        int status = header_parse(&pool, text, &header);
        pool_close(&pool);
        if (!status)
            break;
        assert_int_equal(status, -1);
        assert_true(n < 1000);
    }
}
