/* rotid.f90 is the twin of rotid.h: by what the two declare, and by what compilers make of them. */
#include "compilers.h"
#include "fortran_twin.h"
#include "fortran_types.h"
#include "shell.h"
#include "support.h"

#define HEADER ROTID_SOURCE_DIR "/include/rotid.h"
#define MODULE ROTID_SOURCE_DIR "/include/rotid.f90"
#define STRICT "-std=f2008 -Wall -Wextra -pedantic -Werror"

static void read_header(const char *text, struct header *header)
{
    if (header_parse(&test_pool, text, header))
        fail_msg("rotid.h:%d: %s", header->line, header->error);
}

static void read_module(const char *text, struct fortran_module *module)
{
    if (fortran_parse(&test_pool, text, module))
        fail_msg("rotid.f90:%d: %s", module->line, module->error);
}

/* The text with `to` in place of `from`, which occurs once or more often: the first one. */
static const char *changed(const char *text, const char *from, const char *to)
{
    const char *at = strstr(text, from);
    if (!at)
        fail_msg("there is no \"%s\" to change", from);
    return pool_format(&test_pool, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
}

POOL_TEST(the_module_declares_what_the_header_declares)
{
    struct header header;
    struct fortran_module module;
    read_header(shell_file(&test_pool, HEADER), &header);
    read_module(shell_file(&test_pool, MODULE), &module);
    assert_true(header.nconstant > 30 && header.nstruct > 20 && header.nfunction > 30);
    assert_int_equal(module.ntype, header.nstruct);
    assert_string_equal(fortran_differences(&test_pool, &header, &module), "");
}

POOL_TEST(the_types_of_results_are_those_of_the_header)
{
    struct header header;
    const char *module = shell_file(&test_pool, MODULE);
    read_header(shell_file(&test_pool, HEADER), &header);
    const char *types = fortran_types(&test_pool, &header), *now = fortran_with_types(&test_pool, module, types ? types : "");
    assert_non_null(types);
    assert_non_null(now);
    if (strcmp(now, module) != 0)
        fail_msg("the types of results in include/rotid.f90 are not those of rotid.h: write them with `make fortran`");
}

/* Every kind of drift, made on purpose: what the comparison has to say about it. */
POOL_TEST(drift_is_told)
{
    static const struct {
        const char *from, *to, *told;
    } drift[] = {
        {"ROTID_ERROR_SLAVE = -4", "ROTID_ERROR_SLAVE = 4", "ROTID_ERROR_SLAVE is 4, not -4\n"},
        {"parameter :: ROTID_IRS = 2", "parameter :: ROTID_ITS = 2", "ROTID_IRS is missing\nrotid_its is not in the header\n"},
        {"ROTID_VERSION_TEXT = \"", "ROTID_VERSION_TEXT = \"9", "ROTID_VERSION_TEXT is \"9"},
        {"integer(c_int), parameter :: ROTID_NOTE", "integer(c_long), parameter :: ROTID_NOTE",
         "ROTID_NOTE is integer(c_long)\n"},
        /* members: swapped, renamed, left out, of another kind, of another length, added, without a beginning */
        {"frequency_std = c_null_ptr ! real [nmode]\n    type(c_ptr) :: shape =",
         "shape = c_null_ptr\n    type(c_ptr) :: frequency_std =", "rotid_deck: member 14 is shape, not frequency_std\n"},
        {"lower = 0, upper = 0", "upper = 0, lower = 0", "rotid_parameter: member 3 is upper, not lower\n"},
        {"baseline = 0\n    integer(c_int) :: max", "base = 0\n    integer(c_int) :: max",
         "rotid_fit_options: member 5 is base, not baseline\n"},
        {", mass = 0, centre = 0", ", mass = 0", "rotid_deck: member 7 is nsensor, not centre\n"},
        {"    integer(c_int) :: fixed = 0\n", "", "rotid_cause_value: member 6 is the end, not fixed\n"},
        {"    integer(c_int) :: fixed = 0\n", "    real(c_double) :: fixed = 0\n",
         "rotid_cause_value.fixed is real(c_double)(), not integer(c_int)()\n"},
        {"integer(c_long) :: seed", "integer(c_int) :: seed",
         "rotid_suggest_options.seed is integer(c_int)(), not integer(c_long)"},
        {"ci95(2)", "ci95(3)", "rotid_fitted_parameter.ci95 is real(c_double)(3), not real(c_double)(2)\n"},
        {"type(c_funptr) :: trace =", "type(c_ptr) :: trace =",
         "rotid_lm_options.trace is type(c_ptr)(), not type(c_funptr)()\n"},
        {"    integer(c_int) :: beyond = 0\n", "    integer(c_int) :: beyond = 0, more = 0\n",
         "rotid_hidden: member 12 is more, not the end\n"},
        {":: nrigid_hz = 0\n", ":: nrigid_hz\n", "rotid_spectrum.nrigid_hz has no value to begin with\n"},
        {"type, bind(C) :: rotid_pair", "type, bind(C) :: rotid_goodness", "rotid_goodness is not in the header\n"},
        /* functions: missing, bound to another, another number, name, kind, passing or intent of arguments, another result */
        {"function rotid_mac(n, a, b) result(mac) bind(C, name=\"rotid_mac\")\n      import :: c_double, c_int\n"
         "      integer(c_int), value :: n\n      real(c_double), intent(in) :: a(*), b(*)\n      real(c_double) :: mac\n"
         "    end function rotid_mac",
         "", "rotid_mac is missing\n"},
        {"name=\"rotid_deck_free\"", "name=\"rotid_fit_free\"", "rotid_deck_free is bound to rotid_fit_free\n"},
        {"rotid_nco(n, mass, a, b, work)", "rotid_nco(n, mass, b, a, work)", "rotid_nco: argument 3 is b, not a\n"},
        {"rotid_lm_workspace(m, n) result(length) bind(C, name=\"rotid_lm_workspace\")\n      import :: c_int, c_size_t\n"
         "      integer(c_int), value :: m, n",
         "rotid_lm_workspace(m) result(length) bind(C, name=\"rotid_lm_workspace\")\n      import :: c_int, c_size_t\n"
         "      integer(c_int), value :: m",
         "rotid_lm_workspace: 1 arguments, not 2\n"},
        {"real(c_double), value :: force, phi, l", "real(c_float), value :: force, phi, l",
         "rotid_element_geometric: force is real(c_float), value, not double force\n"},
        {"integer(c_int), value :: ld\n", "integer(c_long), value :: ld\n",
         "rotid_matrix_set_dense: ld is integer(c_long), value, not int ld\n"},
        {"real(c_double), value :: nu, a", "real(c_double), intent(in) :: nu, a",
         "rotid_shear_coefficient_annulus: nu is real(c_double), in, not double nu\n"},
        {"real(c_double), intent(in) :: e(nd, *)", "real(c_double), intent(inout) :: e(nd, *)",
         "rotid_matrix_add_element: e is real(c_double), in, out, array, not const double *e\n"},
        {"real(c_double), intent(out) :: outer, inner", "real(c_double), intent(in) :: outer, inner",
         "rotid_equivalent_cylinder: outer is real(c_double), in, not double *outer\n"},
        {"type(rotid_measured), intent(in)", "type(rotid_matrix), intent(in)",
         "rotid_fit: measured is type(rotid_matrix), in, not const rotid_measured *measured\n"},
        {"type(c_funptr), value :: residual", "type(c_ptr), value :: residual",
         "rotid_lm: residual is type(c_ptr), value, not rotid_residual residual\n"},
        {"integer(c_size_t) :: length\n    end function rotid_lm_w", "integer(c_int) :: length\n    end function rotid_lm_w",
         "rotid_lm_workspace: the result is integer(c_int), not integer(c_size_t)\n"},
        {"real(c_double) :: nco\n", "real(c_float) :: nco\n", "rotid_nco: the result is real(c_float), not real(c_double)\n"},
        /* callbacks */
        {"function rotid_model_derivatives(user, x, p,", "function rotid_model_derivatives(user, p, x,",
         "rotid_model_derivatives: argument 2 is p, not x\n"},
        {"function rotid_lm_options_trace(user, iteration)", "function rotid_lm_trace(user, iteration)",
         "rotid_lm_options_trace is missing\n"},
        {"type(c_ptr), value :: r, jacobian", "type(c_ptr) :: r, jacobian", "rotid_residual: r is type(c_ptr), not double *r\n"},
    };
    const char *text = shell_file(&test_pool, MODULE);
    struct header header;
    read_header(shell_file(&test_pool, HEADER), &header);
    for (size_t i = 0; i < sizeof drift / sizeof *drift; i++) {
        struct fortran_module module;
        read_module(changed(text, drift[i].from, drift[i].to), &module);
        const char *differences = fortran_differences(&test_pool, &header, &module);
        if (!strstr(differences, drift[i].told))
            fail_msg("%s\nbecomes %s\nexpected: %sfound: %s", drift[i].from, drift[i].to, drift[i].told, differences);
    }
}

/* The other way: the header goes on and the module stays behind. */
POOL_TEST(a_header_that_goes_on_is_told)
{
    static const struct {
        const char *from, *to, *told;
    } change[] = {
        {"ROTID_API double rotid_mac(", "ROTID_API int rotid_more(int n);\nROTID_API double rotid_mac(",
         "rotid_more is missing\n"},
        {"    int max_iterations; ", "    int more, max_iterations; ",
         "rotid_fit_options: member 6 is max_iterations, not more\n"},
        {"ROTID_HYBRID, ", "ROTID_MORE, ROTID_HYBRID, ",
         "ROTID_MORE is missing\nROTID_HYBRID is 1, not 2\nROTID_HYBRID_F is 2, not 3\n"},
        {"X(ROTID_ERROR_IO, -14,", "X(ROTID_ERROR_IO, -24,", "ROTID_ERROR_IO is -14, not -24\n"},
        {"typedef int (*rotid_residual)(void *user, int m, int n,", "typedef int (*rotid_residual)(void *user, long m, int n,",
         "rotid_residual: m is integer(c_int), value, not long m\n"},
    };
    const char *text = shell_file(&test_pool, HEADER);
    struct fortran_module module;
    read_module(shell_file(&test_pool, MODULE), &module);
    for (size_t i = 0; i < sizeof change / sizeof *change; i++) {
        struct header header;
        read_header(changed(text, change[i].from, change[i].to), &header);
        const char *differences = fortran_differences(&test_pool, &header, &module);
        if (!strstr(differences, change[i].told))
            fail_msg("expected: %sfound: %s", change[i].told, differences);
    }
}

POOL_TEST(what_the_reader_does_not_know_is_an_error)
{
    static const struct {
        const char *text, *error;
        int line;
    } bad[] = {
        {"program a\nend program a\n", "expected a module: program a", 1},
        {"module a\n\n  common /b/ c\nend module a\n", "no statement that is known here: common/b/c", 3},
        {"module a\n  integer(c_int) :: b = 0\nend module a\n", "a variable that cannot stand here: integer(c_int)::b=0", 2},
        {"module a\n  type, bind(C) :: b\n    real(c_double), &\n      & allocatable :: c(:)\n  end type\nend module a\n",
         "an attribute that C does not know: real(c_double),allocatable::c(:)", 3},
        {"module a\ninterface\nsubroutine b(c) bind(C)\nend subroutine b\nend interface\nend module a\n",
         "an argument or the result is not declared: end subroutine b", 4},
        {"module a\ninterface\nsubroutine b(c)\ninteger(c_int), value :: c\nend subroutine b\n",
         "a procedure without bind(C): b(c)", 3},
        {"module a\ninterface\nsubroutine b(c) bind(C)\ninteger(c_int), value :: c\nreal(c_double), value :: c\n",
         "declared twice: real(c_double),value::c", 5},
        {"module a\n  ! end module a\n", "expected the end of the module: ", 2},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct fortran_module module;
        if (!fortran_parse(&test_pool, bad[i].text, &module))
            fail_msg("read without an error: %s", bad[i].text);
        assert_string_equal(module.error, bad[i].error);
        assert_int_equal(module.line, bad[i].line);
    }
}

/* ---- by compilers */

/* Compilers say nothing about these sources. */
#define compile(...) assert_string_equal(shell(&test_pool, __VA_ARGS__), "")

/* What the two programs print about constants, sizes and offsets. */
static void run_witnesses(const char *folder, const struct header *header, const char *module, const char **in_c,
                          const char **in_fortran)
{
    FILE *c = fopen(pool_format(&test_pool, "%s/c.c", folder), "w"),
         *fortran = fopen(pool_format(&test_pool, "%s/f.f90", folder), "w");
    assert_true(c && fortran);
    assert_int_equal(write_c_witness(c, header), 0);
    assert_int_equal(write_fortran_witness(fortran, header), 0);
    assert_int_equal(fclose(c) | fclose(fortran), 0);
    compile("cd %s && %s -I%s/include c.c -o c", folder, compiler("CC"), ROTID_SOURCE_DIR);
    compile("cd %s && %s -fsyntax-only %s", folder, compiler("FC"), module);
    compile("cd %s && %s f.f90 -o f", folder, compiler("FC")); /* of the module it takes names alone */

    *in_c = shell(&test_pool, "cd %s && ./c", folder);
    *in_fortran = shell(&test_pool, "cd %s && ./f", folder);
}

POOL_TEST(both_compilers_give_the_same_values_sizes_and_offsets)
{
    needs_compiler(&test_pool, "FC");
    const char *in_c, *in_fortran, *folder = make_folder(&test_pool);
    struct header header;
    read_header(shell_file(&test_pool, HEADER), &header);
    run_witnesses(folder, &header, MODULE, &in_c, &in_fortran);
    assert_non_null(strstr(in_c, "\nrotid_deck 2")); /* sizes of three digits */
    assert_non_null(strstr(in_c, "\nROTID_ERROR_LIBRARY -15\n"));
    assert_non_null(strstr(in_c, "\nrotid_lm_options says "));
    assert_string_equal(in_fortran, in_c);

    /* a module that has drifted is seen here, too */
    static const char *const drift[][2] = {{"integer(c_long) :: seed", "integer(c_int) :: seed"},
                                           {"lower = 0, upper = 0", "upper = 0, lower = 0"},
                                           {"ROTID_NAMED = 1", "ROTID_NAMED = 3"},
                                           {"ci95(2)", "ci95(3)"},
                                           {"size = 112", "size = 72"}};
    const char *text = shell_file(&test_pool, MODULE);
    for (size_t i = 0; i < sizeof drift / sizeof *drift; i++) {
        (void)write_file(&test_pool, folder, "rotid.f90", changed(text, drift[i][0], drift[i][1]));
        run_witnesses(folder, &header, "rotid.f90", &in_c, &in_fortran);
        assert_string_not_equal(in_fortran, in_c);
    }
    remove_folder(&test_pool, folder);
}

POOL_TEST(the_module_is_standard_fortran)
{
    needs_compiler(&test_pool, "FC");
    const char *folder = make_folder(&test_pool), *version = shell(&test_pool, "%s --version", compiler("FC"));
    compile("cd %s && %s %s -c %s -o rotid.o", folder, compiler("FC"), strstr(version, "GNU") ? STRICT : "", MODULE);
    remove_folder(&test_pool, folder);
}

static int write_types(void)
{
    struct pool pool;
    struct header header;
    pool_open(&pool, NULL);
    if (header_read(&pool, HEADER, &header)) {
        (void)fprintf(stderr, "rotid.h:%d: %s\n", header.line, header.error);
        return 1;
    }
    const char *types = fortran_types(&pool, &header),
               *text = types ? fortran_with_types(&pool, shell_file(&pool, MODULE), types) : NULL;
    FILE *stream = text ? fopen(MODULE, "w") : NULL;
    int written = stream && fputs(text, stream) >= 0;
    if (!stream || fclose(stream) != 0 || !written) {
        (void)fprintf(stderr, "include/rotid.f90 is not written\n");
        return 1;
    }
    pool_close(&pool);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--write") == 0)
        return write_types();
    return test_main(argc, argv);
}
