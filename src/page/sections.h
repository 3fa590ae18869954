/* Sections of a page, each of one result: text, tables and figures in the order in which they are read. An answer goes into
 * document->tone, headline, answer and next. */
#ifndef ROTID_PAGE_SECTIONS_H
#define ROTID_PAGE_SECTIONS_H

#include "page/document.h"
#include "page/result.h"

/* What an identification says in a sentence, how far it is to be trusted, and why: the answer, and a section "trust". */
void answer_identify(struct document *document, const struct result *result, const rotid_identification *fit);
/* The verdict of a diagnosis, what to do next, and what it rests on: the answer, and a section "trust". */
void answer_diagnose(struct document *document, const struct result *result);
/* What a study says as a whole. */
void answer_study(struct document *document, const struct result *result);
/* Modes of a test and whether any of them is doubtful. */
void answer_ema(struct document *document, const struct result *result);
/* Another result in a sentence, without a judgement. */
void answer_plain(struct document *document, const struct result *result);

/* What causes below their detection limits may do to the parameters of the fit, as a table; nothing where there is none. */
void section_hidden(struct document *document, const rotid_identification *fit, int count, const rotid_hidden *hidden);
/* The parameters that a diagnosis leaves, by each cause that cannot be told apart, and what may hide in them. */
void section_parameters(struct document *document, const rotid_diagnosis *d);

/* Data, noise and model of all results, the heading of the deck, and what rotid notes. */
void section_rests_on(struct document *document, int count, const struct result *result);
/* The last section: files, version, commit, seed, build of all results, ids of causes, and the keys that older results lack. The one
 * place of a page with absolute paths, ids and builds. */
void section_provenance(struct document *document, int count, const struct result *result);

void section_rotor(struct document *document, const struct result *result, const rotid_identification *fit);
/* How well model and measurement agree, of a deck that is one state or of one of its states; of all states together; what was
 * identified and how the fit got there, of all states at once. */
void section_agreement(struct document *document, const struct result *result);
void section_states(struct document *document, const struct result *result);
void section_fit(struct document *document, const struct result *result);
void section_diagnose(struct document *document, const struct result *result);
void section_suggest(struct document *document, const struct result *result);
void section_study(struct document *document, const struct result *result);
void section_modes(struct document *document, const struct result *result);
void section_sensitivity(struct document *document, const struct result *result);
void section_ema(struct document *document, const struct result *result);
void section_transfer(struct document *document, const struct result *result);

#endif
