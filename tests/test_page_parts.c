/* The parts of a page: numbers for people, colours that can be told apart, texts in scripts, pictures made ready, programs run.
 */
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "page/document.h"
#include "page/html.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/picture.h"
#include "page/plot.h"
#include "page/process.h"
#include "page_bench.h"
#include "picture_check.h"
#include "result/place.h"
#include "support.h"

#define MINUS "\xe2\x88\x92"
#define SPACE "\xc2\xa0"

static void numbers_are_written_for_people(void **state)
{
    (void)state;
    struct pool *pool = &test_pool;
    const double wide[2] = {55.1e9, 176.4e9}, narrow[2] = {209.978e9, 210.505e9}, none[2] = {NAN, NAN}, mass[2] = {-0.5, 2.5};
    assert_string_equal(human_interval(pool, 115.75e9, wide, "Pa"), "115.8" SPACE "GPa (95" SPACE "%: 55.1 to 176.4)");
    assert_string_equal(human_interval(pool, 210.2415e9, narrow, "Pa"), "210.242" SPACE "GPa (95" SPACE "%: 209.978 to 210.505)");
    assert_string_equal(human_interval(pool, 1, mass, "kg"), "1.00" SPACE "kg (95" SPACE "%: " MINUS "0.50 to 2.50)");
    assert_string_equal(human_interval(pool, 60e9, none, "Pa"), "60" SPACE "GPa");
    assert_string_equal(human_value(pool, 9790, "N/m"), "9.79" SPACE "kN/m");
    assert_string_equal(human_value(pool, 1e6, "Pa"), "1" SPACE "MPa");
    assert_string_equal(human_value(pool, -999, "N/m"), MINUS "999" SPACE "N/m");
    assert_string_equal(human_value(pool, 0, "Pa"), "0" SPACE "Pa");
    assert_string_equal(human_value(pool, 0.3333333, "1"), "0.3333");
    assert_string_equal(human_value(pool, 7850, "kg/m3"), "7850" SPACE "kg/m\xc2\xb3");
    assert_string_equal(human_value(pool, 12, "furlong"), "12" SPACE "furlong");
    assert_string_equal(human_signed(pool, 8.2149, 2), "+8.21");
    assert_string_equal(human_signed(pool, -4.376, 2), MINUS "4.38");
    assert_string_equal(human_signed(pool, -0.001, 2), "0.00");
    assert_string_equal(human_fixed(pool, NAN, 2), "\xe2\x80\x93");
    assert_string_equal(human_fixed(pool, -INFINITY, 2), "\xe2\x80\x93");
    assert_string_equal(human_digits(pool, 9.145e-11, 2), "9.1e-11");
    assert_string_equal(human_digits(pool, -1.5e120, 2), MINUS "1.5e120");
    assert_string_equal(human_fixed(pool, 1.234e-8, 9), "1.2e-8");
    assert_string_equal(human_fixed(pool, 0.00049, 4), "5e-4");
    assert_string_equal(human_fixed(pool, 0.00049, 3), "0.000");
    assert_string_equal(human_signed(pool, 2.5e-6, 8), "+2.50e-6");
    assert_string_equal(human_interval(pool, 3e-8, (const double[]){2.9e-8, 3.1e-8}, "1"), 
                        "3.000e-8 (95" SPACE "%: 2.900e-8 to 3.100e-8)");
    assert_string_equal(human_digits(pool, 0.023053, 3), "0.0231");
    assert_string_equal(human_digits(pool, 2314.4, 3), "2314");
    assert_string_equal(human_digits(pool, 999.96, 4), "1000");
    assert_string_equal(human_trimmed(pool, 80.470, 5), "80.47");
    assert_string_equal(human_trimmed(pool, 100, 5), "100");
    assert_string_equal(human_count(pool, 12), "twelve");
    assert_string_equal(human_count(pool, 13), "13");
    assert_string_equal(human_seconds(pool, 0.0301), "30" SPACE "ms");
    assert_string_equal(human_seconds(pool, 600), "10" SPACE "min");
    assert_close(human_half_width_percent(-2, (double[]){-3, -1}), 50, 1e-15, 0);
}

/* Relative luminance and contrast as WCAG 2.1 has them. */
static double luminance(unsigned rgb)
{
    static const double weight[3] = {0.2126, 0.7152, 0.0722};
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double c = (double)(rgb >> (16 - 8 * i) & 255) / 255;
        sum += weight[i] * (c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4));
    }
    return sum;
}

static double contrast(unsigned a, unsigned b)
{
    double x = luminance(a), y = luminance(b);
    return x > y ? (x + 0.05) / (y + 0.05) : (y + 0.05) / (x + 0.05);
}

static const struct role *role_called(const char *name)
{
    const struct role *role = palette;
    while (role->name && strcmp(role->name, name) != 0)
        role++;
    assert_non_null(role->name);
    return role;
}

static void every_colour_reads_on_its_ground(void **state)
{
    (void)state;
    static const char *const text[] = {"INK", "MUTED", "BLUE", "VERMILION", "GREEN", "PURPLE", "OCHRE"};
    static const char *const grounds[] = {"PAPER", "BAND"};
    for (size_t i = 0; i < sizeof text / sizeof *text; i++)
        for (size_t g = 0; g < 2; g++) {
            const struct role *role = role_called(text[i]), *ground = role_called(grounds[g]);
            assert_true(contrast(role->light, ground->light) >= 4.5);
            assert_true(contrast(role->dark, ground->dark) >= 4.5);
        }
    static const char *const faces[] = {"STEEL", "SHEETS", "LEAF", "ROSE", "SAND", "SHADE"}; /* lines and words lie on them */
    for (size_t i = 0; i < sizeof faces / sizeof *faces; i++) {
        assert_true(contrast(role_called("INK")->light, role_called(faces[i])->light) >= 4.5);
        assert_true(contrast(role_called("INK")->dark, role_called(faces[i])->dark) >= 4.5);
    }
    for (int step = 0; step <= 10; step++) { /* numbers in the cells of a matrix */
        const struct role *cell = role_called(palette_ramp(step / 10.0)), *number = role_called(palette_on_ramp(step / 10.0));
        assert_true(contrast(cell->light, number->light) >= 4.5);
        assert_true(contrast(cell->dark, number->dark) >= 4.5);
    }
    /* a colour names one role: a picture finds its dark one by that */
    for (const struct role *role = palette; role->name; role++)
        for (const struct role *other = palette; other < role; other++)
            assert_true(other->light != role->light);
    assert_string_equal(palette_ramp(NAN), "RAMP0");
    assert_string_equal(palette_ramp(7), "RAMP10");
}

static void texts_are_escaped(void **state)
{
    (void)state;
    char *text = NULL;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    assert_non_null(out);
    html_text(out, "<a href='x'>\"&\" \xc3\xa9 \xf0\x9f\x98\x80 \xc3 \xed\xa0\x80 \x01\x7f \xc2\x85 \t \xe2\x80\xae");
    (void)fclose(out);
    assert_string_equal(text, "&lt;a href=&#39;x&#39;&gt;&quot;&amp;&quot; \xc3\xa9 \xf0\x9f\x98\x80 \xef\xbf\xbd "
                              "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd \xef\xbf\xbd\xef\xbf\xbd \xef\xbf\xbd \t \xef\xbf\xbd");
    free(text);
    struct plot plot = {.pool = &test_pool};
    assert_string_equal(plot_quote(&plot, "it's `rm` \"q\" \\"), "'it\xe2\x80\x99s `rm` \"q\" \\'");
    assert_string_equal(plot_quote(&plot, "a\nb\xff\r\xc3\xa9''"), "'a b\xef\xbf\xbd \xc3\xa9\xe2\x80\x99\xe2\x80\x99'");
    assert_string_equal(plot_quote(&plot, ""), "''");
    assert_string_equal(plot_quote(&plot, "\xe2\x80\xae\xc2\x9b\x7f\xef\xbf\xbe."), /* turned round, C1, DEL, no character */
                        "'\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd.'");
    assert_string_equal(plot_quote(&plot, "100 %"), "'100 %'");
    assert_string_equal(plot_quote_tick(&plot, "it's 100 %s"), "'it\xe2\x80\x99s 100 %%s'");
    assert_string_equal(plot_number(&plot, NAN), "NaN");
    assert_string_equal(plot_number(&plot, -1.5e-7), "-1.5e-07");
}

/* ------------------------------------------------------------------------------------------------ scripts */

static void ranges_and_ticks_cover_what_is_drawn(void **state)
{
    (void)state;
    const double value[] = {3, NAN, -1, INFINITY, 7}, same[] = {5, 5}, small[] = {2e-3, 0, 40, -1, NAN};
    struct plot_range range = plot_range_of(5, value, 0.1);
    assert_close(range.from, -1.8, 1e-15, 0);
    assert_close(range.to, 7.8, 1e-15, 0);
    range = plot_range_of(2, same, 0);
    assert_true(range.from < 5 && range.to > 5);
    range = plot_range_of(0, NULL, 0);
    assert_true(range.from == 0 && range.to == 1);
    range = plot_decades(5, small, 9);
    assert_true(range.from == -3 && range.to == 2);
    range = plot_decades(5, small, 3);
    assert_true(range.from == -1 && range.to == 2);
    range = plot_decades(1, (const double[]){1}, 3);
    assert_true(range.to == range.from + 1);
    assert_close(plot_tic(2.03, 6), 0.2, 1e-12, 0);
    assert_close(plot_tic(1, 5), 0.2, 1e-12, 0);
    assert_close(plot_tic(7e-7, 6), 1e-7, 1e-12, 0);
    assert_true(plot_tic(0, 5) > 0 && plot_tic(INFINITY, 5) > 0 && plot_tic(NAN, 5) > 0);
    assert_true(plot_left(&(struct plot_range){-0.02, 0.01}, 0.005) > plot_left(&(struct plot_range){0, 5}, 1) + 20);
    assert_true(plot_left(&(struct plot_range){-1e308, 1e308}, 1) < 1000); /* ends, and within the page */
}

/* Heights of the labels "one", "two", ... of a script. */
static void labels_at_the_end_of_lines_do_not_overlap(void **state)
{
    (void)state;
    static const char *const text[] = {"one", "two", "three", "four", "five", "six"};
    static const char *const color[] = {"BLUE", "BLUE", "BLUE", "BLUE", "BLUE", "BLUE"};
    static const double heights[][6] = {
        {0.5, 0.5, 0.5, 0.5, 0.5, 0.5}, {1, 1, 1, 1, 1, 1}, {0, 0, 0.01, 0.9, 2, -3}, {0.1, 0.9, 0.3, 0.5, NAN, 0.7}};
    for (size_t c = 0; c < sizeof heights / sizeof *heights; c++) {
        struct figure figure = {.id = "labels"};
        struct plot plot;
        double y[6];
        assert_status(plot_open(&plot, &test_pool, &figure, "test"), ROTID_OK);
        plot_begin(&plot, &(struct plot_layout){.panels = 1, .columns = {1, 1}, .height = 260, .right = 80, .top = 10, .bottom = 50});
        plot_panel(&plot, 0);
        plot_end_labels(&plot, 6, text, heights[c], color);
        assert_status(plot_close(&plot), ROTID_OK);
        for (int i = 0; i < 6; i++) {
            char quoted[16];
            (void)snprintf(quoted, sizeof quoted, "'%s' at", text[i]);
            const char *at = strstr(figure.script, quoted);
            assert_non_null(at);
            assert_int_equal(sscanf(at + strlen(quoted), " graph 1, graph %lf", &y[i]), 1); /* NOLINT */
            assert_true(y[i] >= -1e-9 && y[i] <= 1 + 1e-9);
            for (int j = 0; j < i; j++) {
                assert_true(fabs(y[i] - y[j]) * 200 > 14.5);
                if (fmin(fmax(heights[c][i], 0), 1) < fmin(fmax(heights[c][j], 0), 1)) /* in the order of the lines */
                    assert_true(y[i] < y[j]);
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------------ pictures */

static const char picture[] =
    "<?xml version=\"1.0\"?>\n<svg \n viewBox=\"0 0 720 300\"\n xmlns=\"http://www.w3.org/2000/svg\"\n>\n<title>Gnuplot</title>\n"
    "<rect x=\"0\" y=\"0\" width=\"720\" height=\"300\" fill=\"#ffffff\"/>\n"
    "<path stroke='rgb(  0, 114, 178)' d='M1,2 L3,4'/>\n<path style='fill:none; stroke:rgb(91,98,107)' d='M0,0 L8,8'/>\n"
    "<polygon fill = 'rgb(199, 214, 226)' points = '0,0 1,1'/>\n"
    "<g stroke=\"none\" fill=\"black\" font-family=\"Arial\"><text>x &lt; 1 \xc2\xb5</text></g>\n</svg>\n";

static void a_picture_follows_light_and_dark(void **state)
{
    (void)state;
    const char *uri = picture_uri(&test_pool, picture);
    assert_non_null(uri);
    assert_int_equal(strspn(uri, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=:;,"), strlen(uri));
    char *svg = picture_of_uri(uri), *style = svg ? strstr(svg, "<style>") : NULL,
         *behind = style ? strstr(style, "</style>") : NULL;
    assert_non_null(behind);
    assert_int_equal(picture_problems(svg), 0);
    /* what gnuplot drew, with a style behind its first tag */
    assert_int_equal(strlen(svg), strlen(picture) + (size_t)(behind + 8 - style));
    assert_memory_equal(svg, picture, (size_t)(style - svg));
    assert_string_equal(behind + 8, picture + (style - svg));
    *behind = 0;
    static const char *const holds[] = {"@media screen and (prefers-color-scheme:dark){",
                                        "[stroke=\"rgb(  0, 114, 178)\"]{stroke:#56b4e9}",
                                        "[style*=\"stroke:rgb(91,98,107)\"]{stroke:#a3abb5!important}",
                                        "[fill=\"#ffffff\"]{fill:#16181d}", "[fill=\"black\"]{fill:#e8eaed}"};
    for (size_t i = 0; i < sizeof holds / sizeof *holds; i++)
        page_says(style, "%s", holds[i]);
    assert_null(strstr(style, "214"));     /* one off the colour of steel: no role */
    assert_null(strstr(style, "#2bbf93")); /* nothing is green */
    free(svg);
    for (int more = 0; more < 4; more++) { /* any number of bytes */
        char text[sizeof picture + 4];
        (void)snprintf(text, sizeof text, "%s%.*s", picture, more, "\n\n\n");
        char *again = picture_of_uri(picture_uri(&test_pool, text));
        assert_non_null(again);
        assert_string_equal(strstr(again, "<title>"), strstr(text, "<title>"));
        free(again);
    }
    /* cut off anywhere, or with anything behind it, it is no picture */
    for (size_t cut = 0; cut < sizeof picture - 2; cut++) {
        char text[sizeof picture];
        memcpy(text, picture, cut);
        text[cut] = 0;
        assert_null(picture_uri(&test_pool, text));
    }
    assert_null(picture_uri(&test_pool, "<svg></svg>more"));
}

/* The judge of all pictures finds what it is there for. */
static void a_hostile_picture_is_seen(void **state)
{
    (void)state;
    static const char *const hostile[] = {"<svg><script>1</script></svg>",
                                          "<svg><g font-family=\"X\" onload=\"1\"/></svg>",
                                          "<svg><use xlink:href='http://x/#a'/></svg>",
                                          "<svg><path fill='url(//x)'/></svg>",
                                          "<svg><a href='#x'/></svg>",
                                          "<svg><g></svg>",
                                          "<svg>\x01</svg>",
                                          "<svg>&</svg>",
                                          "<svg><g fill=none/></svg>",
                                          "<svg><image href='#a'/></svg>"};
    assert_int_equal(picture_problems(picture), 0);
    print_message("ten pictures that are to be refused:\n");
    for (size_t i = 0; i < sizeof hostile / sizeof *hostile; i++)
        assert_true(picture_problems(hostile[i]) > 0);
}

static void identifiers_of_a_page_occur_once(void **state)
{
    (void)state;
    struct document document;
    document_open(&document, &test_pool);
    document_section(&document, "shapes", "One");
    struct figure *first = document_figure(&document, "shapes", "First"),
                  *second = document_figure(&document, "shapes", "Second"),
                  *other = document_figure(&document, "shapes-of-others", "Third");
    document_section(&document, "shapes", "Two");
    assert_string_equal(first->id, "shapes-2");
    assert_string_equal(second->id, "shapes-3");
    assert_string_equal(other->id, "shapes-of-others");
    assert_string_equal(document.last->id, "shapes-4");
    document_paragraph(&document, "%s is <not> %d %%", "this & that", 5);
    char *text = NULL;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    assert_non_null(out);
    document.title = "Title";
    document_write(out, &document, "made", "how");
    (void)fclose(out);
    assert_non_null(strstr(text, "<p>this &amp; that is &lt;not&gt; 5 %</p>"));
    assert_int_equal(page_problems(text), 0);
    free(text);
    assert_false(document.failed);
}

/* ------------------------------------------------------------------------------------------------ programs */

static int cancel_now(void *context)
{
    (void)context;
    return 1;
}

static void a_program_is_run_waited_for_and_ended(void **state)
{
    (void)state;
    struct process_result run;
    const char *const say[] = {"sh", "-c", "echo out; echo err >&2; read x || echo eof; exit 3", NULL};
    assert_status(process_run(say, PROCESS_HERE, 10, NULL, &run), ROTID_OK);
    assert_true(run.exit_code == 3 && !run.timed_out && !run.cancelled);
    assert_string_equal(run.out, "out\neof\n");
    assert_string_equal(run.err, "err\n");
    /* more than is kept, on both streams: neither blocks */
    const char *const flood[] = {"sh", "-c", "head -c 300000 /dev/zero | tr '\\0' a; head -c 300000 /dev/zero | tr '\\0' b >&2",
                                 NULL};
    assert_status(process_run(flood, PROCESS_HERE, 20, NULL, &run), ROTID_OK);
    assert_true(run.exit_code == 0 && strlen(run.out) == PROCESS_TEXT - 1 && strlen(run.err) == PROCESS_TEXT - 1);
    double begin = clock_seconds();
    const char *const sleeper[] = {"sleep", "20", NULL};
    assert_status(process_run(sleeper, PROCESS_HERE, 0.2, NULL, &run), ROTID_OK);
    assert_true(run.timed_out && run.exit_code == -1);
    const rotid_environment impatient = {.size = sizeof impatient, .cancelled = cancel_now};
    assert_status(process_run(sleeper, PROCESS_HERE, 20, &impatient, &run), ROTID_OK);
    assert_true(run.cancelled && clock_seconds() - begin < 10);
    const char *const where[] = {"pwd", NULL};
    char before[4096], after[4096];
    int root = open("/", O_RDONLY | O_DIRECTORY);
    assert_non_null(getcwd(before, sizeof before));
    assert_status(process_run(where, root, 10, NULL, &run), ROTID_OK);
    assert_string_equal(run.out, "/\n");
    assert_non_null(getcwd(after, sizeof after));
    assert_string_equal(before, after);
    (void)close(root);
    const char *const nobody[] = {"/nowhere/at/all", NULL};
    assert_status(process_run(nobody, PROCESS_HERE, 1, NULL, &run), ROTID_ERROR_IO);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_test_pool, close_test_pool)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(numbers_are_written_for_people),
        TEST(every_colour_reads_on_its_ground),
        TEST(texts_are_escaped),
        TEST(ranges_and_ticks_cover_what_is_drawn),
        TEST(labels_at_the_end_of_lines_do_not_overlap),
        TEST(a_picture_follows_light_and_dark),
        TEST(a_hostile_picture_is_seen),
        TEST(identifiers_of_a_page_occur_once),
        TEST(a_program_is_run_waited_for_and_ended),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
