#ifndef ROTID_PAGE_PAGE_H
#define ROTID_PAGE_PAGE_H

/* page: results as a page: one HTML file that holds the answer and the tables as text, the results as data, one style sheet and
 * one script, page.js, which draws the figures from the data.
 *
 * Comes in: files of JSON that commands wrote, or a file of results of a study. Goes out: the file. Called by rotid report alone.
 *
 *   page_result_read   a file of JSON, every mistake with its place                                               compose.c
 *   page_compose       answer, tiles, sections, tables, places of figures, results by rank                        compose.c
 *   answer_*, section_*  what a page says of a kind of result: identification.c, diagnosis.c; the others, basis and
 *                      provenance: compose.c
 *   document_*         the page under construction: answers, headings, tables (struct table of src/report), figures  document.c
 *   words              causes, candidates and files in words                                                      words.c
 *   page_write         head with the content policy, answers, body, the data block: results as JSON, script to a file, whole or
 *                      not there: document.c
 *
 * C draws nothing: where a figure may stand it writes an empty element with the name of a group of figures, and the script knows
 * which figures belong there. Without the script, or without D3 when the program was built, answer and tables stand alone. The
 * room computes nothing of a model; texts of files are escaped by html_text of src/report. */

#include <cJSON.h>

#include "report/report.h"
#include "result/result.h"
#include "run/run.h"

/* ---- reading */

/* Reads a file that a command wrote with --json, or a file of results of a study. Statuses of result_read; the caller deletes
 * result->json. */
int page_result_read(struct pool *pool, const char *file, struct message_list *messages, struct result *result);

/* ---- the page under construction. Whatever is added when memory is out is lost and marks the document. */

#define TILES_MOST 8

struct tile { /* a number to design with, and how far it can be trusted */
    const char *name, *value, *note;
};

struct answer { /* of one result */
    struct answer *following;
    enum tone tone;
    const char *of;       /* whose it is, NULL of the only result */
    const char *headline; /* NULL: the words of the tone */
    const char *text, *next;
    int ntiles;
    struct tile tile[TILES_MOST];
};

struct heading {
    struct heading *following;
    const char *id, *text;
};

struct document {
    struct pool *pool;
    const char *title, *subtitle;
    struct answer now;      /* the answer that is being made */
    struct answer *answers; /* the gravest first */
    const char *of;         /* whose sections are added, told in their headings; NULL: that of the page */
    int result, state;      /* index of the result and of its state (-1: none) whose figures are placed */
    int verbatim;           /* texts are shown with folders and ids: of the provenance */
    FILE *body;
    char *text; /* of the body */
    size_t length;
    struct heading *first, *last;
    int ntables, in_section;
};

int document_open(struct document *document, struct pool *pool); /* ROTID_OK or ROTID_ERROR_MEMORY */
void document_close(struct document *document);
/* Puts the answer that was made among those of the page. */
void document_answer(struct document *document, const char *of);
void document_tile(struct document *document, const char *name, const char *value, const char *note);
/* What is added from here on belongs to this section, which begins with these figures, NULL: none. An id that is taken gets a
 * number. */
void document_section(struct document *document, const char *id, const char *heading, const char *figures);
void document_heading(struct document *document, const char *text);
void document_paragraph(struct document *document, const char *format, ...) __attribute__((format(printf, 2, 3)));
void document_list(struct document *document, int count, const char *const text[]);
/* Names and their values; a value NULL is left out with its name. */
void document_facts(struct document *document, int count, const char *const name[], const char *const value[]);
/* A table; a long one is folded by the script. */
void document_table(struct document *document, const struct table *table);
/* The place of a group of figures of page.js, drawn from the current result and state. */
void document_figures(struct document *document, const char *group);

/* ---- words: texts never NULL, "" where memory is out */

const char *plain_cause(struct pool *pool, const char *id);  /* "soft zone" of stiffness_local */
const char *plain_text(struct pool *pool, const char *text); /* ids of causes in words, absolute paths without folders */
const char *plain_file(const char *path);                    /* the last part of an absolute path */
const char *cause_label(struct pool *pool, const rotid_diagnosis *d, const rotid_cause *cause);
/* Of cause i of the extended model: those that were named, then those that are likely beside them. */
const char *extended_label(struct pool *pool, const rotid_diagnosis *d, int i);

/* ---- what a page says of each kind of result: the answer, then the sections */

void tile_parameter(struct document *document, const rotid_fitted_parameter *parameter, const char *note);
void answer_identify(struct document *document, const struct result *result);
void answer_diagnose(struct document *document, const struct result *result);
void answer_plain(struct document *document, const struct result *result);

/* of all states */
void section_trust(struct document *document, const struct result *result);
void section_diagnose(struct document *document, const struct result *result);

void section_hidden(struct document *document, const rotid_identification *fit, int count, const rotid_hidden *hidden);

/* ---- the page */

void page_compose(struct document *document, int count, const struct result *result);
/* Writes the page into a file: path, or index.html in it where path is a folder or does not end in .html; a folder that is
 * missing is made. *file is what was written. ROTID_OK; ROTID_ERROR_ARGUMENT, ROTID_ERROR_IO, ROTID_ERROR_MEMORY with what is
 * wrong in the messages and nothing written. */
int page_write(struct document *document, int count, const struct result *result, const char *path, const char *made_by,
               struct message_list *messages, const char **file);

/* The style sheet and the script as `make` embeds them, with the SHA-256 of their bytes in base64; no script ("") where there was
 * no D3. page_licence: of D3. */
extern const char page_style[], page_style_hash[], page_script[], page_script_hash[], page_licence[];

#endif
