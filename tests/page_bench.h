/* `rotid report` run in a folder of its own, what a page has to be, and a browser that opens pages. */
#ifndef ROTID_TESTS_PAGE_BENCH_H
#define ROTID_TESTS_PAGE_BENCH_H

#include <cJSON.h>
#include <stddef.h>

#include "rotid.h"

/* Setup and teardown of a group: makes and removes the folder. */
int page_bench_open(void **state);
int page_bench_close(void **state);

/* name in that folder; good for the next 16 calls. */
const char *page_path(const char *name);
void page_write_file(const char *name, const char *text);
/* The whole file, kept until the next 8 calls; the test fails where it is not there. */
const char *page_read(const char *name);
int page_exists(const char *name);
/* The same as JSON; what page_json gives is to be deleted. */
cJSON *page_json(const char *name);
void page_write_json(const char *name, const cJSON *json);
/* `rotid study` of BENCH_DECK, beam.inp, by a plan: NAME.jsonl and the summary NAME.json, unless the plan is there already. */
void page_make_study(const char *name, const char *plan);
/* The runs of a file of results, without its header; to be deleted. */
cJSON *page_runs(const char *name);
/* Entries of the folder whose names begin with `prefix`. */
int page_count(const char *folder, const char *prefix);

/* Exit code of a shell command; page_out and page_err hold what it wrote. */
int page_run(const char *format, ...) __attribute__((format(printf, 1, 2)));
extern char page_out[1 << 16], page_err[1 << 16];

/* Problems of a page: elements that are not closed or in wrong order, attributes without quotes, identifiers that occur twice or
 * are referred to and missing, anything that would be loaded or run. Each is printed; their number. */
int page_problems(const char *html);
/* Of its elements and attributes alone: its texts may say anything. */
int page_problems_of_markup(const char *html);

/* The page that `rotid report` makes of a result in the folder; nothing is wrong with it. */
const char *page_made(const char *name);
/* The test fails where the page does not hold this text. */
void page_says(const char *html, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* How often `what` stands in the text. */
int page_times(const char *text, const char *what);

/* Reads a result in the folder and composes its page without writing it, in this process; everything is freed, with `allocator`
 * (may be NULL) for the pool. The status of the reader; *errors (may be NULL): how many it found. A page that is composed with
 * enough memory lacks nothing. */
int page_composed(const char *name, const rotid_allocator *allocator, int *errors);
/* The same with memory that ends after 1, 2, ... blocks: never a crash, never a leak. How many blocks there are. */
long page_composed_without_memory(const char *name);

/* The name of a Chromium that starts here, NULL where there is none. */
const char *browser_name(void);
/* The document after its script ran, as the browser has it; what the console said stands in page_err, CONSOLE in its lines. size:
 * of the window, such as "1000,800"; more: further options. */
const char *browser_dom(const char *name, const char *size, const char *more);
/* The same of a copy with a script of the test behind its own, and without the policy, which would not let that run: what the
 * script puts into the title. The console has to be silent. */
const char *browser_driven(const char *name, const char *size, const char *script);
/* Lines of the console, each printed. */
int browser_complaints(void);

#endif
