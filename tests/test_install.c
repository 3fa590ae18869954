/* The library as hosts get it: what make install puts where and make uninstall takes away, the names both libraries show, hosts
 * in C and C++ linked against them, and that the rooms of the library call nothing that a library has no business to call. */
#include <unistd.h>

#include "shell.h"
#include "support.h"

#ifndef ROTID_BUILD /* the Makefile says what the library was built with */
#define ROTID_BUILD "build"
#define ROTID_CC    "cc"
#define ROTID_CXX   "c++"
#define ROTID_FLAGS ""
#endif

#define SOURCES ROTID_SOURCE_DIR
#define HOSTS   SOURCES "/tests/embedding"
/* what is built is not built again */
#define MAKE "make -s -C " SOURCES " -o all BUILD=" ROTID_BUILD " "
#define CC   ROTID_CC " " ROTID_FLAGS " -std=c17 -Wall -Wextra -Wpedantic -Werror "

static char prefix[] = "/tmp/test_install_XXXXXX"; /* where it is installed, once for all tests */

static int install(void **state)
{
    (void)state;
    struct pool pool;
    pool_open(&pool, NULL);
    if (!mkdtemp(prefix))
        return -1;
    (void)shell(&pool, MAKE "install PREFIX=%s", prefix);
    pool_close(&pool);
    return 0;
}

static int remove_all(void **state)
{
    (void)state;
    struct pool pool;
    pool_open(&pool, NULL);
    (void)shell(&pool, "rm -r %s", prefix);
    pool_close(&pool);
    return 0;
}

static const char *text(const char *format, ...) __attribute__((format(printf, 1, 2)));
static const char *text(const char *format, ...)
{
    static char line[8][1024];
    static int next;
    va_list list;
    next = (next + 1) % 8;
    va_start(list, format);
    (void)vsnprintf(line[next], sizeof line[next], format, list);
    va_end(list);
    return line[next];
}

static const char *soname(void)
{
    return text("librotid.so.%d", ROTID_VERSION_MAJOR);
}

/* pkg-config as a host calls it. */
static const char *pkg_config(const char *what)
{
    const char *output = shell(&test_pool, "PKG_CONFIG_PATH=%s/lib/pkgconfig pkg-config %s rotid", prefix, what);
    return text("%.*s", (int)strcspn(output, "\n"), output);
}

/* ---- files */

static const char *expected_files(void)
{
    static const char *const fixed[] = {"bin/rotid",
                                        "include/rotid.h",
                                        "lib/cmake/rotid/rotid-config-version.cmake",
                                        "lib/cmake/rotid/rotid-config.cmake",
                                        "lib/librotid.a",
                                        "lib/librotid.so",
                                        "lib/pkgconfig/rotid.pc",
                                        "share/bash-completion/completions/rotid",
                                        "share/doc/rotid/CHANGELOG.md",
                                        "share/doc/rotid/LICENSE",
                                        "share/doc/rotid/README.md",
                                        "share/fish/vendor_completions.d/rotid.fish",
                                        "share/man/man1/rotid.1",
                                        "share/man/man3/librotid.3",
                                        "share/zsh/site-functions/_rotid",
                                        NULL};
    const char *list = text("lib/%s\nlib/librotid.so.%s\n", soname(), ROTID_VERSION);
    for (int i = 0; fixed[i]; i++)
        list = pool_format(&test_pool, "%s%s\n", list, fixed[i]);
    list = pool_format(&test_pool, "%s%s", list,
                       shell(&test_pool, "cd " SOURCES "; for f in include/*.f90; do [ ! -f $f ] || echo $f; done; "
                                         "find docs -type f ! -name '*.[13]' | sed 's|^|share/doc/rotid/|'; "
                                         "find input -type f | sed 's|^|share/rotid/|'"));
    return shell(&test_pool, "sort <<'END'\n%sEND", list);
}

POOL_TEST(every_file_is_where_it_belongs)
{
    assert_string_equal(shell(&test_pool, "cd %s && find . ! -type d | sed 's|^./||' | sort", prefix), expected_files());
    assert_string_equal(shell(&test_pool, "cd %s/lib && readlink librotid.so %s", prefix, soname()),
                        text("%s\nlibrotid.so.%s\n", soname(), ROTID_VERSION));
    (void)shell(&test_pool,
                "cd %s && cmp include/rotid.h " SOURCES "/include/rotid.h && cmp share/man/man1/rotid.1 " SOURCES "/docs/rotid.1",
                prefix);
    /* for everybody, to be run only where it is a program or a shared library */
    assert_string_equal(shell(&test_pool,
                              "cd %s && find . -type f -perm 755 | sort; find . -mindepth 1 ! -type l ! -perm 755 ! -perm 644",
                              prefix),
                        text("./bin/rotid\n./lib/librotid.so.%s\n", ROTID_VERSION));
    /* the program finds decks with the data they name */
    (void)shell(&test_pool,
                "cd %s/share/rotid/input && for deck in *.inp; do ../../../bin/rotid check $deck --quiet || exit 1; done",
                prefix);
    assert_string_equal(pkg_config("--modversion"), ROTID_VERSION);
}

POOL_TEST(a_package_is_staged_and_taken_away_again)
{
    char stage[] = "/tmp/test_install_XXXXXX";
    assert_non_null(mkdtemp(stage));
    const char *where = text("DESTDIR=%s PREFIX=/usr LIBDIR=/usr/lib/some-triplet DOCDIR=/opt/doc/rotid", stage);
    (void)shell(&test_pool, MAKE "install %s", where);
    const char *pc = shell_file(&test_pool, text("%s/usr/lib/some-triplet/pkgconfig/rotid.pc", stage));
    assert_non_null(strstr(pc, "\nprefix=/usr\nlibdir=${prefix}/lib/some-triplet\nincludedir=${prefix}/include\n"));
    assert_null(strstr(pc, stage));
    assert_null(strstr(pc, "@"));
    const char *cmake = shell_file(&test_pool, text("%s/usr/lib/some-triplet/cmake/rotid/rotid-config.cmake", stage));
    assert_non_null(strstr(cmake, "rotid_LIBDIR \"${CMAKE_CURRENT_LIST_DIR}/../..\""));
    assert_non_null(strstr(cmake, "rotid_INCLUDEDIR \"${CMAKE_CURRENT_LIST_DIR}/../../../../include\""));
    assert_non_null(strstr(cmake, "librotid.so." ROTID_VERSION));
    /* of what the program calls beside the library, and of the machine, nothing */
    static const char *const never[] = {"@", "kiss", "cjson", "/usr/lib/", "/tmp"};
    for (size_t i = 0; i < sizeof never / sizeof *never; i++)
        assert_null(strstr(cmake, never[i]));
    assert_null(strstr(pc, "kiss"));
    assert_null(strstr(pc, "-L/usr"));
    const char *first = shell(&test_pool, "cd %s && find . | sort", stage);
    assert_non_null(strstr(first, "./usr/bin/rotid\n"));
    assert_non_null(strstr(first, "./usr/lib/some-triplet/librotid.so\n"));
    assert_non_null(strstr(first, "./opt/doc/rotid/docs/deck.md\n"));
    assert_null(strstr(first, "./usr/lib/librotid"));
    /* the same once more over it; then another's file among its own stays, and with it the folder */
    (void)shell(&test_pool, MAKE "install %s", where);
    assert_string_equal(shell(&test_pool, "cd %s && find . | sort", stage), first);
    (void)shell(&test_pool, "echo mine > %s/opt/doc/rotid/mine", stage);
    (void)shell(&test_pool, MAKE "uninstall %s", where);
    assert_string_equal(shell(&test_pool, "cd %s && find . ! -type d", stage), "./opt/doc/rotid/mine\n");
    (void)shell(&test_pool, "rm %s/opt/doc/rotid/mine", stage);
    (void)shell(&test_pool, MAKE "uninstall %s", where); /* of nothing */
    assert_string_equal(shell(&test_pool, "cd %s && find . ! -type d; find . -name '*rotid*'", stage), "");
    (void)shell(&test_pool, "test -d %s/usr/bin && test -d %s/usr/share/man/man1 && rm -r %s", stage, stage, stage);
}

/* Nothing is installed by halves, and it is said what to do. */
POOL_TEST(a_place_that_cannot_be_written_to_is_named)
{
    char folder[] = "/tmp/test_install_XXXXXX";
    const char *output, *as_user = "";
    assert_non_null(mkdtemp(folder));
    (void)shell(&test_pool, "touch %s/file", folder);
    assert_int_not_equal(shell_code(&test_pool, &output, MAKE "install PREFIX=%s/file", folder), 0);
    assert_non_null(
        strstr(output, text("rotid: %s/file is no directory, so nothing can be installed in %s/file/bin", folder, folder)));
    assert_int_not_equal(shell_code(&test_pool, &output, MAKE "install PREFIX=%s DATADIR=%s/file", folder, folder), 0);
    assert_non_null(strstr(output, "choose another PREFIX"));
    assert_int_not_equal(shell_code(&test_pool, &output, MAKE "install PREFIX=some/where"), 0);
    assert_non_null(strstr(output, "some/where/bin is no absolute path"));
    if (geteuid() == 0) /* who may write everywhere */
        as_user = "setpriv --reuid=65534 --regid=65534 --clear-groups ";
    if (!*as_user ||
        shell_code(&test_pool, NULL, "%stest -r " ROTID_BUILD "/rotid -a -r " SOURCES "/include/rotid.h", as_user) == 0) {
        (void)shell(&test_pool, "chmod 555 %s", folder);
        assert_int_not_equal(shell_code(&test_pool, &output, "%s" MAKE "install PREFIX=%s/new", as_user, folder), 0);
        assert_non_null(strstr(output, text("rotid: %s cannot be written to: choose another PREFIX", folder)));
        (void)shell(&test_pool, "chmod 755 %s", folder);
    }
    assert_string_equal(shell(&test_pool, "cd %s && find . ! -name .", folder), "./file\n");
    (void)shell(&test_pool, "rm -r %s", folder);
}

/* ---- hosts */

/* Compiles and runs a host; `link` behind the source. */
static void run_host(const char *compiler, const char *source, const char *link, const char *name)
{
    (void)shell(&test_pool, "cd %s && %s %s " HOSTS "/%s %s -lm -o %s", prefix, compiler, pkg_config("--cflags"), source, link,
                name);
    assert_string_equal(shell(&test_pool, "cd %s && LD_LIBRARY_PATH=lib OPENBLAS_NUM_THREADS=1 ./%s", prefix, name),
                        "ok " ROTID_VERSION "\n");
}

POOL_TEST(hosts_link_statically_beside_routines_of_the_same_name)
{
    run_host(CC, "namesakes.c", pkg_config("--variable=static_libs"), "static");
    assert_string_equal(shell(&test_pool, "objdump -p %s/static | grep librotid || true", prefix), "");
    /* where there is no shared library, by the usual option */
    (void)shell(&test_pool,
                "cd %s && mkdir -p only/lib/pkgconfig && cp lib/librotid.a only/lib && "
                "sed 's|^prefix=.*|prefix=%s/only|' lib/pkgconfig/rotid.pc > only/lib/pkgconfig/rotid.pc",
                prefix, prefix);
    run_host(CC, "namesakes.c",
             shell(&test_pool, "PKG_CONFIG_PATH=%s/only/lib/pkgconfig pkg-config --static --libs rotid | tr '\\n' ' '", prefix),
             "archive");
    (void)shell(&test_pool, "cd %s && rm -r only static archive", prefix);
}

/* What it does not call is not in it. */
POOL_TEST(a_host_of_the_minimiser_alone_stays_small)
{
    (void)shell(&test_pool, "cd %s && %s %s " SOURCES "/docs/examples/curve.c %s -lm -o curve", prefix, CC,
                pkg_config("--cflags"), pkg_config("--variable=static_libs"));
    const char *names = shell(&test_pool, "nm %s/curve | awk '$3 ~ /^rotid_/ { print $3 }'", prefix);
    assert_non_null(strstr(names, "rotid_lm\n"));
    static const char *const absent[] = {"rotid_fit\n", "rotid_deck_read\n", "rotid_eigenpairs\n", "rotid_private_job"};
    for (size_t i = 0; i < sizeof absent / sizeof *absent; i++)
        assert_null(strstr(names, absent[i]));
    (void)shell(&test_pool, "rm %s/curve", prefix);
}

POOL_TEST(hosts_link_the_shared_library)
{
    const char *libs = pkg_config("--libs");
    assert_string_equal(libs, text("-L%s/lib -lrotid ", prefix));
    assert_string_equal(pkg_config("--cflags"),
                        text("-I%s/include ", prefix)); /* and nothing of what the library is built with */
    run_host(CC, "namesakes.c", libs, "shared");
    assert_string_equal(shell(&test_pool, "objdump -p %s/shared | awk '/NEEDED.*rotid/ { print $2 }'", prefix),
                        text("%s\n", soname()));
    (void)shell(&test_pool, "rm %s/shared", prefix);
}

POOL_TEST(the_header_serves_c99_and_cpp)
{
    static const char *const compilers[] = {"g++", "clang++", "clang++-14", NULL}, *const c[] = {"gcc", "clang", "clang-14",
                                                                                                 NULL};
    for (int i = 0; compilers[i]; i++)
        if (shell_code(&test_pool, NULL, "command -v %s", compilers[i]) == 0)
            (void)shell(&test_pool,
                        "for standard in c++11 c++17; do %s -std=$standard -Wall -Wextra -Wpedantic -Wold-style-cast -Werror "
                        "-I%s/include -fsyntax-only " HOSTS "/host.cpp || exit 1; done",
                        compilers[i], prefix);
    for (int i = 0; c[i]; i++)
        if (shell_code(&test_pool, NULL, "command -v %s", c[i]) == 0)
            (void)shell(
                &test_pool,
                "echo '#include <rotid.h>' | %s -std=c99 -Wall -Wextra -Wpedantic -Wstrict-prototypes -Werror -I%s/include "
                "-fsyntax-only -x c -",
                c[i], prefix);
    /* sanitizers of two compilers do not go into one program */
    if (strstr(ROTID_FLAGS, "-fsanitize"))
        return;
    run_host(ROTID_CXX " " ROTID_FLAGS " -std=c++11", "host.cpp", pkg_config("--libs"), "host");
    run_host(ROTID_CXX " " ROTID_FLAGS " -std=c++11", "host.cpp", pkg_config("--variable=static_libs"), "host");
    (void)shell(&test_pool, "rm %s/host", prefix);
}

TEST_GROUP(install, remove_all);
