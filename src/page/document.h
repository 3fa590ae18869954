/* A page under construction: an answer, then sections of text, tables and figures, in the order in which they are added.
 * Whatever is added when memory is out is lost and marks the document, so that its writer notices. Texts are plain: they are
 * escaped when the page is written. Figures are added empty; whoever adds one fills in caption, alt, script and table. */
#ifndef ROTID_PAGE_DOCUMENT_H
#define ROTID_PAGE_DOCUMENT_H

#include <stdio.h>

#include "page/figure.h"

enum tone { TONE_NONE, TONE_GOOD, TONE_CARE, TONE_BAD }; /* of the answer: no judgement, to be relied on, with care, not at all */

struct page_block { /* text of the page, or a figure */
    struct page_block *next;
    char *html;
    struct figure *figure;
};

struct page_section {
    struct page_section *next;
    const char *id, *heading;
    struct page_block *first, *last;
};

struct page_answer { /* of one result */
    struct page_answer *following;
    enum tone tone;
    const char *of; /* "Diagnosis of rotor.inp", NULL: of the page's only result */
    const char *headline, *answer, *next;
};

struct document {
    struct pool *pool;
    int failed;           /* memory was out */
    const char *title;    /* of the page */
    const char *subtitle; /* what it is made of, under the title */
    /* the answer that is being made, which document_answer takes */
    enum tone tone;
    const char *headline; /* over the answer; NULL: the words of the tone */
    const char *answer;   /* the result in a sentence or two; "": none */
    const char *next;     /* what to do with it, NULL: nothing */
    struct page_answer *answers; /* in the order of the page */
    const char *of;              /* whose sections are added, told in their headings; NULL: that of the page */
    int verbatim; /* texts are shown as they are, with folders and ids: of the section on provenance. Elsewhere page/plain.h */
    struct page_section *first, *last;
    int nfigure, ntable;
    struct figure lost; /* written into where memory was out */
};

void document_open(struct document *document, struct pool *pool);
/* Puts the answer that was made among those of the page: the gravest tone first, of one tone the earlier one. of: whose it is, NULL
 * on a page of one result. */
void document_answer(struct document *document, const char *of);
/* What is added from here on belongs to this section; id as in struct figure. */
void document_section(struct document *document, const char *id, const char *heading);
void document_paragraph(struct document *document, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* A heading within a section. */
void document_heading(struct document *document, const char *text);
void document_list(struct document *document, int count, const char *const text[]);
/* Names and their values; a value NULL is left out with its name. */
void document_facts(struct document *document, int count, const char *const name[], const char *const value[]);
void document_table(struct document *document, const char *caption, struct number_table *table);
/* An empty figure at this place, never NULL: where memory is out one that is thrown away. An id that is taken gets a number. */
struct figure *document_figure(struct document *document, const char *id, const char *title);
/* The figures in the order of the page (pool), document->nfigure of them; NULL where memory is out. */
struct figure **document_figures(const struct document *document);

/* The whole page. made_by: how, for its foot; hint: how to get the figures, NULL where they are there. */
void document_write(FILE *out, const struct document *document, const char *made_by, const char *hint);

/* What tells that a page is one of rotid: in its first KB. */
#define DOCUMENT_MARK "<meta name=\"generator\" content=\"rotid report"

#endif
