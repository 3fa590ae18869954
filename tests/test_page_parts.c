/* The parts of a page: numbers for people, texts, one table shown in three ways, words in place of ids. */
#include "page/page.h"
#include "page_bench.h"
#include "report/report.h"
#include "support.h"

#define MINUS "\xe2\x88\x92"
#define SPACE "\xc2\xa0"
#define DASH  "\xe2\x80\x93"

POOL_TEST(numbers_are_written_for_people)
{
    struct pool *pool = &test_pool;
    const double wide[2] = {55.1e9, 176.4e9}, narrow[2] = {209.978e9, 210.505e9}, none[2] = {NAN, NAN}, mass[2] = {-0.5, 2.5};
    assert_string_equal(human_interval(pool, 115.75e9, wide, "Pa"), "116" SPACE "GPa (95" SPACE "%: 55 to 176)");
    assert_string_equal(human_interval(pool, 210.2415e9, narrow, "Pa"), "210.24" SPACE "GPa (95" SPACE "%: 209.98 to 210.51)");
    assert_string_equal(human_interval(pool, 1, mass, "kg"), "1.0" SPACE "kg (95" SPACE "%: " MINUS "0.5 to 2.5)");
    assert_string_equal(human_interval(pool, 60e9, none, "Pa"), "60" SPACE "GPa");
    assert_string_equal(human_quote(pool, 115.75e9, wide, "Pa"), "120 \xc2\xb1 60" SPACE "GPa");
    assert_string_equal(human_quote(pool, 210.2415e9, narrow, "Pa"), "210.24 \xc2\xb1 0.26" SPACE "GPa");
    assert_null(human_quote(pool, 60e9, none, "Pa"));
    assert_string_equal(human_quote(pool, 1, mass, "kg"), "1.0 \xc2\xb1 1.5" SPACE "kg");
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
                        "3.00e-8 (95" SPACE "%: 2.90e-8 to 3.10e-8)");
    assert_string_equal(human_digits(pool, 0.023053, 3), "0.0231");
    assert_string_equal(human_digits(pool, 2314.4, 3), "2314");
    assert_string_equal(human_digits(pool, 999.96, 4), "1000");
    assert_string_equal(human_trimmed(pool, 80.470, 5), "80.47");
    assert_string_equal(human_trimmed(pool, 100, 5), "100");
    assert_string_equal(human_count(pool, 12), "twelve");
    assert_string_equal(human_count(pool, 13), "13");
    assert_string_equal(human_seconds(pool, 0.0301), "30" SPACE "ms");
    assert_string_equal(human_seconds(pool, 600), "10" SPACE "min");
}

UNIT_TEST(texts_are_escaped)
{
    char *text = NULL;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    assert_non_null(out);
    html_text(out, "<a href='x'>\"&\" \xc3\xa9 \xf0\x9f\x98\x80 \xc3 \xed\xa0\x80 \x01\x7f \xc2\x85 \t \xe2\x80\xae");
    (void)fclose(out);
    assert_string_equal(text, "&lt;a href=&#39;x&#39;&gt;&quot;&amp;&quot; \xc3\xa9 \xf0\x9f\x98\x80 \xef\xbf\xbd "
                              "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd \xef\xbf\xbd\xef\xbf\xbd \xef\xbf\xbd \t \xef\xbf\xbd");
    free(text);
}

/* What a stream holds after a table was written to it. */
static const char *written(void (*write)(FILE *out, const struct table *table), const struct table *table)
{
    char *text = NULL;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    assert_non_null(out);
    write(out, table);
    assert_int_equal(fclose(out), 0);
    const char *kept = pool_copy_text(&test_pool, text);
    free(text);
    return kept;
}

static void write_text(FILE *out, const struct table *table)
{
    table_write_text(out, table, 80);
}

static void write_html(FILE *out, const struct table *table)
{
    table_write_html(out, table, 7, plain_text);
}

POOL_TEST(a_table_is_shown_in_three_ways)
{
    static const struct {
        const char *part;
        double error, chance, mass;
    } rows[] = {{"=left", -0.126, 1e-9, 60}, {"core \xe2\x82\xac", 12.5, 0.254, NAN}};
    struct table *table = table_open(&test_pool, "Masses & errors");
    table->note = "The last row is not known.";
    for (int i = 0; i < 2; i++) {
        text_column(table, "part", SHOW_TEXT, rows[i].part);
        number_column(table, "error", "%", SHOW_SIGNED(2), rows[i].error);
        number_column(table, "none", NULL, SHOW_FIXED(3), NAN);
        number_column(table, "chance", NULL, SHOW_CHANCE(2), rows[i].chance);
        scaled_column(table, "stiffness", "N/m", SHOW_DIGITS(3), 2e6, 1e6 * (i + 1));
        number_column(table, "mass", "kg", SHOW_TRIMMED(4), rows[i].mass);
        number_column(table, "raw", NULL, SHOW_COUNT | IN_CSV_ONLY, i);
        text_column(table, "remark", NOT_IN_CSV | DETAIL, i ? "a long remark that a narrow screen has no room for" : "");
    }
    assert_false(table->pool->out_of_memory);
    assert_int_equal(table_rows(table), 2);
    assert_int_equal(table_column_is_shown(table, 2), 0); /* dashes alone */
    /* columns end under their heads, in characters and not in bytes; a column without a value is not there */
    assert_string_equal(written(write_text, table), "Masses & errors\n"
                                                    "part    error [%]  chance  stiffness [MN/m]  mass [kg]\n"
                                                    "=left       -0.13  <0.001              1.00         60\n"
                                                    "core \xe2\x82\xac     +12.50    0.25              2.00          -\n"
                                                    "The last row is not known.\n");
    /* numbers as they are, and nothing that a spreadsheet runs */
    assert_string_equal(written(table_write_csv, table), "part,error [%],none,chance,stiffness [N/m],mass [kg],raw\n"
                                                         "'=left,-0.126,,1e-9,1e6,60,0\n"
                                                         "core \xe2\x82\xac,12.5,,0.254,2e6,,1\n");
    const char *html = written(write_html, table);
    page_says(html, "<caption id=\"table-7\"><span>Masses &amp; errors</span></caption>");
    page_says(html, "<tr><th scope=\"col\">part</th><th scope=\"col\" class=\"n\">error [%%]</th>");
    page_says(html, "<tr><th scope=\"row\">=left</th><td class=\"n\">" MINUS "0.13</td><td class=\"n\">&lt;0.001</td>");
    page_says(html, "<p class=\"note\">The last row is not known.</p>");
    assert_null(strstr(html, "none"));
}

/* People read it in its unit, with the digits of its interval; CSV has SI. */
POOL_TEST(a_row_has_a_unit)
{
    struct table *table = table_open(&test_pool, "");
    unit_column(table, 115.75e9, (176.4e9 - 55.1e9) / 2, "Pa");
    number_column(table, "value", ROW_UNIT, SHOW_ROW, 115.75e9);
    number_column(table, "upper", ROW_UNIT, SHOW_ROW, 176.4e9);
    assert_string_equal(written(write_text, table), "unit  value  upper\nGPa   115.8  176.4\n");
    assert_string_equal(written(table_write_csv, table), "unit,value,upper\nPa,115750000000,1.764e11\n");
}

POOL_TEST(ids_become_words_and_paths_names)
{
    static const char *const text[][2] = {{"The model lacks added_mass; it explains", "The model lacks added mass; it explains"},
                                          {"stiffness_local of core, joint", "soft zone of core, joint"},
                                          {"my_added_mass added_mass2 added_mass.inp core.added_mass", NULL},
                                          {"(beam_theory)", "(error of beam theory)"},
                                          {"rotid diagnose /home/a/rotor.inp --extended", "rotid diagnose rotor.inp --extended"},
                                          {"added_mass of '/a/b.inp', /c/d/e", "added mass of 'b.inp', e"},
                                          {"kg/m3, input/rotor.inp, and /or, https://x/y/z", NULL},
                                          {"", NULL}};
    for (size_t i = 0; i < sizeof text / sizeof *text; i++)
        assert_string_equal(plain_text(&test_pool, text[i][0]), text[i][1] ? text[i][1] : text[i][0]);
    assert_null(plain_text(&test_pool, NULL));
    assert_string_equal(plain_file("/a/b.inp"), "b.inp");
    assert_string_equal(plain_file("a/b.inp"), "a/b.inp");
    assert_string_equal(plain_cause(&test_pool, "step_stiffness"), "step stiffness");
}

/* Whoever adds a text to a page: outside of the section on provenance it is shown so. */
POOL_TEST(every_text_of_a_page_is_shown_so)
{
    struct document document;
    struct message_list messages;
    const char *file;
    message_open(&messages, &test_pool);
    static const char *const text[] = {"list: added_mass of /a/b/c1.inp"}, *const name[] = {"fact"};
    assert_status(document_open(&document, &test_pool), ROTID_OK);
    document.title = document.subtitle = "";
    document.now.text = "answer: beam_theory";
    document.now.headline = "headline: support_extra";
    document.now.next = "next: rotid diagnose /a/b/c2.inp";
    document_answer(&document, NULL);
    document_section(&document, "one", "One", NULL);
    document_paragraph(&document, "paragraph: %s", "stiffness_local");
    document_heading(&document, "heading: step_stiffness");
    document_list(&document, 1, text);
    document_facts(&document, 1, name, text);
    struct table *table = table_open(&test_pool, "caption: layer_slip");
    text_column(table, "head: tie_shear", SHOW_TEXT, "cell: tie_tension");
    table->note = "note: tie_stiffness";
    document_table(&document, table);
    document.verbatim = 1;
    document_section(&document, "provenance", "Provenance", NULL);
    document_paragraph(&document, "as it is: added_inertia /a/b/c3.inp");
    document.verbatim = 0;
    assert_false(document.pool->out_of_memory);
    assert_status(page_write(&document, 0, NULL, page_path("shown.html"), "made", &messages, &file), ROTID_OK);
    document_close(&document);
    const char *html = page_read("shown.html");
    static const char *const shown[] = {"answer: error of beam theory",
                                        "headline: extra support",
                                        "next: rotid diagnose c2.inp",
                                        "paragraph: soft zone",
                                        "heading: step stiffness",
                                        "<li>list: added mass of c1.inp",
                                        "<dd>list: added mass of c1.inp",
                                        "head: tie shear",
                                        "cell: tie tension",
                                        "caption: layer slip",
                                        "note: tie stiffness",
                                        "as it is: added_inertia /a/b/c3.inp"};
    for (size_t i = 0; i < sizeof shown / sizeof *shown; i++)
        if (!strstr(html, shown[i]))
            fail_msg("'%s' is not on the page:\n%s", shown[i], html);
}

TEST_GROUP(page_bench_open, page_bench_close);
