/* The card of the transfer functions. */
#include "deck/deck_row.h"

void deck_write_frf(struct deck_writer *w)
{
    static const char *const quantities[] = {"DISPLACEMENT", "VELOCITY", "ACCELERATION"}, *const axes[] = {"X", "Y", "Z"};
    const struct frf_request *frf = &w->job->options.frf;
    if (!frf->given)
        return;
    if (frf->npair > DECK_MOST_LINES)
        w->status = w->status ? w->status : ROTID_ERROR_ARGUMENT;
    deck_put_card(w, "FRF");
    if (frf->file) {
        deck_put_option(w, "FILE", frf->file);
        deck_put_option(w, "AXIS", axes[frf->axis]);
        deck_put_option(w, "FLIP", frf->flip ? "YES" : "NO");
        deck_put_option_number(w, "ORIGIN", frf->origin);
    }
    deck_write_options(w, deck_frf_rows, frf);
    if (frf->has_quantity)
        deck_put_option(w, "QUANTITY", quantities[frf->quantity]);
    if (frf->damping > 0)
        deck_put_option_number(w, "DAMPING", frf->damping);
    deck_put(w, "\n");
    for (int i = 0; i < frf->npair; i++)
        deck_put(w, "%d, %d\n", frf->pair[i].response, frf->pair[i].reference);
}
