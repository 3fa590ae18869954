/* Hostile texts in every text of every kind of result that `rotid report` reads, in a page that a browser opens: nothing of them
 * runs, becomes markup or leads elsewhere, neither in the page as it is written nor in the document after its script. `make test`
 * makes one page of each kind; ROTID_SWEEP_PAYLOADS asks for as many texts as that. */
#include <cJSON.h>

#include "page/page.h"
#include "page_bench.h"
#include "study/study.h"
#include "support.h"

#define PAPER      ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define SOLID      ROTID_SOURCE_DIR "/input/solid_rotor.inp"
#define LAP        ROTID_SOURCE_DIR "/input/brake_reuss_lap.inp"
#define MOST_TEXT  600
#define MOST_KEYS  200
#define MOST_TEXTS 2000
/* Itself a text that the page and the scripts hold. */
#define HOSTILE_NAME "it's `touch pwned` <script>\" %s $(touch pwned)\n#\\.json"

/* %s: a file that whoever runs the text would make */
static const char *const fragments[] = {"<script>alert(1)</script>",
                                        "<img src=x onerror=alert(1)>",
                                        "\" onload=\"alert(1)\" x=\"",
                                        "' onload='alert(1)' x='",
                                        "{/X\"><script>alert(1)</script> y}",
                                        "{/X\" onload=\"alert(1) y}",
                                        "{/:Bold=99 x}^{2}_{3}",
                                        "@^{a}_{b} &{c} ~d{.8-}",
                                        "`touch %s`",
                                        "$(touch %s)",
                                        "'; system('touch %s') #",
                                        "\"; system(\"touch %s\") #",
                                        "'\nsystem('touch %s')\n#",
                                        "\r\n!touch %s\r\n",
                                        "'.system('touch %s').'",
                                        "|touch %s",
                                        "'\nset output '%s'\nreplot\n'",
                                        "\nend\n$x << end\n",
                                        "@W @name $W",
                                        "}}}{{{",
                                        "[(}])",
                                        "# no more",
                                        "\\",
                                        "\\'",
                                        "''",
                                        "\"",
                                        "%%s %%n %%d %%T %%%%",
                                        "%%",
                                        "</svg></style></title></html>",
                                        "]]> --> <!--",
                                        "&amp;&lt;&#60;&",
                                        "<a href=\"http://example.org/x\">",
                                        "url(//example.org/x)",
                                        "javascript:alert(1)",
                                        "data:text/html,<script>1</script>",
                                        "\x1b[31m\x07\x08",
                                        "\xc2\x9b\xc2\x85\x7f",
                                        "\xe2\x80\xae\xe2\x81\xa6\xe2\x80\xa8",
                                        "\xff\xfe\xc3\xed\xa0\x80",
                                        "\xef\xbf\xbf\xef\xbf\xbe",
                                        "\xc3\xa9\xf0\x9f\x98\x80",
                                        "\t",
                                        ""};

struct kind {
    const char *file;
    int lines; /* a value a line */
    cJSON *json;
    int nkey;
    const char *refused[MOST_KEYS]; /* keys whose text is a word of rotid: another is refused */
};

static struct kind kinds[] = {
    {.file = "identify.json"}, {.file = "diagnose.json"}, {.file = "frf.json"},   {.file = "sensitivity.json"},
    {.file = "modes.json"},    {.file = "study.json"},    {.file = "check.json"}, {.file = "runs.jsonl", .lines = 1}};
#define KINDS (sizeof kinds / sizeof *kinds)

static struct random_stream stream;

static cJSON *read_kind(const struct kind *kind)
{
    if (!kind->lines)
        return page_json(kind->file);
    cJSON *list = cJSON_CreateArray();
    for (const char *text = page_read(kind->file), *end; *text; text = end + 1) {
        cJSON *line = cJSON_ParseWithOpts(text, &end, 0);
        assert_non_null(line);
        cJSON_AddItemToArray(list, line);
    }
    return list;
}

/* A line of results as the study writes it: stamped, since nobody reads a line that was changed. `study` is that of the header,
 * which is the first line. */
static void write_line(FILE *out, const cJSON *item, int is_header, char study[DIGEST_LETTERS + 1])
{
    struct study_header header;
    cJSON *copy = cJSON_Duplicate(item, 1);
    if (!is_header) {
        cJSON_DeleteItemFromObjectCaseSensitive(copy, "study");
        cJSON_DeleteItemFromObjectCaseSensitive(copy, "digest");
    }
    char *bare = cJSON_PrintUnformatted(copy), *line = bare ? pool_format(&test_pool, "%s\n", bare) : NULL;
    if (line && is_header && !results_header_read(&test_pool, line, strlen(line), &header)) /* else nobody reads the file */
        stamp_study(&header, study);
    char *stamped = line && !is_header ? stamp_line(study, line) : NULL;
    assert_true(line && (is_header || stamped));
    (void)fputs(is_header ? line : stamped, out);
    free(stamped);
    cJSON_free(bare);
    cJSON_Delete(copy);
}

static void write_kind(const struct kind *kind, const cJSON *json, const char *name)
{
    char *text = NULL, study[DIGEST_LETTERS + 1] = "";
    size_t length;
    FILE *out = open_memstream(&text, &length);
    assert_non_null(out);
    for (const cJSON *item = kind->lines ? json->child : NULL; item; item = item->next)
        write_line(out, item, item == json->child, study);
    char *whole = kind->lines ? NULL : cJSON_PrintUnformatted(json);
    if (whole)
        (void)fprintf(out, "%s\n", whole);
    cJSON_free(whole);
    assert_int_equal(fclose(out), 0);
    page_write_file(name, text);
    free(text);
}

static int is_refused(const struct kind *kind, const char *key)
{
    for (int i = 0; i < kind->nkey; i++)
        if (!strcmp(kind->refused[i], key))
            return 1;
    return 0;
}

/* ------------------------------------------------------------------------------------------------ the texts of a result */

struct replaced { /* the same text is the same name in all places */
    const char *from;
    char *to;
};

struct walk {
    const struct kind *kind;
    const char *only; /* this key alone, NULL: all that are not refused */
    double share;     /* of the texts that are replaced */
    int count;
    struct replaced text[MOST_TEXTS];
};

static void append(char text[MOST_TEXT], const char *fragment)
{
    char piece[MOST_TEXT];
    (void)snprintf(piece, sizeof piece, fragment, page_path("pwned")); /* NOLINT: one of the list above */
    size_t used = strlen(text);
    (void)snprintf(text + used, MOST_TEXT - used, "%s", piece);
}

/* One to three fragments, and a number that no other text has: names tell parameters apart. */
static char *hostile_text(int number)
{
    char text[MOST_TEXT] = "", last[16];
    int parts = 1 + (int)(3 * random_uniform(&stream));
    for (int i = 0; i < parts; i++)
        append(text, fragments[(size_t)(random_uniform(&stream) * (double)(sizeof fragments / sizeof *fragments))]);
    (void)snprintf(last, sizeof last, "%d", number);
    append(text, number % 2 ? last : "");
    if (number % 2 == 0) { /* what ends with a fragment may swallow the quote behind it */
        char turned[MOST_TEXT];
        (void)snprintf(turned, sizeof turned, "%s%.*s", last, MOST_TEXT - 32, text);
        return strdup(turned);
    }
    return strdup(text);
}

static void replace(struct walk *walk, cJSON *item)
{
    int k = 0;
    while (k < walk->count && strcmp(walk->text[k].from, item->valuestring) != 0)
        k++;
    if (k == MOST_TEXTS)
        return;
    if (k == walk->count) {
        walk->text[walk->count++] =
            (struct replaced){strdup(item->valuestring), random_uniform(&stream) < walk->share ? hostile_text(k) : NULL};
        assert_non_null(walk->text[k].from);
    }
    if (walk->text[k].to)
        assert_non_null(cJSON_SetValuestring(item, walk->text[k].to));
}

static void walk_over(struct walk *walk, cJSON *item, const char *key)
{
    key = item->string ? item->string : key;
    if (cJSON_IsString(item) && key && (walk->only ? !strcmp(walk->only, key) : !is_refused(walk->kind, key)))
        replace(walk, item);
    for (cJSON *child = item->child; child; child = child->next)
        walk_over(walk, child, key);
}

/* The result with hostile texts under a name: how many. */
static int write_hostile(const struct kind *kind, const char *only, double share, const char *name)
{
    static struct walk walk;
    int hostile = 0;
    cJSON *json = cJSON_Duplicate(kind->json, 1);
    walk = (struct walk){.kind = kind, .only = only, .share = share};
    walk_over(&walk, json, NULL);
    write_kind(kind, json, name);
    cJSON_Delete(json);
    for (int k = 0; k < walk.count; k++) {
        hostile += walk.text[k].to != NULL;
        free((char *)walk.text[k].from);
        free(walk.text[k].to);
    }
    return hostile;
}

static void learn_keys(struct kind *kind, const cJSON *item, int *free_keys)
{
    static const char *seen[MOST_KEYS];
    static int nseen;
    if (item == kind->json)
        nseen = 0;
    for (const cJSON *child = item->child; child; child = child->next)
        learn_keys(kind, child, free_keys);
    if (!cJSON_IsString(item) || !item->string)
        return;
    for (int i = 0; i < nseen; i++)
        if (!strcmp(seen[i], item->string))
            return;
    assert_true(nseen < MOST_KEYS);
    seen[nseen++] = item->string;
    (void)write_hostile(kind, item->string, 1, "learn.json");
    if (!page_composed("learn.json", NULL, NULL))
        (*free_keys)++;
    else
        kind->refused[kind->nkey++] = item->string;
}

/* ------------------------------------------------------------------------------------------------ what became of them */

/* The page in a browser, without its policy: its script ends without a complaint, the texts became no element and no attribute
 * that runs or leads elsewhere, and figures are there. */
static int judge_document(const struct kind *kind)
{
    static const char script[] =
        "const "
        "bad=[...document.querySelectorAll('*')].filter(e=>['IMG','IFRAME','OBJECT','EMBED','B','FORM','BASE','LINK'].includes("
        "e.tagName)||[...e.attributes].some(a=>/^on/.test(a.name)||a.name==='style'||(/href|src/.test(a.name)&&!/^#/"
        ".test(a.value))));"
        "document.title=`${bad.length+(document.scripts.length-3)} of ${document.querySelectorAll('figure').length}`+"
        "bad.slice(0,3).map(e=>e.outerHTML.slice(0,200)).join(' ');";
    const char *title = browser_driven("hostile.html", "1000,800", script);
    int invaders = -1, figures = 0;
    if (sscanf(title, "%d of %d", &invaders, &figures) != 2 || invaders || !figures) { /* NOLINT: two numbers of our script */
        print_error("%s: %s\n", kind->file, title);
        return 1;
    }
    return 0;
}

/* A page of this kind with hostile texts; how many, 0 where the result is refused: a file of results that is no UTF-8. */
static int try_page(const struct kind *kind, double share)
{
    static int number;
    int texts = write_hostile(kind, NULL, share, HOSTILE_NAME);
    int code = page_run("cd %s && rm -f hostile.html && %s report it*json -o hostile.html", page_path(""), ROTID_PROGRAM);
    char said[400];
    (void)snprintf(said, sizeof said, "%.399s", page_err);
    int refused =
            code == 2 && kind->lines && strstr(page_err, "is none of those that the file has") && !page_exists("hostile.html"),
        bad = !refused && (code != 0 || *said);
    if (!bad && !refused) {
        bad += page_problems_of_markup(page_read("hostile.html")) > 0;
        bad += judge_document(kind);
    }
    bad += page_exists("pwned") || page_count("", "pwned");
    if (bad) { /* kept, to be looked at: the folder of the test goes */
        (void)page_run("cp %s/it*json /tmp/report-sweep-%d.json", page_path(""), number);
        print_error("%s, page %d: exit code %d, '%s'; the result is /tmp/report-sweep-%d.json\n", kind->file, number, code, said,
                    number);
    }
    assert_int_equal(bad, 0);
    number++;
    return refused ? 0 : texts;
}

POOL_TEST(hostile_texts_stay_texts)
{
    if (!browser_name()) {
        print_message("no Chromium: what a browser makes of hostile texts is left out\n");
        skip();
    }
    const char *asked = getenv("ROTID_SWEEP_PAYLOADS"); /* NOLINT: nobody sets it meanwhile */
    long wanted = asked ? strtol(asked, NULL, 10) : 0, texts = 0, pages = 0, refused = 0;
    double begin = clock_seconds();
    stream.state = 12;
    assert_int_equal(page_run("cd %s; %s identify %s --quiet --json identify.json; %s sensitivity %s --quiet --json "
                              "sensitivity.json && " /* 1: not
                                                        adequate
                                                      */
                              "%s frf %s --quiet --set FRF.LINES=40 --json frf.json && %s modes %s --quiet --json modes.json && "
                              "%s diagnose %s --quiet --json diagnose.json && %s check %s --quiet --json "
                              "check.json && "
                              "%s study %s %s %s/input/brake_reuss_beam.inp -o runs.jsonl --quiet --json study.json",
                              page_path(""), ROTID_PROGRAM, SOLID, ROTID_PROGRAM, PAPER, ROTID_PROGRAM, PAPER, ROTID_PROGRAM,
                              PAPER, ROTID_PROGRAM, LAP, ROTID_PROGRAM, PAPER, ROTID_PROGRAM, SOLID, PAPER, ROTID_SOURCE_DIR),
                     0);
    for (size_t i = 0; i < KINDS; i++) {
        int free_keys = 0;
        kinds[i].json = read_kind(&kinds[i]);
        learn_keys(&kinds[i], kinds[i].json, &free_keys);
        assert_true(free_keys >= 5); /* else nothing was tried */
    }
    for (; texts < wanted || pages < (long)KINDS; pages++) {
        int more = try_page(&kinds[(size_t)pages % KINDS], (size_t)pages < KINDS ? 1 : 0.5);
        texts += more;
        refused += !more;
    }
    print_message("%ld hostile texts in %ld pages, %ld results refused, %.0f s: nothing ran\n", texts, pages - refused, refused,
                  clock_seconds() - begin);
    assert_true(4 * refused <= pages);
    for (size_t i = 0; i < KINDS; i++)
        cJSON_Delete(kinds[i].json);
}

TEST_GROUP(page_bench_open, page_bench_close);
