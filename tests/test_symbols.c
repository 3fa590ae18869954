/* The names that both libraries show, and what the rooms of the library call: nothing that a library has no business to. */
#include "header.h"
#include "shell.h"
#include "support.h"

#ifndef ROTID_BUILD /* the Makefile says what the library was built with */
#define ROTID_BUILD "build"
#define ROTID_FLAGS ""
#endif

#define STATIC ROTID_BUILD "/librotid.a"
#define SHARED ROTID_BUILD "/librotid.so"

/* ---- names */

/* Tools that count what is run add their own names to every library. */
static int is_counted(void)
{
    return strstr(ROTID_FLAGS, "coverage") || strstr(ROTID_FLAGS, "profile");
}

/* The third column of nm is exactly the functions that rotid.h declares. */
static void assert_public_names(const char *names, const char *library)
{
    struct header header;
    const char *missing = "", *list = pool_format(&test_pool, "\n%s", names);
    if (header_read(&test_pool, ROTID_SOURCE_DIR "/include/rotid.h", &header))
        fail_msg("rotid.h:%d: %s", header.line, header.error);
    for (const char *line = names; *line; line += strcspn(line, "\n") + 1) {
        const char *name = pool_format(&test_pool, "%.*s", (int)strcspn(line, "\n"), line);
        if (!header_function(&header, name) && !is_counted())
            fail_msg("%s shows %s, which rotid.h does not declare", library, name);
    }
    for (int i = 0; i < header.nfunction; i++) {
        assert_int_equal(strncmp(header.function[i].name, "rotid_", 6), 0);
        if (!strstr(list, pool_format(&test_pool, "\n%s\n", header.function[i].name)))
            missing = pool_format(&test_pool, "%s %s", missing, header.function[i].name);
    }
    if (*missing)
        fail_msg("%s lacks%s", library, missing);
}

POOL_TEST(the_shared_library_shows_what_the_header_declares)
{
    assert_public_names(shell(&test_pool, "nm -D --defined-only " SHARED " | awk '{ print $3 }'"), "librotid.so");
    assert_string_equal(shell(&test_pool, "objdump -p " SHARED " | awk '$1 == \"SONAME\" { print $2 }'"),
                        pool_format(&test_pool, "librotid.so.%d\n", ROTID_VERSION_MAJOR));
    /* JSON is the program's, and so is whatever else somebody may add there */
    static const char *const known[] = {"liblapacke.", "libopenblas", "libblas.",  "libcblas.", "libblis.",  "libnlopt.", "libm.",
                                        "libc.",       "libpthread.", "libgcc_s.", "libasan.",  "libubsan.", "libtsan.",  NULL};
    const char *needed = shell(&test_pool, "objdump -p " SHARED " | awk '$1 == \"NEEDED\" { print $2 }'");
    for (const char *line = needed; *line; line += strcspn(line, "\n") + 1) {
        int i = 0;
        while (known[i] && strncmp(known[i], line, strlen(known[i])) != 0)
            i++;
        if (!known[i])
            fail_msg("librotid.so needs %.*s", (int)strcspn(line, "\n"), line);
    }
}

POOL_TEST(the_static_library_shows_what_the_header_declares)
{
    assert_public_names(
        shell(&test_pool, "nm -g --defined-only " STATIC " | awk 'NF == 3 && $3 !~ /^rotid_private_/ { print $3 }'"),
        "librotid.a");
}

/* No public routine reaches the rooms of the program, and no host links what they call. */
POOL_TEST(the_library_holds_nothing_of_the_program)
{
    const char *held = shell(&test_pool, "nm " STATIC " | sed -n 's/.* \\(rotid_private_\\)*//p' | sort -u"), *line;
    const char *of_program =
        shell(&test_pool, "cd " ROTID_BUILD "/src && nm -g --defined-only signal/*.o ema/*.o import/*.o report/*.o "
                          "export/*.o study/*.o page/*.o cli/*.o | awk 'NF == 3 { print $3 }' | sort -u");
    assert_non_null(strstr(held, "\ndeck_read_states\n")); /* that there is something to be found */
    assert_non_null(strstr(of_program, "\nestimator_transfer\n"));
    for (line = of_program; *line; line += strcspn(line, "\n") + 1) {
        const char *name = pool_format(&test_pool, "\n%.*s\n", (int)strcspn(line, "\n"), line);
        if (strstr(held, name) && !is_counted())
            fail_msg("librotid.a knows %s", name + 1);
    }
    assert_null(strstr(held, "kiss_fft"));
}

/* ---- what the rooms of the library call */

#define BELOW_FILES "base linalg rotor beam model modal fit signal ema run diagnose"
#define LIBRARY     BELOW_FILES " file uff import deck api"

/* Names that the objects of these rooms need and do not have, a line each. */
static const char *called_by(const char *rooms)
{
    return shell(&test_pool,
                 "cd " ROTID_BUILD "/src && for room in %s; do [ ! -d $room ] || find $room -name '*.o'; done | xargs nm -u | "
                 "awk 'NF == 2 { print $2 }' | sort -u",
                 rooms);
}

/* Whether it is one of the names, or one with what glibc puts before or behind: __printf_chk, fopen64, __isoc99_sscanf. */
static const char *find_call(const char *calls, const char *const *names)
{
    for (const char *line = calls; *line; line += strcspn(line, "\n") + 1)
        for (int i = 0; names[i]; i++) {
            const char *at = line;
            if (strncmp(at, "__isoc99_", 9) == 0)
                at += 9;
            at += strspn(at, "_");
            size_t length = strlen(names[i]);
            if (strncmp(at, names[i], length) == 0 &&
                (at[length] == '\n' || strncmp(at + length, "64\n", 3) == 0 || strncmp(at + length, "_chk\n", 5) == 0))
                return names[i];
        }
    return NULL;
}

POOL_TEST(the_library_does_not_print_or_exit)
{
    static const char *const never[] = {"printf",
                                        "vprintf",
                                        "puts",
                                        "putchar",
                                        "perror",
                                        "stdout",
                                        "stderr",
                                        "stdin",
                                        "exit",
                                        "Exit",
                                        "quick_exit",
                                        "abort",
                                        "assert_fail",
                                        "atexit",
                                        "signal",
                                        "sigaction",
                                        "raise",
                                        "kill",
                                        "setenv",
                                        "putenv",
                                        "unsetenv",
                                        "getenv",
                                        "system",
                                        "popen",
                                        "fork",
                                        "execve",
                                        "setlocale",
                                        "srand",
                                        "rand",
                                        "random",
                                        "strtok",
                                        "remove",
                                        "rename",
                                        "unlink",
                                        "mkstemp",
                                        "tmpfile",
                                        "openblas_set_num_threads",
                                        "longjmp",
                                        "err",
                                        "errx",
                                        "warn",
                                        "warnx",
                                        "syslog",
                                        NULL};
    static const char *const no_files[] = {"fopen",  "fdopen", "freopen", "fclose", "fread",   "fwrite",   "fputs",   "fputc",
                                           "putc",   "fgets",  "fgetc",   "getc",   "fprintf", "vfprintf", "fscanf",  "fseek",
                                           "fseeko", "ftell",  "open",    "close",  "read",    "write",    "getline", "stat",
                                           "fstat",  "access", "getcwd",  "chdir",  "opendir", NULL};
    const char *call = find_call(called_by(LIBRARY), never);
    if (call)
        fail_msg("a room of the library calls %s", call);
    call = find_call(called_by(BELOW_FILES), no_files);
    if (call)
        fail_msg("a room below src/uff calls %s", call);
    /* that there is something to be found */
    assert_non_null(find_call(called_by("cli"), never));
    assert_non_null(find_call(called_by("uff"), no_files));
}

/* What is printed passes one filter: no other file can reach the two streams. */
POOL_TEST(one_file_knows_the_terminal)
{
    assert_string_equal(shell(&test_pool,
                              "cd " ROTID_BUILD "/src && find . -name '*.o' ! -path './mpi/*' | xargs nm -A -u | "
                              "awk '$NF ~ /^(__)?(stdout|stderr|v?printf(_chk)?|puts|putchar|perror|psignal|v?warnx?|v?errx?|"
                              "v?dprintf(_chk)?)(@.*)?$/ { sub(/:.*/, \"\"); print }' | sort -u"),
                        "./report/terminal.o\n");
}

/* Static variables that can be written to would be shared by all calls. */
POOL_TEST(the_library_keeps_no_state)
{
    if (is_counted() || strstr(ROTID_FLAGS, "-fsanitize")) /* these keep some of their own */
        return;
    assert_string_equal(shell(&test_pool, "nm -f sysv " STATIC " | awk -F '|' "
                                          "'$3 ~ /C/ || ($7 ~ /^\\.t?(data|bss)/ && $7 !~ /^\\.data\\.rel\\.ro/) { print $1 }'"),
                        "");
}
