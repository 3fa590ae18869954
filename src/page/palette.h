/* Colours by their purpose. Scripts name them (BLUE); files that stand alone carry the light values, by which a picture in
 * a page finds the dark ones. After Okabe and Ito (2008), darkened or lightened until each
 * has a contrast of 4.5 against both grounds of its scheme: they tell apart without red and green, and read as text. */
#ifndef ROTID_PAGE_PALETTE_H
#define ROTID_PAGE_PALETTE_H

#include <stddef.h>
#include <stdio.h>

struct role {
    const char *name;     /* of the variable in scripts, and in small letters of that of the style */
    unsigned light, dark; /* 0xrrggbb */
};

extern const struct role palette[]; /* ended by one without a name */

/* Series in this order; from the sixth on they repeat, told apart by their dashes. */
#define SERIES 5
extern const char *const series_color[SERIES];

/* The name of the k-th of 0 ... 10 steps of the ramp from nothing to much; and of the text on it. */
const char *palette_ramp(double share);
const char *palette_on_ramp(double share);

/* NAME = 0xrrggbb for scripts. */
void palette_script(FILE *out);
/* --name: #rrggbb for a style. */
void palette_style(FILE *out, int dark);
#endif
