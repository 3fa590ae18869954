#include "compilers.h"

#include "shell.h"
#include "support.h"

const char *compiler(const char *variable)
{
    static const char *const usual[][2] = {{"CC", "cc"}, {"CXX", "c++"}, {"FC", "gfortran"}};
    const char *named = getenv(variable);
    for (size_t i = 0; !(named && *named) && i < sizeof usual / sizeof *usual; i++)
        if (strcmp(variable, usual[i][0]) == 0)
            named = usual[i][1];
    return named;
}

int has_compiler(struct pool *pool, const char *variable)
{
    return shell_code(pool, NULL, "command -v %s", compiler(variable)) == 0;
}

void needs_compiler(struct pool *pool, const char *variable)
{
    if (has_compiler(pool, variable))
        return;
    print_message("there is no %s; %s names another compiler\n", compiler(variable), variable);
    skip();
}

const char *make_folder(struct pool *pool)
{
    char *path = pool_copy_text(pool, "/tmp/rotid_test_XXXXXX");
    assert_true(path && mkdtemp(path));
    return path;
}

void remove_folder(struct pool *pool, const char *folder)
{
    (void)shell(pool, "rm -rf '%s'", folder);
}

const char *write_file(struct pool *pool, const char *folder, const char *name, const char *text)
{
    const char *path = pool_format(pool, "%s/%s", folder, name);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
    return path;
}
