/* Tables of a page that stand open, beside those that belong to a figure. All in the pool, NULL where memory is out. */
#ifndef ROTID_PAGE_TABLES_H
#define ROTID_PAGE_TABLES_H

#include "page/figure.h"
#include "page/result.h"

struct number_table *tables_parameters(struct pool *pool, const rotid_identification *fit);
/* Measured and predicted frequencies with all that is known of each mode. */
struct number_table *tables_fitted_modes(struct pool *pool, const struct result *result, const rotid_identification *fit);
/* What each state has of the fit. */
struct number_table *tables_states(struct pool *pool, const rotid_identification *fit);
/* Levenberg-Marquardt and NLopt side by side. */
struct number_table *tables_minimisers(struct pool *pool, const rotid_identification *fit);
struct number_table *tables_modes(struct pool *pool, const rotid_spectrum *modes);
/* The beam beside the solid: modes, and what it would take the moduli for. */
struct number_table *tables_beside(struct pool *pool, const rotid_beam_beside_solid *beside);
struct number_table *tables_beside_moduli(struct pool *pool, const rotid_beam_beside_solid *beside);
struct number_table *tables_transfer_modes(struct pool *pool, const struct transfer_result *out);

#endif
