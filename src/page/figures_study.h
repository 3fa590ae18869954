/* The figures of a study; as figures.h. Those of single runs need the file of results; the others do with a summary. */
#ifndef ROTID_PAGE_FIGURES_STUDY_H
#define ROTID_PAGE_FIGURES_STUDY_H

#include "page/document.h"
#include "page/result.h"

/* From the starts to the ends of the runs, of the first two parameters (Figure 12): of the cell with the most frequencies. */
void figure_starts(struct document *document, const struct result *result);
/* Mean functional over the square of the number of modes (13), and the parameters (14), by the number of modes that were fitted.
 */
void figure_functional_by_modes(struct document *document, const struct result *result);
void figure_parameters_by_modes(struct document *document, const struct result *result);
/* Values less truth over their stated standard deviation, beside the normal distribution. */
void figure_errors_of_runs(struct document *document, const struct result *result);
/* Share of the 95 % intervals that hold the truth, cell by cell. */
void figure_coverage(struct document *document, const struct result *result);
/* Verdicts, or where the truth is known their scores, cell by cell. */
void figure_verdicts(struct document *document, const struct result *result);
/* Parameters of many decks beside each other. */
void figure_decks(struct document *document, const struct result *result);

#endif
