#include "page/palette.h"

#include <ctype.h>
#include <math.h>

const struct role palette[] = {
    {"INK", 0x1b1f24, 0xe8eaed},   /* text, axes */
    {"MUTED", 0x5b626b, 0xa3abb5}, /* what is said besides */
    {"GRID", 0xd9dde2, 0x3a4048},  /* thin lines */
    {"PAPER", 0xffffff, 0x16181d}, /* the ground */
    {"BLUE", 0x0072b2, 0x56b4e9},  /* series */
    {"VERMILION", 0xb04a00, 0xf08a4b},
    {"GREEN", 0x007a58, 0x2bbf93},
    {"PURPLE", 0xa8487e, 0xd992b9},
    {"OCHRE", 0x8a5c00, 0xe0b040},
    {"STEEL", 0xc9d6e2, 0x34424f}, /* faces: materials */
    {"SHEETS", 0xf6cf9f, 0x64441a},
    {"LEAF", 0xc4e3d4, 0x24523f},
    {"ROSE", 0xe9cfdf, 0x57394d},
    {"SAND", 0xe6e1c5, 0x4a4630},
    {"BAND", 0xf0f2f5, 0x23272e},  /* a ground that is set off */
    {"SHADE", 0xe6eaf0, 0x272d36}, /* behind a part of a figure */
    {"RAMP0", 0xf7f9fb, 0x1c1f25}, /* from nothing to much */
    {"RAMP1", 0xe4edf5, 0x1b2a38},
    {"RAMP2", 0xd1e2ee, 0x1c354a},
    {"RAMP3", 0xbad5e7, 0x1d405b},
    {"RAMP4", 0xa0c6df, 0x1f4c6d},
    {"RAMP5", 0x84b5d6, 0x215980},
    {"RAMP6", 0x5aa0cb, 0x26668f},
    {"RAMP7", 0x2377ad, 0x66b0df},
    {"RAMP8", 0x126aa2, 0x83c2ea},
    {"RAMP9", 0x065f95, 0xa2d3f3},
    {"RAMP10", 0x004f80, 0xc2e4fa},
    {NULL, 0, 0},
};

const char *const series_color[SERIES] = {"BLUE", "VERMILION", "GREEN", "PURPLE", "OCHRE"};

static int step_of(double share)
{
    return share > 0 ? share < 1 ? (int)floor(10 * share + 0.5) : 10 : 0; /* NaN is none */
}

const char *palette_ramp(double share)
{
    static const char *const names[] = {"RAMP0", "RAMP1", "RAMP2", "RAMP3", "RAMP4", "RAMP5",
                                        "RAMP6", "RAMP7", "RAMP8", "RAMP9", "RAMP10"};
    return names[step_of(share)];
}

const char *palette_on_ramp(double share)
{
    return step_of(share) > 6 ? "PAPER" : "INK";
}

void palette_script(FILE *out)
{
    for (const struct role *role = palette; role->name; role++)
        (void)fprintf(out, "%s = 0x%06x%s", role->name, role->light, (role - palette) % 5 == 4 || !role[1].name ? "\n" : "; ");
}

static void print_name(FILE *out, const char *name)
{
    for (; *name; name++)
        (void)fputc(tolower((unsigned char)*name), out);
}

void palette_style(FILE *out, int dark)
{
    for (const struct role *role = palette; role->name; role++) {
        (void)fputs("--", out);
        print_name(out, role->name);
        (void)fprintf(out, ":#%06x;", dark ? role->dark : role->light);
    }
}
