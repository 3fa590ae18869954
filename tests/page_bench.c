#include "page_bench.h"

#include <ctype.h>
#include <dirent.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "page/page.h"
#include "study_bench.h"
#include "support.h"

static char directory[] = "/tmp/test_page_XXXXXX";
char page_out[1 << 16], page_err[1 << 16];

const char *page_path(const char *name)
{
    static char path[16][512];
    static int next;
    next = (next + 1) % 16;
    (void)snprintf(path[next], sizeof path[next], "%s/%s", directory, name);
    return path[next];
}

int page_bench_open(void **state)
{
    (void)state;
    return mkdtemp(directory) ? 0 : -1;
}

int page_bench_close(void **state)
{
    (void)state;
    return page_run("chmod -R u+w %s; rm -r %s", directory, directory);
}

void page_write_file(const char *name, const char *text)
{
    FILE *stream = fopen(page_path(name), "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0 && fclose(stream) == 0);
}

const char *page_read(const char *name)
{
    static char *kept[8];
    static int next;
    struct stat is;
    FILE *stream = fopen(page_path(name), "rb");
    if (!stream)
        print_error("%s is not there\n", page_path(name));
    assert_non_null(stream);
    assert_int_equal(fstat(fileno(stream), &is), 0);
    next = (next + 1) % 8;
    free(kept[next]);
    kept[next] = malloc((size_t)is.st_size + 1);
    assert_non_null(kept[next]);
    assert_int_equal(fread(kept[next], 1, (size_t)is.st_size, stream), is.st_size);
    kept[next][is.st_size] = 0;
    (void)fclose(stream);
    return kept[next];
}

int page_exists(const char *name)
{
    struct stat is;
    return lstat(page_path(name), &is) == 0;
}

int page_count(const char *folder, const char *prefix)
{
    DIR *list = opendir(page_path(folder));
    struct dirent *entry;
    int count = 0;
    while (list && (entry = readdir(list)))
        count += !strncmp(entry->d_name, prefix, strlen(prefix)) && strcmp(entry->d_name, ".") && strcmp(entry->d_name, "..");
    if (list)
        (void)closedir(list);
    return count;
}

static void read_into(const char *name, char *text, size_t size)
{
    FILE *stream = fopen(page_path(name), "rb");
    size_t length = stream ? fread(text, 1, size - 1, stream) : 0;
    text[length] = 0;
    if (stream)
        (void)fclose(stream);
}

int page_run(const char *format, ...)
{
    static char command[8192], whole[9000];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(command, sizeof command, format, arguments);
    va_end(arguments);
    (void)snprintf(whole, sizeof whole, "{ %s ; } > %s/.out 2> %s/.err", command, directory, directory);
    int status = system(whole); /* NOLINT: a command of the test */
    read_into(".out", page_out, sizeof page_out);
    read_into(".err", page_err, sizeof page_err);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* ------------------------------------------------------------------------------------------------ what a page has to be */

#define MOST_OPEN 64
#define MOST_IDS  20000
#define DATA      "<script type=\"application/json\" id=\"data\">["
#define SCRIPT    "<script>// https://d3js.org" /* the one that was embedded begins so */

struct checker {
    int problems, open, nid, nreference, scripts;
    char stack[MOST_OPEN][24];
    const char *id[MOST_IDS], *reference[MOST_IDS];
    int id_length[MOST_IDS], reference_length[MOST_IDS];
};

static void problem(struct checker *checker, const char *what, const char *at)
{
    if (checker->problems++ < 10)
        print_error("%s: %.80s\n", what, at);
}

static int is_void(const char *name)
{
    static const char *const names[] = {"meta", "br", "hr", "link", "img", "input"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strcmp(names[i], name))
            return 1;
    return 0;
}

static void note(const char **list, int *lengths, int *count, const char *at, int length)
{
    if (*count < MOST_IDS) {
        list[*count] = at;
        lengths[(*count)++] = length;
    }
}

static void judge_attribute(struct checker *checker, const char *name, const char *value, int length)
{
    if (!strcmp(name, "id"))
        note(checker->id, checker->id_length, &checker->nid, value, length);
    if (!strcmp(name, "aria-labelledby"))
        for (int from = 0, to; from < length; from = to + 1) {
            for (to = from; to < length && value[to] != ' '; to++)
                continue;
            note(checker->reference, checker->reference_length, &checker->nreference, value + from, to - from);
        }
    if (!strcmp(name, "href") && *value == '#')
        note(checker->reference, checker->reference_length, &checker->nreference, value + 1, length - 1);
    else if (!strcmp(name, "href"))
        problem(checker, "refers elsewhere", value);
    if (!strcmp(name, "src"))
        problem(checker, "loads", value);
    if (!strncmp(name, "on", 2) || !strcmp(name, "srcset") || !strcmp(name, "style"))
        problem(checker, "attribute that loads or runs", name);
    if (!strncmp(value, "url(#", 5))
        note(checker->reference, checker->reference_length, &checker->nreference, value + 5, length - 6);
    for (int i = 0; i < length; i++)
        if (value[i] == '<')
            problem(checker, "< in an attribute", value);
}

/* Attributes up to '>' : the place behind it. */
static const char *judge_attributes(struct checker *checker, const char *at, int *is_empty)
{
    *is_empty = 0;
    while (*at && *at != '>') {
        char name[40];
        int n = 0;
        if (isspace((unsigned char)*at) || *at == '/') {
            *is_empty = *at++ == '/';
            continue;
        }
        while (isalnum((unsigned char)*at) || (*at && strchr("-:_", *at))) {
            if (n < 39)
                name[n++] = *at;
            at++;
        }
        name[n] = 0;
        if (!n || *at != '=' || at[1] != '"') {
            problem(checker, "attribute without quoted value", at);
            return at + strcspn(at, ">") + 1;
        }
        const char *value = at + 2, *end = strchr(value, '"');
        if (!end) {
            problem(checker, "quote that is not closed", value);
            return value + strlen(value);
        }
        judge_attribute(checker, name, value, (int)(end - value));
        at = end + 1;
    }
    return *at ? at + 1 : at;
}

static const char *judge_tag(struct checker *checker, const char *at)
{
    char name[24];
    int n = 0, closes = at[1] == '/', is_empty;
    const char *tag = at;
    at += 1 + closes;
    while (isalnum((unsigned char)*at) && n < 23)
        name[n++] = *at++;
    name[n] = 0;
    if (!n)
        problem(checker, "< that begins no element", tag);
    if (!closes && !strcmp(name, "script") && strncmp(tag, DATA, sizeof DATA - 1) != 0 &&
        strncmp(tag, SCRIPT, sizeof SCRIPT - 1) != 0)
        problem(checker, "script that is none of ours", tag);
    if (!strcmp(name, "iframe") || !strcmp(name, "object") || !strcmp(name, "link"))
        problem(checker, "element that loads or runs", tag);
    at = judge_attributes(checker, at, &is_empty);
    if (closes) {
        if (!checker->open || strcmp(checker->stack[checker->open - 1], name) != 0)
            problem(checker, "closes what is not open", tag);
        checker->open -= checker->open > 0;
    } else if (!is_empty && !is_void(name) && checker->open < MOST_OPEN) {
        (void)strcpy(checker->stack[checker->open++], name);
    }
    if (!closes && !strcmp(name, "style"))
        at = strstr(at, "</style>") ? strstr(at, "</style>") : at;
    if (!closes && !strcmp(name, "script")) {
        checker->scripts++;
        at = strstr(at, "</script>") ? strstr(at, "</script>") : at;
    }
    return at;
}

static void judge_references(struct checker *checker)
{
    for (int i = 0; i < checker->nid; i++)
        for (int j = 0; j < i; j++)
            if (checker->id_length[i] == checker->id_length[j] &&
                !memcmp(checker->id[i], checker->id[j], (size_t)checker->id_length[i]))
                problem(checker, "identifier that occurs twice", checker->id[i]);
    for (int r = 0; r < checker->nreference; r++) {
        int found = 0;
        for (int i = 0; i < checker->nid && !found; i++)
            found = checker->id_length[i] == checker->reference_length[r] &&
                    !memcmp(checker->id[i], checker->reference[r], (size_t)checker->id_length[i]);
        if (!found)
            problem(checker, "refers to what is not there", checker->reference[r]);
    }
}

int page_problems_of_markup(const char *html)
{
    static struct checker checker;
    memset(&checker, 0, sizeof checker);
    static const char begin[] = "<!DOCTYPE html>\n<html lang=\"en\">";
    if (strncmp(html, begin, sizeof begin - 1) != 0)
        problem(&checker, "begins as no page", html);
    for (const char *at = html + 15; *at;)
        if (*at == '<')
            at = judge_tag(&checker, at);
        else if (*at == '&' && strncmp(at, "&amp;", 5) != 0 && strncmp(at, "&lt;", 4) != 0 && strncmp(at, "&gt;", 4) != 0 &&
                 strncmp(at, "&quot;", 6) != 0 && strncmp(at, "&#39;", 5) != 0) {
            problem(&checker, "& that begins no reference", at);
            at++;
        } else {
            at++;
        }
    if (checker.open)
        problem(&checker, "is not closed", checker.stack[checker.open - 1]);
    judge_references(&checker);
    if (checker.scripts != 0 && checker.scripts != 2)
        problem(&checker, "scripts more or less than the data and ours", html);
    if (!strstr(
            html,
            "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: blob:; style-src 'sha256-"))
        problem(&checker, "has no policy that lets nothing of others run", html);
    return checker.problems;
}

/* Blanks from an element on to its end, whatever it is of. */
static void blank(char *text, const char *begin, const char *end)
{
    for (char *at = text; (at = strstr(at, begin));) {
        char *last = strstr(at, end);
        for (; at < last; at++)
            *at = ' ';
        at += last ? 1 : strlen(at);
    }
}

int page_problems(const char *html)
{
    static struct checker checker;
    checker.problems = page_problems_of_markup(html);
    static const char *const never[] = {"http:", "https:", "javascript:", "@import", "NaN", "nan "};
    char *text = strdup(html);
    assert_non_null(text);
    blank(text, "<script", "</script>");
    blank(text, "<pre>", "</pre>");
    for (size_t i = 0; i < sizeof never / sizeof *never; i++)
        for (const char *at = text; (at = strstr(at, never[i])); at++)
            problem(&checker, "has no place on a page", at);
    free(text);
    return checker.problems;
}

/* ------------------------------------------------------------------------------------------------ a browser */

const char *browser_name(void)
{
    static const char *const names[] = {"chromium", "chromium-browser", "google-chrome"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!page_run("command -v %s", names[i]))
            return names[i];
    return NULL;
}

const char *browser_dom(const char *name, const char *size, const char *more)
{
    assert_int_equal(
        page_run(
            "cd %s; timeout 120 %s --headless --no-sandbox --disable-gpu --user-data-dir=%s/browser --virtual-time-budget=4000 "
            "--enable-logging=stderr --window-size=%s %s --dump-dom file://%s > %s.dom",
            directory, browser_name(), directory, size, more, page_path(name), name),
        0);
    char dom[300];
    (void)snprintf(dom, sizeof dom, "%s.dom", name);
    return page_read(dom);
}

int browser_complaints(void)
{
    int count = 0;
    for (const char *at = page_err; (at = strstr(at, ":CONSOLE")); at++) {
        print_error("console: %.300s\n", at);
        count++;
    }
    return count;
}

const char *browser_driven(const char *name, const char *size, const char *script)
{
    static char title[4000];
    char *page = strdup(page_read(name)), *policy = page ? strstr(page, "http-equiv=\"Content-Security-Policy\"") : NULL;
    assert_non_null(policy);
    memcpy(policy, "data-nothing", 12);
    char *end = strstr(page, "</body>");
    assert_non_null(end);
    FILE *out = fopen(page_path("driven.html"), "wb");
    assert_non_null(out);
    (void)fprintf(out, "%.*s<script>%s</script></body></html>", (int)(end - page), page, script);
    assert_int_equal(fclose(out), 0);
    free(page);
    const char *dom = browser_dom("driven.html", size, ""), *from = strstr(dom, "<title>");
    assert_int_equal(browser_complaints(), 0);
    assert_non_null(from);
    (void)snprintf(title, sizeof title, "%.*s", (int)(strstr(from, "</title>") - from - 7), from + 7);
    return title;
}

cJSON *page_json(const char *name)
{
    cJSON *json = cJSON_Parse(page_read(name));
    assert_non_null(json);
    return json;
}

void page_make_study(const char *name, const char *plan)
{
    char path[64];
    (void)snprintf(path, sizeof path, "%s.plan", name);
    if (page_exists(path))
        return;
    page_write_file("beam.inp", BENCH_DECK);
    page_write_file(path, plan);
    assert_int_equal(
        page_run("cd %s; %s study %s.plan -o %s.jsonl --quiet --json %s.json", page_path(""), ROTID_PROGRAM, name, name, name),
        0);
}

cJSON *page_runs(const char *name)
{
    const char *text = strchr(page_read(name), '\n') + 1, *end;
    cJSON *list = cJSON_CreateArray();
    while (*text) {
        cJSON *line = cJSON_ParseWithOpts(text, &end, 0);
        assert_non_null(line);
        cJSON_AddItemToArray(list, line);
        text = end + 1;
    }
    return list;
}

void page_write_json(const char *name, const cJSON *json)
{
    char *text = cJSON_Print(json);
    assert_non_null(text);
    page_write_file(name, text);
    cJSON_free(text);
}

const char *page_made(const char *name)
{
    static char file[64];
    (void)snprintf(file, sizeof file, "%s.html", name);
    assert_int_equal(page_run("cd %s; %s report %s -o %s", page_path(""), ROTID_PROGRAM, name, file), 0);
    assert_string_equal(page_err, "");
    const char *html = page_read(file);
    assert_int_equal(page_problems(html), 0);
    return html;
}

void page_says(const char *html, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (!strstr(html, text))
        print_error("the page does not say '%s'\n", text);
    assert_non_null(strstr(html, text));
}

int page_times(const char *text, const char *what)
{
    int count = 0;
    while ((text = strstr(text, what))) {
        count++;
        text++;
    }
    return count;
}

int page_composed(const char *name, const rotid_allocator *allocator, int *errors)
{
    struct pool pool;
    struct message_list messages;
    struct result result;
    struct document document;
    pool_open(&pool, allocator);
    message_open(&messages, &pool);
    int status = page_result_read(&pool, page_path(name), &messages, &result);
    if (errors)
        *errors = messages.errors;
    if (!status) {
        assert_status(document_open(&document, &pool), ROTID_OK);
        page_compose(&document, 1, &result);
        assert_true(allocator || !document.pool->out_of_memory);
        document_close(&document);
    }
    cJSON_Delete(result.json);
    pool_close(&pool);
    return status;
}

long page_composed_without_memory(const char *name)
{
    long served = 0;
    assert_status(page_composed(name, NULL, NULL), ROTID_OK);
    for (long n = 0; n == 0 || n <= served; n += 1 + n / 9) { /* 0: counts */
        struct failing_allocator failing;
        failing_allocator_open(&failing, n);
        int status = page_composed(name, &failing.allocator, NULL);
        assert_true(n > 0 || !status);
        served = n ? served : failing.served;
        assert_int_equal(failing.in_use, 0);
    }
    return served;
}
