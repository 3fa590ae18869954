/* Pages in a browser: every figure of every kind of result is drawn, the console stays silent, every button does what it says,
 * nothing is wider than a phone, a print has the tables open, and without the script the page reads as well. */
#include "page_bench.h"
#include "support.h"

#define INPUT ROTID_SOURCE_DIR "/input/"

static const struct {
    const char *name, *command; /* command: of a shell, %1$s being the program */
    const char *figures[16];    /* that the page has to have */
} kinds[] = {
    {"check", "check " INPUT "paper_rotor.inp --json", {"rotor"}},
    {"modes", "modes " INPUT "paper_rotor.inp --json", {"motion", "frequencies"}},
    {"solid", "modes " INPUT "paper_rotor_solid.inp --json", {"motion", "frequencies", "meridian"}},
    {"states", "modes " INPUT "strip_states.inp --json", {"rotor", "frequencies", "rotor-2", "frequencies-2"}},
    {"sensitivity", "sensitivity " INPUT "paper_rotor.inp --json", {"sensitivity", "sensitivity-curves", "growth"}},
    {"speeds", "speeds " INPUT "motor_running.inp --draws 30 --json", {"campbell", "response", "speed-map", "critical-shapes"}},
    {"frf", "frf " INPUT "paper_rotor.inp --json", {"transfer"}},
    {"identify",
     "identify " INPUT "solid_rotor.inp --json",
     {"motion", "frequencies", "mac", "nco", "intervals", "correlation", "convergence", "iterates", "bijection"}},
    {"identify_states",
     "identify " INPUT "strip_states.inp --json",
     {"frequencies", "frequencies-2", "intervals", "convergence"}},
    {"diagnose",
     "diagnose " INPUT "brake_reuss_lap.inp --json",
     {"motion", "frequencies", "mac", "nco", "gain", "causes-1", "places", "residuals", "limits"}},
    {"suggest", "suggest " INPUT "foam_bar.inp --json", {"rotor", "tests", "plan", "sensor-worth", "counts"}},
    {"ema", "ema " ROTID_SOURCE_DIR "/tests/data/uff/beam_excerpt.uff --json", {"shapes", "mac", "stabilisation", "functions"}},
    {"study", "study " INPUT "paper_study.plan -o", {"starts", "functional-by-modes", "parameters-by-modes", "decks"}},
};
#define KINDS (int)(sizeof kinds / sizeof *kinds)

static const char *file_of(int i)
{
    static char name[64];
    (void)snprintf(name, sizeof name, "%s.%s", kinds[i].name, strcmp(kinds[i].name, "study") ? "json" : "jsonl");
    return name;
}

static const char *page_of(int i)
{
    static char name[64];
    (void)snprintf(name, sizeof name, "%s.html", kinds[i].name);
    return name;
}

static int make_pages(void **state)
{
    (void)state;
    for (int i = 0; i < KINDS && browser_name(); i++) {
        int code = page_run("cd %s; %s %s %s --quiet", page_path(""), ROTID_PROGRAM, kinds[i].command, file_of(i));
        if (code > 1 || page_run("cd %s; %s report %s -o %s.html", page_path(""), ROTID_PROGRAM, file_of(i), kinds[i].name)) {
            print_error("%s: %s\n", kinds[i].name, page_err);
            return -1;
        }
    }
    return 0;
}

static void need_browser(void)
{
    if (browser_name())
        return;
    print_message("no Chromium: what a browser makes of pages is left out\n");
    skip();
}

FIXTURE_TEST(every_figure_is_drawn_and_nothing_complains, make_pages, NULL)
{
    need_browser();
    for (int i = 0; i < KINDS; i++) {
        char page[64], figure[64];
        (void)snprintf(page, sizeof page, "%s.html", kinds[i].name);
        const char *dom = browser_dom(page, "1000,800", "");
        assert_int_equal(browser_complaints(), 0);
        for (int k = 0; kinds[i].figures[k]; k++) {
            (void)snprintf(figure, sizeof figure, "<figure id=\"%s\">", kinds[i].figures[k]);
            const char *at = strstr(dom, figure);
            if (!at)
                print_error("%s: %s is not there\n", kinds[i].name, kinds[i].figures[k]);
            assert_non_null(at);
            const char *end = strstr(at, "</figure>");
            int shapes = 0; /* of a drawing that is empty there is an axis at most */
            for (const char *shape = at; end && (shape = strpbrk(shape, "<")) && shape < end; shape++)
                shapes += !strncmp(shape, "<path", 5) || !strncmp(shape, "<circle", 7) || !strncmp(shape, "<rect", 5);
            if (!shapes)
                print_error("%s: nothing is drawn in %s\n", kinds[i].name, kinds[i].figures[k]);
            assert_true(shapes > 0);
        }
        const char *from = strstr(dom, "<main>"), *to = strstr(dom, "</main>"), *nan = strstr(from, "NaN"),
                   *none = strstr(from, "undefined");
        assert_true((!nan || nan > to) && (!none || none > to)); /* behind it stands the script */
    }
}

UNIT_TEST(every_button_works)
{
    need_browser();
    /* what is saved is kept in place of the download; what is chosen changes its drawing, a choice of one apart */
    static const char script[] =
        "const saved=[];const "
        "wrong=[];URL.createObjectURL=(b)=>{saved.push(b.type+':'+b.size);if(!b.size)wrong.push('empty');return "
        "'data:,';};HTMLAnchorElement.prototype.click=function(){if(!this.download)wrong.push('no name');};"
        "for(const f of document.querySelectorAll('figure')){const svg=f.querySelector('svg[role]');"
        "for(const b of f.querySelectorAll('.controls button')){const was=svg.innerHTML;const "
        "on=b.getAttribute('aria-pressed');const said=b.textContent;"
        "b.click();if(on==='false'&&said!=='play'&&was===svg.innerHTML&&!f.querySelector('h3').textContent.includes('alike'))"
        "wrong.push(f.id+' '+b.textContent);"
        "if(b.textContent==='stop')b.click();}"
        "const n=saved.length;for(const b of f.querySelectorAll('.tools "
        "button'))if(['SVG','CSV'].includes(b.textContent))b.click();"
        "if(saved.length!==n+2)wrong.push(f.id+' saves '+(saved.length-n));"
        "const d=f.querySelector('details.numbers');d.open=true;d.dispatchEvent(new Event('toggle'));"
        "if(d.querySelectorAll('tbody tr').length<1)wrong.push(f.id+' has no numbers');}"
        "const before=saved.length;document.querySelector('footer .tools "
        "button').click();if(saved.length!==before+1)wrong.push('JSON');"
        "for(const b of document.querySelectorAll('main>section>.tools button'))if(b.textContent==='CSV')b.click();"
        "document.title=wrong.length?wrong.join('; '):'fine '+saved.length;";
    for (int i = 0; i < KINDS; i++) {
        const char *title = browser_driven(page_of(i), "1000,800", script);
        if (strncmp(title, "fine ", 5) != 0)
            print_error("%s: %s\n", kinds[i].name, title);
        assert_true(!strncmp(title, "fine ", 5) && atoi(title + 5) > 2);
    }
}

UNIT_TEST(nothing_is_wider_than_a_phone)
{
    need_browser();
    /* a frame of 390 px, since a window has a least width */
    static const char script[] =
        "document.body.style.maxWidth='none';document.documentElement.style.width='390px';document.documentElement.style."
        "overflowX='hidden';"
        "document.body.style.width='390px';innerWidth;dispatchEvent(new Event('resize'));"
        "const wide=[];for(const e of document.querySelectorAll('main *, header *'))if(!e.closest('.scroll')&&!e.closest('svg')&&"
        "e.getBoundingClientRect().right>391)wide.push(e.tagName+' '+(e.id||e.className)+' '+e.getBoundingClientRect().right);"
        "document.title=wide.length?wide.slice(0,5).join('; '):'fits';";
    for (int i = 0; i < KINDS; i++) {
        const char *title = browser_driven(page_of(i), "390,800", script);
        if (strcmp(title, "fits") != 0)
            print_error("%s: %s\n", kinds[i].name, title);
        assert_string_equal(title, "fits");
    }
}

UNIT_TEST(a_print_has_its_tables_open)
{
    need_browser();
    const char *title = browser_driven(
        "study.html", "1000,800",
        "const shut=[...document.querySelectorAll('main details.fold')];const all=shut.every(d=>!d.open);"
        "dispatchEvent(new Event('beforeprint'));document.title=shut.length&&all&&shut.every(d=>d.open)?'open':'shut';");
    assert_string_equal(title, "open");
    assert_int_equal(
        page_run("cd %s; timeout 120 %s --headless --no-sandbox --disable-gpu --user-data-dir=%s --print-to-pdf=print.pdf "
                 "file://%s",
                 page_path(""), browser_name(), page_path("browser"), page_path("identify.html")),
        0);
    assert_true(page_exists("print.pdf"));
    assert_int_equal(page_run("head -c 5 %s | grep -q %%PDF", page_path("print.pdf")), 0);
    assert_int_equal(page_run("grep -aq '/Subtype */Image' %s", page_path("print.pdf")), 1); /* vectors alone */
}

/* As it is written: what a reader has where the script does not run. */
UNIT_TEST(without_the_script_the_page_reads)
{
    need_browser();
    for (int i = 0; i < KINDS; i++) {
        char page[64];
        (void)snprintf(page, sizeof page, "%s.html", kinds[i].name);
        const char *html = page_read(page), *end = strstr(html, "<script"), *figure = strstr(html, "<figure"),
                   *shut = strstr(html, "<details class=\"fold\"><summary>1");
        assert_non_null(end);
        assert_true((!figure || figure > end) && (!shut || shut > end));
        assert_true(strstr(html, "class=\"answer") < end && strstr(html, "id=\"provenance\"") < end);
        assert_int_equal(page_problems(html), 0);
    }
}

TEST_GROUP(page_bench_open, page_bench_close);
